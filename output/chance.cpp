// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/chance.h"

#include <algorithm>
#include <cmath>

namespace tranos::output {
namespace {

constexpr std::uint64_t kOddA = 0x9e3779b97f4a7c15u, kOddB = 0xc2b2ae3d27d4eb4fu,
                        kOddC = 0x165667b19e3779f9u;

std::uint64_t Mixed(std::uint64_t z) {
  z += kOddA;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

std::uint64_t Cell(float x) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x)));
}
float Eased(float x) {
  const float t = x - std::floor(x);
  return t * t * (3 - 2 * t);
}
float AtCorner(std::uint64_t seed, std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  // Mixed once: noise is most of what a photograph costs.
  return 2 * Share(Mixed(seed * kOddC + x * kOddA + y * kOddB + z * (kOddA ^ kOddB))) - 1;
}
float Between(float a, float b, float t) { return a + (b - a) * t; }

float Layer(std::uint64_t seed, float x, float y, std::uint64_t z) {
  const std::uint64_t i = Cell(x), k = Cell(y);
  const float u = Eased(x), v = Eased(y);
  return Between(Between(AtCorner(seed, i, k, z), AtCorner(seed, i + 1, k, z), u),
                 Between(AtCorner(seed, i, k + 1, z), AtCorner(seed, i + 1, k + 1, z), u), v);
}

// The sum of `octaves` calls of noise(scale, which), weighed.
template <class F>
float Sum(int octaves, F&& noise) {
  float sum = 0, weight = 1, scale = 1, whole = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * noise(scale, static_cast<std::uint64_t>(i));
    whole += weight;
    weight *= 0.5f;
    scale *= 2;
  }
  return sum / whole * 1.5f;
}

}  // namespace

std::uint64_t Hashed(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return Mixed(Mixed(seed + a * kOddA) + b * kOddB + c * kOddC);
}

float Draws::Normal() {
  const float u = std::max(Uniform(), 0x1p-24f), v = Uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(6.2831853f * v);
}

float Noise2(std::uint64_t seed, float x, float y) { return Layer(seed, x, y, 0); }

float Noise3(std::uint64_t seed, const Eigen::Vector3f& p) {
  const std::uint64_t k = Cell(p.z());
  return Between(Layer(seed, p.x(), p.y(), k), Layer(seed, p.x(), p.y(), k + 1), Eased(p.z()));
}

float Clouds2(std::uint64_t seed, float x, float y, int octaves) {
  return Sum(octaves,
             [&](float scale, std::uint64_t i) { return Noise2(seed + i, scale * x, scale * y); });
}

float Clouds3(std::uint64_t seed, const Eigen::Vector3f& p, int octaves) {
  return Sum(octaves, [&](float scale, std::uint64_t i) { return Noise3(seed + i, scale * p); });
}

}  // namespace tranos::output
