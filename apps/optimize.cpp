// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/chi_squared.hpp"
#include "hmt/graph/g2o_file.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/graph/submap_optimizer.hpp"
#include "optimize_submap.hpp"

namespace hmt::apps {
namespace {

using Clock = std::chrono::steady_clock;

/// Lines of a file that a warning names; the count stands beside them.
constexpr size_t kNamedLines = 10;

enum class Method { flat, submaps };

struct OptimizeArguments {
  std::string input;
  std::string output;
  std::string verdicts;  ///< empty: none are written
  graph::PoseOptimizerOptions options;
  Method method = Method::flat;
  int submap = -1;  ///< >= 0: the input is a map, and this submap alone is optimized
  bool force = false;
};

const char* name_of(graph::Termination termination) {
  switch (termination) {
    case graph::Termination::converged:
      return "converged";
    case graph::Termination::iteration_limit:
      return "iteration_limit";
    case graph::Termination::nothing_to_do:
      return "nothing_to_do";
    case graph::Termination::failed:
      break;
  }
  return "failed";
}

const char* name_of(graph::Initialization start) {
  switch (start) {
    case graph::Initialization::given:
      return "given";
    case graph::Initialization::chordal:
      return "chordal";
    case graph::Initialization::spanning_tree:
      return "spanning_tree";
    case graph::Initialization::random_tree:
      return "random_tree";
    case graph::Initialization::best:
      break;
  }
  return "best";
}

// Asked before the work, so that a long run does not end in a refusal.
void refuse_to_overwrite(const OptimizeArguments& arguments) {
  for (const std::string& path : {arguments.output, arguments.verdicts})
    if (!arguments.force && !path.empty() && std::filesystem::exists(path))
      throw graph::InputError(path + ": exists; choose another name or give --force");
}

/// "12, 13, 14, ..." of the edges that `wanted` picks.
template <class Predicate>
std::string lines_of(const graph::G2oFile& file, const Predicate& wanted) {
  std::string text;
  size_t named = 0;
  for (const graph::G2oWeakEdge& weak : file.weak_edges) {
    if (!wanted(weak)) continue;
    if (named++ == kNamedLines) return text + ", ...";
    text += (text.empty() ? "" : ", ") + std::to_string(weak.line);
  }
  return text;
}

/// Says what the file held besides a sound graph; true if something was left out or changed.
bool warn_about(const graph::G2oFile& file, const submap::Run& run) {
  const auto replaced = [](const graph::G2oWeakEdge& weak) { return weak.replaced; };
  const auto singular = [](const graph::G2oWeakEdge& weak) { return !weak.replaced; };
  const auto& weak = file.weak_edges;
  const auto num_replaced = std::count_if(weak.begin(), weak.end(), replaced);
  const auto num_singular = std::count_if(weak.begin(), weak.end(), singular);
  if (num_replaced > 0)
    run.log_warning(fmt::format(
        "{} information matrices have a negative eigenvalue; the nearest positive semidefinite "
        "matrix is used instead (lines {})",
        num_replaced, lines_of(file, replaced)));
  if (num_singular > 0)
    run.log_warning(
        fmt::format("{} information matrices are singular and used as they are "
                    "(lines {})",
                    num_singular, lines_of(file, singular)));
  for (const auto& [tag, count] : file.skipped)
    run.log_warning(fmt::format("{} lines with {} skipped", count, tag));
  if (!file.created.empty())
    run.log_info(fmt::format("{} vertices have no line of their own; they start from the edges",
                             file.created.size()));
  if (file.components > 1)
    run.log_warning(
        fmt::format("the graph has {} components; each keeps its own gauge", file.components));
  return num_replaced > 0 || !file.skipped.empty();
}

nlohmann::ordered_json inputs_to_json(const graph::G2oFile& file) {
  nlohmann::ordered_json weak = nlohmann::ordered_json::array();
  for (const graph::G2oWeakEdge& edge : file.weak_edges)
    weak.push_back({{"line", edge.line},
                    {"smallest_eigenvalue", edge.smallest},
                    {"treatment", edge.replaced ? "replaced" : "kept"}});
  return {{"components", file.components},
          {"created_vertices", file.created.size()},
          {"skipped_lines", file.skipped},
          {"weak_information", weak}};
}

nlohmann::ordered_json starts_to_json(const std::vector<graph::StartReport>& starts) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const graph::StartReport& start : starts)
    all.push_back({{"start", name_of(start.start)},
                   {"chi2_start", start.chi2_start},
                   {"cost", start.cost},
                   {"termination", name_of(start.termination)}});
  return all;
}

/// In the file's terms, every edge that was judged an outlier.
nlohmann::ordered_json outliers_to_json(const graph::G2oFile& file,
                                        const graph::PoseOptimizerReport& report) {
  nlohmann::ordered_json outliers = nlohmann::ordered_json::array();
  for (size_t k = 0; k < report.inlier.size(); ++k) {
    if (report.inlier[k]) continue;
    const graph::PoseGraphEdge& edge = file.graph.edges[k];
    outliers.push_back({{"edge", k},
                        {"from", file.ids[static_cast<size_t>(edge.from)]},
                        {"to", file.ids[static_cast<size_t>(edge.to)]},
                        {"chi2", report.edge_chi2[k]}});
  }
  return outliers;
}

/// One line an edge, in the order of the file.
void write_verdicts(const std::string& path, const graph::G2oFile& file,
                    const graph::PoseOptimizerReport& report) {
  std::string text = "edge,from,to,chi2,inlier\n";
  for (size_t k = 0; k < report.inlier.size(); ++k) {
    const graph::PoseGraphEdge& edge = file.graph.edges[k];
    text += fmt::format("{},{},{},{},{}\n", k, file.ids[static_cast<size_t>(edge.from)],
                        file.ids[static_cast<size_t>(edge.to)], report.edge_chi2[k],
                        report.inlier[k] ? 1 : 0);
  }
  const std::string unfinished = path + ".part";
  std::ofstream out(unfinished, std::ios::binary);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(unfinished, path, error);
  if (!out || error) throw graph::InputError(path + ": cannot be written");
}

/// What chi2 should be if the information is right and all edges are true.
struct Expectation {
  double low = 0;  ///< of the interval that holds chi2 with a probability of 95 %
  double high = 0;
  double p_value = 1;  ///< probability of a chi2 at least as large
};

/// Nothing where no edge is left over to contradict the others.
std::optional<Expectation> expectation_of(const graph::PoseOptimizerReport& report) {
  const auto dof = static_cast<int>(report.degrees_of_freedom);
  if (dof < 1) return std::nullopt;
  return Expectation{graph::chi_squared_quantile(dof, 0.025),
                     graph::chi_squared_quantile(dof, 0.975),
                     graph::chi_squared_survival(dof, report.chi2)};
}

nlohmann::ordered_json to_json(const graph::SubmapReport& submaps) {
  return {{"submaps", submaps.submaps},
          {"links", submaps.links},
          {"chi2_before_refinement", submaps.chi2_before_refinement},
          {"partition_s", submaps.partition_s},
          {"submaps_s", submaps.submaps_s},
          {"links_s", submaps.links_s},
          {"refinement_s", submaps.refinement_s}};
}

nlohmann::ordered_json to_json(const graph::G2oFile& file, const graph::PoseOptimizerReport& report,
                               std::optional<double> condition, double wall_s) {
  nlohmann::ordered_json json = {
      {"poses", file.graph.poses.size()},
      {"edges", file.graph.edges.size()},
      {"chi2_initial", report.chi2_initial},
      {"chi2", report.chi2},
      {"degrees_of_freedom", report.degrees_of_freedom},
      {"iterations", report.iterations},
      {"termination", name_of(report.termination)},
      {"start", name_of(report.start)},
      {"starts", starts_to_json(report.starts)},
      {"cost", report.cost},
      {"gradient_norm", report.gradient_norm},
      {"inliers", std::count(report.inlier.begin(), report.inlier.end(), true)},
      {"outliers", outliers_to_json(file, report)},
      {"untrusted_start", report.untrusted_start},
      {"input", inputs_to_json(file)},
      {"solve_s", report.solve_s},
      {"wall_s", wall_s}};
  if (condition) json["condition"] = *condition;
  if (const auto expected = expectation_of(report)) {
    json["chi2_95_percent"] = {expected->low, expected->high};
    json["chi2_p_value"] = expected->p_value;
  }
  return json;
}

/// "below", "within" or "above" what is expected, and what that means.
std::string judge(const graph::PoseOptimizerReport& report) {
  const auto expected = expectation_of(report);
  if (!expected) return "no edge more than the poses need";
  const char* const verdict =
      report.chi2 < expected->low    ? "less: the edges are better than their information states"
      : report.chi2 > expected->high ? "more: false edges, or too much information"
                                     : "as expected";
  return fmt::format("{:.6g} to {:.6g} in 95 % of cases if the information is right; {}",
                     expected->low, expected->high, verdict);
}

std::string to_text(const graph::G2oFile& file, const graph::PoseOptimizerReport& report,
                    std::optional<double> condition, double wall_s) {
  std::string text = fmt::format(
      "{} poses, {} edges\n"
      "chi2         {:.9g} -> {:.9g}\n"
      "expected     {}\n"
      "start        {}\n"
      "termination  {} after {} iterations, gradient {:.2g}\n",
      file.graph.poses.size(), file.graph.edges.size(), report.chi2_initial, report.chi2,
      judge(report), name_of(report.start), name_of(report.termination), report.iterations,
      report.gradient_norm);
  text += condition ? fmt::format("condition    {:.3g}\n", *condition)
                    : "condition    singular: the edges leave poses open\n";
  for (const graph::StartReport& start : report.starts)
    if (report.starts.size() > 1)
      text += fmt::format("  from {:<13} chi2 {:.9g}, cost {:.9g}\n", name_of(start.start),
                          start.chi2_start, start.cost);
  const auto outliers = std::count(report.inlier.begin(), report.inlier.end(), false);
  if (outliers > 0) text += fmt::format("outliers     {} edges\n", outliers);
  return text +
         fmt::format("time         {:.3f} s solving, {:.3f} s in all\n", report.solve_s, wall_s);
}

int run_optimize(const OptimizeArguments& arguments, const Globals& globals) {
  if (arguments.submap >= 0) return optimize_one_submap(arguments.input, arguments.submap, globals);
  const Clock::time_point begin = Clock::now();
  refuse_to_overwrite(arguments);
  const submap::Run run = make_run(globals);
  graph::G2oFile file = graph::read_g2o(arguments.input);
  bool losses = warn_about(file, run);
  graph::PoseOptimizerOptions options = arguments.options;
  options.threads = globals.threads;
  std::optional<graph::SubmapReport> submaps;
  graph::PoseOptimizerResult result;
  if (arguments.method == Method::submaps) {
    graph::SubmapOptimizerResult by_submaps = graph::optimize_by_submaps(file.graph, options);
    result = std::move(by_submaps.result);
    submaps = by_submaps.submaps;
  } else {
    result = graph::optimize(file.graph, options);
  }
  const graph::PoseOptimizerReport& report = result.report;
  if (report.termination == graph::Termination::failed)
    throw graph::InputError(arguments.input + ": the solver failed: " + report.message);
  if (report.termination == graph::Termination::iteration_limit) {
    run.log_warning(
        fmt::format("stopped after {} iterations before convergence", report.iterations));
    losses = true;
  }
  if (report.untrusted_start)
    run.log_warning(
        "the edges between consecutive vertices do not determine all poses; what joins them is a "
        "guess that was checked: the verdict on the edges is sound for a few drives that loops "
        "join, and weak where no odometry is known");
  file.graph.poses = std::move(result.poses);
  graph::write_g2o(arguments.output, file);
  if (!arguments.verdicts.empty()) write_verdicts(arguments.verdicts, file, report);
  const auto condition = graph::PoseCovariance(file.graph).condition();
  const double wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  nlohmann::ordered_json json = to_json(file, report, condition, wall_s);
  if (submaps) json["by_submaps"] = to_json(*submaps);
  print_result(globals, json, to_text(file, report, condition, wall_s));
  return losses ? kDoneWithLosses : kDone;
}

}  // namespace

Action add_optimize(CLI::App& command) {
  // Shared by the options, which write into it, and the action, which reads it later.
  const auto arguments = std::make_shared<OptimizeArguments>();
  graph::PoseOptimizerOptions& options = arguments->options;
  options.initialization = graph::Initialization::best;
  command.add_option("graph", arguments->input, "Pose graph in g2o format, or a map")->required();
  CLI::App* result = command.add_option_group("result")->require_option(1);
  result->add_option("-o,--output", arguments->output, "Optimized graph in g2o format");
  result
      ->add_option(
          "--submap", arguments->submap,
          "Optimize this submap of a map, on its own in its own frame, and touch nothing else")
      ->check(CLI::NonNegativeNumber);
  const std::map<std::string, graph::RobustMethod> methods = {{"none", graph::RobustMethod::none},
                                                              {"huber", graph::RobustMethod::huber},
                                                              {"gnc", graph::RobustMethod::gnc}};
  command
      .add_option("--robust", options.robust,
                  "Edges that contradict the others: none, huber (weakened) or gnc (refused)")
      ->transform(CLI::CheckedTransformer(methods, CLI::ignore_case).description(""));
  const std::map<std::string, Method> ways = {{"flat", Method::flat}, {"submaps", Method::submaps}};
  command
      .add_option("--method", arguments->method,
                  "flat, or submaps: cut by min-Ncut, solved apart, joined, refined together")
      ->transform(CLI::CheckedTransformer(ways, CLI::ignore_case).description(""));
  command.add_option("--restarts", options.restarts, "Further starts to solve from")
      ->check(CLI::Range(0, 1000));
  command.add_option("--max-iterations", options.max_iterations, "Upper limit of one solve")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_option("--verdicts", arguments->verdicts,
                     "CSV file of all edges in the order of the graph: edge,from,to,chi2,inlier");
  command.add_flag("--force", arguments->force, "Overwrite files that exist");
  command.footer(
      "chi2 is that of the g2o format: the sum of r^T Omega r with r = (R_z^T (t_rel - t_z), yaw) "
      "or\n(R_z^T (t_rel - t_z), vec(q_z^-1 q_rel)). Tools that leave the translation in frame i, "
      "or take\n2 vec(q) or the logarithm, minimize something else.");
  return [arguments](const Globals& globals) { return run_optimize(*arguments, globals); };
}

}  // namespace hmt::apps
