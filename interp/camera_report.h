// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of a camera, in words and as numbers of the language.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interp/arithmetic.h"
#include "model/element.h"

namespace tranos::interp {

// K, pose, deviations, residuals and warnings, a line each, in the terms of the paper's Tables 1–3.
std::vector<std::string> CameraReport(const model::Element& element,
                                      const model::Photograph& photograph);

// The value of an unknown with its deviation, in its unit: "2.4 m ± 0.012 m".
std::string UnknownText(const model::Photograph& photograph, const camera::Estimate& estimate,
                        std::size_t unknown);

// A member of a photograph or camera: width, height, file, and of one with a camera its parameters
// with their deviations. Nothing if there is no such member. Throws OpFailure (kNotDetermined) for
// what the data left open.
std::optional<model::Value> PhotographMember(const model::Photograph& photograph,
                                             std::string_view name);
std::vector<std::string> PhotographMembers();

}  // namespace tranos::interp
