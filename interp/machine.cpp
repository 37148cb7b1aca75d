// SPDX-License-Identifier: GPL-3.0-or-later
// The instruction loop. Arithmetic on plain numbers is done in place; everything else is a call.
#include "interp/machine.h"

#include <cmath>
#include <new>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

namespace {

inline const Value& Get(Operand operand, const Value* registers, const Value* constants) {
  return operand & kConstantBit ? constants[operand & ~kConstantBit] : registers[operand];
}

// Both are numbers without derivatives and of one dimension.
inline bool Alike(const Value& a, const Value& b) {
  return a.fast_number() && b.fast_number() && a.dimension() == b.dimension();
}

bool FastCompare(Op op, double a, double b) {
  switch (op) {
    case Op::kEqual:
      return a == b;
    case Op::kNotEqual:
      return a != b;
    case Op::kLess:
      return a < b;
    case Op::kLessEqual:
      return a <= b;
    case Op::kGreater:
      return a > b;
    default:
      return a >= b;
  }
}

}  // namespace

Machine::Machine(const Program& program, const RunOptions& options, const Host& host)
    : program_(program), options_(options), host_(host), budget_(options.limits) {
  if (options.on_progress) budget_.on_progress = &options.on_progress;
  innermost_.resize(program.units.size());
  places_.resize(program.scopes.size());
}

StageLinks Machine::LinksFor(bool is_script) {
  return {&program_,
          &budget_,
          &outcome_.diagnostics,
          is_script && options_.on_step ? &options_ : nullptr,
          &host_,
          is_script ? &outcome_.outputs : nullptr,
          is_script ? &outcome_.output_spans : nullptr,
          [this](const Placement& placement, const model::State& state) {
            return Place(placement, state);
          },
          &turns_,
          &turn_values_};
}

Outcome Machine::Run() {
  Stage stage(LinksFor(true), true);
  stage_ = &stage;
  places_[0] = {&stage, 0};
  Registers registers(program_.units[0].registers);
  try {
    Execute(0, registers.data(), 0, &stage);
  } catch (RunFailure& failure) {
    outcome_.diagnostics.Add(std::move(failure.diagnostic));
  } catch (const std::bad_alloc&) {
    outcome_.diagnostics.Add({Code::kMemoryLimit,
                              {},
                              "the run needs more memory than its limit",
                              "",
                              "--limit memory=N raises it"});
  }
  outcome_.state = stage.state();
  outcome_.steps = options_.limits.steps - budget_.steps_left;
  for (const auto& [name, reg] : program_.lets) outcome_.lets.emplace_back(name, registers[reg]);
  return std::move(outcome_);
}

void Machine::Throw(const OpFailure& failure, Span span, const CodeUnit* unit,
                    std::uint32_t at) const {
  if (unit && failure.operand >= 0) {
    const auto found = unit->argument_spans.find(at);
    if (found != unit->argument_spans.end() &&
        static_cast<std::size_t>(failure.operand) < found->second.size()) {
      span = found->second[static_cast<std::size_t>(failure.operand)];
    }
  }
  Fail(failure.code, span, failure.message, failure.label, failure.help);
}

CallContext Machine::ContextOf(const Instruction& i, Span span) {
  return {{&program_.measures[i.n], &sources_},
          &stage_->state(),
          [this, span](const Value& closure, std::span<const Value> arguments) {
            return CallClosure(closure, arguments, span);
          },
          [this, span](std::uint64_t items) {
            budget_.ChargeBytes(items * sizeof(Value), span);
            budget_.ChargeSteps(items, span);
          }};
}

Value Machine::Execute(std::uint32_t unit_id, Value* r, std::uint32_t from, Stage* stage) {
  const CodeUnit& unit = program_.units[unit_id];
  const Instruction* const code = unit.code.data();
  const Value* const k = unit.constants.data();
  const Activation outer = std::exchange(innermost_[unit_id], Activation{r, stage});
  struct Restore {
    Activation* slot;
    Activation value;
    ~Restore() { *slot = value; }
  } restore{&innermost_[unit_id], outer};
  std::uint32_t at = from;
  try {
    for (;;) {
      const Instruction& i = code[at];
      switch (i.op) {
        case Op::kMove:
          r[i.a] = Get(i.b, r, k);
          break;
        case Op::kAdd: {
          const Value &x = Get(i.b, r, k), &y = Get(i.c, r, k);
          const double sum = x.fast_value() + y.fast_value();
          if (Alike(x, y) && std::isfinite(sum))
            r[i.a] = Value::Number(sum, x.dimension());
          else
            Compute(i, unit, r, unit.spans[at]);
          break;
        }
        case Op::kSubtract: {
          const Value &x = Get(i.b, r, k), &y = Get(i.c, r, k);
          const double difference = x.fast_value() - y.fast_value();
          if (Alike(x, y) && std::isfinite(difference))
            r[i.a] = Value::Number(difference, x.dimension());
          else
            Compute(i, unit, r, unit.spans[at]);
          break;
        }
        case Op::kMultiply: {
          const Value &x = Get(i.b, r, k), &y = Get(i.c, r, k);
          const double product = x.fast_value() * y.fast_value();
          if (Alike(x, y) && x.dimension().plain() && std::isfinite(product))
            r[i.a] = Value::Number(product);
          else
            Compute(i, unit, r, unit.spans[at]);
          break;
        }
        case Op::kDivide: {
          const Value &x = Get(i.b, r, k), &y = Get(i.c, r, k);
          if (Alike(x, y) && y.fast_value() != 0) {
            const double quotient = x.fast_value() / y.fast_value();
            if (std::isfinite(quotient)) {
              r[i.a] = Value::Number(quotient);
              break;
            }
          }
          Compute(i, unit, r, unit.spans[at]);
          break;
        }
        case Op::kEqual:
        case Op::kNotEqual:
        case Op::kLess:
        case Op::kLessEqual:
        case Op::kGreater:
        case Op::kGreaterEqual: {
          const Value &x = Get(i.b, r, k), &y = Get(i.c, r, k);
          if (Alike(x, y))
            r[i.a] = Value::Boolean(FastCompare(i.op, x.fast_value(), y.fast_value()));
          else
            Compute(i, unit, r, unit.spans[at]);
          break;
        }
        case Op::kJump:
          at = i.a;
          continue;
        case Op::kJumpIfFalse: {
          const Value& condition = Get(i.b, r, k);
          if (!condition.is_boolean()) {
            Fail(Code::kNotBoolean, unit.spans[at], "the condition is " + Describe(condition),
                 "expected true or false");
          }
          if (!condition.boolean()) {
            at = i.a;
            continue;
          }
          break;
        }
        case Op::kJumpIfGiven:
          if (!r[i.b].is_none()) {
            at = i.a;
            continue;
          }
          break;
        case Op::kForCount:
          if (!BeginCount(i, r, unit.spans[at])) {
            at = i.c;
            continue;
          }
          break;
        case Op::kForCountNext:
          if (NextCount(i, r, unit.spans[at])) {
            at = i.c;
            continue;
          }
          break;
        case Op::kForEach:
          if (!BeginEach(i, r, unit.spans[at])) {
            at = i.c;
            continue;
          }
          break;
        case Op::kForEachNext:
          if (NextEach(i, r, unit.spans[at])) {
            at = i.c;
            continue;
          }
          break;
        case Op::kLoadName:
          r[i.a] = LoadName(i, r, code[at + 1], unit.spans[at]);
          if (i.flags & 1) ++at;
          break;
        case Op::kCallFunction: {
          const std::uint32_t count = program_.units[i.c].parameters;
          r[i.a] = CallUnit(i.c, {r + i.b, count}, {}, unit.spans[at]);
          break;
        }
        case Op::kReturn:
          return Get(i.b, r, k);
        case Op::kHalt:
          return {};
        default:
          if (i.op < Op::kStart || i.op == Op::kCheckRange || i.op == Op::kUnknown) {
            Compute(i, unit, r, unit.spans[at]);
          } else {
            Effect(i, unit, r, stage, unit.spans[at]);
          }
      }
      ++at;
    }
  } catch (const OpFailure& failure) {
    Throw(failure, unit.spans[at], &unit, at);
  } catch (const std::bad_alloc&) {
    Fail(Code::kMemoryLimit, unit.spans[at], "the run needs more memory than its limit", "",
         "--limit memory=N raises it");
  }
}

Value Machine::CallUnit(std::uint32_t unit_id, std::span<const Value> arguments,
                        std::span<const Value> captured, Span span) {
  const CodeUnit& unit = program_.units[unit_id];
  budget_.ChargeSteps(1, span);
  if (++call_depth_ > budget_.limits.depth) {
    call_depth_ = 0;
    Fail(Code::kDepthLimit, span,
         "calls are nested more than " + std::to_string(budget_.limits.depth) + " deep", "",
         "does the function call itself without end? --limit depth=N raises the limit");
  }
  Registers registers(unit.registers);
  std::copy(arguments.begin(), arguments.end(), registers.begin());
  std::copy(captured.begin(), captured.end(),
            registers.begin() + static_cast<std::ptrdiff_t>(arguments.size()));
  Value result = Execute(unit_id, registers.data(), 0, stage_);
  --call_depth_;
  return result;
}

Value Machine::CallClosure(const Value& closure, std::span<const Value> arguments, Span span) {
  if (closure.kind() != Value::Kind::kClosure) {
    throw OpFailure{Code::kWrongType, Describe(closure) + " is not a function",
                    "expected a function such as x => x * 2"};
  }
  const auto& code = *static_cast<const ClosureCode*>(closure.closure().code.get());
  const std::size_t parameters = program_.units[code.unit].parameters;
  if (arguments.size() != parameters) {
    throw OpFailure{Code::kWrongCount, "the function takes " + std::to_string(parameters) +
                                           " value, and is given " +
                                           std::to_string(arguments.size())};
  }
  if (code.stage == stage_) return CallUnit(code.unit, arguments, closure.closure().captured, span);
  std::vector<Value> captured;
  for (const Value& value : closure.closure().captured) captured.push_back(Detached(value, span));
  return CallUnit(code.unit, arguments, captured, span);
}

bool Machine::BeginCount(const Instruction& i, Value* r, Span span) {
  Value &from = r[i.a], &to = r[i.a + 1], &step = r[i.a + 2];
  if (!from.is_number() || !to.is_number() || !(step.is_none() || step.is_number())) {
    const Value& wrong = !from.is_number() ? from : !to.is_number() ? to : step;
    Fail(Code::kBadLoop, span, "a loop counts over numbers, not over " + Describe(wrong), "",
         "for x in LIST goes through a list");
  }
  const Unit& unit = program_.measures[i.n];
  if (step.is_none()) step = Value::Number(BareFactor(from.dimension(), unit), from.dimension());
  if (!Align(&from, &to, unit) || !Align(&from, &step, unit) || !Align(&from, &to, unit)) {
    Fail(Code::kBadLoop, span,
         "the loop goes from " + Describe(from) + " to " + Describe(to) + " by " + Describe(step));
  }
  if (step.number() == 0) Fail(Code::kBadLoop, span, "the step of the loop is zero");
  // How many turns: a bound that is met but for rounding is met.
  const double turns = std::floor((to.number() - from.number()) / step.number() + 1e-9);
  if (!std::isfinite(turns)) Fail(Code::kBadLoop, span, "the loop's bounds are not finite");
  from = Value::Number(from.number(), from.dimension());
  to = Value::Number(turns);
  step = Value::Number(step.number());
  r[i.a + 3] = Value::Number(0);
  if (turns < 0) return false;
  budget_.ChargeSteps(1, span);
  turns_.push_back(0);
  turn_values_.push_back(&r[i.b]);
  r[i.b] = from;
  return true;
}

bool Machine::NextCount(const Instruction& i, Value* r, Span span) {
  const double turn = r[i.a + 3].fast_value() + 1;
  if (turn > r[i.a + 1].fast_value()) {
    turns_.pop_back();
    turn_values_.pop_back();
    return false;
  }
  budget_.ChargeSteps(1, span);
  r[i.a + 3] = Value::Number(turn);
  turns_.back() = static_cast<std::uint32_t>(turn);
  r[i.b] = Value::Number(r[i.a].fast_value() + turn * r[i.a + 2].fast_value(), r[i.a].dimension());
  return true;
}

bool Machine::BeginEach(const Instruction& i, Value* r, Span span) {
  Value& list = r[i.a];
  if (list.kind() == Value::Kind::kRange && list.dimension().plain()) {
    // a..b counts up by one.
    const double first = list.range().from, count = std::floor(list.range().to - first + 1e-9) + 1;
    if (count > 0)
      budget_.ChargeBytes(static_cast<std::uint64_t>(std::min(count, 1e18)) * sizeof(Value), span);
    std::vector<Value> items;
    for (double n = 0; n < count; ++n) {
      budget_.ChargeSteps(1, span);
      items.push_back(Value::Number(first + n));
    }
    list = Value::List(std::move(items));
  }
  if (!list.is_list()) {
    Fail(Code::kBadLoop, span, "a loop goes through a list, not through " + Describe(list), "",
         "for i = 1 to 8 counts");
  }
  if (list.list().empty()) return false;
  turns_.push_back(0);
  turn_values_.push_back(&r[i.b]);
  r[i.a + 1] = Value::Number(-1);
  return NextEach(i, r, span);
}

bool Machine::NextEach(const Instruction& i, Value* r, Span span) {
  const double index = r[i.a + 1].fast_value() + 1;
  const auto& items = r[i.a].list();
  if (index >= static_cast<double>(items.size())) {
    turns_.pop_back();
    turn_values_.pop_back();
    return false;
  }
  budget_.ChargeSteps(1, span);
  turns_.back() = static_cast<std::uint32_t>(index);
  r[i.a + 1] = Value::Number(index);
  r[i.a + 2] = Value::Number(index);
  r[i.b] = items[static_cast<std::size_t>(index)];
  return true;
}

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

// Instructions that compute a value and change nothing else.
void Machine::Compute(const Instruction& i, const CodeUnit& unit, Value* r, Span span) {
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
      r[i.a] = PlusMinus(b(), c(), i.flags & 1, {&measure, &sources_});
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
      r[i.a] = IndexInto(b(), c());
      break;
    case Op::kConvert:
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
      r[i.a] = row.call(ContextOf(i, span), {r + i.b, i.c});
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
      closure->stage = stage_;
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
      const UnknownInfo& unknown = program_.unknowns[i.c];
      if (!b().is_number())
        Fail(Code::kWrongType, span, "an unknown is a number, not " + Describe(b()));
      outcome_.diagnostics.Add(
          {Code::kUnknownUnsolved, span,
           "`" + unknown.name + "` keeps its start, " + Format(b(), measure, -1), "",
           "`calibrate` would solve for it"});
      r[i.a] = b();
      break;
    }
    default:
      budget_.ChargeSteps(DeviationSteps(b()) + DeviationSteps(c()), span);
      r[i.a] = Binary(i.op, b(), c(), {&measure, &sources_});
      break;
  }
}

void Machine::PointEffect(const Instruction& i, const CodeUnit& unit, const Value* r, Stage* stage,
                          Span span) {
  const auto kind = static_cast<PointKey>(i.flags & ~kPackedPoint);
  if (i.flags & kPackedPoint) {
    const Value& value = Get(i.b, r, unit.constants.data());
    if (kind != PointKey::kOn) return stage->Point(kind, value, span);
    return stage->On(InterfaceOf(value), span);
  }
  const Unit& measure = program_.measures[i.n];
  if (i.c == 1) {
    // A whole offset as one value, or its first coordinate.
    const Value& value = r[i.b];
    const bool whole = value.is_list();
    return stage->Point(
        kind, Convert(value, whole ? Type::kPoint : Type::kLength, measure, "the offset"), span);
  }
  stage->Point(kind, Value::List(std::vector<Value>(r + i.b, r + i.b + i.c)), span);
}

void Machine::Effect(const Instruction& i, const CodeUnit& unit, Value* r, Stage* stage,
                     Span span) {
  const Value* const k = unit.constants.data();
  const auto text = [&](Operand operand) -> const std::string& {
    return Get(operand, r, k).string();
  };
  switch (i.op) {
    case Op::kStart: {
      budget_.ChargeSteps(1, span);
      const std::int32_t definition = program_.row_definition[i.a];
      stage->Start(
          program_.rows[i.a],
          definition < 0 ? nullptr : &program_.definitions[static_cast<std::size_t>(definition)],
          span);
      break;
    }
    case Op::kOption:
      stage->Option(text(i.a), span);
      break;
    case Op::kBareString:
      stage->BareString(text(i.b), span);
      break;
    case Op::kParameterKey:
      budget_.ChargeSteps(1, span);
      stage->Parameter(i.a, Get(i.b, r, k), span);
      break;
    case Op::kPoint:
      PointEffect(i, unit, r, stage, span);
      break;
    case Op::kSetting:
      stage->Set(AllSettings()[i.flags], Get(i.b, r, k), span);
      break;
    case Op::kReset:
      stage->Reset(span);
      break;
    case Op::kName:
      stage->Name(text(i.a), i.c, i.flags & 1,
                  i.flags & 1 ? static_cast<std::size_t>(r[i.b].fast_value()) : 0, span);
      break;
    case Op::kEndStatement:
      stage->EndStatement(span);
      break;
    case Op::kEndCommand:
      stage->EndCommand(span);
      break;
    case Op::kBlockBegin:
      stage->BlockBegin(i.flags & 1);
      break;
    case Op::kBlockEnd:
      stage->BlockEnd(span);
      break;
    case Op::kGroupBegin:
      stage->GroupBegin(i.a, span);
      outer_places_.emplace_back(i.a,
                                 std::exchange(places_[i.a], ScopePlace{stage, stage->groups()}));
      break;
    case Op::kGroupEnd:
      stage->GroupEnd(span);
      places_[outer_places_.back().first] = outer_places_.back().second;
      outer_places_.pop_back();
      break;
    case Op::kInterface:
      NoteInterface(i, unit, r, span);
      break;
    case Op::kAssert:
      NoteAssert(i, unit, r, span);
      break;
    default:
      break;  // computed elsewhere
  }
}

void Machine::NoteAssert(const Instruction& i, const CodeUnit& unit, const Value* r, Span span) {
  const AssertInfo& info = program_.asserts[i.a];
  const Unit& measure = program_.measures[i.n];
  const Value& condition = Get(i.b, r, unit.constants.data());
  AssertResult result;
  result.text = info.text;
  result.message = r[i.c + 2].is_string() ? r[i.c + 2].string() : info.message;
  result.passed = condition.boolean();
  result.span = span;
  if (info.compares) {
    result.value = Format(r[i.c], measure, -1, &sources_);
    result.expected = Format(r[i.c + 1], measure, -1, &sources_);
  } else {
    result.value = result.passed ? "true" : "false";
    result.expected = "true";
  }
  outcome_.asserts.push_back(std::move(result));
}

Outcome Run(const Program& program, const RunOptions& options, const Host& host) {
  return Machine(program, options, host).Run();
}

}  // namespace tranos::interp
