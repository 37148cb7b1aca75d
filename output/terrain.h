// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "output/ray_scene.h"

namespace tranos::output {

// The ground that a building stands on: level below it, at the foot of its box, and running down
// (never up) to where the photographer stands, his camera 1.6 m above it; uneven by a few
// centimetres, out to the horizon. Where the camera is inside the building's plan or high above,
// it is level. In metres about `origin`.
RayMesh TerrainOf(const geom::Box& building, const geom::Vec3& camera, const geom::Vec3& origin);

}  // namespace tranos::output
