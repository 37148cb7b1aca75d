// SPDX-License-Identifier: GPL-3.0-or-later
// What a material's name says of how its faces look.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "model/element.h"

namespace tranos::output {

enum class Material : std::uint8_t {
  kPlain,  // no name, or one that says nothing of the look
  kBrick,
  kStone,
  kMortar,
  kPlaster,
  kMarble,
  kTile,
  kTimber,
  kMetal,
  kLead,
  kCopper,
  kSlate,
  kGlass,
  kConcrete,
  kEarth,
  kGrass,
};

// By the first word of the name that is known, in whatever case: "red brick" is brick.
Material MaterialOf(std::string_view name);

// The colour of a face: its own; of colour 0, that of its material, or else of a light stone (for
// colour 0, that of lines where none is set, is nearly black, in which a form would drown).
model::Rgb SurfaceColour(model::Colour colour, std::string_view material);

// The light that a value of the screen stands for, from 0 to 1 (IEC 61966-2-1).
double LinearFromSrgb(std::uint8_t value);

}  // namespace tranos::output
