// SPDX-License-Identifier: GPL-3.0-or-later
// value.name and value.name(…)
#include <algorithm>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

namespace {

std::string Listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 40;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    text += (i > 0 ? ", " : "") + names[i];
  return names.size() > kMost ? text + ", …" : text;
}

Value NumberMember(const CallContext& context, const Value& value, std::string_view name) {
  if (name == "value") return ValueOf(value);
  if (name == "sigma") {
    return Value::Number(Sigma(value, *context.arithmetic.sources), value.dimension());
  }
  FailMember(Describe(value), name, {"value", "sigma"});
}

Value ListMember(const Value& value, std::string_view name) {
  static constexpr std::string_view kAxes[] = {"x", "y", "z"};
  const std::vector<Value>& items = value.list();
  if (!IsVector(value)) {
    if (!items.empty() && items[0].is_element()) {
      throw OpFailure{Code::kUnknownMember, "a list of elements has no `" + Printable(name) + "`",
                      "",
                      "take one of them, list[0], or map(list, e => e." + Printable(name) + ")"};
    }
    throw OpFailure{Code::kUnknownMember, Describe(value) + " has no `" + Printable(name) + "`", "",
                    "lists are indexed: list[0]; len(list) counts"};
  }
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (kAxes[i] == name) return items[i];
  }
  std::vector<std::string> members(std::begin(kAxes),
                                   std::begin(kAxes) + static_cast<long>(items.size()));
  FailMember(Describe(value), name, members);
}

Value RangeMember(const Value& value, std::string_view name) {
  if (name == "from") return Value::Number(value.range().from, value.dimension());
  if (name == "to") return Value::Number(value.range().to, value.dimension());
  FailMember("a range", name, {"from", "to"});
}

Value Direction(const geom::Vec3& unit) {
  return Value::List({Value::Number(unit.x()), Value::Number(unit.y()), Value::Number(unit.z())});
}

Value PlaneMember(const Value& value, std::string_view name) {
  const geom::Frame& plane = value.plane();
  if (name == "origin") return Value::OfPoint(plane.origin);
  if (name == "x") return Direction(plane.x);
  if (name == "y") return Direction(plane.y);
  if (name == "normal") return Direction(plane.z());
  FailMember("a plane", name, {"origin", "x", "y", "normal"});
}

Value RecordMember(const Value& value, std::string_view name) {
  const model::Record& record = value.record();
  if (const Value* member = record.Find(name)) return *member;
  std::vector<std::string> members;
  for (const auto& [key, member] : record.members) members.push_back(key);
  FailMember(WithArticle(record.type), name, members);
}

}  // namespace

void FailMember(std::string_view what, std::string_view name,
                const std::vector<std::string>& members) {
  const std::string message = std::string(what) + " has no `" + Printable(name) + "`";
  if (members.empty()) throw OpFailure{Code::kUnknownMember, message};
  std::string help = "it has " + Listed(members);
  if (const auto meant = DidYouMean(name, members)) help = "did you mean `" + *meant + "`? " + help;
  throw OpFailure{Code::kUnknownMember, message, "", help};
}

Value Member(const CallContext& context, const Value& value, std::string_view name) {
  switch (value.kind()) {
    case Value::Kind::kNumber:
    case Value::Kind::kUncertain:
      return NumberMember(context, value, name);
    case Value::Kind::kList:
      return ListMember(value, name);
    case Value::Kind::kRange:
      return RangeMember(value, name);
    case Value::Kind::kPlane:
      return PlaneMember(value, name);
    case Value::Kind::kRecord:
      return RecordMember(value, name);
    case Value::Kind::kElement:
      return ElementMember(context, value.element(), name);
    case Value::Kind::kNone:
    case Value::Kind::kBoolean:
    case Value::Kind::kString:
    case Value::Kind::kClosure:
      break;
  }
  FailMember(Describe(value), name, {});
}

Value CallMember(const CallContext& context, const Value& value, std::string_view name,
                 std::span<const Value> arguments) {
  if (value.is_element()) return ElementMethod(context, value.element(), name, arguments);
  const Value member = Member(context, value, name);
  if (member.kind() == Value::Kind::kClosure) return context.call(member, arguments);
  throw OpFailure{Code::kWrongType,
                  "`" + Printable(name) + "` is " + Describe(member) + ", and is not called", "",
                  "write it without ( )"};
}

model::ElementPtr CurrentElement(const model::State& state, const model::ElementPtr& element) {
  if (element->id >= state.model.entries.size()) return element;  // a part of a placed one
  model::ElementPtr current = state.model.Current(element->id);
  if (!current) {
    const std::string named = element->name ? " `" + *element->name + "`" : "";
    throw OpFailure{Code::kNoLongerThere,
                    "the " + model::TypeOf(*element) + named + " was deleted"};
  }
  return current;
}

}  // namespace tranos::interp
