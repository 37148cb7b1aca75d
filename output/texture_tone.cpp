// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/texture_tone.h"

#include <algorithm>
#include <cmath>

#include "output/chance.h"

namespace tranos::output {
namespace {

using Eigen::Vector3f;

// Where a place is on its face: along it horizontally, and up it.
struct OnFace {
  float along, up;
};
OnFace OnFaceOf(const Vector3f& p, const Vector3f& n) {
  const float level = std::hypot(n.x(), n.y());
  if (level < 0.2f) return {p.x(), p.y()};  // a floor
  const Vector3f across(-n.y() / level, n.x() / level, 0);
  return {p.dot(across), p.dot(n.cross(across))};
}

// What is left of the contrast of a pattern of this size.
float Seen(float pattern_m, float size_m) {
  return std::clamp(1.5f * pattern_m / std::max(size_m, 1e-4f) - 1, 0.0f, 1.0f);
}

// Blocks in courses, each other course moved by half a block: each has its own tone, and joints.
float Courses(const OnFace& at, float length_m, float height_m, float joint_m, float spread,
              float joint_tone, float size_m, std::uint64_t seed) {
  const float course = std::floor(at.up / height_m);
  const float shifted = at.along / length_m + (std::fmod(std::abs(course), 2) < 0.5f ? 0 : 0.5f);
  const float block = std::floor(shifted);
  const auto id = [](float f) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(f)); };
  const float own = 2 * Share(Hashed(seed, id(course), id(block))) - 1;
  const float from_bed = std::min(at.up / height_m - course, 1 - (at.up / height_m - course));
  const float from_end = std::min(shifted - block, 1 - (shifted - block));
  const float gap = std::min(from_bed * height_m, from_end * length_m);
  // A joint thinner than a pixel darkens it by its share.
  const float width = std::max(joint_m, 0.6f * size_m);
  const float joint = std::clamp(1.5f - gap / (0.5f * width), 0.0f, 1.0f) * (joint_m / width);
  const float tone = 1 + spread * own * Seen(height_m, size_m);
  return tone + (joint_tone - tone) * joint * Seen(height_m, size_m);
}

float Tiles(const OnFace& at, float size_m) {
  const float wave = std::sin(6.2831853f * at.along / 0.24f);
  const float row = at.up / 0.34f - std::floor(at.up / 0.34f);
  const float lap = row < 0.12f ? -0.25f : 0.0f;
  const auto id = [](float f) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(f)));
  };
  const float own = 2 * Share(Hashed(5, id(at.along / 0.24f), id(at.up / 0.34f))) - 1;
  return 1 + (0.22f * wave + lap) * Seen(0.24f, 1.6f * size_m) + 0.12f * own * Seen(0.24f, size_m);
}

float Pattern(Material material, const Vector3f& p, const Vector3f& n, float size_m) {
  const OnFace at = OnFaceOf(p, n);
  switch (material) {
    case Material::kBrick:
      return Courses(at, 0.27f, 0.085f, 0.018f, 0.16f, 1.45f, size_m, 1);
    case Material::kStone:
      return Courses(at, 0.8f, 0.38f, 0.012f, 0.07f, 0.62f, size_m, 2) +
             0.05f * Clouds3(21, 6 * p, 2) * Seen(0.15f, size_m);
    case Material::kConcrete:
      return 1 + 0.06f * Clouds3(22, 2 * p, 3);
    case Material::kPlaster:
      // Rain draws streaks down it.
      return 1 + 0.06f * Clouds2(23, 2.4f * at.along, 0.25f * at.up, 3) * Seen(0.3f, size_m) +
             0.05f * Clouds3(24, 1.3f * p, 3);
    case Material::kMarble: {
      const float bent = Clouds3(25, 1.5f * p, 3);
      const float vein = std::abs(std::sin(9 * (p.x() + p.y() + p.z()) / 3 + 3 * bent));
      return 1 - 0.1f * std::pow(1 - vein, 6.0f) * Seen(0.1f, size_m);
    }
    case Material::kTile:
      return Tiles(at, size_m);
    case Material::kTimber:
      return 1 + 0.18f * Noise2(26, 22 * at.along, 1.2f * at.up) * Seen(0.08f, size_m);
    case Material::kSlate:
      return Courses(at, 0.3f, 0.22f, 0.01f, 0.14f, 0.5f, size_m, 3);
    case Material::kMetal:
    case Material::kLead:
    case Material::kCopper:
      return 1 + 0.1f * Clouds2(27, 3 * at.along, 0.4f * at.up, 2);
    case Material::kEarth:
    case Material::kGrass:
      return 1 + 0.16f * Clouds2(28, 0.35f * p.x(), 0.35f * p.y(), 3) +
             0.22f * Clouds2(29, 3 * p.x(), 3 * p.y(), 3) * Seen(0.3f, size_m);
    case Material::kPlain:
    case Material::kMortar:
    case Material::kGlass:
      return 1;
  }
  return 1;
}

}  // namespace

geom::Vec3 PatternOrigin(const geom::Vec3& middle_m) {
  constexpr double kStep_m = 4096;
  return kStep_m * (middle_m / kStep_m).array().round().matrix();
}

float TextureTone(Material material, const Vector3f& place_m, const Vector3f& normal,
                  float size_m) {
  if (material == Material::kGlass) return 1;
  const float weather = 0.07f * Clouds3(20, 0.45f * place_m, 4);
  return std::max(0.05f, Pattern(material, place_m, normal, size_m) * (1 + weather));
}

}  // namespace tranos::output
