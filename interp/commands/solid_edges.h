// SPDX-License-Identifier: GPL-3.0-or-later
// Straight edges of solids, rounded or cut off: what fillet and chamfer do to solids.
#pragma once

#include <functional>
#include <optional>

#include "geom/solid_edge.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

// What is done to an edge. `shared`: others are worked on, too.
struct EdgeTool {
  struct Size {
    std::string_view key;
    double size_m, largest_m;
  };
  std::function<std::vector<Size>(const geom::SolidEdge&, bool shared)> sizes;
  std::function<geom::Result<geom::TriangleMesh>(const geom::SolidEdge&)> prism;
};
EdgeTool FilletOfEdges(const model::State& state, double radius_m);
// `second_m` as the first where it is not given.
EdgeTool ChamferOfEdges(double first_m, std::optional<double> second_m);

// The chosen solids, their edges (or the one nearest to `at=`) worked on. E0212 names how large the
// tool may be, kWrongElement is for what is no solid or has no such edge.
CommandResult WorkEdges(const model::State& state, const Answers& answers, std::string_view what,
                        const EdgeTool& tool);

}  // namespace tranos::interp
