// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/firing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interp/commands/range.h"
#include "interp/geometry_error.h"

namespace tranos::interp {

using model::ElementPtr;
using model::State;
using model::Value;

namespace {

bool IsFar(double length_m) { return !(std::abs(length_m) <= kFarthest_m); }

bool IsFar(const Value& value) {
  if (value.is_number()) return value.dimension() == model::kLength && IsFar(value.number());
  if (!value.is_list()) return false;
  for (const Value& item : value.list()) {
    if (IsFar(item)) return true;
  }
  return false;
}

CommandError FarError(Where where) {
  return {.code = Code::kOutOfRange,
          .message = "this lies more than a million kilometres away",
          .label = "at most 1e9 m",
          .where = where};
}

}  // namespace

CommandError FromGeom(const geom::Error& error, std::string_view what, Where where) {
  if (where.kind == Where::kCommand && error.part >= 0) where = {Where::kChosen, error.part, {}};
  return {.code = CodeOf(error.code),
          .message = fmt::format("{} cannot be made: {}", what, error.detail),
          .where = where};
}

model::ElementPtr NewElement(const State& state, model::Geometry geometry) {
  const model::Settings& settings = *state.drawing.settings;
  return model::MakeElement(model::kNoElement, std::move(geometry), settings.attributes, nullptr,
                            settings.tolerance);
}

model::Geometry CurveGeometry(geom::Curve curve) {
  return std::make_shared<const geom::Curve>(std::move(curve));
}

model::Geometry SurfaceGeometry(geom::Surface surface) {
  return std::make_shared<const geom::Surface>(std::move(surface));
}

std::optional<CommandError> TooFar(const Answers& answers) {
  for (std::size_t i = 0; i < answers.points.size(); ++i) {
    if (IsFar(answers.points[i].cwiseAbs().maxCoeff())) {
      return FarError({Where::kPoint, static_cast<int>(i), {}});
    }
  }
  for (const auto& [key, value] : answers.keys) {
    if (IsFar(value)) return FarError({Where::kKey, 0, key});
  }
  return std::nullopt;
}

tl::expected<std::vector<ElementPtr>, CommandError> ListedBy(const State& state,
                                                             const Answers& answers,
                                                             std::string_view key) {
  std::vector<ElementPtr> listed;
  const Value* value = answers.Find(key);
  if (!value) return listed;
  const std::vector<Value> items = value->is_list() ? value->list() : std::vector<Value>{*value};
  for (const Value& item : items) {
    ElementPtr element = item.element();
    // What lies beyond the entries is a part of a placed element, and cannot have changed.
    if (element->id < state.model.entries.size()) {
      const std::string name = NameForMessage(*element);
      element = state.model.Current(element->id);
      if (!element) {
        return Fail({.code = Code::kNoLongerThere,
                     .message = fmt::format("{} was deleted", name),
                     .where = AtKey(key)});
      }
    }
    listed.push_back(std::move(element));
  }
  return listed;
}

geom::Frame PlaneAt(const State& state, const geom::Vec3& origin) {
  const geom::Frame& plane = state.drawing.settings->plane;
  return {origin, plane.x, plane.y};
}

CommandError OffPlane(const State& state, double height_m, int point) {
  return {.code = Code::kNotPlanar,
          .message = fmt::format("this point lies {} off the active plane through the first one",
                                 InWords(std::abs(height_m), *state.drawing.settings)),
          .help = "`set plane front` draws upright; see `tranos help set plane`",
          .where = AtPoint(point)};
}

std::optional<CommandError> NothingChosen(const Answers& answers) {
  if (!answers.chosen.empty()) return std::nullopt;
  return CommandError{.code = Code::kNothingChosen,
                      .message = "nothing is chosen",
                      .help = "choose first (`choose element;xy=…`), or give `of=`"};
}

namespace {

bool IsOfPhotograph(const model::Element& element) {
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    return std::any_of((*group)->members.begin(), (*group)->members.end(),
                       [](const ElementPtr& member) { return IsOfPhotograph(*member); });
  }
  return !model::IsBuilt(element);
}

}  // namespace

std::optional<CommandError> NothingToMove(const Answers& answers) {
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const model::Element& element = *answers.chosen[i];
    if (!IsOfPhotograph(element)) continue;
    const std::string name = NameForMessage(element);
    CommandError error{.code = Code::kWrongElement,
                       .message = fmt::format("{} has no place in space to be changed", name),
                       .help = "attach or trace it again; `step camera` moves a camera",
                       .where = {Where::kChosen, static_cast<int>(i), {}}};
    if (std::holds_alternative<model::GroupPtr>(element.geometry)) {
      error.message = fmt::format("{} has traces, with no place in space to be changed", name);
    } else if (std::holds_alternative<model::OrthophotoPtr>(element.geometry)) {
      error.help = "`construct orthophoto` makes another, of another facade or extent";
    } else if (std::holds_alternative<model::FacadePtr>(element.geometry)) {
      error.message = fmt::format("what was drawn on {} would not move with it", name);
      error.help = "`construct facade` makes another, in another place";
    }
    return error;
  }
  return NothingChosen(answers);
}

CommandResult Make(const State& state, model::Geometry geometry) {
  Fired fired;
  fired.edit.added.push_back(NewElement(state, std::move(geometry)));
  return fired;
}

CommandResult MakeFromChosen(const State& state, const Answers& answers,
                             std::vector<model::Geometry> geometries) {
  Fired fired;
  for (model::Geometry& geometry : geometries) {
    fired.edit.added.push_back(NewElement(state, std::move(geometry)));
  }
  Consume(answers, &fired.edit);
  return fired;
}

void Consume(const Answers& answers, model::Edit* edit) {
  if (answers.Flag("keep")) return;
  for (const ElementPtr& element : answers.chosen) edit->consumed.push_back(element->id);
}

tl::expected<std::vector<geom::Curve>, CommandError> CurvesOf(const Answers& answers,
                                                              std::string_view what) {
  std::vector<geom::Curve> curves;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const model::Element& element = *answers.chosen[i];
    const auto* curve = std::get_if<model::CurvePtr>(&element.geometry);
    if (!curve) {
      return Fail({.code = Code::kWrongElement,
                   .message = fmt::format("{} is made from curves, and this is {}", what,
                                          NameForMessage(element)),
                   .where = {Where::kChosen, static_cast<int>(i), {}}});
    }
    curves.push_back(**curve);
  }
  return curves;
}

std::string NameForMessage(const model::Element& element) {
  const std::string type = model::TypeOf(element);
  const std::string_view name = element.name_or_empty();
  if (!name.empty()) return fmt::format("the {} `{}`", type, name);
  const bool vowel =
      std::string_view("aeio").find(type.empty() ? 'x' : type[0]) != std::string::npos;
  return fmt::format("{} {}", vowel ? "an" : "a", type);
}

std::string InWords(double length_m, const model::Settings& settings) {
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr Unit kUnits[] = {
      {"mm", 0.001}, {"cm", 0.01}, {"km", 1000}, {"ft", 0.3048}, {"in", 0.0254}};
  for (const Unit& unit : kUnits) {
    if (unit.name == settings.unit)
      return fmt::format("{:.4g} {}", length_m / unit.metres, unit.name);
  }
  return fmt::format("{:.4g} m", length_m);
}

std::string RangeInWords(double largest_m, const model::Settings& settings) {
  if (largest_m <= 0) return {};
  return fmt::format("above 0 and at most {}", InWords(largest_m, settings));
}

}  // namespace tranos::interp
