// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <array>
#include <map>
#include <thread>
#include <vector>

#include "commands.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::apps {
namespace {

// In the order of the work; one file a command.
const std::vector<Command> kCommands = {
    {"map", "Make a hybrid map of a log", add_map},
    {"export", "Write the files of a map: submaps, topology, trajectory, image, report",
     add_export},
    {"check", "Examine logs: clocks, gaps, geometry, odometry, damage", add_check},
    {"info", "What is in a log or a map", add_info},
    {"evaluate", "Errors of a map or trajectory against truth; how crisp a map is", add_evaluate},
    {"route", "The shortest way between two places, and how well it is known", add_route},
    {"loops", "List the loop closures of a map, or overrule them", add_loops},
    {"partition", "Cut an overlap graph into groups by recursive spectral min-Ncut", add_partition},
    {"optimize", "Optimize a pose graph in g2o format", add_optimize},
    {"compare", "How alike two partitions, trajectories or maps are", add_compare},
    {"simulate", "Make a log with ground truth", add_simulate},
};

void add_globals(CLI::App& app, Globals& globals) {
  app.add_flag("--json", globals.json, "Print one JSON object on stdout; messages go to stderr");
  app.add_option("--threads", globals.threads, "Threads to use; 0 takes every core")
      ->check(CLI::Range(0, 1024));
  app.add_flag("-v,--verbose", globals.verbose, "More messages, with the time of day");
  app.add_flag("-q,--quiet", globals.quiet, "Only warnings and errors");
  const std::map<std::string, ProgressMode> modes = {{"auto", ProgressMode::automatic},
                                                     {"plain", ProgressMode::plain},
                                                     {"none", ProgressMode::none}};
  app.add_option("--progress", globals.progress, "auto, plain (lines) or none")
      ->transform(CLI::CheckedTransformer(modes, CLI::ignore_case).description(""));
  app.set_config("--config", "",
                 "Read options from a TOML or INI file; a command's options stand in its section");
  app.set_version_flag("--version", "hmtmap " HMTMAP_VERSION);
}

void set_up_messages(const Globals& globals) {
  auto logger =
      std::make_shared<spdlog::logger>("hmtmap", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern(globals.verbose ? "%H:%M:%S.%e %^%l%$: %v" : "%^%l%$: %v");
  if (globals.verbose) logger->set_level(spdlog::level::debug);
  if (globals.quiet) logger->set_level(spdlog::level::warn);
  spdlog::set_default_logger(logger);
}

int run_action(const Action& action, const Globals& globals) {
  try {
    return action(globals);
  } catch (const submap::Interrupted&) {
    spdlog::warn("interrupted; the same command goes on from the last finished stage");
    return kInterrupted;
  } catch (const graph::InputError& error) {
    spdlog::error(error.what());
  } catch (const std::bad_alloc&) {
    spdlog::error("out of memory");
  } catch (const std::exception& error) {
    spdlog::error("internal error, please report it: {}", error.what());
  }
  return kFailed;
}

int run(int argc, char** argv) {
  CLI::App app{"Hybrid metric-topological maps from robot logs", "hmtmap"};
  app.require_subcommand(1);
  app.fallthrough();
  Globals globals;
  add_globals(app, globals);
  Action chosen;
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    const Action action = command.add(*sub);
    sub->callback([&chosen, action] { chosen = action; });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  if (globals.threads == 0)
    globals.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  set_up_messages(globals);
  return run_action(chosen, globals);
}

}  // namespace
}  // namespace hmt::apps

int main(int argc, char** argv) {
  return hmt::apps::run(argc, argv);
}
