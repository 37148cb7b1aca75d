// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/slice.h"

#include <algorithm>
#include <unordered_map>

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

using Known = std::unordered_map<const Derivatives*, Value>;

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

// The value with its numbers as they are now.
Value Replaced(const Value& value, const Known& known) {
  if (const Derivatives* derivatives = value.derivatives()) {
    const auto found = known.find(derivatives);
    return found == known.end() ? value : found->second;
  }
  if (!HoldsNumber(value)) return value;
  std::vector<Value> items;
  for (const Value& item : value.list()) items.push_back(Replaced(item, known));
  return Value::List(std::move(items));
}

// Takes the numbers of a result for those of the result when it was first made.
void Bind(const Value& first, const Value& now, Known* known) {
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

void Slice::KeepFor(const std::vector<Value>& numbers) {
  std::unordered_set<const Derivatives*> wanted;
  const auto want = [&](const Value& number) { wanted.insert(number.derivatives()); };
  for (const Value& number : numbers) ForEachNumber(number, want);
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

std::vector<Value> Slice::Evaluated(const std::vector<Value>& numbers, const Again& again) const {
  Known known;
  std::vector<Value> registers;
  for (const Operation& operation : operations_) {
    registers.resize(std::max<std::size_t>(registers.size(), operation.unit->registers));
    for (const auto& [at, value] : operation.registers) registers[at] = Replaced(value, known);
    Bind(operation.result, again(operation, registers.data()), &known);
  }
  std::vector<Value> out;
  for (const Value& number : numbers) out.push_back(Replaced(number, known));
  return out;
}

}  // namespace tranos::interp
