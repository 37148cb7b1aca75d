// SPDX-License-Identifier: GPL-3.0-or-later
// The slower instructions that compute a value and change nothing else.
#include <algorithm>

#include "interp/differences.h"
#include "interp/machine.h"
#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

Value Machine::LoadName(const Instruction& i, const Value* r, const Instruction& next, Span span) {
  const std::string& name = program_.scopes[i.b].names[i.c];
  const ScopePlace& place = places_[i.b];
  if (!place.stage) Fail(Code::kNotYetBound, span, "`" + Printable(name) + "` names nothing yet");
  const model::Names& names = place.stage->NamesOut(place.stage->groups() - place.depth);
  const auto& ids = names[i.c].ids;
  const std::size_t from = i.flags & 1 ? static_cast<std::size_t>(r[next.a].fast_value()) : 0;
  const model::Model& model = place.stage->state().model;
  std::vector<Value> items;
  for (std::size_t at = from; at < ids.size(); ++at) {
    model::ElementPtr element = model.Current(ids[at]);
    if (!element) {
      if (i.flags & 2) continue;
      Fail(Code::kNoLongerThere, span, "`" + Printable(name) + "` was deleted");
    }
    items.push_back(Value::OfElement(std::move(element)));
  }
  if (place.stage != stage_) {
    for (Value& item : items) item = Detached(item, span);
  }
  if (i.flags & 2) return Value::List(std::move(items));
  if (items.empty()) {
    Fail(Code::kNotYetBound, span, "`" + Printable(name) + "` names nothing yet", "",
         "it is named only when its `as` has run, and no longer when that was undone");
  }
  if (items.size() == 1) return items[0];
  return Value::List(std::move(items));
}

void Machine::CheckRange(const Instruction& i, const CodeUnit& unit, const Value* r, Span span) {
  const Value& value = r[i.a];
  const Value& range = Get(i.b, r, unit.constants.data());
  const std::string& name = Get(i.c, r, unit.constants.data()).string();
  Span at = span;
  if (placing_ && i.a < placing_->argument_spans.size()) at = placing_->argument_spans[i.a];
  const Unit& measure = program_.measures[i.n];
  bool inside = false;
  if (range.kind() == Value::Kind::kRange) {
    const Value items = value.is_list() ? value : Value::List({value});
    inside = true;
    for (const Value& item : items.list()) {
      inside = inside && item.is_number() &&
               Binary(Op::kWithin, item, range, {&measure, &sources_}).boolean();
    }
  } else if (range.is_list()) {
    for (const Value& allowed : range.list()) {
      Value aligned = allowed;
      Value own = value;
      if (allowed.is_number() && value.is_number()) Align(&own, &aligned, measure);
      inside = inside || model::Same(own, aligned);
    }
  } else {
    Value aligned = range;
    Value own = value;
    if (range.is_number() && value.is_number()) Align(&own, &aligned, measure);
    inside = model::Same(own, aligned);
  }
  if (inside) return;
  const auto shown = [&](const Value& item) {
    return item.is_string() ? "\"" + Printable(item.string()) + "\"" : Format(item, measure, -1);
  };
  std::string expected;
  if (range.is_list()) {
    for (const Value& item : range.list())
      expected += (expected.empty() ? "one of " : ", ") + shown(item);
  } else {
    expected = shown(range);
  }
  Fail(Code::kOutOfRange, at, "`" + name + "` is " + shown(value) + ", outside its range",
       "expected " + expected, "",
       at == span ? std::vector<Note>{} : std::vector<Note>{{span, "declared here"}});
}

// A value that crosses into or out of a definition's body: its elements are geometry there, for
// their ids mean other elements.
Value Machine::Detached(const Value& value, Span span, int depth) {
  if (value.is_element()) {
    return Value::OfElement(model::WithId(*value.element(), model::kNoElement));
  }
  if (!value.holds_elements()) return value;
  if (depth > budget_.limits.depth) {
    Fail(
        Code::kDepthLimit, span,
        "lists of elements are nested more than " + std::to_string(budget_.limits.depth) + " deep");
  }
  budget_.ChargeSteps(value.list().size(), span);
  std::vector<Value> items;
  for (const Value& item : value.list()) items.push_back(Detached(item, span, depth + 1));
  return Value::List(std::move(items));
}

void Machine::Compute(const Instruction& i, const CodeUnit& unit, Value* r, Span span) {
  if (!slice_) return ComputeValue(i, unit, r, span);
  auto read = Slice::ReadBy(i, r);
  const bool is_text = TakesUnknownText(i, unit, r);
  const std::size_t sources_before = solvables_.size();
  ComputeValue(i, unit, r, span);
  if (is_text) slice_->NoteText(r[i.a]);
  if (!read) return;
  const auto at = static_cast<std::uint32_t>(&i - unit.code.data());
  const bool is_source = solvables_.size() > sources_before;
  slice_->Note({&unit, at, *std::move(read), r[i.a], is_source ? sources_before : Slice::kNone});
}

// Whether it makes text of what depends on an unknown.
bool Machine::TakesUnknownText(const Instruction& i, const CodeUnit& unit, const Value* r) const {
  if (i.op == Op::kFormat) return DependsOnUnknown(Get(i.b, r, unit.constants.data()));
  return i.op == Op::kMakeString && std::any_of(r + i.b, r + i.b + i.c, [&](const Value& piece) {
           return DependsOnUnknown(piece);
         });
}

// Instructions that compute a value and change nothing else.
void Machine::ComputeValue(const Instruction& i, const CodeUnit& unit, Value* r, Span span) {
  const Value* const k = unit.constants.data();
  const auto b = [&]() -> const Value& { return Get(i.b, r, k); };
  const auto c = [&]() -> const Value& { return Get(i.c, r, k); };
  const Unit& measure = program_.measures[i.n];
  switch (i.op) {
    case Op::kNegate:
      budget_.ChargeSteps(DeviationSteps(b()), span);
      r[i.a] = Negate(b());
      break;
    case Op::kNot:
      if (!b().is_boolean())
        Fail(Code::kNotBoolean, span, "`not` takes true or false, not " + Describe(b()));
      r[i.a] = Value::Boolean(!b().boolean());
      break;
    case Op::kCheckBoolean:
      if (!b().is_boolean())
        Fail(Code::kNotBoolean, span, "this is " + Describe(b()), "expected true or false");
      if (i.a != i.b) r[i.a] = b();
      break;
    case Op::kPlusMinus:
      budget_.ChargeSteps(DeviationSteps(b()), span);
      r[i.a] = ForEachCoordinate(b(), [&](const Value& number) {
        return WithError(PlusMinus(number, c(), i.flags & 1, {&measure, &sources_}), span);
      });
      break;
    case Op::kMakeList: {
      budget_.ChargeSteps(i.c, span);
      r[i.a] = Value::List(std::vector<Value>(r + i.b, r + i.b + i.c));
      break;
    }
    case Op::kMakeString: {
      std::string text;
      for (std::uint32_t n = 0; n < i.c; ++n) {
        budget_.ChargeBytes(text.size() + r[i.b + n].string().size(), span);
        text += r[i.b + n].string();
      }
      r[i.a] = Value::String(std::move(text));
      break;
    }
    case Op::kFormat: {
      const int decimals = static_cast<int>(i.flags) - 1;
      r[i.a] = b().is_string() ? b() : Value::String(Format(b(), measure, decimals, &sources_));
      break;
    }
    case Op::kMember:
      r[i.a] = Member(ContextOf(i, span), b(), c().string());
      break;
    case Op::kIndex:
      if (unsolved_) {
        RefuseUnknown(c(), span, "an index");
        if (c().is_number())
          trail_.push_back(
              {span, static_cast<std::uint32_t>(static_cast<std::int64_t>(c().number()))});
      }
      r[i.a] = IndexInto(b(), c());
      break;
    case Op::kConvert:
      if (unsolved_ && static_cast<Type>(i.flags) == Type::kCount) {
        RefuseUnknown(b(), span, "a count");
      }
      r[i.a] = Convert(b(), static_cast<Type>(i.flags), measure, c().string());
      break;
    case Op::kConvertList: {
      const Value list = b().is_list() ? b() : Value::List({b()});
      std::vector<Value> items;
      for (const Value& item : list.list()) {
        items.push_back(Convert(item, static_cast<Type>(i.flags), measure, c().string()));
      }
      r[i.a] = Value::List(std::move(items));
      break;
    }
    case Op::kCallBuiltin: {
      const Builtin& row = AllBuiltins()[i.flags];
      budget_.ChargeSteps(1, span);
      for (std::uint32_t n = 0; n < i.c; ++n) budget_.ChargeSteps(DeviationSteps(r[i.b + n]), span);
      r[i.a] = CallBuiltin(row, ContextOf(i, span), {r + i.b, i.c});
      break;
    }
    case Op::kCallValue:
      r[i.a] = CallClosure(r[i.b - 1], {r + i.b, i.c}, span);
      break;
    case Op::kCallMember: {
      budget_.ChargeSteps(1, span);
      r[i.a] = CallMember(ContextOf(i, span), r[i.b - 2], r[i.b - 1].string(), {r + i.b, i.c});
      break;
    }
    case Op::kMakeClosure: {
      auto closure = std::make_shared<ClosureCode>();
      closure->unit = i.b;
      closure->stage = stage_->serial();
      closure->serial = ++closures_made_;
      const std::uint32_t captured = program_.units[i.b].captured;
      r[i.a] = Value::OfClosure({std::move(closure), {r + i.c, r + i.c + captured}});
      break;
    }
    case Op::kLoadOuter: {
      const Activation& activation = innermost_[i.b];
      if (!activation.registers || activation.registers[i.c].is_none()) {
        Fail(Code::kNotYetBound, span, "this name has no value yet", "",
             "bind it before the first use of the function");
      }
      r[i.a] = activation.stage == stage_ ? activation.registers[i.c]
                                          : Detached(activation.registers[i.c], span);
      break;
    }
    case Op::kLoadLast: {
      const model::State& state = stage_->state();
      std::vector<Value> items;
      for (model::ElementId id : state.drawing.last) {
        if (model::ElementPtr element = state.model.Current(id))
          items.push_back(Value::OfElement(std::move(element)));
      }
      if (items.empty())
        Fail(Code::kNotYetBound, span, "nothing was made yet that `last` could mean");
      r[i.a] = items.size() == 1 ? items[0] : Value::List(std::move(items));
      break;
    }
    case Op::kCountName: {
      const ScopePlace& place = places_[i.b];
      const model::Names& names = place.stage->NamesOut(place.stage->groups() - place.depth);
      r[i.a] = Value::Number(static_cast<double>(names[i.c].ids.size()));
      break;
    }
    case Op::kCheckUnnamed: {
      const ScopePlace& place = places_[i.b];
      const model::Names& names = place.stage->NamesOut(place.stage->groups() - place.depth);
      if (names[i.c].given) {
        Fail(Code::kBoundTwice, span,
             "`" + program_.scopes[i.b].names[i.c] + "` names something already",
             "named again in this loop", "choose another name");
      }
      break;
    }
    case Op::kCheckRange:
      CheckRange(i, unit, r, span);
      break;
    case Op::kUnknown: {
      r[i.a] = UnknownValue(program_.unknowns[i.c], b(), r, span);
      break;
    }
    default:
      budget_.ChargeSteps(DeviationSteps(b()) + DeviationSteps(c()), span);
      const bool from_unknown = unsolved_ && (DependsOnUnknown(b()) || DependsOnUnknown(c()));
      r[i.a] = Binary(i.op, b(), c(), {&measure, &sources_});
      if (from_unknown && r[i.a].is_boolean()) r[i.a] = Value::Boolean(r[i.a].boolean(), true);
      break;
  }
}

}  // namespace tranos::interp
