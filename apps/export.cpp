// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/submap/export/export_map.hpp"

namespace hmt::apps {
namespace {

struct Arguments {
  std::string map;
  std::string folder;
  submap::ExportOptions options;
};

int export_files(const Arguments& arguments, const Globals& globals) {
  const submap::MapFile map = submap::MapFile::open(arguments.map);
  const std::vector<std::string> files =
      submap::export_map(map, arguments.folder, arguments.options, make_run(globals));
  nlohmann::ordered_json json;
  json["folder"] = arguments.folder;
  json["files"] = files;
  print_result(globals, json, fmt::format("{} files in {}\n", files.size(), arguments.folder));
  return kDone;
}

}  // namespace

Action add_export(CLI::App& command) {
  const auto arguments = std::make_shared<Arguments>();  // shared by the parser and the action
  submap::ExportOptions& options = arguments->options;
  command.add_option("MAP", arguments->map, "Map file made by hmtmap map")->required();
  command.add_option("-o,--output", arguments->folder, "Folder for the files; made if needed")
      ->required();
  command.add_option("--only", options.parts, "Only these parts, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(submap::export_parts()));
  command
      .add_option("--resolution", options.map_resolution_m,
                  "Side of the pixels of map.pgm in metres; larger makes a coarser image")
      ->capture_default_str();
  command.add_flag("--force", options.overwrite, "Replace files that are there already");
  return [arguments](const Globals& globals) { return export_files(*arguments, globals); };
}

}  // namespace hmt::apps
