// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/input_error.hpp"
#include "log_options.hpp"
#include "log_text.hpp"
#include "map_info.hpp"
#include "trajectory_input.hpp"

namespace hmt::apps {
namespace {

struct InfoArguments {
  std::string path;
  submap::LogOptions options;
};

struct LogInfo {
  nlohmann::ordered_json json;
  std::string text;
  bool losses = false;

  void add_losses(const submap::LogReport& report) {
    for (const auto& [what, times] : report.losses) {
      losses = true;
      json["losses"][what] = times;
    }
  }
};

/// Observations and sensors. Of a recording a user may want the topics only, so that it cannot be
/// mapped is an answer there.
void add_observations(const InfoArguments& arguments, bool is_recording, const submap::Run& run,
                      LogInfo& info) {
  try {
    const auto log = submap::open_log(arguments.path, arguments.options);
    const submap::LogSummary summary = submap::summarize_log(*log, run);
    info.json.update(log_json(summary));
    info.text += log_text(summary);
    info.add_losses(summary.report);
  } catch (const graph::InputError& error) {
    if (!is_recording) throw;
    info.json["no_map_because"] = error.what();
    info.text += fmt::format("  no map can be made: {}\n", error.what());
  }
}

int log_info(const InfoArguments& arguments, const Globals& globals) {
  const submap::Run run = make_run(globals);
  LogInfo info;
  info.json = {{"log", arguments.path}};
  const auto recording = submap::summarize_recording(arguments.path, run);
  info.text = fmt::format("{}: {}\n", arguments.path, recording ? "recording" : "log");
  if (recording) {
    info.json["topics"] = topics_json(recording->topics);
    info.text += topics_text(recording->topics);
    info.add_losses(recording->report);
  }
  add_observations(arguments, recording.has_value(), run, info);
  if (info.losses)
    for (const auto& [what, times] : info.json["losses"].items())
      info.text += fmt::format("  loss: {} ({})\n", what, times.get<int64_t>());
  print_result(globals, info.json, info.text);
  return info.losses ? kDoneWithLosses : kDone;
}

}  // namespace

Action add_info(CLI::App& command) {
  const auto arguments = std::make_shared<InfoArguments>();  // shared by the parser and the action
  command
      .add_option("LOG|MAP", arguments->path,
                  std::string("Map file or log to look into; logs: ") + kLogFormats)
      ->required();
  add_log_options(command, arguments->options);
  return [arguments](const Globals& globals) {
    return is_map_file(arguments->path) ? map_info(arguments->path, globals)
                                        : log_info(*arguments, globals);
  };
}

}  // namespace hmt::apps
