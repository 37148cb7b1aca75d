// SPDX-License-Identifier: GPL-3.0-or-later
// How far a value may go, for messages: found by trying.
#pragma once

#include <string>

#include "interp/commands/firing.h"

namespace tranos::interp {

// The largest length below `failing_m` for which works(length), taking it that all below it work;
// zero if none does.
template <class Works>
double LargestThatWorks(double failing_m, const Works& works) {
  constexpr int kHalvings = 30;
  double low = 0, high = failing_m;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (works(middle) ? low : high) = middle;
  }
  return low > 1e-6 * failing_m ? low : 0;
}

// "above 0 and at most 1.5 m", or nothing if no length works.
std::string RangeInWords(double largest_m, const model::Settings& settings);

}  // namespace tranos::interp
