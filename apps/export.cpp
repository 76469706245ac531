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
  std::vector<double> height_band;  // none, or MIN and MAX
};

int export_files(const Arguments& arguments, const Globals& globals) {
  const submap::MapFile map = submap::MapFile::open(arguments.map);
  submap::ExportOptions options = arguments.options;
  if (!arguments.height_band.empty())
    options.height_band_m = {arguments.height_band[0], arguments.height_band[1]};
  const std::vector<std::string> files =
      submap::export_map(map, arguments.folder, options, make_run(globals));
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
                  "Side of the pixels of map.pgm in metres; larger makes a coarser image; unless "
                  "given 0.05, of clouds 0.2")
      ->type_name("FLOAT");
  command
      .add_option(
          "--height-band", arguments->height_band,
          "Of clouds: map.pgm shows what lies between these two heights in metres over the "
          "origin of the robot; unless given, from 0.3 to 2 m over the ground that is found")
      ->type_name("MIN MAX")
      ->expected(2);
  command.add_flag("--force", options.overwrite, "Replace files that are there already");
  return [arguments](const Globals& globals) { return export_files(*arguments, globals); };
}

}  // namespace hmt::apps
