// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of an element's parameters, drawn from the ranges that it declares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "interp/program.h"

namespace tranos::app {

// Numbers drawn at random: the same ones for the same seed, on every machine (splitmix64).
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(seed) {}
  double UpToOne();  // 0 ≤ x < 1
  std::size_t Below(std::size_t count);

 private:
  std::uint64_t state_;
};

// What a parameter is set to: its default, an end of its range, or anything within.
enum class Pick : std::uint8_t { kStandard, kLow, kHigh, kRandom };

// The parameters that are to declare a range and do not.
std::vector<std::string> RangesMissing(const interp::Definition& element);

// The words of `detail`; a single "" where the element has no such parameter.
std::vector<std::string> DetailsOf(const interp::Definition& element);

// The settings that a test tries first: all parameters at their defaults, all at the low ends of
// their ranges, all at the high ones, and each at its ends alone.
std::vector<std::vector<Pick>> CornersOf(const interp::Definition& element);

// A line of script that places the element so and calls it `it`; ranges and defaults are evaluated
// in the order of the parameters, for each may depend on those before it. What is wrong with a
// range is told as a sentence.
tl::expected<std::string, std::string> PlacementOf(const interp::Definition& element,
                                                   const std::vector<Pick>& picks,
                                                   const std::string& detail, Draws* draws);

}  // namespace tranos::app
