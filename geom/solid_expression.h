// SPDX-License-Identifier: GPL-3.0-or-later
// A solid's tree laid out flat: the meshes it begins with, in its own frame, and which combinations
// of them are inside it. Internal to geom.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geom/solid.h"

namespace tranos::geom {

class SolidExpression {
 public:
  // kTooLarge above ten million triangles in all.
  static Result<SolidExpression> Of(const Solid& solid);

  // The meshes that it begins with, from left to right.
  const std::vector<std::shared_ptr<const TriangleMesh>>& leaves() const { return leaves_; }
  // What of a leaf lies outside this box makes no difference: it would be cut off nothing, or has
  // nothing to be in common with.
  const Box& RelevantPartOf(std::uint32_t leaf) const { return leaf_places_[leaf].relevant; }
  // Whether a place that is inside these leaves, and outside all others, is inside the solid.
  // The time is that of the steps above those leaves alone.
  bool Contains(const std::vector<std::uint32_t>& inside_leaves);

 private:
  using Kind = Solid::Kind;
  static constexpr std::uint32_t kNone = 0xffffffff;
  // A step with its parts; a part that is a step has a lower number than what it is a part of.
  struct Step {
    Kind kind;
    std::uint32_t parts = 0;
    std::uint32_t parent = kNone;
    bool is_first = false;  // of its parent's parts
    // Of the question being answered:
    std::uint32_t parts_inside = 0;
    bool first_inside = false;
  };
  struct Place {
    std::uint32_t parent;
    bool is_first;
    Box relevant;
  };
  struct Layout;
  bool IsInside(const Step& step) const;
  void Tell(std::uint32_t step, bool is_first, std::vector<std::uint32_t>* open);

  std::vector<std::shared_ptr<const TriangleMesh>> leaves_;
  std::vector<Place> leaf_places_;
  std::vector<Step> steps_;
};

}  // namespace tranos::geom
