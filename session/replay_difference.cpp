// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/replay_difference.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tranos::session {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostTold = 12;
constexpr std::size_t kLongestShown = 80;

std::string Short(std::string text) {
  if (text.size() > kLongestShown) text = text.substr(0, kLongestShown) + "...";
  return text;
}
std::string Shown(const Json& value) {
  return Short(value.is_string() ? value.get<std::string>()
                                 : value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

bool IsHashKey(std::string_view key) {
  return key == "hash" || key == "model" || key == "state" || key == "prototype" ||
         key == "library";
}

class Comparison {
 public:
  explicit Comparison(LineDifference* out) : out_(out) {}

  void Compare(const Json& recorded, const Json& found, const std::string& path) {
    if (recorded == found) return;
    if (recorded.is_number() && found.is_number()) {
      return Number(recorded.get<double>(), found.get<double>(), path,
                    recorded.is_number_float() || found.is_number_float());
    }
    if (recorded.type() != found.type()) return Tell(path, recorded, found);
    if (recorded.is_object()) return Objects(recorded, found, path);
    if (recorded.is_array()) return Arrays(recorded, found, path);
    if (recorded.is_string() && path == "key_in") {
      return KeyIn(recorded.get_ref<const std::string&>(), found.get_ref<const std::string&>());
    }
    Tell(path, recorded, found);
  }

 private:
  void Tell(const std::string& path, const Json& recorded, const Json& found) {
    if (out_->differing.size() < kMostTold) {
      out_->differing.push_back(path + ": recorded " + Shown(recorded) + ", now " + Shown(found));
    }
  }
  void Number(double recorded, double found, const std::string& path, bool may_be_close) {
    const double by = std::abs(recorded - found);
    if (may_be_close && by <= kReplayTolerance_m) return Close(by);
    if (out_->differing.size() >= kMostTold) return;
    out_->differing.push_back(path + ": recorded " + Json(recorded).dump() + ", now " +
                              Json(found).dump() + ", by " + Json(found - recorded).dump());
  }
  void Close(double by) {
    ++out_->close;
    out_->largest_close = std::max(out_->largest_close, by);
  }
  void Objects(const Json& recorded, const Json& found, const std::string& path) {
    const std::string prefix = path.empty() ? "" : path + ".";
    for (const auto& [key, value] : recorded.items()) {
      const auto other = found.find(key);
      if (other == found.end()) {
        Tell(prefix + key, value, "nothing");
      } else if (IsHashKey(key) && value.is_string() && other->is_string()) {
        if (value != *other) out_->hashes.push_back(prefix + key);
      } else {
        Compare(value, *other, prefix + key);
      }
    }
    for (const auto& [key, value] : found.items()) {
      if (!recorded.contains(key)) Tell(prefix + key, "nothing", value);
    }
  }
  void Arrays(const Json& recorded, const Json& found, const std::string& path) {
    if (recorded.size() != found.size()) {
      return Tell(path, std::to_string(recorded.size()) + " items",
                  std::to_string(found.size()) + " items");
    }
    for (std::size_t i = 0; i < recorded.size(); ++i) {
      Compare(recorded[i], found[i], path + "[" + std::to_string(i) + "]");
    }
  }
  // The texts are equal but for numbers, which are close.
  void KeyIn(const std::string& recorded, const std::string& found) {
    const char *a = recorded.data(), *const a_end = a + recorded.size();
    const char *b = found.data(), *const b_end = b + found.size();
    double largest = 0;
    while (a < a_end && b < b_end) {
      double x = 0, y = 0;
      const auto from_a = std::from_chars(a, a_end, x);
      const auto from_b = std::from_chars(b, b_end, y);
      if (from_a.ec == std::errc() && from_b.ec == std::errc()) {
        if (!(std::abs(x - y) <= kReplayTolerance_m)) break;
        largest = std::max(largest, std::abs(x - y));
        a = from_a.ptr, b = from_b.ptr;
      } else if (*a++ != *b++) {
        return Tell("key_in", recorded, found);
      }
    }
    if (a != a_end || b != b_end) return Tell("key_in", recorded, found);
    Close(largest);
  }

  LineDifference* out_;
};

}  // namespace

LineDifference CompareLines(std::string_view recorded, std::string_view found) {
  LineDifference out;
  const Json a = Json::parse(recorded.begin(), recorded.end(), nullptr, false);
  const Json b = Json::parse(found.begin(), found.end(), nullptr, false);
  if (!a.is_object() || !(a.contains("n") || a.contains("end"))) {
    out.malformed = true;
    return out;
  }
  if (a.contains("end") != b.contains("end")) {
    out.differing.push_back(a.contains("end") ? "the journal ends here, and the replay goes on"
                                              : "the replay ends here, and the journal goes on");
    return out;
  }
  Comparison(&out).Compare(a, b, "");
  return out;
}

}  // namespace tranos::session
