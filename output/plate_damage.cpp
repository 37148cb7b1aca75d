// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/plate_damage.h"

#include <algorithm>
#include <cmath>

#include "output/chance.h"

namespace tranos::output {
namespace {

using Eigen::Vector2f;

enum Kind : std::uint64_t { kSpeck = 101, kHair, kScratch, kStain, kFoxing };

// A layer of coverage that things are drawn on.
class Layer {
 public:
  Layer(std::vector<float>& values, int width_px, int height_px)
      : values_(values), width_px_(width_px), height_px_(height_px) {
    values_.assign(static_cast<std::size_t>(width_px) * height_px, 0);
  }

  // The larger of what is there and cover(offset from the centre) within this radius; in pixels.
  template <class F>
  void Cover(const Vector2f& centre, float radius, F&& cover) {
    const int left = std::max(0, static_cast<int>(std::floor(centre.x() - radius)));
    const int right = std::min(width_px_ - 1, static_cast<int>(std::ceil(centre.x() + radius)));
    const int top = std::max(0, static_cast<int>(std::floor(centre.y() - radius)));
    const int bottom = std::min(height_px_ - 1, static_cast<int>(std::ceil(centre.y() + radius)));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        float& value = values_[static_cast<std::size_t>(y) * width_px_ + x];
        const Vector2f offset = Vector2f(static_cast<float>(x), static_cast<float>(y)) - centre;
        value = std::max(value, cover(offset));
      }
    }
  }

  // A stroke of dots. One thinner than a pixel covers it in part.
  void Dot(const Vector2f& centre, float radius, float strength) {
    const float drawn = std::max(radius, 0.55f);
    const float share = strength * radius / drawn;
    Cover(centre, drawn + 1, [&](const Vector2f& offset) {
      return share * std::clamp(drawn + 0.5f - offset.norm(), 0.0f, 1.0f);
    });
  }

 private:
  std::vector<float>& values_;
  int width_px_, height_px_;
};

int CountOf(double strength, double most) { return static_cast<int>(std::lround(strength * most)); }

struct Paper {
  float width, height;  // px
  std::uint64_t seed;

  Vector2f Anywhere(Draws& draws) const {
    const float x = draws.Within(0, width);
    return {x, draws.Within(0, height)};
  }
};

void AddSpecks(const Paper& paper, double strength, Layer& light, Layer& dark) {
  for (int i = 0; i < CountOf(strength, 260); ++i) {
    Draws draws(paper.seed, kSpeck, static_cast<std::uint64_t>(i));
    const Vector2f centre = paper.Anywhere(draws);
    const float small = draws.Uniform();
    const float radius = paper.width * (0.0004f + 0.0022f * small * small * small * small);
    const float stretch = draws.Within(1, 2.2f), turn = draws.Within(0, 3.14159f);
    const Vector2f along(std::cos(turn), std::sin(turn));
    Layer& layer = draws.Uniform() < 0.65f ? light : dark;
    const float most = draws.Within(0.35f, 0.95f), drawn = std::max(radius, 0.55f);
    layer.Cover(centre, stretch * drawn + 1, [&](const Vector2f& o) {
      const float a = o.dot(along) / stretch, b = o.dot(Vector2f(-along.y(), along.x()));
      return most * radius / drawn * std::clamp(drawn + 0.5f - std::hypot(a, b), 0.0f, 1.0f);
    });
  }
}

// A line that bends as it goes.
struct Line {
  Vector2f at;
  float heading, bend;  // rad, rad a width
  float length, radius, strength;
};
void Draw(const Paper& paper, const Line& line, std::uint64_t seed, float broken, Layer& layer) {
  const float step = std::max(0.5f, 0.4f * line.radius);
  Vector2f at = line.at;
  float heading = line.heading;
  for (float gone = 0; gone < line.length; gone += step) {
    const float t = gone / paper.width;
    heading += line.bend * step / paper.width * Noise2(seed, 12 * t, 0.5f);
    at += step * Vector2f(std::cos(heading), std::sin(heading));
    const float ends = std::min({1.0f, 8 * gone / line.length, 8 * (1 - gone / line.length)});
    const float whole =
        std::clamp(1 - broken * (1 + 2 * Noise2(seed + 1, 60 * t, 0.5f)), 0.0f, 1.0f);
    layer.Dot(at, line.radius * (0.7f + 0.3f * Noise2(seed + 2, 90 * t, 0.5f)),
              line.strength * ends * whole);
  }
}

void AddHairs(const Paper& paper, double strength, Layer& light, Layer& dark) {
  for (int i = 0; i < CountOf(strength, 14); ++i) {
    Draws draws(paper.seed, kHair, static_cast<std::uint64_t>(i));
    Line hair{paper.Anywhere(draws), draws.Within(0, 6.28f), draws.Within(60, 260), 0, 0, 0};
    hair.length = paper.width * draws.Within(0.015f, 0.06f);
    hair.radius = paper.width * 0.0006f;
    hair.strength = draws.Within(0.35f, 0.7f);
    Draw(paper, hair, Hashed(paper.seed, kHair, static_cast<std::uint64_t>(i), 1), 0.1f,
         draws.Uniform() < 0.5f ? light : dark);
  }
}

// Most run the long way that a plate is pushed into its sleeve, some anywhere.
void AddScratches(const Paper& paper, double strength, Layer& light, Layer& dark) {
  for (int i = 0; i < CountOf(strength, 34); ++i) {
    Draws draws(paper.seed, kScratch, static_cast<std::uint64_t>(i));
    Line scratch{paper.Anywhere(draws), 0, draws.Within(0.2f, 3), 0, 0, 0};
    const bool is_pushed = draws.Uniform() < 0.7f;
    scratch.heading = is_pushed ? 1.5708f + draws.Within(-0.12f, 0.12f) : draws.Within(0, 6.28f);
    const float u = draws.Uniform();
    scratch.length = paper.width * (0.03f + 0.6f * u * u * u);
    scratch.radius = paper.width * draws.Within(0.0002f, 0.0007f);
    scratch.strength = draws.Within(0.25f, 0.85f);
    Draw(paper, scratch, Hashed(paper.seed, kScratch, static_cast<std::uint64_t>(i), 1),
         draws.Within(0.1f, 0.8f), draws.Uniform() < 0.8f ? light : dark);
  }
}

// Damp leaves what it carried at its rim.
void AddStains(const Paper& paper, double strength, Layer& brown) {
  for (int i = 0; i < CountOf(strength, 9); ++i) {
    Draws draws(paper.seed, kStain, static_cast<std::uint64_t>(i));
    Vector2f centre = paper.Anywhere(draws);
    if (draws.Uniform() < 0.7f) {  // it comes from the edges
      centre.x() = draws.Uniform() < 0.5f ? -0.02f * paper.width : 1.02f * paper.width;
    }
    const float radius = paper.width * draws.Within(0.04f, 0.17f);
    const float most = draws.Within(0.25f, 0.65f);
    const std::uint64_t seed = Hashed(paper.seed, kStain, static_cast<std::uint64_t>(i), 1);
    brown.Cover(centre, 1.6f * radius, [&](const Vector2f& o) {
      const Vector2f at = o / radius;
      const float edge = 1 + 0.35f * Clouds2(seed, 1.7f * at.x(), 1.7f * at.y(), 4);
      const float inside = edge - at.norm();
      if (inside < 0) return most * std::exp(inside * 40) * 0.8f;
      return most * (0.28f + 0.1f * Clouds2(seed + 9, 5 * at.x(), 5 * at.y(), 3) +
                     0.72f * std::exp(-inside * 22));
    });
  }
  for (int i = 0; i < CountOf(strength, 90); ++i) {
    Draws draws(paper.seed, kFoxing, static_cast<std::uint64_t>(i));
    const Vector2f centre = paper.Anywhere(draws);
    const float u = draws.Uniform();
    const float radius = paper.width * (0.001f + 0.006f * u * u * u);
    const float most = draws.Within(0.08f, 0.4f);
    brown.Cover(centre, 3 * radius, [&](const Vector2f& o) {
      return most * std::exp(-o.squaredNorm() / (radius * radius));
    });
  }
}

}  // namespace

Damage DamageOf(const model::PrintEffects& effects, std::uint64_t seed, int width_px,
                int height_px) {
  Damage damage;
  Layer light(damage.light, width_px, height_px), dark(damage.dark, width_px, height_px);
  Layer brown(damage.brown, width_px, height_px);
  const Paper paper{static_cast<float>(width_px), static_cast<float>(height_px), seed};
  AddSpecks(paper, effects.dust, light, dark);
  AddHairs(paper, effects.dust, light, dark);
  AddScratches(paper, effects.scratches, light, dark);
  AddStains(paper, effects.stains, brown);
  return damage;
}

}  // namespace tranos::output
