// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/slice.h"

#include <algorithm>

#include "interp/stage.h"

namespace tranos::interp {

using model::Derivatives;
using model::Value;

namespace {

// Calls f for each number in the value that came from a source.
template <class F>
void ForEachNumber(const Value& value, F&& f) {
  if (value.derivatives()) return f(value);
  if (!value.is_list()) return;
  for (const Value& item : value.list()) ForEachNumber(item, f);
}

bool HoldsNumber(const Value& value) {
  if (value.derivatives()) return true;
  return value.is_list() && std::any_of(value.list().begin(), value.list().end(), HoldsNumber);
}

// The registers among an instruction's operands; nothing where it is no operation of the slice.
std::optional<std::vector<std::uint32_t>> RegistersOf(const Instruction& i) {
  std::vector<std::uint32_t> out;
  const auto add = [&](Operand operand) {
    if (!(operand & kConstantBit)) out.push_back(operand);
  };
  const auto add_row = [&] {
    for (std::uint32_t n = 0; n < i.c; ++n) out.push_back(i.b + n);
  };
  switch (i.op) {
    case Op::kMakeList:
    case Op::kMakeString:
    case Op::kFormat:
    case Op::kCallValue:
    case Op::kMakeClosure:
    case Op::kLoadOuter:
    case Op::kLoadLast:
    case Op::kCountName:
    case Op::kCheckUnnamed:
    case Op::kCheckRange:
      return std::nullopt;
    case Op::kUnknown:  // its value is the adjustment's
      break;
    case Op::kNegate:
    case Op::kMember:
    case Op::kConvert:
    case Op::kConvertList:
      add(i.b);
      break;
    case Op::kCallBuiltin:
      add_row();
      break;
    case Op::kCallMember:
      out = {i.b - 2, i.b - 1};
      add_row();
      break;
    default:
      add(i.b);
      add(i.c);
  }
  return out;
}

// Takes the numbers of a result for those of the result when it was first made.
void Bind(const Value& first, const Value& now, Slice::Known* known) {
  if (const Derivatives* derivatives = first.derivatives()) {
    known->insert_or_assign(derivatives, now);
    return;
  }
  if (!first.is_list() || !now.is_list()) return;
  const std::size_t count = std::min(first.list().size(), now.list().size());
  for (std::size_t i = 0; i < count; ++i) Bind(first.list()[i], now.list()[i], known);
}

}  // namespace

std::optional<Slice::Registers> Slice::ReadBy(const Instruction& instruction,
                                              const Value* registers) {
  const auto operands = RegistersOf(instruction);
  if (!operands) return std::nullopt;
  Registers read;
  for (const std::uint32_t at : *operands) {
    if (registers[at].kind() == Value::Kind::kClosure) return std::nullopt;
    read.emplace_back(at, registers[at]);
  }
  return read;
}

bool Slice::Knows(const Value& value) const {
  bool knows = true;
  ForEachNumber(value, [&](const Value& n) { knows = knows && made_.contains(n.derivatives()); });
  return knows;
}

void Slice::Note(Operation operation) {
  if (Knows(operation.result)) return;
  ForEachNumber(operation.result, [&](const Value& n) { made_.insert(n.derivatives()); });
  operations_.push_back(std::move(operation));
}

void Slice::NoteText(const Value& text) {
  if (texts_.insert(&text.string()).second) text_values_.push_back(text);
}

std::size_t Slice::NotePoint(PointKey kind, const Value& values, const model::Drawing& drawing,
                             const geom::Frame& view, std::size_t last) {
  if (last == kNone && !HoldsNumber(values)) return kNone;
  points_.push_back({kind, values, drawing, view, last});
  return points_.size() - 1;
}

void Slice::NoteFiring(Firing firing) {
  const bool by_point = std::any_of(firing.points.begin(), firing.points.end(),
                                    [](std::size_t point) { return point != kNone; });
  const bool by_key = std::any_of(firing.answers.keys.begin(), firing.answers.keys.end(),
                                  [](const auto& key) { return HoldsNumber(key.second); });
  if (by_point || by_key) firings_.push_back(std::move(firing));
}

void Slice::KeepFor(const std::vector<Value>& numbers,
                    const std::unordered_set<model::ElementId>& elements) {
  std::erase_if(firings_, [&](const Firing& firing) { return !elements.contains(firing.placed); });
  std::unordered_set<const Derivatives*> wanted;
  const auto want = [&](const Value& number) { wanted.insert(number.derivatives()); };
  for (const Value& number : numbers) ForEachNumber(number, want);
  for (const Firing& firing : firings_) {
    for (const auto& [key, value] : firing.answers.keys) ForEachNumber(value, want);
    for (std::size_t point : firing.points) {
      for (; point != kNone; point = points_[point].last)
        ForEachNumber(points_[point].values, want);
    }
  }
  std::vector<Operation> kept;
  for (auto operation = operations_.rbegin(); operation != operations_.rend(); ++operation) {
    bool leads = false;
    ForEachNumber(operation->result, [&](const Value& number) {
      leads = leads || wanted.contains(number.derivatives());
    });
    if (!leads) continue;
    for (const auto& [at, value] : operation->registers) ForEachNumber(value, want);
    kept.push_back(std::move(*operation));
  }
  std::reverse(kept.begin(), kept.end());
  operations_ = std::move(kept);
}

Slice::Known Slice::Evaluated(const Again& again) const {
  Known known;
  std::vector<Value> registers;
  for (const Operation& operation : operations_) {
    registers.resize(std::max<std::size_t>(registers.size(), operation.unit->registers));
    for (const auto& [at, value] : operation.registers) registers[at] = Now(value, known);
    Bind(operation.result, again(operation, registers.data()), &known);
  }
  return known;
}

Value Slice::Now(const Value& value, const Known& known) {
  if (const Derivatives* derivatives = value.derivatives()) {
    const auto found = known.find(derivatives);
    return found == known.end() ? value : found->second;
  }
  if (!HoldsNumber(value)) return value;
  std::vector<Value> items;
  for (const Value& item : value.list()) items.push_back(Now(item, known));
  return Value::List(std::move(items));
}

geom::Vec3 Slice::Now(const Point& point, const Known& known) const {
  const geom::Vec3 last =
      point.last == kNone ? point.drawing.last_point : Now(points_[point.last], known);
  return PlaceOf(point.kind, Now(point.values, known), point.drawing, point.view, last);
}

Answers Slice::Now(const Firing& firing, const Known& known) const {
  Answers answers = firing.answers;
  for (auto& [key, value] : answers.keys) value = Now(value, known);
  for (std::size_t i = 0; i < answers.points.size(); ++i) {
    if (firing.points[i] != kNone) answers.points[i] = Now(points_[firing.points[i]], known);
  }
  return answers;
}

}  // namespace tranos::interp
