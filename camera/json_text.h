// SPDX-License-Identifier: GPL-3.0-or-later
// JSON of other programs, read with bounds.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "geom/primitives.h"

namespace tranos::camera {

inline constexpr std::size_t kMaxCameraText = 16 << 20;  // bytes of a text that tells of cameras

// The value in a text. Errors: kTooLarge (more than kMaxCameraText, nested deeper than 64),
// kUnreadable (no JSON).
geom::Result<nlohmann::json> JsonIn(std::string_view text);

// The member of an object, or a null that lives for ever: also of what is no object.
const nlohmann::json& MemberOf(const nlohmann::json& object, const char* key);
// A finite number; nothing for anything else.
std::optional<double> NumberIn(const nlohmann::json& value);
// So many finite numbers in a list; nothing for anything else.
std::optional<std::vector<double>> NumbersIn(const nlohmann::json& list, std::size_t count);
// Width and height as whole numbers from 1 to 10⁶; nothing for anything else.
std::optional<Eigen::Vector2i> SizeIn(const nlohmann::json& width, const nlohmann::json& height);

}  // namespace tranos::camera
