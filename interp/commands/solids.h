// SPDX-License-Identifier: GPL-3.0-or-later
// What the commands that make solids share.
#pragma once

#include "geom/solid.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

// The mesh as a solid; else what went wrong, of `what` and at `where`.
tl::expected<model::Geometry, CommandError> SolidGeometry(geom::Result<geom::TriangleMesh> mesh,
                                                          std::string_view what, Where where = {});
// An edit that adds it.
CommandResult MakeSolid(const model::State& state, geom::Result<geom::TriangleMesh> mesh,
                        std::string_view what, Where where = {});

// The elements that a key names, as they now are in the model.
tl::expected<std::vector<model::ElementPtr>, CommandError> ElementsOf(const model::State& state,
                                                                      const Answers& answers,
                                                                      std::string_view key);
// The curve that an element is; kWrongElement for another.
tl::expected<geom::Curve, CommandError> CurveOfElement(const model::Element& element,
                                                       std::string_view what, Where where);
// The closed curves that bound the face an element stands for: a region's outlines and holes, or a
// closed curve itself. kWrongElement for another element, kNotClosed for an open curve.
tl::expected<std::vector<geom::Curve>, CommandError> OutlineOfElement(const model::Element& element,
                                                                      std::string_view what,
                                                                      Where where);

// A size that a key gives, which is above zero, or that a data point gives, which is not zero.
// `by_point` is what the point of this prompt says.
tl::expected<double, CommandError> SizeOf(const model::State& state, const Answers& answers,
                                          std::string_view key, int prompt, double by_point);

}  // namespace tranos::interp
