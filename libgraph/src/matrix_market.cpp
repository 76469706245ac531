// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/matrix_market.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gzip_lines.hpp"
#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

// A few bytes of header must not be able to ask for more memory than a partition could use.
constexpr int64_t kMaxNodes = 10'000'000;
// Entries are counted before memory is asked for; this much is taken on trust.
constexpr int64_t kTrustedEntries = 1 << 20;

struct Header {
  bool pattern = false;
  bool symmetric = false;
  int nodes = 0;
  int64_t entries = 0;
};

// One entry as in the file, from 0, with its line for messages.
struct Entry {
  int row = 0;
  int column = 0;
  double weight = 0;
  int64_t line = 0;

  std::pair<int, int> key() const { return std::minmax(row, column); }
};

std::string_view next_word(std::string_view& line) {
  const size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  line.remove_prefix(word.size());
  return word;
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t") == std::string_view::npos;
}

std::string lower(std::string_view word) {
  std::string result(word);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string in_quotes(std::string_view word) {
  return std::string("'").append(word.substr(0, 40)).append("'");
}

template <class T>
T parse(const GzipLines& lines, std::string_view word, const char* what) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || word.empty())
    lines.refuse(std::string(what) + " is " + in_quotes(word) + ", which is no number in range");
  return value;
}

Header read_banner(GzipLines& lines) {
  const auto first = lines.next();
  std::string_view line = first.value_or("");
  if (next_word(line) != "%%MatrixMarket")
    lines.refuse("a Matrix Market file starts with %%MatrixMarket");
  const std::string object = lower(next_word(line));
  const std::string format = lower(next_word(line));
  const std::string field = lower(next_word(line));
  const std::string symmetry = lower(next_word(line));
  if (object != "matrix" || format != "coordinate")
    lines.refuse("holds " + in_quotes(object + " " + format) + "; 'matrix coordinate' is needed");
  if (field != "real" && field != "integer" && field != "pattern" && field != "double")
    lines.refuse("has entries of type " + in_quotes(field) +
                 "; real, integer or pattern is needed");
  if (symmetry != "symmetric" && symmetry != "general")
    lines.refuse("is " + in_quotes(symmetry) + "; symmetric or general is needed");
  return {field == "pattern", symmetry == "symmetric", 0, 0};
}

// The next line that is neither blank nor a comment.
std::optional<std::string_view> next_data(GzipLines& lines) {
  auto line = lines.next();
  while (line && (is_blank(*line) || line->front() == '%')) line = lines.next();
  return line;
}

Header read_header(GzipLines& lines) {
  Header header = read_banner(lines);
  auto line = next_data(lines);
  if (!line) lines.refuse("the file ends before its size line");
  const auto rows = parse<int64_t>(lines, next_word(*line), "the number of rows");
  const auto columns = parse<int64_t>(lines, next_word(*line), "the number of columns");
  header.entries = parse<int64_t>(lines, next_word(*line), "the number of entries");
  if (!is_blank(*line)) lines.refuse("the size line has more than three numbers");
  if (rows != columns)
    lines.refuse("the matrix has " + std::to_string(rows) + " rows and " + std::to_string(columns) +
                 " columns; it must be square");
  if (rows < 0 || rows > kMaxNodes)
    lines.refuse("the matrix has " + std::to_string(rows) + " rows; 0 to " +
                 std::to_string(kMaxNodes) + " can be read");
  if (header.entries < 0 || header.entries > rows * rows)
    lines.refuse("the matrix says it has " + std::to_string(header.entries) +
                 " entries, which it cannot hold");
  header.nodes = static_cast<int>(rows);
  return header;
}

Entry read_entry(const GzipLines& lines, const Header& header, std::string_view line) {
  Entry entry;
  entry.line = lines.line_number();
  const auto row = parse<int64_t>(lines, next_word(line), "the row");
  const auto column = parse<int64_t>(lines, next_word(line), "the column");
  entry.weight = header.pattern ? 1 : parse<double>(lines, next_word(line), "the weight");
  const auto refuse = [&](const std::string& reason) {
    lines.refuse("entry (row " + std::to_string(row) + ", column " + std::to_string(column) +
                 "): " + reason);
  };
  if (!is_blank(line)) refuse("the line has more numbers than an entry");
  const auto outside = [&](int64_t index) { return index < 1 || index > header.nodes; };
  if (outside(row) || outside(column))
    refuse("outside the matrix of " + std::to_string(header.nodes) + " rows; rows count from 1");
  if (!std::isfinite(entry.weight)) refuse("the weight is not a finite number");
  if (entry.weight < 0)
    refuse("the weight " + std::to_string(entry.weight) + " is negative; weights must be >= 0");
  if (row == column && entry.weight != 0)
    refuse("the weight on the diagonal must be 0 or left out: no node is its own neighbor");
  entry.row = static_cast<int>(row - 1);
  entry.column = static_cast<int>(column - 1);
  return entry;
}

std::vector<Entry> read_entries(GzipLines& lines, const Header& header) {
  std::vector<Entry> entries;
  entries.reserve(static_cast<size_t>(std::min(header.entries, kTrustedEntries)));
  int64_t count = 0;
  while (const auto line = next_data(lines)) {
    if (++count > header.entries)
      lines.refuse("more entries than the " + std::to_string(header.entries) + " of the size line");
    const Entry entry = read_entry(lines, header, *line);
    if (entry.row != entry.column) entries.push_back(entry);
  }
  if (count < header.entries)
    lines.refuse("the file ends after " + std::to_string(count) + " of " +
                 std::to_string(header.entries) + " entries");
  return entries;
}

[[noreturn]] void refuse_entry(const std::filesystem::path& path, const Entry& entry,
                               const std::string& reason) {
  throw InputError(path.string() + ":" + std::to_string(entry.line) + ": entry (row " +
                   std::to_string(entry.row + 1) + ", column " + std::to_string(entry.column + 1) +
                   "): " + reason);
}

// One arc a pair of nodes; entries of a pair are neighbors after the sort.
std::vector<Arc> pair_up(const std::filesystem::path& path, const Header& header,
                         std::vector<Entry>& entries) {
  const auto before = [](const Entry& x, const Entry& y) {
    return x.key() != y.key() ? x.key() < y.key() : x.line < y.line;
  };
  if (!std::is_sorted(entries.begin(), entries.end(), before))
    std::sort(entries.begin(), entries.end(), before);
  std::vector<Arc> arcs;
  arcs.reserve(header.symmetric ? entries.size() : entries.size() / 2);
  for (size_t i = 0; i < entries.size();) {
    const Entry& entry = entries[i];
    size_t end = i + 1;
    while (end < entries.size() && entries[end].key() == entry.key()) ++end;
    for (size_t k = i + 1; k < end; ++k)
      if (header.symmetric || entries[k].row == entry.row || k > i + 1)
        refuse_entry(path, entries[k],
                     "given before, in line " + std::to_string(entries[k - 1].line));
    const double mirrored = header.symmetric ? entry.weight
                            : end == i + 2   ? entries[i + 1].weight
                                             : 0;
    if (mirrored != entry.weight)
      refuse_entry(path, entry,
                   "the weight " + std::to_string(entry.weight) + " has " +
                       std::to_string(mirrored) +
                       " on the other side of the diagonal; the matrix must be symmetric");
    arcs.push_back({entry.key().first, entry.key().second, entry.weight});
    i = end;
  }
  return arcs;
}

}  // namespace

WeightedGraph read_matrix_market(const std::filesystem::path& path) {
  GzipLines lines(path);
  const Header header = read_header(lines);
  std::vector<Entry> entries = read_entries(lines, header);
  const std::vector<Arc> arcs = pair_up(path, header, entries);
  try {
    return {header.nodes, arcs};
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

bool is_matrix_market(const std::filesystem::path& path) {
  try {
    GzipLines lines(path);
    return lines.next().value_or("").starts_with("%%MatrixMarket");
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace hmt::graph
