// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/print.h"

#include <algorithm>
#include <cmath>

#include "output/chance.h"
#include "output/parallel.h"
#include "output/plate_damage.h"

namespace tranos::output {
namespace {

using Eigen::Vector3f;

constexpr float kUsualWidth_px = 484;  // that grain and softness are stated for

template <class F>
void ForRows(int height_px, int threads, F&& row) {
  ParallelFor(static_cast<std::size_t>(height_px), threads,
              [&](std::size_t y) { row(static_cast<int>(y)); });
}

// Blurred by a Gaussian; what is beyond the edge is as the edge is.
void Soften(std::vector<float>& values, int width, int height, float sigma_px, int threads) {
  const int reach = std::max(1, static_cast<int>(std::ceil(3 * sigma_px)));
  std::vector<float> weights(static_cast<std::size_t>(reach) + 1);
  float sum = 0;
  for (int i = 0; i <= reach; ++i) {
    const float t = static_cast<float>(i) / sigma_px;
    weights[i] = std::exp(-0.5f * t * t);
    sum += weights[i] * (i == 0 ? 1 : 2);
  }
  for (float& weight : weights) weight /= sum;
  std::vector<float> across(values.size());
  ForRows(height, threads, [&](int y) {
    const float* row = &values[static_cast<std::size_t>(y) * width];
    for (int x = 0; x < width; ++x) {
      float value = weights[0] * row[x];
      for (int i = 1; i <= reach; ++i) {
        value += weights[i] * (row[std::max(x - i, 0)] + row[std::min(x + i, width - 1)]);
      }
      across[static_cast<std::size_t>(y) * width + x] = value;
    }
  });
  ForRows(height, threads, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto at = [&](int row) { return across[static_cast<std::size_t>(row) * width + x]; };
      float value = weights[0] * at(y);
      for (int i = 1; i <= reach; ++i) {
        value += weights[i] * (at(std::max(y - i, 0)) + at(std::min(y + i, height - 1)));
      }
      values[static_cast<std::size_t>(y) * width + x] = value;
    }
  });
}

// Light that goes through the emulsion comes back from the glass behind it, around what is bright.
void Glow(Tones& tones, int threads) {
  // On a quarter of the pixels in each direction: it is soft.
  const int w = (tones.width_px + 3) / 4, h = (tones.height_px + 3) / 4;
  std::vector<float> bright(static_cast<std::size_t>(w) * h);
  ForRows(h, threads, [&](int y) {
    for (int x = 0; x < w; ++x) {
      float sum = 0;
      for (int k = 0; k < 16; ++k) {
        sum += tones.At(std::min(4 * x + k % 4, tones.width_px - 1),
                        std::min(4 * y + k / 4, tones.height_px - 1));
      }
      bright[static_cast<std::size_t>(y) * w + x] = sum / 16;
    }
  });
  Soften(bright, w, h, std::max(1.0f, static_cast<float>(w) / 60), threads);
  ForRows(tones.height_px, threads, [&](int y) {
    for (int x = 0; x < tones.width_px; ++x) {
      const float fx =
          std::clamp((static_cast<float>(x) - 1.5f) / 4, 0.0f, static_cast<float>(w - 1));
      const float fy =
          std::clamp((static_cast<float>(y) - 1.5f) / 4, 0.0f, static_cast<float>(h - 1));
      const int i = std::min(static_cast<int>(fx), std::max(w - 2, 0));
      const int k = std::min(static_cast<int>(fy), std::max(h - 2, 0));
      const float u = fx - static_cast<float>(i), v = fy - static_cast<float>(k);
      const auto at = [&](int a, int b) {
        return bright[static_cast<std::size_t>(std::min(b, h - 1)) * w + std::min(a, w - 1)];
      };
      const float glow = (1 - v) * ((1 - u) * at(i, k) + u * at(i + 1, k)) +
                         v * ((1 - u) * at(i, k + 1) + u * at(i + 1, k + 1));
      tones.At(x, y) = 0.94f * tones.At(x, y) + 0.06f * glow;
    }
  });
}

// Clumps of silver, seen most in middle tones.
void AddGrain(Tones& tones, double strength, std::uint64_t seed, int threads) {
  if (!(strength > 0)) return;
  std::vector<float> grain(tones.values.size());
  ForRows(tones.height_px, threads, [&](int y) {
    for (int x = 0; x < tones.width_px; ++x) {
      Draws draws(seed, 201, static_cast<std::uint64_t>(y) * tones.width_px + x);
      grain[static_cast<std::size_t>(y) * tones.width_px + x] = draws.Normal();
    }
  });
  const float size_px = std::max(0.5f, 0.3f * static_cast<float>(tones.width_px) / kUsualWidth_px);
  Soften(grain, tones.width_px, tones.height_px, size_px, threads);
  // A Gaussian of σ leaves 1/(2 σ √π) of the deviation of white noise.
  const float scale = 3.545f * size_px * 0.11f * static_cast<float>(strength);
  ForRows(tones.height_px, threads, [&](int y) {
    for (int x = 0; x < tones.width_px; ++x) {
      float& tone = tones.At(x, y);
      const float middle = 0.35f + 0.65f * std::sqrt(std::max(0.0f, 4 * tone * (1 - tone)));
      tone += scale * middle * grain[static_cast<std::size_t>(y) * tones.width_px + x];
    }
  });
}

struct Colours {
  Vector3f shadow, middle, paper, stain;
};
Colours ColoursOf(model::PrintTone tone) {
  const auto rgb = [](int r, int g, int b) -> Vector3f {
    return Vector3f(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)) / 255;
  };
  if (tone == model::PrintTone::kGrey) {
    return {rgb(18, 18, 19), rgb(122, 121, 119), rgb(238, 237, 232), rgb(196, 180, 146)};
  }
  return {rgb(36, 25, 18), rgb(138, 112, 84), rgb(241, 229, 202), rgb(178, 138, 84)};
}

// From shadow through middle to paper, smoothly: a parabola through the three.
Vector3f Coloured(const Colours& colours, float tone) {
  const float t = std::clamp(tone, 0.0f, 1.0f);
  return colours.shadow * ((1 - t) * (1 - 2 * t)) + colours.middle * (4 * t * (1 - t)) +
         colours.paper * (t * (2 * t - 1));
}

// By how much its fibres lighten or darken the paper.
float Fibres(std::uint64_t seed, float x, float y, float width_px) {
  const float u = x / width_px, v = y / width_px;
  const float turn = Noise2(seed, 40 * u, 40 * v);
  const float along = Noise2(seed + 1, 520 * u + 30 * turn, 130 * v);
  const float across = Noise2(seed + 2, 130 * u, 520 * v + 30 * turn);
  return 0.45f * (along + across) + 0.7f * Clouds2(seed + 3, 7 * u, 7 * v, 4);
}

}  // namespace

camera::Photo PrintOf(Tones tones, const model::PhotoRequest& request, int threads) {
  const model::PrintEffects& effects = request.effects;
  const std::uint64_t seed = request.seed;
  const float wider = static_cast<float>(tones.width_px) / kUsualWidth_px;
  Soften(tones.values, tones.width_px, tones.height_px, 0.35f + 0.2f * std::min(wider, 6.0f),
         threads);
  Glow(tones, threads);
  AddGrain(tones, effects.grain, seed, threads);
  const int width = tones.width_px, height = tones.height_px;
  const Damage damage = DamageOf(effects, seed, width, height);
  const Colours colours = ColoursOf(request.tone);
  const auto fade = static_cast<float>(effects.fade), fibres = static_cast<float>(effects.paper);
  camera::Photo photo{width, height, std::vector<std::uint8_t>(3 * tones.values.size())};
  ForRows(height, threads, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      float tone = tones.values[pixel];
      tone += (0.97f - tone) * damage.light[pixel];
      tone *= 1 - 0.8f * damage.dark[pixel];
      const float uneven =
          0.5f + 0.5f * Clouds2(seed + 31, 3.0f * static_cast<float>(x) / static_cast<float>(width),
                                3.0f * static_cast<float>(y) / static_cast<float>(width), 3);
      const float faded = fade * std::clamp(0.55f + 0.25f * uneven +
                                                0.3f * std::pow(Outward(x, y, width, height), 4.0f),
                                            0.0f, 1.0f);
      tone += faded * (0.30f + 0.58f * tone - tone);
      Vector3f colour = Coloured(colours, tone);
      const Vector3f stained = colour.cwiseProduct(colours.stain / colours.paper.maxCoeff());
      colour += damage.brown[pixel] * (stained - colour);
      colour *= 1 + 0.055f * fibres *
                        Fibres(seed + 51, static_cast<float>(x), static_cast<float>(y),
                               static_cast<float>(width));
      for (int c = 0; c < 3; ++c) {
        float value = colour[c];
        if (effects.scan > 0) {
          Draws draws(seed, 301 + static_cast<std::uint64_t>(c), pixel);
          value += 0.04f * static_cast<float>(effects.scan) * draws.Normal();
        }
        photo.rgb[3 * pixel + static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f);
      }
    }
  });
  return photo;
}

}  // namespace tranos::output
