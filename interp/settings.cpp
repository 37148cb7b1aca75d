// SPDX-License-Identifier: GPL-3.0-or-later
// The settings and the point keys, a row each; in the order of their enumerations.
#include "interp/program.h"

namespace tranos::interp {

namespace {

constexpr SettingRow kSettings[] = {
    {"co", SettingKey::kColour, Type::kColor, "", "colour: 0–255 of the palette, or \"#rrggbb\"",
     "0"},
    {"lc", SettingKey::kLinestyle, Type::kCount, "", "line style, 0–7", "0"},
    {"wt", SettingKey::kWeight, Type::kCount, "", "line weight, 0–31", "1"},
    {"lv", SettingKey::kLevel, Type::kLabel, "", "level: a number or a name", "1"},
    {"aa", SettingKey::kAngle, Type::kAngle, "",
     "active angle, of placed elements, text and rotations", "0"},
    {"as", SettingKey::kScale, Type::kScale, "", "active scale, one number or three", "1"},
    {"az", SettingKey::kDepth, Type::kLength, "",
     "active depth: z of points given by two coordinates", "0"},
    {"mt", SettingKey::kMaterial, Type::kLabel, "", "material", ""},
    {"ev", SettingKey::kEvidence, Type::kWord,
     "measured|photo|excavation|document|symmetry|analogy|conjecture",
     "evidence: why it stands where it stands", ""},
    {"source", SettingKey::kSource, Type::kString, "", "where the evidence is from", ""},
    {"tol", SettingKey::kChord, Type::kLength, "", "chord tolerance of facets", "1mm"},
    {"fn", SettingKey::kFacets, Type::kCount, "", "facets of a full turn; 0: by tol", "0"},
    {"lt", SettingKey::kLocate, Type::kLength, "", "locate tolerance of picks", "1cm"},
    {"un", SettingKey::kUnit, Type::kAny, "", "working unit of bare numbers in the text after it",
     "m"},
    {"noise", SettingKey::kNoise, Type::kPixel, "estimated",
     "standard deviation of a dot's coordinates; estimated: from the residuals", "0.5px"},
};

constexpr PointKeyRow kPointKeys[] = {
    {"xy", PointKey::kXy, 1, 3,
     "xy=x,y or xy=x,y,z, or one point: of the world, or of the element's own frame"},
    {"ax", PointKey::kAx, 1, 3, "ax=x,y or ax=x,y,z: of the active plane's system"},
    {"dl", PointKey::kDl, 1, 3,
     "dl=dx or dl=dx,dy or dl=dx,dy,dz: from the last data point, along the active system"},
    {"di", PointKey::kDi, 2, 2, "di=length,angle: from the last data point, in the active plane"},
    {"dx", PointKey::kDx, 1, 3, "dx=dx,dy,dz: from the last data point, along the view's axes"},
    {"dot", PointKey::kDot, 1, 2, "dot=u,v, or a list of both: of the active photograph"},
    {"on", PointKey::kOn, 1, 2,
     "on=INTERFACE: the place of another element's interface; on=INTERFACE,NAME: one of its own "
     "interfaces is put there"},
};

}  // namespace

std::span<const SettingRow> AllSettings() { return kSettings; }
std::span<const PointKeyRow> AllPointKeys() { return kPointKeys; }

const SettingRow* FindSetting(std::string_view key) {
  for (const SettingRow& row : kSettings) {
    if (row.key == key) return &row;
  }
  return nullptr;
}

const PointKeyRow* FindPointKey(std::string_view key) {
  for (const PointKeyRow& row : kPointKeys) {
    if (row.key == key) return &row;
  }
  return nullptr;
}

}  // namespace tranos::interp
