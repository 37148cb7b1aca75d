// SPDX-License-Identifier: GPL-3.0-or-later
// Chance that depends on a seed and a place alone: the same for any number of threads.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace tranos::output {

// Bits that look random, of these four numbers (SplitMix64's finalizer, twice).
std::uint64_t Hashed(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0);

// Uniform in [0, 1).
inline float Share(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }

// Numbers one after another.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0) : seed_(Hashed(seed, a, b)) {}
  float Uniform() { return Share(Hashed(seed_, ++count_)); }
  float Within(float low, float high) { return low + (high - low) * Uniform(); }
  // Of mean 0 and deviation 1 (Box and Muller).
  float Normal();

 private:
  std::uint64_t seed_, count_ = 0;
};

// Smooth noise in [−1, 1] that varies over a length of 1.
float Noise2(std::uint64_t seed, float x, float y);
float Noise3(std::uint64_t seed, const Eigen::Vector3f& p);
// Sums of it, each of half the length and half the strength of the one before; about [−1, 1].
float Clouds2(std::uint64_t seed, float x, float y, int octaves);
float Clouds3(std::uint64_t seed, const Eigen::Vector3f& p, int octaves);

}  // namespace tranos::output
