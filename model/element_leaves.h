// SPDX-License-Identifier: GPL-3.0-or-later
// ForEachLeaf of model/element.h.
#pragma once

#include "model/element.h"

namespace tranos::model {

namespace internal {
template <class F>
void ForEachLeafResolved(const Element& element, const geom::Affine& world_from_element,
                         const Attributes& attributes, F& f);

// `placement` is of the instance that the element is a part of, null for none: a group hands it on,
// for its own settings are not its members'.
template <class F>
void ForEachLeafIn(const Element& element, const geom::Affine& world_from_element,
                   const Attributes* placement, F& f) {
  if (const auto* group = std::get_if<GroupPtr>(&element.geometry)) {
    for (const ElementPtr& member : (*group)->members) {
      ForEachLeafIn(*member, world_from_element, placement, f);
    }
    return;
  }
  if (placement) {
    const Attributes resolved = Inherit(*element.attributes, *placement);
    ForEachLeafResolved(element, world_from_element, resolved, f);
    return;
  }
  ForEachLeafResolved(element, world_from_element, *element.attributes, f);
}

template <class F>
void ForEachLeafResolved(const Element& element, const geom::Affine& world_from_element,
                         const Attributes& attributes, F& f) {
  const auto* instance = std::get_if<InstancePtr>(&element.geometry);
  if (!instance) {
    f(element, world_from_element, attributes);
    return;
  }
  const geom::Affine world = world_from_element * (*instance)->world_from_prototype;
  for (const ElementPtr& part : (*instance)->prototype->parts) {
    ForEachLeafIn(*part, world, &attributes, f);
  }
}
}  // namespace internal

template <class F>
void ForEachLeaf(const Element& element, F&& f) {
  internal::ForEachLeafIn(element, geom::Affine::Identity(), nullptr, f);
}

}  // namespace tranos::model
