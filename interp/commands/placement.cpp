// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/placement.h"

#include <cmath>

namespace tranos::interp {

using geom::Affine;
using geom::Vec3;
using model::Element;
using model::ElementPtr;

namespace {

// Zero or one where the angle is a quarter turn up to its last bits.
double Snapped(double cosine_or_sine) {
  const double nearest = std::round(cosine_or_sine);
  return std::abs(cosine_or_sine - nearest) < 4e-16 ? nearest : cosine_or_sine;
}

}  // namespace

Affine Translation(const Vec3& offset) {
  Affine out = Affine::Identity();
  out.translation() = offset;
  return out;
}

Affine Rotation(const Vec3& pivot, const Vec3& axis, double angle_rad) {
  const double c = Snapped(std::cos(angle_rad)), s = Snapped(std::sin(angle_rad));
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  Affine out = Affine::Identity();
  out.linear() = c * Eigen::Matrix3d::Identity() + s * cross + (1 - c) * axis * axis.transpose();
  out.translation() = pivot - out.linear() * pivot;
  return out;
}

Affine Reflection(const Vec3& on, const Vec3& normal) {
  Affine out = Affine::Identity();
  out.linear() -= 2 * normal * normal.transpose();
  out.translation() = 2 * on.dot(normal) * normal;
  return out;
}

Affine Scaling(const geom::Frame& frame, const Vec3& factors) {
  Affine out = Affine::Identity();
  if (factors.x() == factors.y() && factors.y() == factors.z()) {
    out.linear() *= factors.x();
  } else {
    out.linear() = factors.x() * frame.x * frame.x.transpose() +
                   factors.y() * frame.y * frame.y.transpose() +
                   factors.z() * frame.z() * frame.z().transpose();
  }
  out.translation() = frame.origin - out.linear() * frame.origin;
  return out;
}

ElementPtr FreshCopy(const Element& element, const Affine& target_from_source) {
  const ElementPtr moved = model::Transformed(element, target_from_source);
  return model::MakeElement(model::kNoElement, moved->geometry, element.attributes, nullptr,
                            element.tolerance);
}

Fired MoveChosen(const Answers& answers, const Affine& target_from_source) {
  Fired fired;
  std::vector<model::ElementId> selection;
  for (const ElementPtr& element : answers.chosen) {
    fired.edit.replaced.push_back(model::Transformed(*element, target_from_source));
    selection.push_back(element->id);
  }
  fired.edit.selection = model::Selection(std::move(selection));
  return fired;
}

Fired CopyChosen(const Answers& answers, const Affine& target_from_source) {
  Fired fired;
  std::vector<model::ElementId> selection;
  for (const ElementPtr& element : answers.chosen) {
    selection.push_back(model::kAddedBase + static_cast<model::ElementId>(fired.edit.added.size()));
    fired.edit.added.push_back(FreshCopy(*element, target_from_source));
  }
  fired.edit.selection = model::Selection(std::move(selection));
  return fired;
}

}  // namespace tranos::interp
