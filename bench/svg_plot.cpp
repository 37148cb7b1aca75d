// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tranos::bench {
namespace {

constexpr double kPanelWidth = 400, kPlotLeft = 70, kPlotRight = 385, kPlotTop = 34,
                 kPlotBottom = 300, kLegendTop = 362;

double Fraction(const Axis& axis, double value) {
  if (axis.is_logarithmic) return std::log(value / axis.from) / std::log(axis.to / axis.from);
  return (value - axis.from) / (axis.to - axis.from);
}

// Where the values of one panel are on the page.
struct Page {
  const Panel& panel;
  double left;

  double X(double value) const {
    return left + kPlotLeft + (kPlotRight - kPlotLeft) * Fraction(panel.x, value);
  }
  double Y(double value) const {
    const double inside = std::clamp(Fraction(panel.y, value), 0.0, 1.0);
    return kPlotBottom - (kPlotBottom - kPlotTop) * inside;
  }
};

std::string Text(double x, double y, std::string_view anchor, std::string_view text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     text);
}

std::string Line(double x1, double y1, double x2, double y2, std::string_view style) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" {}/>\n", x1, y1, x2, y2, style);
}

std::string AxesOf(const Page& page) {
  constexpr std::string_view grid = "stroke=\"#ddd\"";
  const double left = page.left + kPlotLeft, right = page.left + kPlotRight;
  std::string svg;
  for (const Tick& tick : page.panel.x.ticks) {
    svg += Line(page.X(tick.at), kPlotTop, page.X(tick.at), kPlotBottom, grid);
    svg += Text(page.X(tick.at), kPlotBottom + 17, "middle", tick.label);
  }
  for (const Tick& tick : page.panel.y.ticks) {
    svg += Line(left, page.Y(tick.at), right, page.Y(tick.at), grid);
    svg += Text(left - 6, page.Y(tick.at) + 4, "end", tick.label);
  }
  svg += fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>\n", left,
      kPlotTop, kPlotRight - kPlotLeft, kPlotBottom - kPlotTop);
  svg += Text(0.5 * (left + right), kPlotBottom + 37, "middle", page.panel.x.label);
  svg += Text(0.5 * (left + right), kPlotTop - 12, "middle", page.panel.title);
  svg += fmt::format(
      "<text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
      page.left + 18, 0.5 * (kPlotTop + kPlotBottom), page.panel.y.label);
  return svg;
}

std::string StyleOf(const Series& series) {
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"{}",
                     series.colour, series.is_dashed ? " stroke-dasharray=\"6 4\"" : "");
}

std::string CurveOf(const Page& page, const Series& series) {
  std::string path, markers;
  bool is_open = false;
  for (const PlotPoint& p : series.points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
      is_open = false;
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f}", is_open ? "L" : "M", page.X(p.x), page.Y(p.y));
    is_open = true;
    if (series.has_markers)
      markers += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n",
                             page.X(p.x), page.Y(p.y), series.colour);
  }
  if (path.empty()) return "";
  return fmt::format("<path d=\"{}\" {}/>\n{}", path, StyleOf(series), markers);
}

std::string PanelOf(const Page& page) {
  std::string svg = AxesOf(page);
  for (const Series& series : page.panel.series) svg += CurveOf(page, series);
  if (const auto& mark = page.panel.mark) {
    const double x = page.X(mark->at);
    svg += Line(x, kPlotTop, x, kPlotBottom, "stroke=\"#444\" stroke-dasharray=\"2 3\"");
    svg += Text(x + 5, kPlotBottom - 8, "start", mark->label);
  }
  return svg;
}

// Of all panels' series, each name once.
std::string LegendOf(const std::vector<Panel>& panels) {
  std::string svg;
  std::vector<std::string> names;
  double x = kPlotLeft;
  for (const Panel& panel : panels)
    for (const Series& series : panel.series) {
      if (std::ranges::find(names, series.name) != names.end()) continue;
      names.push_back(series.name);
      svg += Line(x, kLegendTop, x + 24, kLegendTop, StyleOf(series));
      svg += Text(x + 30, kLegendTop + 4, "start", series.name);
      x += 54 + 8 * static_cast<double>(series.name.size());
    }
  return svg;
}

}  // namespace

namespace {

// 1000 and more, 0.001 and less, as a power.
std::string PowerOfTen(int power) {
  constexpr const char* superscript[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (std::abs(power) < 3) return fmt::format("{:g}", std::pow(10, power));
  std::string text = power < 0 ? "10⁻" : "10";
  for (const char digit : fmt::format("{}", std::abs(power))) text += superscript[digit - '0'];
  return text;
}

}  // namespace

Axis LogarithmicAxis(std::string label, double from, double to) {
  const int low = static_cast<int>(std::floor(std::log10(from) + 1e-9));
  const int high = static_cast<int>(std::ceil(std::log10(to) - 1e-9));
  Axis axis{std::move(label), std::pow(10, low), std::pow(10, std::max(high, low + 1)), true, {}};
  for (int power = low; power <= std::max(high, low + 1); ++power)
    axis.ticks.push_back({std::pow(10, power), PowerOfTen(power)});
  return axis;
}

std::string Svg(const std::vector<Panel>& panels) {
  const double width = kPanelWidth * static_cast<double>(panels.size()), height = kLegendTop + 18;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, height);
  for (std::size_t i = 0; i < panels.size(); ++i)
    svg += PanelOf({panels[i], kPanelWidth * static_cast<double>(i)});
  return svg + LegendOf(panels) + "</svg>\n";
}

}  // namespace tranos::bench
