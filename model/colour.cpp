// SPDX-License-Identifier: GPL-3.0-or-later
// Our palette, for pictures on a light ground: 0 is near-black, 1–15 are told apart at a
// glance, and 16–255 are 24 hues in ten tones each.
#include <algorithm>
#include <array>
#include <cmath>

#include "model/element.h"

namespace tranos::model {

namespace {

constexpr std::array<Rgb, 16> kFirstColours = {{
    {38, 38, 42},     // near-black
    {32, 96, 192},    // blue
    {24, 140, 72},    // green
    {200, 40, 40},    // red
    {224, 168, 0},    // amber
    {128, 64, 176},   // violet
    {232, 112, 24},   // orange
    {0, 160, 176},    // teal
    {144, 144, 148},  // grey
    {120, 180, 240},  // sky
    {136, 204, 112},  // leaf
    {240, 136, 144},  // rose
    {250, 222, 110},  // straw
    {190, 156, 228},  // lilac
    {132, 84, 48},    // umber
    {214, 204, 184},  // stone
}};

constexpr std::uint32_t kHues = 24;

struct Tone {
  double saturation, value;
};
// From full colour to dark, then from half colour to pale.
constexpr std::array<Tone, 10> kTones = {{{1.0, 0.95},
                                          {1.0, 0.80},
                                          {1.0, 0.65},
                                          {1.0, 0.50},
                                          {1.0, 0.35},
                                          {0.6, 0.95},
                                          {0.6, 0.75},
                                          {0.6, 0.55},
                                          {0.3, 0.95},
                                          {0.3, 0.75}}};

Rgb FromHsv(double hue_turns, const Tone& tone) {
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + hue_turns * 6, 6);
    const double fall = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(255 * tone.value * (1 - tone.saturation * fall)));
  };
  return {channel(5), channel(3), channel(1)};
}

}  // namespace

Rgb RgbOf(Colour colour) {
  if (colour.code & Colour::kRgb) {
    return {static_cast<std::uint8_t>(colour.code >> 16),
            static_cast<std::uint8_t>(colour.code >> 8), static_cast<std::uint8_t>(colour.code)};
  }
  const std::uint32_t index = colour.code & 0xff;
  if (index < kFirstColours.size()) return kFirstColours[index];
  const std::uint32_t step = index - static_cast<std::uint32_t>(kFirstColours.size());
  return FromHsv(static_cast<double>(step % kHues) / kHues, kTones[step / kHues]);
}

std::string Describe(Colour colour) {
  if (!(colour.code & Colour::kRgb)) return std::to_string(colour.code);
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "#";
  for (int shift = 20; shift >= 0; shift -= 4) text += kDigits[(colour.code >> shift) & 15];
  return text;
}

}  // namespace tranos::model
