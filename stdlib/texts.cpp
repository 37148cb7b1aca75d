// SPDX-License-Identifier: GPL-3.0-or-later
#include "stdlib/texts.h"

namespace tranos::stdlib {

namespace {

constexpr Text kFamilies[] = {
#include "stdlib/families.inc"
};
constexpr Text kFacts[] = {
#include "stdlib/facts.inc"
};

}  // namespace

std::span<const Text> Families() { return kFamilies; }
std::span<const Text> Facts() { return kFacts; }

}  // namespace tranos::stdlib
