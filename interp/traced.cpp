// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/traced.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "camera/virtual_camera.h"
#include "model/facades.h"

namespace tranos::interp {

using model::ElementId;
using model::ElementPtr;
using model::Trace;
using model::Value;

namespace {

// A curve is compared with its dots as a polyline: half a circle of 10 m is off by less than 0.1
// mm.
constexpr int kCurvePoints = 513;

class Gathering {
 public:
  Gathering(const model::State& state, ElementId only) : state_(state) {
    std::unordered_set<ElementId> traced;
    ForEachPart([&](const ElementPtr& element) {
      const auto* trace = std::get_if<model::TracePtr>(&element->geometry);
      if (trace) traced.insert((*trace)->photograph);
    });
    ForEachPart([&](const ElementPtr& element) {
      const auto* photograph = std::get_if<model::PhotographPtr>(&element->geometry);
      const bool is_attached = photograph && (*photograph)->attached;
      const bool has_camera = photograph && !(*photograph)->camera_file.empty();
      const bool meant = only == model::kNoElement
                             ? is_attached && (!has_camera || traced.contains(element->id))
                             : element->id == only;
      if (photograph && meant) Add(*element, **photograph);
    });
    NameFacades();
    ForEachPart([&](const ElementPtr& element) {
      if (const auto* trace = std::get_if<model::TracePtr>(&element->geometry)) {
        Add(element->id, **trace);
      }
    });
  }
  Traced Take() { return std::move(out_); }

 private:
  // Elements of the model, and members of its groups.
  template <class F>
  void ForEachPart(F&& f) {
    state_.model.entries.ForEach([&](const model::Entry& entry) {
      const bool stands =
          entry.standing == model::Standing::kInModel || entry.standing == model::Standing::kMember;
      if (entry.element && stands) f(entry.element);
    });
  }

  void Add(const model::Element& element, const model::Photograph& photograph) {
    place_[element.id] = out_.photographs.size();
    camera::Photograph& added = out_.photographs.emplace_back();
    added.name = element.name_or_empty();
    added.frame = photograph.frame;
    std::copy(std::begin(photograph.priors), std::end(photograph.priors), added.priors);
    out_.photograph_ids.push_back(element.id);
    out_.trace_ids.emplace_back();
  }

  void Add(ElementId id, const Trace& trace) {
    const auto place = place_.find(trace.photograph);
    if (place == place_.end()) return;
    const auto made = Made(trace);
    out_.number_owners.resize(out_.numbers.size(), id);
    if (!made) return;
    if (is_first_) out_.noise_px = Noise(trace);
    is_first_ = false;
    out_.photographs[place->second].traces.push_back(*made);
    out_.trace_ids[place->second].push_back(id);
  }

  std::optional<camera::Trace> Made(const Trace& trace) {
    const double sigma_px = Noise(trace);
    switch (trace.kind) {
      case Trace::Kind::kDirection:
        if (trace.axis < 0) return std::nullopt;
        if (const auto line = Line(trace)) return camera::DirectionTrace{*line, trace.axis};
        return std::nullopt;
      case Trace::Kind::kEdge: {
        const int from = Numbers(trace);
        if (const auto line = Line(trace)) return camera::EdgeTrace{*line, from, from + 3};
        return std::nullopt;
      }
      case Trace::Kind::kElement:
        return OfElement(trace);
      case Trace::Kind::kPoint:
        return camera::PointTrace{trace.dots_px[0], sigma_px, Numbers(trace)};
      case Trace::Kind::kRectangle: {
        const int a = Numbers(trace);
        camera::RectangleTrace made{{}, sigma_px, a, a + 1, Facade(trace)};
        std::copy_n(trace.dots_px.begin(), 4, made.dots_px);
        return made;
      }
      case Trace::Kind::kRatio: {
        camera::RatioTrace made{{}, sigma_px, Numbers(trace), Facade(trace)};
        std::copy_n(trace.dots_px.begin(), 4, made.dots_px);
        return made;
      }
      case Trace::Kind::kCircle:
        return camera::CircleTrace{trace.dots_px, sigma_px, Facade(trace)};
    }
    return std::nullopt;
  }

  std::optional<camera::Trace> OfElement(const Trace& trace) {
    ElementPtr current = state_.model.Current(trace.of->id);
    if (!current) current = trace.of;
    out_.elements.insert(current->id);
    const auto* curve = std::get_if<model::CurvePtr>(&current->geometry);
    if (!curve) return std::nullopt;
    const int first = static_cast<int>(out_.numbers.size());
    const auto* line = std::get_if<geom::Line>(curve->get());
    const int points = line ? 2 : kCurvePoints;
    for (int i = 0; i < points; ++i) {
      const geom::Vec3 p = geom::PointAt(**curve, static_cast<double>(i) / (points - 1));
      for (const double x : p) out_.numbers.push_back(Value::Number(x, model::kLength));
    }
    if (!line) return camera::CurveTrace{trace.dots_px, Noise(trace), first, points};
    if (const auto image = Line(trace)) return camera::EdgeTrace{*image, first, first + 3};
    return std::nullopt;
  }

  // Where noise is estimated, all dots count alike.
  double Noise(const Trace& trace) {
    if (trace.noise_px > 0) return trace.noise_px;
    out_.noise_is_estimated = true;
    return 1;
  }

  std::optional<camera::ImageLine> Line(const Trace& trace) {
    auto line = camera::FitImageLine(trace.dots_px, Noise(trace), trace.samples);
    if (!line) return std::nullopt;
    return *line;
  }

  int Numbers(const Trace& trace) {
    const int first = static_cast<int>(out_.numbers.size());
    out_.numbers.insert(out_.numbers.end(), trace.numbers.begin(), trace.numbers.end());
    return first;
  }

  // Facades whose place is to be found come first. Where no trace has a place in space, the first
  // of all is y = 0, known or not.
  void NameFacades() {
    std::vector<std::string> given;
    bool world_is_fixed = false;
    ForEachTrace([&](const Trace& trace) { world_is_fixed |= HasPlace(trace); });
    ForEachTrace([&](const Trace& trace) {
      if (trace.facade.empty() || !LiesOnFacade(trace)) return;
      const ElementPtr known = model::FindFacade(state_.model, trace.facade);
      const bool is_first = known && IsFirst(model::FacadeOf(*known).plane);
      auto& names = known && (world_is_fixed || !is_first) ? given : out_.facades;
      if (std::ranges::find(names, trace.facade) == names.end()) names.push_back(trace.facade);
    });
    out_.given_planes.assign(out_.facades.size(), -1);
    for (const std::string& name : given) {
      out_.given_planes.push_back(static_cast<int>(out_.numbers.size()));
      const geom::Frame& plane = model::FacadeOf(*model::FindFacade(state_.model, name)).plane;
      const geom::Vec3 away = -plane.z();
      out_.numbers.push_back(Value::Number(std::atan2(plane.x.y(), plane.x.x()), model::kAngle));
      out_.numbers.push_back(Value::Number(away.dot(plane.origin), model::kLength));
      out_.facades.push_back(name);
    }
  }

  // Of the photographs that are meant.
  template <class F>
  void ForEachTrace(F&& f) {
    ForEachPart([&](const ElementPtr& element) {
      const auto* trace = std::get_if<model::TracePtr>(&element->geometry);
      if (trace && place_.contains((*trace)->photograph)) f(**trace);
    });
  }

  // Of what the camera's traces fix the world by (camera::WorldIsFixed), before they are made.
  static bool HasPlace(const Trace& trace) {
    return trace.kind == Trace::Kind::kEdge || trace.kind == Trace::Kind::kElement ||
           trace.kind == Trace::Kind::kPoint;
  }
  static bool LiesOnFacade(const Trace& trace) {
    return trace.kind == Trace::Kind::kRectangle || trace.kind == Trace::Kind::kRatio ||
           trace.kind == Trace::Kind::kCircle;
  }
  // The plane y = 0, seen from before it.
  static bool IsFirst(const geom::Frame& plane) {
    return (plane.x - geom::Vec3::UnitX()).norm() < 1e-12 && std::abs(plane.origin.y()) < 1e-12;
  }

  int Facade(const Trace& trace) const {
    const auto found = std::find(out_.facades.begin(), out_.facades.end(), trace.facade);
    return static_cast<int>(found - out_.facades.begin());
  }

  const model::State& state_;
  Traced out_;
  bool is_first_ = true;
  std::map<ElementId, std::size_t> place_;
};

}  // namespace

Traced TracedIn(const model::State& state, ElementId only) { return Gathering(state, only).Take(); }

std::optional<double> PenaltyOf(const model::State& state, const model::Element& photograph,
                                const camera::Camera& camera) {
  const Traced traced = TracedIn(state, photograph.id);
  const auto point = [&](int first) {
    const auto at = static_cast<std::size_t>(first);
    return geom::Vec3(traced.numbers[at].number(), traced.numbers[at + 1].number(),
                      traced.numbers[at + 2].number());
  };
  std::vector<camera::TracedEdge> edges;
  for (const camera::Photograph& taken : traced.photographs) {
    for (const camera::Trace& trace : taken.traces) {
      const auto* edge = std::get_if<camera::EdgeTrace>(&trace);
      if (edge) edges.push_back({edge->line, point(edge->from), point(edge->to)});
    }
  }
  if (edges.empty()) return std::nullopt;
  const auto penalty = camera::Penalty(camera, traced.photographs[0].frame, edges);
  if (!penalty) return std::nullopt;
  return *penalty;
}

Eigen::VectorXd ValuesOf(std::span<const Value> numbers) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = numbers[i].number();
  }
  return values;
}

}  // namespace tranos::interp
