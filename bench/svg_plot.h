// SPDX-License-Identifier: GPL-3.0-or-later
// Line plots as SVG text: panels side by side with one legend below.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tranos::bench {

struct Tick {
  double at;
  std::string label;
};

struct Axis {
  std::string label;  // with its unit
  double from;
  double to;
  bool is_logarithmic = false;
  std::vector<Tick> ticks;
};
// From `from` to `to`, a tick at each power of ten, both widened to one.
Axis LogarithmicAxis(std::string label, double from, double to);

struct PlotPoint {
  double x, y;
};

struct Series {
  std::string name;    // in the legend, once for all panels
  std::string colour;  // #rrggbb
  std::vector<PlotPoint> points;
  bool has_markers = false;
  bool is_dashed = false;
};

struct Mark {  // a line across the panel at an x
  double at;
  std::string label;
};

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::optional<Mark> mark;
};

// A complete SVG file on a white ground. Points that are not finite break their line, points beyond
// the y axis are drawn at its end.
std::string Svg(const std::vector<Panel>&);

}  // namespace tranos::bench
