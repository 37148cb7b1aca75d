// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of elements, with the reason where there is none.
#include <cmath>

#include "interp/geometry_error.h"
#include "interp/value_support.h"

namespace tranos::interp {

namespace {

double Finite(double measure) {
  if (!std::isfinite(measure))
    throw OpFailure{Code::kNotFinite, "the measure is not a finite number"};
  return measure;
}

// Whether the plans of two boxes share more than a border.
bool PlansOverlap(const geom::Box& a, const geom::Box& b) {
  for (int axis = 0; axis < 2; ++axis) {
    const double overlap = std::min(a.max[axis], b.max[axis]) - std::max(a.min[axis], b.min[axis]);
    if (overlap <= 1e-9 * (1 + std::abs(a.max[axis]))) return false;
  }
  return true;
}

}  // namespace

OpFailure FromGeomError(const geom::Error& error, std::string what) {
  if (!error.detail.empty()) what += ": " + error.detail;
  return {CodeOf(error.code), what};
}

const geom::Curve* CurveOf(const model::Element& element) {
  const auto* curve = std::get_if<model::CurvePtr>(&element.geometry);
  return curve ? curve->get() : nullptr;
}

const geom::Surface* SurfaceOf(const model::Element& element) {
  const auto* surface = std::get_if<model::SurfacePtr>(&element.geometry);
  return surface ? surface->get() : nullptr;
}

const geom::Solid* SolidOf(const model::Element& element) {
  const auto* solid = std::get_if<model::SolidPtr>(&element.geometry);
  return solid ? solid->get() : nullptr;
}

const geom::Region* RegionOf(const model::Element& element) {
  const auto* region = std::get_if<model::RegionPtr>(&element.geometry);
  return region ? region->get() : nullptr;
}

double LengthOf(const model::Element& element) {
  if (const std::optional<double> length_m = model::Length(element)) return Finite(*length_m);
  throw OpFailure{Code::kWrongElement, WithArticle(model::TypeOf(element)) + " has no length"};
}

double AreaOf(const model::Element& element) {
  if (const std::optional<double> area_m2 = model::Area(element)) return Finite(*area_m2);
  const std::string what = WithArticle(model::TypeOf(element));
  if (const geom::Curve* curve = CurveOf(element)) {
    const geom::Result<double> area = geom::EnclosedArea(*curve);
    if (!area) throw FromGeomError(area.error(), what + " has no area");
    return Finite(*area);
  }
  throw OpFailure{Code::kNotClosed, what + " has no area"};
}

double VolumeOf(const model::Element& element) {
  if (const std::optional<double> volume_m3 = model::Volume(element)) return Finite(*volume_m3);
  throw OpFailure{Code::kNotClosed,
                  WithArticle(model::TypeOf(element)) + " that is open has no volume", "",
                  "volume_under(s, z) is the volume between a surface and a height"};
}

double FilledVolumeOf(const model::Element& element) {
  const std::optional<double> volume_m3 = model::FilledVolume(element);
  if (volume_m3) return Finite(*volume_m3);
  if (model::Volume(element)) {
    throw OpFailure{Code::kDegenerate, "the parts cannot be united to measure them", "",
                    "`volume` is the sum of theirs"};
  }
  throw OpFailure{Code::kWrongElement, WithArticle(model::TypeOf(element)) + " has no solids", "",
                  "`volume` is that of closed surfaces, too"};
}

double VolumeUnder(const model::Element& element, double z_m) {
  std::vector<geom::Surface> surfaces;
  model::ForEachLeaf(element, [&](const model::Element& leaf, const geom::Affine& world_from_leaf,
                                  const model::Attributes&) {
    const geom::Surface* surface = SurfaceOf(leaf);
    if (surface) surfaces.push_back(geom::Transformed(*surface, world_from_leaf));
  });
  const std::string what = WithArticle(model::TypeOf(element));
  if (surfaces.empty())
    throw OpFailure{Code::kWrongElement, what + " has no surface", "expected a surface", "", 0};
  // Each surface stands for its own part of the plan.
  constexpr std::size_t kMostCompared = 4096;
  if (surfaces.size() > kMostCompared) {
    throw OpFailure{Code::kNotAGraph,
                    what + " has too many surfaces for one height over each point", "", "", 0};
  }
  std::vector<geom::Box> boxes;
  double volume = 0;
  for (const geom::Surface& surface : surfaces) {
    boxes.push_back(geom::BoundingBox(surface));
    for (std::size_t i = 0; i + 1 < boxes.size(); ++i) {
      if (!PlansOverlap(boxes[i], boxes.back())) continue;
      throw OpFailure{Code::kNotAGraph, "surfaces of " + what + " may stand over one another", "",
                      "give volume_under one surface at a time", 0};
    }
    const geom::Result<double> part = geom::VolumeUnder(surface, z_m);
    if (!part) throw FromGeomError(part.error(), what + " has no one height over each point");
    volume += *part;
  }
  return Finite(volume);
}

}  // namespace tranos::interp
