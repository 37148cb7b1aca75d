// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tranos::output {
namespace {

struct Row {
  std::string_view word;
  Material material;
  model::Rgb rgb;
};
constexpr model::Rgb kLightStone = {222, 214, 198};
constexpr std::array kRows = {
    Row{"brick", Material::kBrick, {166, 94, 70}},
    Row{"stone", Material::kStone, {205, 194, 170}},
    Row{"limestone", Material::kStone, {214, 205, 182}},
    Row{"sandstone", Material::kStone, {200, 176, 138}},
    Row{"granite", Material::kStone, {156, 152, 148}},
    Row{"ashlar", Material::kStone, {205, 194, 170}},
    Row{"mortar", Material::kMortar, {203, 196, 182}},
    Row{"plaster", Material::kPlaster, {226, 211, 181}},
    Row{"stucco", Material::kPlaster, {226, 211, 181}},
    Row{"render", Material::kPlaster, {218, 208, 188}},
    Row{"marble", Material::kMarble, {236, 234, 228}},
    Row{"tile", Material::kTile, {185, 103, 74}},
    Row{"tiles", Material::kTile, {185, 103, 74}},
    Row{"terracotta", Material::kTile, {190, 110, 80}},
    Row{"timber", Material::kTimber, {122, 92, 66}},
    Row{"wood", Material::kTimber, {122, 92, 66}},
    Row{"oak", Material::kTimber, {128, 98, 66}},
    Row{"metal", Material::kMetal, {118, 122, 126}},
    Row{"iron", Material::kMetal, {84, 86, 90}},
    Row{"steel", Material::kMetal, {140, 144, 150}},
    Row{"bronze", Material::kMetal, {126, 104, 66}},
    Row{"gold", Material::kMetal, {206, 170, 84}},
    Row{"lead", Material::kLead, {139, 150, 158}},
    Row{"zinc", Material::kLead, {150, 158, 164}},
    Row{"copper", Material::kCopper, {116, 160, 142}},
    Row{"slate", Material::kSlate, {92, 100, 108}},
    Row{"glass", Material::kGlass, {84, 104, 118}},
    Row{"concrete", Material::kConcrete, {168, 166, 162}},
    Row{"earth", Material::kEarth, {136, 116, 92}},
    Row{"grass", Material::kGrass, {112, 128, 80}},
};

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

const Row* RowOf(std::string_view name) {
  for (std::size_t begin = 0; begin < name.size();) {
    std::size_t end = begin;
    while (end < name.size() && IsLetter(name[end])) ++end;
    std::string word(name.substr(begin, end - begin));
    for (char& c : word) c = static_cast<char>(c | 0x20);
    const auto row = std::find_if(kRows.begin(), kRows.end(),
                                  [&](const Row& each) { return each.word == word; });
    if (row != kRows.end()) return &*row;
    begin = end + 1;
  }
  return nullptr;
}

}  // namespace

double LinearFromSrgb(std::uint8_t value) {
  const double s = value / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

Material MaterialOf(std::string_view name) {
  const Row* row = RowOf(name);
  return row ? row->material : Material::kPlain;
}

model::Rgb SurfaceColour(model::Colour colour, std::string_view material) {
  if (!(colour == model::Colour{0})) return model::RgbOf(colour);
  const Row* row = RowOf(material);
  return row ? row->rgb : kLightStone;
}

}  // namespace tranos::output
