// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "model/element.h"

namespace tranos::model {

namespace {

constexpr std::array<std::string_view, 8> kEvidenceWords = {
    "", "measured", "photo", "excavation", "document", "symmetry", "analogy", "conjecture"};

}  // namespace

std::string_view WordOf(Evidence evidence) {
  return kEvidenceWords[static_cast<std::size_t>(evidence)];
}

std::optional<Evidence> EvidenceOf(std::string_view word) {
  for (std::size_t i = 1; i < kEvidenceWords.size(); ++i) {
    if (kEvidenceWords[i] == word) return static_cast<Evidence>(i);
  }
  return std::nullopt;
}

Attributes Inherit(const Attributes& part, const Attributes& placement) {
  Attributes result = part;
  if (!(part.own & Attributes::kColour)) result.colour = placement.colour;
  if (!(part.own & Attributes::kLinestyle)) result.linestyle = placement.linestyle;
  if (!(part.own & Attributes::kWeight)) result.weight = placement.weight;
  if (!(part.own & Attributes::kLevel)) result.level = placement.level;
  if (!(part.own & Attributes::kMaterial)) result.material = placement.material;
  if (!(part.own & Attributes::kEvidence)) {  // the source belongs to the evidence
    result.evidence = placement.evidence;
    result.source = placement.source;
  }
  result.own = part.own | placement.own;
  return result;
}

}  // namespace tranos::model
