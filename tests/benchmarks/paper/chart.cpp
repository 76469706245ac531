// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "svg.hpp"

namespace hmt::paper {
namespace {

constexpr double kWidth = 640;
constexpr double kHeight = 360;
constexpr double kLeft = 60;
constexpr double kRight = 15;
constexpr double kTop = 30;
constexpr double kBottom = 45;

/// A tick's label: rounded, and never -0.
std::string tick_text(double value) {
  return fmt::format("{:g}", std::round(value * 1e6) / 1e6 + 0.0);
}

/// Linear between the neighbors in the sorted sample.
double percentile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(std::floor(at));
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - std::floor(at)) * (sorted[above] - sorted[below]);
}

class Plot {
 public:
  Plot(const Axis& x, const Axis& y) : x_(x), y_(y) {}

  Eigen::Vector2d at(double x, double y) const {
    const double inside = std::clamp(y, y_.low, y_.high);
    return {
        kLeft + (x - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight),
        kHeight - kBottom - (inside - y_.low) / (y_.high - y_.low) * (kHeight - kTop - kBottom)};
  }

  void draw_axes(Svg& svg) const {
    for (double v = y_.low; v <= y_.high + 1e-9; v += y_.tick) {
      svg.line(at(x_.low, v), at(x_.high, v), "#ddd");
      svg.text(at(x_.low, v) + Eigen::Vector2d(-6, 4), tick_text(v), "end", 11);
    }
    for (double v = std::ceil(x_.low / x_.tick) * x_.tick; v <= x_.high + 1e-9; v += x_.tick)
      svg.text(at(v, y_.low) + Eigen::Vector2d(0, 16), tick_text(v), "middle", 11);
    svg.frame(at(x_.low, y_.high), at(x_.high, y_.low) - at(x_.low, y_.high), "#000");
    svg.text({(kLeft + kWidth - kRight) / 2, kHeight - 8}, x_.label, "middle");
    svg.add(
        fmt::format(R"svg(<text transform="translate(16 {}) rotate(-90)" text-anchor="middle" )svg"
                    R"svg(font-size="12">{}</text>)svg",
                    px((kTop + kHeight - kBottom) / 2), y_.label));
  }

  void draw(Svg& svg, const Series& series) const {
    std::vector<Eigen::Vector2d> line;
    for (size_t i = 0; i < series.x.size(); ++i) {
      const Statistics& y = series.y[i];
      svg.line(at(series.x[i], y.low), at(series.x[i], y.high), series.color, 1.5);
      svg.circle(at(series.x[i], y.mean), 2.5, series.color);
      line.push_back(at(series.x[i], y.mean));
    }
    if (series.joined) svg.polyline(line, series.color);
  }

 private:
  const Axis& x_;
  const Axis& y_;
};

}  // namespace

Statistics statistics(std::vector<double> sample) {
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  Statistics s;
  s.mean = std::accumulate(sample.begin(), sample.end(), 0.0) / n;
  for (const double value : sample) s.deviation += (value - s.mean) * (value - s.mean) / n;
  s.deviation = std::sqrt(s.deviation);
  s.low = percentile(sample, 0.16);
  s.high = percentile(sample, 0.84);
  return s;
}

std::string chart_svg(const std::string& title, const Axis& x, const Axis& y,
                      const std::vector<Series>& series) {
  Svg svg(kWidth, kHeight);
  const Plot plot(x, y);
  svg.text({kLeft, 20}, title);
  plot.draw_axes(svg);
  double legend_y = kTop + 18;
  for (const Series& one : series) {
    plot.draw(svg, one);
    svg.circle({kWidth - 200, legend_y - 4}, 3, one.color);
    svg.text({kWidth - 190, legend_y}, one.name, "start", 11);
    legend_y += 16;
  }
  return svg.str();
}

}  // namespace hmt::paper
