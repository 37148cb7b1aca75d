// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/primitives.h"
#include "interp/diagnostic.h"

namespace tranos::interp {

// The diagnostic's code for what geom could not do.
inline Code CodeOf(geom::ErrorCode code) {
  switch (code) {
    case geom::ErrorCode::kDegenerate:
      return Code::kDegenerate;
    case geom::ErrorCode::kNotClosed:
      return Code::kNotClosed;
    case geom::ErrorCode::kNotPlanar:
      return Code::kNotPlanar;
    case geom::ErrorCode::kDoNotMeet:
      return Code::kDoNotMeet;
    case geom::ErrorCode::kNotAGraph:
      return Code::kNotAGraph;
    case geom::ErrorCode::kOutOfRange:
      return Code::kOutOfRange;
    case geom::ErrorCode::kTooLarge:
      return Code::kTooManyFacets;
    case geom::ErrorCode::kUnreadable:
      return Code::kNoPhotograph;
  }
  return Code::kDegenerate;
}

}  // namespace tranos::interp
