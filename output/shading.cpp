// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/shading.h"

#include <algorithm>
#include <cmath>

namespace tranos::output {
namespace {

using Eigen::Vector3f;

// Directions towards the lights, as the viewer sees them: x right, y up, z to the viewer.
const Vector3f kKey = Vector3f(-0.62f, 0.58f, 0.53f).normalized();
const Vector3f kFill = Vector3f(0.75f, -0.05f, 0.66f).normalized();
constexpr float kAmbient = 0.30f, kKeyShare = 0.62f, kFillShare = 0.16f, kGloss = 0.10f;

float PowerOf32(float x) {
  for (int i = 0; i < 5; ++i) x *= x;
  return x;
}

}  // namespace

Shader::Shader(const Scene& scene, const RayScene& rays, bool shadows)
    : scene_(scene), rays_(rays), shadows_(shadows) {
  for (const RaySurface& surface : scene.surfaces) {
    // A mirrored or stretched surface's normals follow the inverse transpose.
    const Eigen::Matrix3f linear = surface.picture_from_mesh.leftCols<3>();
    const float scale = std::max(linear.norm(), 1e-30f);
    picture_from_normal_.push_back((linear / scale).inverse().transpose());
  }
}

Shade Shader::At(const RayPacket& packet, const HitPacket& hits, unsigned i) const {
  const std::uint32_t index = hits.surface[i];
  const RayMesh& mesh = *scene_.surfaces[index].mesh;
  const auto& corners = mesh.triangles[hits.triangle[i]];
  const auto normal_at = [&](std::size_t k) {
    return Eigen::Map<const Vector3f>(mesh.normals[corners[k]].data());
  };
  const float u = hits.u[i], v = hits.v[i];
  Vector3f normal = picture_from_normal_[index] *
                    ((1 - u - v) * normal_at(0) + u * normal_at(1) + v * normal_at(2));
  normal /= std::max(normal.norm(), 1e-20f);
  if (normal.z() < 0) normal = -normal;
  float key = std::max(0.0f, normal.dot(kKey));
  const Vector3f halfway = (kKey + Vector3f::UnitZ()).normalized();
  float gloss = kGloss * PowerOf32(std::max(0.0f, normal.dot(halfway)));
  if (shadows_ && key > 0) {
    const Vector3f point(packet.x[i], packet.y[i], hits.z[i]);
    if (rays_.Occluded(point + 1.5f * normal, kKey)) key *= 0.25f, gloss = 0;
  }
  const float light = kAmbient + kKeyShare * key + kFillShare * std::max(0.0f, normal.dot(kFill));
  return scene_.surface_colours[index] * light + Shade::Constant(gloss);
}

Shade GroundAt(float share) {
  const Shade top(0.855f, 0.890f, 0.925f), bottom(0.985f, 0.985f, 0.975f);
  return top + share * (bottom - top);
}

}  // namespace tranos::output
