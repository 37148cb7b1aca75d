// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "output/scene.h"

namespace tranos::output {

using ShadePacket = std::array<Shade, kPacket>;

// The light of shaded pictures: from the upper left, in front of the picture. Faces are lit on both
// sides.
class Shader {
 public:
  Shader(const Scene& scene, const RayScene& rays, bool shadows);

  // The colours of what the rays of a packet have met; those that met nothing stay as they are.
  void Apply(const RayPacket& rays, const HitPacket& hits, ShadePacket& shades) const;

 private:
  // Unit, on the side that is seen.
  Eigen::Vector3f NormalAt(const HitPacket& hits, unsigned i,
                           const Eigen::Vector3f& towards_viewer) const;
  // What is seen of a picture that the face bears, which has its own light; nothing if it bears
  // none.
  std::optional<Shade> PictureAt(std::uint32_t surface, std::uint32_t triangle,
                                 const Eigen::Vector3f& place) const;

  const Scene& scene_;
  const RayScene& rays_;
  bool shadows_;
  std::vector<Eigen::Matrix3f> picture_from_normal_;  // of each surface
};

// The ground of a shaded picture at this share of its height, from the top.
Shade GroundAt(float share);

}  // namespace tranos::output
