// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "log_text.hpp"
#include "map_info.hpp"
#include "trajectory_input.hpp"

namespace hmt::apps {
namespace {

int log_info(const std::string& path, const Globals& globals) {
  const auto log = submap::open_log(path);
  const submap::LogSummary summary = submap::summarize_log(*log, make_run(globals));
  nlohmann::ordered_json json = {{"log", path}};
  json.update(log_json(summary));
  print_result(globals, json, fmt::format("{}: log\n{}", path, log_text(summary)));
  return summary.report.losses.empty() ? kDone : kDoneWithLosses;
}

}  // namespace

Action add_info(CLI::App& command) {
  const auto path = std::make_shared<std::string>();  // shared by the parser and the action
  command.add_option("LOG|MAP", *path, "Log or map file to look into")->required();
  return [path](const Globals& globals) {
    return is_map_file(*path) ? map_info(*path, globals) : log_info(*path, globals);
  };
}

}  // namespace hmt::apps
