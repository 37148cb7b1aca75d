// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/exposure.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "output/chance.h"
#include "output/eye.h"
#include "output/parallel.h"
#include "output/parts.h"
#include "output/terrain.h"
#include "output/texture_tone.h"

namespace tranos::output {
namespace {

using camera::Frame;
using Eigen::Vector3f;
using geom::Vec2;
using geom::Vec3;

constexpr float kSun = 1.4f;          // the light of the sun on a face turned to it
constexpr float kSky = 0.5f;          // that of the whole sky on a face turned up
constexpr float kBounce = 0.26f;      // of the sky's, what comes from other faces instead
constexpr float kSunRadius = 0.008f;  // softens the edges of shadows; in radians
constexpr float kHaze_m = 2500;       // after which a face has lost two thirds of its contrast
constexpr int kSkyRays = 4;           // from each sample, to find how much of the sky it sees
constexpr float kOffset = 2e-4f;      // of the distance: where rays from a face begin
constexpr int kBlock = 4;             // a packet is a square of samples
constexpr int kBand_px = 16;          // rows of pixels that are made at a time
constexpr int kMeterStep_px = 8;      // one pixel in so many, each way, is metered
constexpr float kExposedTo = 0.75f;   // the light that the brighter parts of a building get

// What an orthochromatic plate makes of a colour.
float Albedo(const model::Rgb& rgb) {
  return static_cast<float>(0.10 * LinearFromSrgb(rgb.r) + 0.42 * LinearFromSrgb(rgb.g) +
                            0.48 * LinearFromSrgb(rgb.b));
}

struct Face {
  float albedo;
  Material material;
};

// The model and the ground, in metres about `origin`; patterns begin at `pattern_origin`.
struct World {
  Vec3 origin;
  Vec3 pattern_origin;
  std::vector<RaySurface> surfaces;
  std::vector<Face> faces;                         // of each surface
  std::vector<Eigen::Matrix3f> world_from_normal;  // likewise
  std::size_t ground;                              // the index of the ground

  void Add(std::shared_ptr<const RayMesh> mesh, const geom::Affine& place, const Face& face) {
    surfaces.push_back({std::move(mesh), place.affine().cast<float>()});
    faces.push_back(face);
    const Eigen::Matrix3f linear = surfaces.back().picture_from_mesh.leftCols<3>();
    world_from_normal.push_back((linear / std::max(linear.norm(), 1e-30f)).inverse().transpose());
  }
};

Result<World> WorldOf(const model::PhotoRequest& request, int threads) {
  Parts parts = VisibleParts(request.model, threads);
  geom::Box box = BoxInWorld(parts);
  const double pixel_m = FinestPixel_m(box, request.camera, request.frame);
  if (auto error = MakeFacets(parts, 0.2 * pixel_m, threads)) {
    return tl::unexpected(*std::move(error));
  }
  const Vec3 eye = request.camera.position_m();
  if (box.empty()) box.Add(Vec3(eye.x(), eye.y(), eye.z() - 1.6));
  World world;
  world.origin = box.centre();
  world.pattern_origin = PatternOrigin(world.origin);
  for (const Placement& placement : parts.placements) {
    const Part& part = parts.parts[placement.part];
    if (!part.ray_mesh) continue;
    geom::Affine place = placement.world_from_part;
    place.translation() = placement.world_from_part * part.centre - world.origin;
    world.Add(part.ray_mesh, place,
              {Albedo(SurfaceColour(placement.colour, placement.material)),
               MaterialOf(placement.material)});
  }
  world.ground = world.surfaces.size();
  world.Add(std::make_shared<const RayMesh>(TerrainOf(box, eye, world.origin)),
            geom::Affine::Identity(), {0.2f, Material::kEarth});
  return world;
}

// Directions of the world that dots look in.
class Lens {
 public:
  explicit Lens(const model::PhotoRequest& request)
      : request_(request),
        world_from_dot_(
            (camera::DotFromWorld(request.camera, request.frame).leftCols<3>()).inverse()) {
    is_straight_ = request.distortion.k1 == 0 && request.distortion.k2 == 0;
  }
  // Nothing where the lens folds the picture over.
  std::optional<Vector3f> Towards(Vec2 dot_px) const {
    if (!is_straight_) {
      const auto seen = camera::UndistortDot(request_.distortion, request_.frame, dot_px);
      if (!seen) return std::nullopt;
      dot_px = *seen;
    }
    return (world_from_dot_ * dot_px.homogeneous()).normalized().cast<float>().eval();
  }

 private:
  const model::PhotoRequest& request_;
  camera::Mat3 world_from_dot_;
  bool is_straight_;
};

float SkyAt(const Vector3f& direction) {
  const float height = std::max(direction.z(), 0.0f);
  return 1.0f - 0.22f * std::sqrt(height);
}

// Hills at the horizon, faint in the haze.
float FarAt(const Vector3f& direction) {
  const float azimuth = std::atan2(direction.y(), direction.x());
  const float ridge = 0.03f + 0.022f * Clouds2(41, 5 * azimuth, 0.5f, 4);
  const float level = std::hypot(direction.x(), direction.y());
  const float above = direction.z() / std::max(level, 1e-6f) - ridge;
  if (above > 0) return SkyAt(direction);
  return 0.74f + 0.03f * Clouds2(42, 40 * azimuth, 60 * direction.z(), 3);
}

class Light {
 public:
  Light(const World& world, const RayScene& rays, const Vector3f& towards_sun)
      : world_(world), rays_(rays), sun_(towards_sun) {
    sun_right_ = sun_.unitOrthogonal();
    sun_up_ = sun_.cross(sun_right_);
  }

  struct Sample {
    float light;
    bool is_built;
  };
  using Samples = std::array<Sample, kPacket>;

  // What comes from these directions to the eye, of a block of samples, `side` of a pixel in each
  // direction; `pixel_rad` is the angle that a pixel covers.
  void Gather(const Vector3f& eye, const RayPacket& towards, int side, float pixel_rad,
              std::uint64_t seed, Samples& out) const {
    const HitPacket hits = rays_.FirstHitsFrom(eye, towards);
    RayPacket from, to_sun;
    LanePacket sunny{}, met{};
    std::array<Vector3f, kPacket> normals, places;
    for (unsigned i = 0; i < kPacket; ++i) {
      const Vector3f direction(towards.x[i], towards.y[i], towards.z[i]);
      if (hits.surface[i] == kNothing) {
        out[i] = {FarAt(direction), false};
        continue;
      }
      normals[i] = NormalAt(hits, i, direction);
      places[i] = eye + hits.z[i] * direction;
      Draws draws(seed, i);
      const Vector3f start = places[i] + (0.002f + kOffset * hits.z[i]) * normals[i];
      Put(from, i, start);
      const float r = kSunRadius * std::sqrt(draws.Uniform()), a = draws.Within(0, 6.2831853f);
      Put(to_sun, i, (sun_ + r * (std::cos(a) * sun_right_ + std::sin(a) * sun_up_)).normalized());
      sunny[i] = normals[i].dot(sun_) > 0;
      met[i] = true;
    }
    rays_.DropOccluded(from, to_sun, sunny);
    const std::array<float, kPacket> from_sky = SkyOver(from, normals, met, side, seed);
    for (unsigned i = 0; i < kPacket; ++i) {
      if (!met[i]) continue;
      const Vector3f direction(towards.x[i], towards.y[i], towards.z[i]);
      const float from_sun = sunny[i] ? kSun * normals[i].dot(sun_) : 0;
      out[i] = {
          Reflected(hits, i, places[i], normals[i], direction, from_sky[i] + from_sun, pixel_rad),
          hits.surface[i] != world_.ground};
    }
  }

 private:
  static void Put(RayPacket& packet, std::size_t i, const Vector3f& v) {
    packet.x[i] = v.x(), packet.y[i] = v.y(), packet.z[i] = v.z();
  }

  // Unit, on the side that is seen.
  Vector3f NormalAt(const HitPacket& hits, unsigned i, const Vector3f& direction) const {
    const RayMesh& mesh = *world_.surfaces[hits.surface[i]].mesh;
    const auto& corners = mesh.triangles[hits.triangle[i]];
    const auto at = [&](std::size_t k) {
      return Eigen::Map<const Vector3f>(mesh.normals[corners[k]].data());
    };
    const float u = hits.u[i], v = hits.v[i];
    const Vector3f blended = (1 - u - v) * at(0) + u * at(1) + v * at(2);
    const Vector3f normal = world_.world_from_normal[hits.surface[i]] * blended;
    const float length = std::max(normal.norm(), 1e-20f);
    return normal / (normal.dot(direction) > 0 ? -length : length);
  }

  // The light of the sky, or of other faces instead, on each sample's face. The rays of a pixel's
  // samples together are spread evenly over its sky: on a lattice, turned by chance for each pixel,
  // and to each the opposite one, so that half of them meet what is below the horizon of a wall.
  std::array<float, kPacket> SkyOver(const RayPacket& from,
                                     const std::array<Vector3f, kPacket>& normals,
                                     const LanePacket& met, int side, std::uint64_t seed) const {
    std::array<float, kPacket> light{};
    const int samples = side * side;
    for (int ray = 0; ray < kSkyRays; ++ray) {
      RayPacket to_sky;
      for (std::size_t i = 0; i < kPacket; ++i) {
        if (!met[i]) continue;
        const int column = static_cast<int>(i) % kBlock, row = static_cast<int>(i) / kBlock;
        const int pixel = row / side * kBlock + column / side;
        const int k = ray / 2 * samples + row % side * side + column % side;
        Draws turn(seed, kPacket + static_cast<std::uint64_t>(pixel));
        const float u =
            turn.Uniform() + static_cast<float>(2 * k) / static_cast<float>(kSkyRays * samples);
        const float v = turn.Uniform() + 0.61803399f * static_cast<float>(k) +
                        0.5f * static_cast<float>(ray % 2);
        Put(to_sky, i, Over(normals[i], u - std::floor(u), v - std::floor(v)));
      }
      LanePacket open = met;
      rays_.DropOccluded(from, to_sky, open);
      for (std::size_t i = 0; i < kPacket; ++i) {
        if (!met[i]) continue;
        const Vector3f sky(to_sky.x[i], to_sky.y[i], to_sky.z[i]);
        light[i] += kSky / kSkyRays * (open[i] ? SkyAt(sky) : kBounce);
      }
    }
    return light;
  }

  // A direction over the face, more often where the face takes more light from, for two numbers
  // from 0 to 1.
  static Vector3f Over(const Vector3f& normal, float u, float v) {
    const Vector3f right = normal.unitOrthogonal(), up = normal.cross(right);
    const float r = std::sqrt(u), a = 6.2831853f * v;
    return (r * std::cos(a) * right + r * std::sin(a) * up +
            std::sqrt(std::max(0.0f, 1 - u)) * normal)
        .normalized();
  }

  float Reflected(const HitPacket& hits, unsigned i, const Vector3f& place, const Vector3f& normal,
                  const Vector3f& direction, float arriving, float pixel_rad) const {
    const Face& face = world_.faces[hits.surface[i]];
    const float facing = std::max(-normal.dot(direction), 0.05f);
    const float size_m = hits.z[i] * pixel_rad / std::sqrt(facing);
    const Vector3f on_pattern = place + (world_.origin - world_.pattern_origin).cast<float>();
    float light = face.albedo * arriving * TextureTone(face.material, on_pattern, normal, size_m);
    if (face.material == Material::kGlass) {
      // Dark within; at a grazing angle the sky is seen in it.
      const Vector3f mirrored = direction + 2 * facing * normal;
      light = 0.03f * arriving + (0.05f + 0.6f * std::pow(1 - facing, 4.0f)) * SkyAt(mirrored);
    }
    const float clear = std::exp(-hits.z[i] / kHaze_m);
    return light * clear + 0.8f * (1 - clear);
  }

  const World& world_;
  const RayScene& rays_;
  Vector3f sun_, sun_right_, sun_up_;
};

// The light that 85 of 100 built samples stay below, from counts by tenths of a stop.
class Brightness {
 public:
  void Add(float light) {
    const float step = 10 * std::log2(std::max(light, 1e-6f)) + kMiddle;
    ++counts_[static_cast<std::size_t>(std::clamp(step, 0.0f, kSteps - 1.0f))];
  }
  float Upper() const {
    std::uint64_t all = 0, below = 0;
    for (const auto& count : counts_) all += count;
    if (all == 0) return 0;
    std::size_t step = 0;
    while (step < kSteps && (below += counts_[step]) * 100 < all * 85) ++step;
    return std::exp2((static_cast<float>(step) - kMiddle) / 10);
  }

 private:
  static constexpr std::size_t kSteps = 300;
  static constexpr float kMiddle = 200;
  std::array<std::atomic<std::uint64_t>, kSteps> counts_{};
};

// More samples a side where there are fewer pixels: large pictures are softened afterwards anyway.
int SamplesASide(const Eigen::Vector2i& size_px) {
  const double pixels = size_px.cast<double>().prod();
  return pixels <= 400'000 ? 4 : 2;
}

// The characteristic curve of plate and paper together: toe, straight part, shoulder.
float Developed(float light) {
  constexpr float kContrast = 1.45f, kMiddle = 0.40f;
  const float powered = std::pow(std::max(light, 0.0f), kContrast);
  static const float middle = std::pow(kMiddle, kContrast);
  return std::min(1.0f, 1.16f * powered / (powered + middle));
}

// What is needed to expose a packet of samples.
struct Ingredients {
  const model::PhotoRequest& request;
  const Lens& lens;
  const Light& light;
  Vector3f eye;
  float pixel_rad;
  int side;  // samples of a pixel, in each direction

  // Directions of the samples of the pixels from this one on, each anywhere in its own square;
  // false where the lens folds the picture over.
  bool Aim(int x, int y, RayPacket& towards) const {
    bool all = true;
    for (int i = 0; i < kPacket; ++i) {
      const std::uint64_t bits =
          Hashed(request.seed, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y),
                 static_cast<std::uint64_t>(i));
      const double across = i % kBlock + double{Share(bits)};
      const double down = i / kBlock + double{Share(bits << 24)};
      const auto direction = lens.Towards(Vec2(x - 0.5 + across / side, y - 0.5 + down / side));
      all = all && direction.has_value();
      const Vector3f d = direction.value_or(Vector3f::UnitZ());
      towards.x[i] = d.x(), towards.y[i] = d.y(), towards.z[i] = d.z();
    }
    return all;
  }
  bool Gather(int x, int y, Light::Samples& samples) const {
    RayPacket towards;
    const bool all = Aim(x, y, towards);
    light.Gather(
        eye, towards, side, pixel_rad,
        Hashed(request.seed, 7, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)),
        samples);
    return all;
  }
  // Measures some pixels of these rows.
  void Meter(int top, int bottom, Brightness& brightness) const {
    Light::Samples samples;
    for (int y = top; y < bottom; y += kMeterStep_px) {
      for (int x = 0; x < request.frame.size_px.x(); x += kMeterStep_px) {
        Gather(x, y, samples);
        for (const Light::Sample& sample : samples) {
          if (sample.is_built) brightness.Add(sample.light);
        }
      }
    }
  }
  // Exposes rows of pixels; as Aim.
  bool Band(int top, int bottom, float exposed, Tones& tones) const {
    const int block_px = kBlock / side;
    const auto vignette = static_cast<float>(request.effects.vignette);
    bool all = true;
    Light::Samples samples;
    for (int y0 = top; y0 < bottom; y0 += block_px) {
      for (int x0 = 0; x0 < tones.width_px; x0 += block_px) {
        all = Gather(x0, y0, samples) && all;
        for (int i = 0; i < kPacket; ++i) {
          const int x = x0 + i % kBlock / side, y = y0 + i / kBlock / side;
          if (x >= tones.width_px || y >= bottom) continue;
          const float out = Outward(x, y, tones.width_px, tones.height_px);
          const float falloff = 1 - 0.85f * vignette * out * out * std::sqrt(out);
          tones.At(x, y) +=
              Developed(samples[i].light * exposed * falloff) / static_cast<float>(side * side);
        }
      }
    }
    return all;
  }
};

}  // namespace

float Outward(int x, int y, int width_px, int height_px) {
  const float u = 2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(width_px) - 1;
  const float v = 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(height_px) - 1;
  return std::sqrt(0.5f * (u * u + v * v));
}

Result<Tones> Expose(const model::PhotoRequest& request, int threads) {
  const Result<World> world = WorldOf(request, threads);
  if (!world) return tl::unexpected(world.error());
  const Result<RayScene> rays = RayScene::Of(world->surfaces);
  if (!rays) return tl::unexpected(rays.error());
  const Lens lens(request);
  const Light light(*world, *rays, request.towards_sun.cast<float>());
  const Eigen::Vector2i size_px = request.frame.size_px;
  const Ingredients ingredients{
      request,
      lens,
      light,
      (request.camera.position_m() - world->origin).cast<float>(),
      static_cast<float>(request.frame.pitch_mm().mean() / request.camera[camera::kFocal]),
      SamplesASide(size_px)};
  const auto for_bands = [&](auto&& make) {
    const int bands = (size_px.y() + kBand_px - 1) / kBand_px;
    ParallelFor(static_cast<std::size_t>(bands), threads, [&](std::size_t band) {
      const int top = static_cast<int>(band) * kBand_px;
      make(top, std::min(top + kBand_px, size_px.y()));
    });
  };
  Brightness brightness;
  for_bands([&](int top, int bottom) { ingredients.Meter(top, bottom, brightness); });
  const float upper = brightness.Upper();
  const float exposed = upper > 0 ? kExposedTo / upper : 1;
  Tones tones{size_px.x(), size_px.y(), {}};
  tones.values.resize(static_cast<std::size_t>(size_px.x()) * size_px.y());
  std::atomic<bool> folds = false;
  for_bands([&](int top, int bottom) {
    if (!ingredients.Band(top, bottom, exposed, tones)) folds = true;
  });
  if (folds) {
    return tl::unexpected(Error{"the lens's distortion would fold the picture over at its edge"});
  }
  return tones;
}

}  // namespace tranos::output
