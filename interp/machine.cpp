// SPDX-License-Identifier: GPL-3.0-or-later
// The instruction loop. Arithmetic on plain numbers is done in place; everything else is a call.
#include "interp/machine.h"

#include <cmath>
#include <new>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

namespace {

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
    : program_(program),
      options_(options),
      outer_host_(host),
      host_{host.read, [this](std::string_view line) { Print(line); }, host.render_photo},
      budget_(options.limits) {
  if (options.on_progress) budget_.on_progress = &options.on_progress;
  unsolved_ = program.calibrates;
  if (unsolved_) slice_.emplace();
  *photographs_ = options.photographs;
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
          [this](const Answers& answers, const model::State& state, Span span) {
            return Calibrate(answers, state, span);
          },
          &sources_,
          [this](model::ElementId photograph, const geom::Vec2& dot_px, double noise_px) {
            return SourceOfDot(photograph, dot_px, noise_px);
          },
          photographs_.get(),
          &solids_,
          unsolved_ ? &trail_ : nullptr,
          is_script ? &slice_ : nullptr,
          stages_made_++,
          &turns_,
          &turn_values_};
}

// One place of a photograph is one observation, however often something is drawn by it. Before
// `calibrate` a source is something that it may solve for, so that dots have none.
std::optional<model::SourceId> Machine::SourceOfDot(model::ElementId photograph,
                                                    const geom::Vec2& dot_px, double noise_px) {
  if (unsolved_) return std::nullopt;
  const auto [known, is_new] = dot_sources_.try_emplace(
      {photograph, dot_px.x(), dot_px.y()}, static_cast<model::SourceId>(sources_.size()));
  if (is_new) sources_.insert(sources_.end(), 2, {noise_px, ""});
  return known->second;
}

Outcome Machine::Run() {
  Stage stage(LinksFor(true), true);
  stage_ = &stage;
  places_[0] = {&stage, 0};
  Registers registers(program_.units[0].registers);
  try {
    Execute(0, registers.data(), 0, &stage);
    EvaluateSolids(stage.state().model);
  } catch (RunFailure& failure) {
    outcome_.diagnostics.Add(std::move(failure.diagnostic));
  } catch (const std::bad_alloc&) {
    outcome_.diagnostics.Add({Code::kMemoryLimit,
                              {},
                              "the run needs more memory than its limit",
                              "",
                              "--limit memory=N raises it"});
  }
  PrintHeld();
  outcome_.state = stage.state();
  outcome_.steps = options_.limits.steps - budget_.steps_left;
  for (const auto& [name, reg] : program_.lets) outcome_.lets.emplace_back(name, registers[reg]);
  return std::move(outcome_);
}

// Before anything is written: what fails is told of the statement that made it.
void Machine::EvaluateSolids(const model::Model& last) const {
  const auto force = [&](const model::ElementPtr& element) { solids_.Force(*element, {}); };
  for (const model::OutputRequest& output : outcome_.outputs) {
    if (const model::Model* shown = model::ModelOf(output)) shown->ForEach(force);
  }
  last.ForEach(force);
}

// What is said before `calibrate` is said once, with the solved values.
void Machine::Print(std::string_view line) {
  if (unsolved_) {
    held_.emplace_back(line);
  } else if (outer_host_.print) {
    outer_host_.print(line);
  }
}

void Machine::PrintHeld() {
  unsolved_ = false;
  slice_.reset();
  for (const std::string& line : std::exchange(held_, {})) Print(line);
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
          },
          [this, span](const model::Element& element) { solids_.Force(element, span); }};
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
          if (program_.calibrates && !(i.flags & kOnlyAValue)) Decide(condition, unit.spans[at]);
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
  if (code.stage == stage_->serial())
    return CallUnit(code.unit, arguments, closure.closure().captured, span);
  std::vector<Value> captured;
  for (const Value& value : closure.closure().captured) captured.push_back(Detached(value, span));
  return CallUnit(code.unit, arguments, captured, span);
}

void Machine::PointEffect(const Instruction& i, const CodeUnit& unit, const Value* r, Stage* stage,
                          Span span) {
  const auto kind = static_cast<PointKey>(i.flags & ~kPackedPoint);
  if (unsolved_ && (stage->picks() || kind == PointKey::kDot)) {
    const std::uint32_t count = i.flags & kPackedPoint ? 1 : i.c;
    for (std::uint32_t n = 0; n < count; ++n) {
      RefuseUnknown(i.flags & kPackedPoint ? Get(i.b, r, unit.constants.data()) : r[i.b + n], span,
                    stage->picks() ? "a pick" : "a dot");
    }
  }
  if (i.flags & kPackedPoint) {
    const Value& value = Get(i.b, r, unit.constants.data());
    if (kind != PointKey::kOn) return stage->Point(kind, value, span);
    const model::Interface interface = InterfaceOf(value);
    const Value* host = value.record().Find("of");
    const std::string& own = Get(i.a, r, unit.constants.data()).string();
    if (i.c == 2 && own.empty()) {
      Fail(Code::kUnknownMember, span, "the second name of `on=` is empty", "",
           "the name of one of the element's own interfaces, or none for its origin");
    }
    return stage->On(interface, own, host ? host->element()->id : model::kNoElement, span);
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
      if (Get(i.b, r, k).is_string()) {
        RefuseUnknown(Get(i.b, r, k), span, "`" + std::string(AllSettings()[i.flags].key) + "=`");
      }
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
