// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/solids.h"

#include <fmt/format.h>

#include <cmath>

namespace tranos::interp {

using model::ElementPtr;
using model::State;

tl::expected<model::Geometry, CommandError> SolidGeometry(geom::Result<geom::TriangleMesh> mesh,
                                                          std::string_view what, Where where) {
  if (!mesh) return Fail(FromGeom(mesh.error(), what, where));
  geom::Result<geom::Solid> solid = geom::Solid::FromMesh(*std::move(mesh));
  if (!solid) return Fail(FromGeom(solid.error(), what, where));
  return std::make_shared<const geom::Solid>(*std::move(solid));
}

CommandResult MakeSolid(const State& state, geom::Result<geom::TriangleMesh> mesh,
                        std::string_view what, Where where) {
  auto geometry = SolidGeometry(std::move(mesh), what, where);
  if (!geometry) return Fail(geometry.error());
  return Make(state, *std::move(geometry));
}

tl::expected<std::vector<ElementPtr>, CommandError> ElementsOf(const State& state,
                                                               const Answers& answers,
                                                               std::string_view key) {
  std::vector<ElementPtr> elements;
  const model::Value* value = answers.Find(key);
  if (!value) return elements;
  const auto add = [&](const ElementPtr& element) {
    const bool in_model = element->id < state.model.entries.size();
    elements.push_back(in_model ? state.model.Current(element->id) : element);
  };
  if (value->is_element()) add(value->element());
  if (value->is_list()) {
    for (const model::Value& item : value->list()) add(item.element());
  }
  for (const ElementPtr& element : elements) {
    if (element) continue;
    return Fail({.code = Code::kNoLongerThere,
                 .message = fmt::format("an element of `{}=` was deleted", key),
                 .where = AtKey(key)});
  }
  return elements;
}

tl::expected<geom::Curve, CommandError> CurveOfElement(const model::Element& element,
                                                       std::string_view what, Where where) {
  if (const auto* curve = std::get_if<model::CurvePtr>(&element.geometry)) return **curve;
  return Fail({.code = Code::kWrongElement,
               .message = fmt::format("{} is made from a curve, and this is {}", what,
                                      NameForMessage(element)),
               .where = where});
}

tl::expected<std::vector<geom::Curve>, CommandError> OutlineOfElement(const model::Element& element,
                                                                      std::string_view what,
                                                                      Where where) {
  if (const auto* region = std::get_if<model::RegionPtr>(&element.geometry)) {
    std::vector<geom::Curve> outlines;
    geom::ForEachOutline(**region,
                         [&](const geom::Curve& curve, bool) { outlines.push_back(curve); });
    return outlines;
  }
  auto curve = CurveOfElement(element, what, where);
  if (!curve) return Fail(curve.error());
  if (!geom::IsClosed(*curve)) {
    return Fail({.code = Code::kNotClosed,
                 .message = fmt::format("{} is made from a closed outline, and {} is open", what,
                                        NameForMessage(element)),
                 .help = "`create chain` joins curves that meet; `place shape` closes by itself",
                 .where = where});
  }
  return std::vector{*std::move(curve)};
}

tl::expected<double, CommandError> SizeOf(const State& state, const Answers& answers,
                                          std::string_view key, int prompt, double by_point) {
  const auto index = static_cast<std::size_t>(prompt);
  if (answers.answered[index]) {
    if (std::abs(by_point) > geom::kCoincident_m) return by_point;
    return Fail({.code = Code::kDegenerate,
                 .message = fmt::format("this point leaves the {} at zero", key),
                 .label = "not in line with the points before",
                 .where = AtPoint(prompt)});
  }
  const double size_m = answers.Number(key);
  if (size_m > geom::kCoincident_m) return size_m;
  return Fail({.code = Code::kOutOfRange,
               .message = fmt::format("`{}` is {}, and must be above zero", key,
                                      InWords(size_m, *state.drawing.settings)),
               .label = "above 0 and at most 1e9 m",
               .where = AtKey(key)});
}

}  // namespace tranos::interp
