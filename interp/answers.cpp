// SPDX-License-Identifier: GPL-3.0-or-later
// How a command's function reads what was answered.
#include <fmt/format.h>

#include "interp/command.h"

namespace tranos::interp {

using model::Value;

namespace {

std::optional<geom::Vec3> PointOf(const Value& value) {
  if (!value.is_list()) return std::nullopt;
  const std::vector<Value>& items = value.list();
  if (items.size() < 2 || items.size() > 3) return std::nullopt;
  geom::Vec3 point = geom::Vec3::Zero();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!items[i].is_number()) return std::nullopt;
    point[static_cast<Eigen::Index>(i)] = items[i].number();
  }
  return point;
}

}  // namespace

const Value* Answers::Find(std::string_view key) const {
  for (const auto& [name, value] : keys) {
    if (name == key) return &value;
  }
  return nullptr;
}

double Answers::Number(std::string_view key, double otherwise) const {
  const Value* value = Find(key);
  return value && value->is_number() ? value->number() : otherwise;
}

bool Answers::Flag(std::string_view key, bool otherwise) const {
  const Value* value = Find(key);
  return value && value->is_boolean() ? value->boolean() : otherwise;
}

std::string Answers::Text(std::string_view key, std::string_view otherwise) const {
  const Value* value = Find(key);
  if (value && value->is_string()) return value->string();
  if (value && value->is_number()) return fmt::format("{}", value->number());  // a level's number
  return std::string(otherwise);
}

std::optional<geom::Vec3> Answers::Point(std::string_view key) const {
  const Value* value = Find(key);
  return value ? PointOf(*value) : std::nullopt;
}

std::vector<geom::Vec3> Answers::Points(std::string_view key) const {
  std::vector<geom::Vec3> out;
  const Value* value = Find(key);
  if (!value || !value->is_list()) return out;
  for (const Value& item : value->list()) {
    if (const auto point = PointOf(item)) out.push_back(*point);
  }
  return out;
}

bool Answers::HasWord(std::string_view word) const {
  for (const std::string& given : words) {
    if (interp::HasWord(word, given)) return true;
  }
  return false;
}

}  // namespace tranos::interp
