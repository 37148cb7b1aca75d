// SPDX-License-Identifier: GPL-3.0-or-later
#include "stdlib/texts.h"

namespace tranos::stdlib {

namespace {

// Not constexpr: the lengths of texts as long as these are more than a compiler counts to.
const Text kFamilies[] = {
#include "stdlib/families.inc"
};
const Text kFacts[] = {
#include "stdlib/facts.inc"
};

}  // namespace

std::span<const Text> Families() { return kFamilies; }
std::span<const Text> Facts() { return kFacts; }

}  // namespace tranos::stdlib
