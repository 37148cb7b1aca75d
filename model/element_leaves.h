// SPDX-License-Identifier: GPL-3.0-or-later
// ForEachLeaf of model/element.h.
#pragma once

#include "model/element.h"

namespace tranos::model {

namespace internal {
template <class F>
void ForEachLeafIn(const Element& element, const geom::Affine& world_from_element,
                   const Attributes& attributes, F& f) {
  if (const auto* group = std::get_if<GroupPtr>(&element.geometry)) {
    for (const ElementPtr& member : (*group)->members) {
      ForEachLeafIn(*member, world_from_element, Inherit(*member->attributes, attributes), f);
    }
  } else if (const auto* instance = std::get_if<InstancePtr>(&element.geometry)) {
    const geom::Affine world = world_from_element * (*instance)->world_from_prototype;
    for (const ElementPtr& part : (*instance)->prototype->parts) {
      ForEachLeafIn(*part, world, Inherit(*part->attributes, attributes), f);
    }
  } else {
    f(element, world_from_element, attributes);
  }
}
}  // namespace internal

template <class F>
void ForEachLeaf(const Element& element, F&& f) {
  internal::ForEachLeafIn(element, geom::Affine::Identity(), *element.attributes, f);
}

}  // namespace tranos::model
