// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with traces before any camera is looked for.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/traces.h"

namespace tranos::camera {

// The first thing that is wrong, `part` the index of the trace, counted through the photographs in
// order (−1: of none alone): numbers or dots that are not finite, deviations, dimensions and ratios
// that are not positive, edges and dots of no length, a circle of less than five dots, rectangles
// crosswise or clockwise, two lines that are one (`other` the first of them) and lie beside each
// other by more than half, lines all parallel within noise and nothing else, two axes with one
// vanishing point.
std::optional<geom::Error> WrongWith(std::span<const Photograph>, const Numbers&);

// An error of one photograph as one of several: `part` and `other` counted through them, and the
// photograph named.
geom::Error ErrorAmong(std::span<const Photograph>, std::ptrdiff_t photograph, geom::Error);

// How a photograph is called in a sentence: by its name, or its number.
std::string NameOfPhotograph(std::span<const Photograph>, std::ptrdiff_t photograph);

// Of each trace, whether it is of a line that an earlier one is of, which `Calibrate` refuses.
std::vector<bool> RepeatsALine(const Photograph&, const Numbers&);

}  // namespace tranos::camera
