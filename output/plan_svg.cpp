// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/plan_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "output/facets.h"
#include "output/view.h"
#include "output/visibility.h"

namespace tranos::output {
namespace {

using geom::Affine;
using geom::Vec3;

// Curves deviate from their chords by no more than this.
constexpr double kChord_px = 0.05;
// Coordinates are written in whole hundredths of a pixel.
constexpr double kSteps_per_px = 100;

using Place = std::pair<long, long>;  // in steps, y down
using Line = std::deque<Place>;
using Style = std::tuple<std::uint32_t, int, int>;  // colour, line style, weight

// Lines of one style; one that begins or ends where another does goes on from it.
class Path {
 public:
  void Add(Line line) {
    line.erase(std::unique(line.begin(), line.end()), line.end());
    if (line.size() < 2) return;
    for (Line& known : lines_) {
      if (known.front() == known.back()) continue;
      if (line.front() == known.front() || line.back() == known.back())
        std::reverse(line.begin(), line.end());
      if (line.front() == known.back()) {
        known.insert(known.end(), line.begin() + 1, line.end());
        return;
      }
      if (line.back() == known.front()) {
        known.insert(known.begin(), line.begin(), line.end() - 1);
        return;
      }
    }
    lines_.push_back(std::move(line));
  }
  std::string Data() const {
    std::string data;
    for (const Line& line : lines_) {
      const bool closed = line.front() == line.back();
      char letter = 'M';
      for (std::size_t i = 0; i + (closed ? 1 : 0) < line.size(); ++i) {
        data += fmt::format("{}{} {}", letter, static_cast<double>(line[i].first) / kSteps_per_px,
                            static_cast<double>(line[i].second) / kSteps_per_px);
        letter = 'L';
      }
      if (closed) data += 'Z';
    }
    return data;
  }
  bool empty() const { return lines_.empty(); }

 private:
  std::vector<Line> lines_;
};

struct Drawn {
  const model::Element* element;
  Affine world_from_element;
  Style style;
};

// Strokes are drawn only of these.
bool IsLine(const model::Element& leaf) {
  return std::holds_alternative<model::CurvePtr>(leaf.geometry) ||
         std::holds_alternative<model::TextPtr>(leaf.geometry);
}

std::vector<Drawn> VisibleLines(const model::Model& model) {
  std::vector<Drawn> lines;
  model.ForEach([&](const model::ElementPtr& element) {
    model::ForEachLeaf(*element, [&](const model::Element& leaf, const Affine& world_from_leaf,
                                     const model::Attributes& attributes) {
      if (!IsLine(leaf) || !model.LevelIsOn(attributes.level)) return;
      lines.push_back({&leaf,
                       world_from_leaf,
                       {attributes.colour.code, attributes.linestyle, attributes.weight}});
    });
  });
  return lines;
}

// The scale is known only when the box is: it is found from boxes of whole elements, which hold
// what is drawn.
Camera CameraOn(const std::vector<Drawn>& lines, int side_px) {
  geom::Box box;
  for (const Drawn& line : lines) {
    box.Add(geom::Carried(model::BoundingBox(*line.element), line.world_from_element));
  }
  return FitCamera(model::FrameOf("top"), box, side_px, side_px);
}

std::string Element(const Style& style, const Path& path) {
  const auto [colour, linestyle, weight] = style;
  const model::Rgb rgb = model::RgbOf(model::Colour{colour});
  const int width = std::max(weight, 1);
  std::string out = fmt::format("<path stroke=\"#{:02x}{:02x}{:02x}\" stroke-width=\"{}\"", rgb.r,
                                rgb.g, rgb.b, width);
  std::string dashes;
  for (const float length : DashesOf(linestyle))
    dashes += fmt::format("{}{}", dashes.empty() ? "" : " ", length * static_cast<float>(width));
  if (!dashes.empty()) out += " stroke-dasharray=\"" + dashes + "\"";
  return out + " d=\"" + path.Data() + "\"/>\n";
}

}  // namespace

Result<std::string> PlanSvgOf(const model::Model& model, int side_px) {
  const std::vector<Drawn> lines = VisibleLines(model);
  const Camera camera = CameraOn(lines, side_px);
  const Affine picture_from_world = camera.picture_from_world();
  std::map<Style, Path> paths;
  for (const Drawn& line : lines) {
    const Affine picture_from_element = picture_from_world * line.world_from_element;
    const double scale = picture_from_element.linear().colwise().norm().maxCoeff();
    const Result<Facets> facets = FacetsOf(*line.element, {kChord_px / std::max(scale, 1e-12), 0});
    if (!facets) return tl::unexpected(facets.error());
    for (const std::vector<Vec3>& stroke : facets->strokes) {
      Line places;
      for (const Vec3& vertex : stroke) {
        const Vec3 p = picture_from_element * vertex;
        places.emplace_back(std::lround((0.5 * side_px + p.x()) * kSteps_per_px),
                            std::lround((0.5 * side_px - p.y()) * kSteps_per_px));
      }
      paths[line.style].Add(std::move(places));
    }
  }
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{0}\" "
      "viewBox=\"0 0 {0} {0}\">\n<g fill=\"none\" stroke-linecap=\"round\" "
      "stroke-linejoin=\"round\">\n",
      side_px);
  for (const auto& [style, path] : paths) {
    if (!path.empty()) out += Element(style, path);
  }
  return out + "</g>\n</svg>\n";
}

}  // namespace tranos::output
