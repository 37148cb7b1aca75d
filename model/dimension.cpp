// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dimension.h"

namespace tranos::model {

std::string Describe(Dimension dimension) {
  if (dimension.plain()) return "a plain number";
  if (dimension == kLength) return "a length";
  if (dimension == kArea) return "an area";
  if (dimension == kVolume) return "a volume";
  if (dimension == kAngle) return "an angle";
  if (dimension == kPixel) return "a number of pixels";
  const char* base = dimension.base == Dimension::kLength  ? "length"
                     : dimension.base == Dimension::kAngle ? "angle"
                                                           : "pixel";
  return base + ("^" + std::to_string(dimension.exponent));
}

}  // namespace tranos::model
