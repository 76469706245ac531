// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/input_error.hpp"
#include "log_options.hpp"
#include "log_text.hpp"

namespace hmt::apps {
namespace {

struct Verdict {
  ExitCode code = kDone;
  nlohmann::ordered_json json;
  std::string text;
};

Verdict judge(const std::string& path, const submap::LogSummary& summary) {
  const bool losses = !summary.report.losses.empty();
  const char* verdict = losses                     ? "usable with losses"
                        : summary.findings.empty() ? "fine"
                                                   : "fine, with notes";
  Verdict result;
  result.code = losses ? kDoneWithLosses : kDone;
  result.json = {{"log", path}, {"verdict", verdict}};
  result.json.update(log_json(summary));
  result.json["notes"] = summary.report.notes;
  result.json["losses"] = summary.report.losses;
  result.json["findings"] = summary.findings;
  result.text = fmt::format("{}: {}\n{}", path, verdict, log_text(summary));
  for (const std::string& finding : summary.findings)
    result.text += fmt::format("  - {}\n", finding);
  return result;
}

Verdict check_log(const std::string& path, const submap::LogOptions& options,
                  const submap::Run& run) {
  try {
    const auto log = submap::open_log(path, options);
    return judge(path, submap::summarize_log(*log, run));
  } catch (const graph::InputError& error) {
    return {kFailed,
            {{"log", path}, {"verdict", "unusable"}, {"findings", {error.what()}}},
            fmt::format("{}: unusable\n  - {}\n", path, error.what())};
  }
}

/// The worst of two: unusable, then losses, then fine.
ExitCode worse(ExitCode a, ExitCode b) {
  for (const ExitCode code : {kFailed, kDoneWithLosses})
    if (a == code || b == code) return code;
  return kDone;
}

struct CheckArguments {
  std::vector<std::string> logs;
  submap::LogOptions options;
};

int check(const CheckArguments& arguments, const Globals& globals) {
  const submap::Run run = make_run(globals);
  nlohmann::ordered_json json = {{"logs", nlohmann::ordered_json::array()}};
  std::string text;
  ExitCode code = kDone;
  for (const std::string& path : arguments.logs) {
    const Verdict verdict = check_log(path, arguments.options, run);
    code = worse(code, verdict.code);
    json["logs"].push_back(verdict.json);
    text += verdict.text;
  }
  print_result(globals, json, text);
  return code;
}

}  // namespace

Action add_check(CLI::App& command) {
  const auto arguments = std::make_shared<CheckArguments>();  // shared by the parser and the action
  command.add_option("LOG", arguments->logs, std::string("Logs to examine: ") + kLogFormats)
      ->required();
  add_log_options(command, arguments->options);
  command.footer("Exit code 0: fine; 3: usable, but records had to be left out; 1: unusable.");
  return [arguments](const Globals& globals) { return check(*arguments, globals); };
}

}  // namespace hmt::apps
