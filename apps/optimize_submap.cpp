// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "optimize_submap.hpp"

#include <spdlog/fmt/fmt.h>

#include <numbers>

#include "console.hpp"
#include "hmt/submap/reoptimize_submap.hpp"

namespace hmt::apps {

int optimize_one_submap(const std::string& map, int submap, const Globals& globals) {
  const submap::SubmapReoptimization result =
      submap::reoptimize_submap(map, submap, make_run(globals));
  const double turn_deg = result.largest_turn_rad * 180 / std::numbers::pi;
  const nlohmann::ordered_json json = {{"map", map},
                                       {"submap", submap},
                                       {"chi2_initial", result.chi2_before},
                                       {"chi2", result.chi2},
                                       {"largest_move_m", result.largest_move_m},
                                       {"largest_turn_deg", turn_deg}};
  print_result(
      globals, json,
      fmt::format("submap {}: chi2 {:.6g} -> {:.6g}; its keyframes moved by up to {:.4f} m "
                  "and {:.3f} deg in its frame\n",
                  submap, result.chi2_before, result.chi2, result.largest_move_m, turn_deg));
  return kDone;
}

}  // namespace hmt::apps
