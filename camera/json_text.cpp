// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/json_text.h"

#include <nlohmann/json.hpp>

namespace tranos::camera {

using nlohmann::json;

namespace {

constexpr int kDeepest = 64;
constexpr double kLargestSize_px = 1e6;

// How deep its brackets are nested, whatever else it is.
int DepthOf(std::string_view text) {
  int depth = 0, deepest = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (quoted) continue;
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest;
}

}  // namespace

geom::Result<json> JsonIn(std::string_view text) {
  if (text.size() > kMaxCameraText || DepthOf(text) > kDeepest) {
    return tl::unexpected(
        geom::Error{geom::ErrorCode::kTooLarge, "it is larger or nested deeper than any camera"});
  }
  json value = json::parse(text.begin(), text.end(), nullptr, false);
  if (!value.is_discarded()) return value;
  return tl::unexpected(geom::Error{geom::ErrorCode::kUnreadable, "it is no JSON, or cut off"});
}

const json& MemberOf(const json& object, const char* key) {
  static const json kNone;
  if (!object.is_object()) return kNone;
  const auto found = object.find(key);
  return found == object.end() ? kNone : *found;
}

std::optional<double> NumberIn(const json& value) {
  if (!value.is_number()) return std::nullopt;
  const auto number = value.get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::optional<std::vector<double>> NumbersIn(const json& list, std::size_t count) {
  if (!list.is_array() || list.size() != count) return std::nullopt;
  std::vector<double> numbers;
  for (const json& item : list) {
    const auto number = NumberIn(item);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<Eigen::Vector2i> SizeIn(const json& width, const json& height) {
  const auto w = NumberIn(width), h = NumberIn(height);
  const auto is_size = [](double n) {
    return n >= 1 && n <= kLargestSize_px && n == std::floor(n);
  };
  if (!w || !h || !is_size(*w) || !is_size(*h)) return std::nullopt;
  return Eigen::Vector2i(static_cast<int>(*w), static_cast<int>(*h));
}

}  // namespace tranos::camera
