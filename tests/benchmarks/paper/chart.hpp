// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace hmt::paper {

/// Mean and spread of a sample.
struct Statistics {
  double mean = 0;
  double deviation = 0;  ///< standard
  double low = 0;        ///< 16th percentile: with `high` the 68 % interval
  double high = 0;       ///< 84th percentile
};

/// Of at least one number.
Statistics statistics(std::vector<double> sample);

/// Points with their 68 % intervals, joined by a line or not.
struct Series {
  std::string name;
  std::string color;
  bool joined = true;
  std::vector<double> x;
  std::vector<Statistics> y;
};

struct Axis {
  std::string label;
  double low = 0;
  double high = 1;
  double tick = 0.1;
};

/// A chart with linear axes as SVG.
std::string chart_svg(const std::string& title, const Axis& x, const Axis& y,
                      const std::vector<Series>& series);

}  // namespace hmt::paper
