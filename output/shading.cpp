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
const Vector3f kHalfway = (kKey + Vector3f::UnitZ()).normalized();
constexpr float kAmbient = 0.32f, kKeyShare = 0.64f, kFillShare = 0.18f, kGloss = 0.08f;
constexpr float kShadowShare = 0.25f;  // of the key light that is left in shadow
constexpr float kShadowOffset_px = 1.5f;

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

Vector3f Shader::NormalAt(const HitPacket& hits, unsigned i, const Vector3f& towards_viewer) const {
  const std::uint32_t index = hits.surface[i];
  const RayMesh& mesh = *scene_.surfaces[index].mesh;
  const auto& corners = mesh.triangles[hits.triangle[i]];
  const auto at = [&](std::size_t k) {
    return Eigen::Map<const Vector3f>(mesh.normals[corners[k]].data());
  };
  const float u = hits.u[i], v = hits.v[i];
  const Vector3f blended = (1 - u - v) * at(0) + u * at(1) + v * at(2);
  const Vector3f normal = picture_from_normal_[index] * blended;
  const float length = std::max(normal.norm(), 1e-20f);
  return normal / (normal.dot(towards_viewer) < 0 ? -length : length);
}

std::optional<Shade> Shader::PictureAt(std::uint32_t surface, std::uint32_t triangle,
                                       const Vector3f& place) const {
  for (const Borne& borne : scene_.borne[surface]) {
    if (!borne.by[triangle]) continue;
    if (auto shade = scene_.planes[borne.plane].At(scene_.InWorld(place))) return shade;
  }
  return std::nullopt;
}

void Shader::Apply(const RayPacket& rays, const HitPacket& hits, ShadePacket& shades) const {
  std::array<Vector3f, kPacket> normals;
  RayPacket from, to_light;
  LanePacket lit{};
  for (unsigned i = 0; i < kPacket; ++i) {
    if (hits.surface[i] == kNothing) continue;
    normals[i] = NormalAt(hits, i, scene_.TowardsViewer(rays.x[i], rays.y[i]));
    lit[i] = normals[i].dot(kKey) > 0;
    if (!shadows_) continue;
    // A little off the facet, which lies a little inside the surface that it stands for.
    const Vector3f place(rays.x[i], rays.y[i], hits.z[i]);
    const Vector3f start = place + kShadowOffset_px * scene_.Moving(place, normals[i]);
    from.x[i] = start.x(), from.y[i] = start.y(), from.z[i] = start.z();
    const Vector3f way = scene_.Moving(start, kKey).normalized();
    to_light.x[i] = way.x(), to_light.y[i] = way.y(), to_light.z[i] = way.z();
  }
  if (shadows_) rays_.DropOccluded(from, to_light, lit);
  for (unsigned i = 0; i < kPacket; ++i) {
    if (hits.surface[i] == kNothing) continue;
    const Vector3f place(rays.x[i], rays.y[i], hits.z[i]);
    if (const auto shade = PictureAt(hits.surface[i], hits.triangle[i], place)) {
      shades[i] = *shade;
      continue;
    }
    const float towards_key = std::max(0.0f, normals[i].dot(kKey));
    const float key = lit[i] ? towards_key : kShadowShare * towards_key;
    const float gloss = lit[i] ? kGloss * PowerOf32(std::max(0.0f, normals[i].dot(kHalfway))) : 0;
    const float fill = std::max(0.0f, normals[i].dot(kFill));
    const float light = kAmbient + kKeyShare * key + kFillShare * fill;
    shades[i] = light * scene_.surface_colours[hits.surface[i]] + Shade::Constant(gloss);
  }
}

Shade GroundAt(float share) {
  const Shade top(0.855f, 0.890f, 0.925f), bottom(0.985f, 0.985f, 0.975f);
  return top + share * (bottom - top);
}

}  // namespace tranos::output
