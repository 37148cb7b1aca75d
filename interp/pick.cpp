// SPDX-License-Identifier: GPL-3.0-or-later
// One pass over the model finds a bound from below for each element's distance and, where that
// costs nothing, the distance itself. Only elements whose bound is below the best are then
// measured, nearest bound first.
#include "interp/pick.h"

#include <algorithm>
#include <cmath>

namespace tranos::interp {

using geom::Box;
using geom::Vec3;
using model::Element;
using model::ElementPtr;

namespace {

constexpr double kTie_m = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double DistanceTo(const Box& box, const Vec3& p) {
  if (box.empty()) return 0;
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
}

// To its farthest corner: no farther is whatever the box holds.
double FarDistanceTo(const Box& box, const Vec3& p) {
  if (box.empty()) return kInfinity;
  return (box.max - p).cwiseMax(p - box.min).norm();
}

double DistanceToLine(const geom::Line& line, const Vec3& p) {
  const Vec3 along = line.end - line.start, from_start = p - line.start;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp(from_start.dot(along) / squared, 0.0, 1.0) : 0;
  return (from_start - t * along).norm();
}

// A box that holds the curve: cheap, not tight.
struct RoughBox {
  Box operator()(const geom::Line& line) const {
    Box box;
    box.Add(line.start), box.Add(line.end);
    return box;
  }
  Box operator()(const geom::Arc& arc) const { return Around(arc.frame.origin, arc.radius); }
  Box operator()(const geom::Circle& circle) const {
    return Around(circle.frame.origin, circle.radius);
  }
  Box operator()(const geom::Polyline& polyline) const { return Over(polyline.vertices); }
  Box operator()(const geom::BsplineCurve& curve) const { return Over(curve.poles); }
  Box operator()(const geom::Chain& chain) const {
    Box box;
    for (const geom::Segment& segment : chain.segments) box.Add(std::visit(*this, segment));
    return box;
  }
  Box operator()(const geom::BsplineSurface& surface) const { return Over(surface.poles); }
  // The patch is a sum of two ruled surfaces less a bilinear one, so it stays in its boundary's
  // box widened by that box's size.
  Box operator()(const geom::CoonsPatch& patch) const {
    Box box;
    for (const auto* side : {&patch.south, &patch.north, &patch.west, &patch.east}) {
      box.Add((*this)(*side));
    }
    const Vec3 size = box.max - box.min;
    box.min -= size, box.max += size;
    return box;
  }

 private:
  static Box Around(const Vec3& centre, double radius) {
    return {centre.array() - radius, centre.array() + radius};
  }
  static Box Over(const std::vector<Vec3>& points) {
    Box box;
    for (const Vec3& point : points) box.Add(point);
    return box;
  }
};

Box RoughBoxOf(const Element& leaf) {
  if (const auto* point = std::get_if<model::Point>(&leaf.geometry)) {
    return {point->position, point->position};
  }
  if (const auto* curve = std::get_if<model::CurvePtr>(&leaf.geometry)) {
    return std::visit(RoughBox{}, **curve);
  }
  if (const auto* surface = std::get_if<model::SurfacePtr>(&leaf.geometry)) {
    return std::visit(RoughBox{}, **surface);
  }
  if (const auto* region = std::get_if<model::RegionPtr>(&leaf.geometry)) {
    Box box;
    for (const auto& part : (*region)->parts) box.Add(std::visit(RoughBox{}, part.outer));
    return box;
  }
  return model::BoundingBox(leaf);
}

Box Transformed(const Box& box, const geom::Affine& world_from_box) {
  const Vec3 half = 0.5 * (box.max - box.min);
  const Vec3 centre = world_from_box * box.centre(),
             reach = world_from_box.linear().cwiseAbs() * half;
  return {centre - reach, centre + reach};
}

bool IsComposite(const Element& element) {
  return std::holds_alternative<model::GroupPtr>(element.geometry) ||
         std::holds_alternative<model::InstancePtr>(element.geometry);
}

// The order in which kinds win where several are equally near.
int RankOf(const Element& leaf) {
  if (std::holds_alternative<model::Point>(leaf.geometry)) return 0;
  if (std::holds_alternative<model::SolidPtr>(leaf.geometry)) return 3;
  const bool is_face = std::holds_alternative<model::SurfacePtr>(leaf.geometry) ||
                       std::holds_alternative<model::RegionPtr>(leaf.geometry);
  return is_face ? 2 : 1;
}

class Search {
 public:
  Search(const model::State& state, const Vec3& p) : model_(state.model), p_(p) {}

  void Run() {
    model_.ForEach([&](const ElementPtr& element) { Consider(element); });
    const auto later = [](const Waiting& a, const Waiting& b) { return a.bound > b.bound; };
    std::make_heap(waiting_.begin(), waiting_.end(), later);
    while (!waiting_.empty() && waiting_.front().bound <= best_ + kTie_m) {
      Measure(*waiting_.front().element);
      std::pop_heap(waiting_.begin(), waiting_.end(), later);
      waiting_.pop_back();
    }
  }

  PickResult Result(double tolerance_m) const {
    PickResult result;
    const Hit* chosen = nullptr;
    for (const Hit& hit : hits_) {
      if (hit.distance > best_ + kTie_m) continue;
      if (chosen && hit.rank > chosen->rank) continue;
      const bool same_rank = chosen && hit.rank == chosen->rank;
      if (!same_rank || hit.element->get()->id > chosen->element->get()->id) chosen = &hit;
      result.ambiguous = same_rank;
    }
    if (!chosen) return result;
    result.element = *chosen->element;
    result.distance_m = best_;
    result.within = best_ <= tolerance_m;
    return result;
  }

 private:
  struct Hit {
    double distance;
    int rank;
    const ElementPtr* element;
  };
  struct Waiting {
    double bound;
    const ElementPtr* element;
  };

  bool AllLevelsOn() const { return !model_.hidden_levels || model_.hidden_levels->empty(); }
  bool IsOn(const model::Attributes& attributes) const {
    return AllLevelsOn() || model_.LevelIsOn(attributes.level);
  }

  void Consider(const ElementPtr& element) {
    if (!model::IsBuilt(*element)) return;
    if (IsComposite(*element)) return Wait(element, VisibleBox(*element));
    if (!IsOn(*element->attributes)) return;
    if (const auto* point = std::get_if<model::Point>(&element->geometry)) {
      return Add(element, (point->position - p_).norm(), 0);
    }
    if (const auto* curve = std::get_if<model::CurvePtr>(&element->geometry)) {
      if (const auto* line = std::get_if<geom::Line>(curve->get())) {
        return Add(element, DistanceToLine(*line, p_), 1);
      }
    }
    Wait(element, RoughBoxOf(*element));
  }

  void Wait(const ElementPtr& element, const Box& box) {
    const double bound = DistanceTo(box, p_);
    if (bound > std::min(best_, reach_) + kTie_m) return;
    reach_ = std::min(reach_, FarDistanceTo(box, p_));
    waiting_.push_back({bound, &element});
  }

  void Add(const ElementPtr& element, double distance, int rank) {
    if (distance > best_ + kTie_m) return;
    if (distance < best_ - kTie_m) hits_.clear();
    best_ = std::min(best_, distance);
    hits_.push_back({distance, rank, &element});
  }

  // Around its parts on levels that are on.
  Box VisibleBox(const Element& element) const {
    Box box;
    model::ForEachLeaf(element, [&](const Element& leaf, const geom::Affine& world_from_leaf,
                                    const model::Attributes& attributes) {
      if (IsOn(attributes)) box.Add(Transformed(RoughBoxOf(leaf), world_from_leaf));
    });
    return box;
  }

  void Measure(const ElementPtr& element) {
    if (!IsComposite(*element)) {
      return Add(element, model::NearestPoint(*element, p_).distance_m, RankOf(*element));
    }
    Hit nearest = {kInfinity, 0, &element};
    model::ForEachLeaf(*element, [&](const Element& leaf, const geom::Affine& world_from_leaf,
                                     const model::Attributes& attributes) {
      if (!IsOn(attributes)) return;
      const double reach = std::min(best_, nearest.distance) + kTie_m;
      if (DistanceTo(Transformed(RoughBoxOf(leaf), world_from_leaf), p_) > reach) return;
      const ElementPtr placed = model::Transformed(leaf, world_from_leaf);
      const Hit hit = {model::NearestPoint(*placed, p_).distance_m, RankOf(leaf), &element};
      const bool ties = std::abs(hit.distance - nearest.distance) <= kTie_m;
      if (ties ? hit.rank < nearest.rank : hit.distance < nearest.distance) nearest = hit;
    });
    if (nearest.distance < kInfinity) Add(element, nearest.distance, nearest.rank);
  }

  const model::Model& model_;
  const Vec3 p_;
  double best_ = kInfinity;   // the least distance measured
  double reach_ = kInfinity;  // and one that some element waiting is sure to be within
  std::vector<Hit> hits_;
  std::vector<Waiting> waiting_;
};

}  // namespace

PickResult Pick(const model::State& state, const Vec3& point_in_world) {
  Search search(state, point_in_world);
  search.Run();
  return search.Result(state.drawing.settings->locate_tolerance_m);
}

bool IsVisible(const model::Model& model, const Element& element) {
  if (!model.hidden_levels || model.hidden_levels->empty()) return true;
  bool visible = false;
  model::ForEachLeaf(element,
                     [&](const Element&, const geom::Affine&, const model::Attributes& attributes) {
                       visible = visible || model.LevelIsOn(attributes.level);
                     });
  return visible;
}

}  // namespace tranos::interp
