// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions to instructions.
#include <cmath>

#include "interp/binder.h"
#include "interp/functions.h"

namespace tranos::interp {

using model::Dimension;
using model::Value;

namespace {

Op OpOf(Operator op) {
  switch (op) {
    case Operator::kEqual:
      return Op::kEqual;
    case Operator::kNotEqual:
      return Op::kNotEqual;
    case Operator::kLess:
      return Op::kLess;
    case Operator::kLessEqual:
      return Op::kLessEqual;
    case Operator::kGreater:
      return Op::kGreater;
    case Operator::kGreaterEqual:
      return Op::kGreaterEqual;
    case Operator::kWithin:
      return Op::kWithin;
    case Operator::kConsistent:
      return Op::kConsistent;
    case Operator::kRange:
      return Op::kMakeRange;
    case Operator::kPlusMinus:
      return Op::kPlusMinus;
    case Operator::kAdd:
      return Op::kAdd;
    case Operator::kSubtract:
      return Op::kSubtract;
    case Operator::kMultiply:
      return Op::kMultiply;
    case Operator::kDivide:
      return Op::kDivide;
    case Operator::kModulo:
      return Op::kModulo;
    case Operator::kPower:
      return Op::kPower;
    case Operator::kNot:
      return Op::kNot;
    case Operator::kNegate:
      return Op::kNegate;
    case Operator::kOr:
    case Operator::kAnd:
      break;  // not one instruction: they do not evaluate their right side for nothing
  }
  return Op::kHalt;
}

// Measures that are lengths, areas and volumes wherever they occur.
std::optional<Dimension> DimensionOfMember(std::string_view name) {
  if (name == "length" || name == "radius" || name == "x" || name == "y" || name == "z")
    return model::kLength;
  if (name == "area") return model::kArea;
  if (name == "volume") return model::kVolume;
  return std::nullopt;
}

}  // namespace

Operand Binder::Expression(NodeId id) {
  if (auto constant = Constant(id)) return AddConstant(std::move(*constant));
  if (KindOf(id) == NodeKind::kParen) return Expression(tree()[id].first_child);
  if (KindOf(id) == NodeKind::kName) {
    const Symbol* symbol = Find(Text(id));
    if (symbol && symbol->kind == Symbol::kRegister && symbol->unit == builder_->id) {
      return symbol->index;
    }
  }
  const std::uint32_t target = NewRegister();
  ExpressionInto(target, id);
  return target;
}

void Binder::ExpressionInto(std::uint32_t target, NodeId id) {
  if (auto constant = Constant(id)) {
    Emit({Op::kMove, 0, 0, target, AddConstant(std::move(*constant)), 0}, SpanOf(id));
    return;
  }
  constexpr int kDeepest = 1000;  // the parser bounds nesting; this bounds chains such as a.b.c.d
  if (depth_ >= kDeepest) {
    Error(Code::kTooDeep, SpanOf(id), "the expression is nested too deeply", "",
          "bind parts of it with `let`");
    return;
  }
  ++depth_;
  const std::uint32_t mark = builder_->next_register;
  const Node& node = tree()[id];
  switch (node.kind) {
    case NodeKind::kConditional:
      ConditionalInto(target, id);
      break;
    case NodeKind::kLambda:
      LambdaInto(target, id);
      break;
    case NodeKind::kBinary:
      BinaryInto(target, id);
      break;
    case NodeKind::kUnary: {
      const Operand operand = Expression(node.first_child);
      const Op op = OpOf(static_cast<Operator>(node.detail));
      Emit({op, 0, 0, target, operand, 0}, SpanOf(id));
      break;
    }
    case NodeKind::kMember: {
      const auto kids = Kids(id);
      const Operand object = Expression(kids[0]);
      Emit({Op::kMember, 0, scope_->measure, target, object, AddText(Text(kids[1]))},
           SpanOf(kids[1]));
      break;
    }
    case NodeKind::kIndex: {
      const auto kids = Kids(id);
      const Operand list = Expression(kids[0]);
      const Operand index = Expression(kids[1]);
      Emit({Op::kIndex, 0, scope_->measure, target, list, index}, SpanOf(kids[1]));
      break;
    }
    case NodeKind::kCall:
      CallInto(target, id);
      break;
    case NodeKind::kString:
      StringInto(target, id);
      break;
    case NodeKind::kName:
      NameInto(target, id);
      break;
    case NodeKind::kLast:
      Emit({Op::kLoadLast, 0, 0, target, 0, 0}, SpanOf(id));
      break;
    case NodeKind::kParen:
      ExpressionInto(target, node.first_child);
      break;
    case NodeKind::kList:
      ListInto(target, Kids(id), id);
      break;
    default:
      break;  // an error node, reported by the parser
  }
  builder_->next_register = mark;
  --depth_;
}

std::optional<Value> Binder::NumberConstant(NodeId id, bool percent_is_share) {
  const std::string text = Text(id);
  const NumberLiteral literal = NumberOf(text);
  if (literal.unit.empty()) return Value::Number(literal.value);
  if (literal.unit == "%") {
    return Value::Number(percent_is_share ? literal.value / 100 : literal.value);
  }
  const auto index = FindMeasure(literal.unit);
  if (!index) {
    std::vector<std::string> names;
    for (const Unit& unit_of_measure : program_->measures) names.push_back(unit_of_measure.name);
    Span span = SpanOf(id);
    span.begin = span.end - static_cast<std::uint32_t>(literal.unit.size());
    const auto meant = DidYouMean(literal.unit, names);
    Error(Code::kUnknownUnit, span, "there is no unit `" + std::string(literal.unit) + "`", "",
          meant ? "did you mean `" + *meant + "`?"
                : "unit " + std::string(literal.unit) + " = 1m declares one");
    return Value::Number(literal.value);
  }
  const Unit& unit_of_measure = program_->measures[*index];
  return Value::Number(InSi(literal.value, unit_of_measure), unit_of_measure.dimension);
}

std::optional<Value> Binder::Constant(NodeId id) {
  const Node& node = tree()[id];
  switch (node.kind) {
    case NodeKind::kNumber:
      return NumberConstant(id);
    case NodeKind::kTrue:
      return Value::Boolean(true);
    case NodeKind::kFalse:
      return Value::Boolean(false);
    case NodeKind::kParen:
      return Constant(node.first_child);
    case NodeKind::kUnary: {
      if (static_cast<Operator>(node.detail) != Operator::kNegate) return std::nullopt;
      if (KindOf(node.first_child) != NodeKind::kNumber) return std::nullopt;
      return interp::Negate(*NumberConstant(node.first_child));
    }
    case NodeKind::kString: {
      const NodeId piece = node.first_child;
      if (piece == kNoNode) return Value::String("");
      if (KindOf(piece) != NodeKind::kStringText || tree()[piece].next != kNoNode)
        return std::nullopt;
      return Value::String(UnescapeStringText(Text(piece)));
    }
    default:
      return std::nullopt;
  }
}

// A long sum leans to the left and is as deep as it is long, so its spine is walked and not
// descended.
std::vector<NodeId> Binder::Spine(NodeId id, NodeId* leftmost) const {
  const auto is_logic = [&](NodeId at) {
    const auto op = static_cast<Operator>(tree()[at].detail);
    return op == Operator::kAnd || op == Operator::kOr;
  };
  std::vector<NodeId> spine;
  NodeId at = id;
  while (KindOf(at) == NodeKind::kBinary && is_logic(at) == is_logic(id) &&
         (!is_logic(id) || tree()[at].detail == tree()[id].detail)) {
    spine.push_back(at);
    at = tree()[at].first_child;
  }
  *leftmost = at;
  return {spine.rbegin(), spine.rend()};
}

void Binder::BinaryInto(std::uint32_t target, NodeId id) {
  const auto logic = static_cast<Operator>(tree()[id].detail);
  if (logic == Operator::kAnd || logic == Operator::kOr) return LogicInto(target, id);
  NodeId leftmost;
  const std::vector<NodeId> spine = Spine(id, &leftmost);
  Operand left = Expression(leftmost);
  for (NodeId at : spine) {
    const auto op = static_cast<Operator>(tree()[at].detail);
    const NodeId right_node = tree()[tree()[at].first_child].next;
    const bool is_share = op == Operator::kPlusMinus && KindOf(right_node) == NodeKind::kNumber &&
                          NumberOf(Text(right_node)).unit == "%";
    const Operand right = Expression(right_node);
    Emit({OpOf(op), static_cast<std::uint8_t>(is_share), scope_->measure, target, left, right},
         OperatorSpan(at));
    left = target;
  }
}

void Binder::LogicInto(std::uint32_t target, NodeId id) {
  const bool is_and = static_cast<Operator>(tree()[id].detail) == Operator::kAnd;
  NodeId leftmost;
  const std::vector<NodeId> spine = Spine(id, &leftmost);
  std::vector<std::uint32_t> to_end;
  const auto side = [&](NodeId node) {
    ExpressionInto(target, node);
    Emit({Op::kCheckBoolean, 0, 0, target, target, 0}, SpanOf(node));
  };
  side(leftmost);
  for (NodeId at : spine) {
    const std::uint32_t jump = Emit({Op::kJumpIfFalse, kOnlyAValue, 0, 0, target, 0}, SpanOf(at));
    if (is_and) {
      to_end.push_back(jump);
    } else {
      to_end.push_back(Emit({Op::kJump, 0, 0, 0, 0, 0}, SpanOf(at)));
      Patch(jump, Here());
    }
    side(tree()[tree()[at].first_child].next);
  }
  for (std::uint32_t jump : to_end) Patch(jump, Here());
}

void Binder::ConditionalInto(std::uint32_t target, NodeId id) {
  const auto kids = Kids(id);
  const Operand condition = Expression(kids[0]);
  const std::uint32_t to_else = Emit({Op::kJumpIfFalse, 0, 0, 0, condition, 0}, SpanOf(kids[0]));
  const auto first = StaticDimension(kids[1]), second = StaticDimension(kids[2]);
  // A bare number beside a length is read as one, here as in `+`.
  const auto read_bare = [&](std::optional<Dimension> own, std::optional<Dimension> other,
                             NodeId at) {
    if (!own || !other || !own->plain()) return;
    if (*other != model::kLength && *other != model::kAngle) return;
    const Type type = *other == model::kLength ? Type::kLength : Type::kAngle;
    Emit({Op::kConvert, static_cast<std::uint8_t>(type), scope_->measure, target, target,
          AddText("")},
         SpanOf(at));
  };
  ExpressionInto(target, kids[1]);
  if (first && second && first->plain() && !second->plain()) read_bare(first, second, kids[1]);
  const std::uint32_t to_end = Emit({Op::kJump, 0, 0, 0, 0, 0}, SpanOf(id));
  Patch(to_else, Here());
  ExpressionInto(target, kids[2]);
  if (first && second && second->plain() && !first->plain()) read_bare(second, first, kids[2]);
  Patch(to_end, Here());
}

// The dimension an expression will have, where its text tells; otherwise nothing.
std::optional<Dimension> Binder::StaticDimension(NodeId id, int depth) {
  if (depth > 32) return std::nullopt;
  const Node& node = tree()[id];
  const auto kids = Kids(id);
  switch (node.kind) {
    case NodeKind::kNumber: {
      const std::string text = Text(id);
      const NumberLiteral literal = NumberOf(text);
      if (literal.unit.empty() || literal.unit == "%") return model::kPlain;
      const auto index = FindMeasure(literal.unit);
      return index ? std::optional(program_->measures[*index].dimension) : std::nullopt;
    }
    case NodeKind::kParen:
      return StaticDimension(kids[0], depth + 1);
    case NodeKind::kUnary:
      return StaticDimension(kids[0], depth + 1);
    case NodeKind::kConditional:
      return StaticDimension(kids[1], depth + 1);
    case NodeKind::kMember:
      return DimensionOfMember(Text(kids[1]));
    case NodeKind::kName: {
      const Symbol* symbol = Find(Text(id));
      return symbol ? symbol->dimension : std::nullopt;
    }
    case NodeKind::kBinary: {
      const auto left = StaticDimension(kids[0], depth + 1),
                 right = StaticDimension(kids[1], depth + 1);
      if (!left || !right) return std::nullopt;
      switch (static_cast<Operator>(node.detail)) {
        case Operator::kAdd:
        case Operator::kSubtract:
        case Operator::kModulo:
          return left->plain() ? right : left;
        case Operator::kPlusMinus:
          return left;
        case Operator::kMultiply:
          if (left->plain()) return right;
          if (right->plain()) return left;
          if (left->base != right->base) return std::nullopt;
          return Dimension{left->base, static_cast<std::int8_t>(left->exponent + right->exponent)};
        case Operator::kDivide:
          if (right->plain()) return left;
          if (*left == *right) return model::kPlain;
          return std::nullopt;
        default:
          return std::nullopt;
      }
    }
    default:
      return std::nullopt;
  }
}

void Binder::CallInto(std::uint32_t target, NodeId id) {
  const auto kids = Kids(id);
  const NodeId callee = kids[0];
  const auto count = static_cast<std::uint32_t>(kids.size() - 1);
  const bool named = KindOf(callee) == NodeKind::kName;
  const std::string name = named ? Text(callee) : "";
  const Symbol* symbol = named ? Find(name) : nullptr;
  const int builtin = named && !symbol ? FindBuiltin(name) : -1;
  if (named && !symbol && builtin < 0) {
    std::vector<std::string> names = VisibleNames();
    for (const Builtin& row : AllBuiltins()) names.emplace_back(row.name());
    const auto meant = DidYouMean(name, names);
    Error(Code::kUnknownFunction, SpanOf(callee), "there is no function `" + Printable(name) + "`",
          "", meant ? "did you mean `" + *meant + "`?" : "tranos help functions");
    return;
  }
  const bool method = KindOf(callee) == NodeKind::kMember;
  // Arguments stand in registers that follow one another; a closure, or an object and its method's
  // name, before them.
  const bool is_function = symbol && symbol->kind == Symbol::kFunction;
  if (method) {
    const auto parts = Kids(callee);
    const std::uint32_t object = NewRegister();
    const std::uint32_t method_name = NewRegister();
    ExpressionInto(object, parts[0]);
    Emit({Op::kMove, 0, 0, method_name, AddText(Text(parts[1])), 0}, SpanOf(parts[1]));
  } else if (!is_function && builtin < 0) {
    const std::uint32_t closure = NewRegister();
    ExpressionInto(closure, callee);
  }
  const std::uint32_t first = builder_->next_register;
  for (std::uint32_t i = 0; i < count; ++i) NewRegister();
  for (std::uint32_t i = 0; i < count; ++i) ExpressionInto(first + i, kids[i + 1]);
  const auto emit = [&](Instruction instruction) {
    const std::uint32_t at = Emit(instruction, SpanOf(id));
    auto& parts = unit().argument_spans[at];
    for (std::uint32_t i = 0; i < count; ++i) parts.push_back(SpanOf(kids[i + 1]));
  };
  if (builtin >= 0) {
    const Builtin& row = AllBuiltins()[static_cast<std::size_t>(builtin)];
    const int given = static_cast<int>(count);
    if (given < row.least || (row.most >= 0 && given > row.most)) {
      Error(Code::kWrongCount, SpanOf(id),
            "`" + name + "` is given " + std::to_string(count) + " values", std::string(row.usage));
    }
    emit({Op::kCallBuiltin, static_cast<std::uint8_t>(builtin), scope_->measure, target, first,
          count});
  } else if (is_function) {
    if (static_cast<int>(count) != symbol->parameters) {
      Error(Code::kWrongCount, SpanOf(id),
            "`" + name + "` takes " + std::to_string(symbol->parameters) +
                " values, and is given " + std::to_string(count),
            "", "", {{symbol->declared, "declared here"}});
      return;
    }
    unit().calls.push_back(symbol->unit);
    emit({Op::kCallFunction, 0, 0, target, first, symbol->unit});
  } else if (method) {
    emit({Op::kCallMember, 0, scope_->measure, target, first, count});
  } else {
    emit({Op::kCallValue, 0, scope_->measure, target, first, count});
  }
}

// The names in a function value that stand for something outside of it.
std::vector<NodeId> Binder::FreeNames(NodeId lambda) const {
  std::vector<NodeId> names;
  std::deque<std::set<std::string>> hidden(1);
  std::vector<std::pair<NodeId, std::size_t>> pending{{lambda, 0}};
  while (!pending.empty()) {
    const auto [at, own] = pending.back();
    pending.pop_back();
    const auto kids = Kids(at);
    if (KindOf(at) == NodeKind::kLambda) {
      hidden.push_back(hidden[own]);
      hidden.back().insert(Text(kids[0]));
      pending.emplace_back(kids[1], hidden.size() - 1);
      continue;
    }
    if (KindOf(at) == NodeKind::kName && !hidden[own].contains(Text(at))) names.push_back(at);
    for (NodeId kid : kids) pending.emplace_back(kid, own);
  }
  return names;
}

void Binder::LambdaInto(std::uint32_t target, NodeId id) {
  const auto kids = Kids(id);
  // What it uses of the unit around it is copied into it when it is made.
  std::map<std::string, std::uint32_t> captured;
  for (NodeId at : FreeNames(id)) {
    const Symbol* symbol = Find(Text(at));
    if (!symbol || symbol->unit != builder_->id) continue;
    if (symbol->kind == Symbol::kRegister) captured[Text(at)] = symbol->index;
    // An element's name in a loop means this turn's: it is read when the function value is made.
    if (symbol->kind == Symbol::kElementName && !captured.contains(Text(at))) {
      const std::uint32_t reg = NewRegister();
      NameInto(reg, at);
      captured[Text(at)] = reg;
    }
  }
  const std::uint32_t first = builder_->next_register;
  for (const auto& [name, reg] : captured) {
    Emit({Op::kMove, 0, 0, NewRegister(), reg, 0}, SpanOf(id));
  }
  const std::uint32_t inner = NewUnit("a function value");
  program_->units[inner].parameters = 1;
  program_->units[inner].captured = static_cast<std::uint32_t>(captured.size());
  Builder builder{inner, builder_, 0};
  Scope scope;
  scope.parent = scope_;
  scope.name_scope = scope_->name_scope;
  scope.measure = scope_->measure;
  Builder* const outer_builder = std::exchange(builder_, &builder);
  Scope* const outer_scope = std::exchange(scope_, &scope);
  scope.symbols[Text(kids[0])] = {
      .unit = inner, .index = NewRegister(), .declared = SpanOf(kids[0])};
  CheckName(Text(kids[0]), SpanOf(kids[0]));
  for (const auto& [name, reg] : captured) {
    if (name == Text(kids[0])) {
      NewRegister();
      continue;
    }
    Symbol symbol = *Find(name);
    symbol.kind = Symbol::kRegister;
    symbol.unit = inner;
    symbol.index = NewRegister();
    scope.symbols[name] = symbol;
  }
  const Operand result = Expression(kids[1]);
  Emit({Op::kReturn, 0, 0, 0, result, 0}, SpanOf(kids[1]));
  builder_ = outer_builder;
  scope_ = outer_scope;
  unit().calls.push_back(inner);
  Emit({Op::kMakeClosure, 0, 0, target, inner, first}, SpanOf(id));
}

void Binder::StringInto(std::uint32_t target, NodeId id) {
  const auto kids = Kids(id);
  const std::uint32_t first = builder_->next_register;
  for (std::size_t i = 0; i < kids.size(); ++i) NewRegister();
  for (std::uint32_t i = 0; i < kids.size(); ++i) {
    const Node& piece = tree()[kids[i]];
    if (piece.kind == NodeKind::kStringText) {
      Emit({Op::kMove, 0, 0, first + i, AddText(UnescapeStringText(Text(kids[i]))), 0},
           SpanOf(kids[i]));
    } else if (piece.first_child != kNoNode) {
      const Operand value = Expression(piece.first_child);
      Emit({Op::kFormat, piece.detail, scope_->measure, first + i, value, 0}, SpanOf(kids[i]));
    }
  }
  Emit({Op::kMakeString, 0, 0, target, first, static_cast<std::uint32_t>(kids.size())}, SpanOf(id));
}

void Binder::NameInto(std::uint32_t target, NodeId id) {
  const std::string name = Text(id);
  const Symbol* symbol = Find(name);
  if (!symbol) {
    if (name == "pi") {
      Emit({Op::kMove, 0, 0, target, AddConstant(Value::Number(geom::kPi)), 0}, SpanOf(id));
      return;
    }
    if (HasWord(whole_words_, name)) {
      Emit({Op::kMove, 0, 0, target, AddConstant(Value::Number(1)), 0}, SpanOf(id));
      return;
    }
    const auto meant = DidYouMean(name, VisibleNames());
    Error(Code::kUnknownName, SpanOf(id), "there is no `" + Printable(name) + "` here", "",
          meant ? "did you mean `" + *meant + "`?"
                : "let " + Printable(name) + " = … binds a value, `as " + Printable(name) +
                      "` names an element");
    return;
  }
  switch (symbol->kind) {
    case Symbol::kRegister:
      if (symbol->unit == builder_->id) {
        Emit({Op::kMove, 0, 0, target, symbol->index, 0}, SpanOf(id));
      } else {
        unit().outer.emplace_back(symbol->unit, symbol->index);
        Emit({Op::kLoadOuter, 0, 0, target, symbol->unit, symbol->index}, SpanOf(id));
      }
      return;
    case Symbol::kElementName: {
      unit().outer_names.emplace_back(symbol->scope, symbol->index);
      std::uint8_t flags = symbol->as_list ? 2 : 0;
      if (symbol->turn_register < 0) {
        Emit({Op::kLoadName, flags, 0, target, symbol->scope, symbol->index}, SpanOf(id));
        return;
      }
      // Where this turn's elements begin; a function or definition within the loop reads it there.
      auto turn = static_cast<std::uint32_t>(symbol->turn_register);
      if (symbol->unit != builder_->id) {
        unit().outer.emplace_back(symbol->unit, turn);
        const std::uint32_t copy = NewRegister();
        Emit({Op::kLoadOuter, 0, 0, copy, symbol->unit, turn}, SpanOf(id));
        turn = copy;
      }
      flags |= 1;
      Emit({Op::kLoadName, flags, 0, target, symbol->scope, symbol->index}, SpanOf(id));
      Emit({Op::kHalt, 0, 0, turn, 0, 0}, SpanOf(id));
      return;
    }
    case Symbol::kFunction:
      Error(Code::kWrongType, SpanOf(id), "`" + name + "` is a function, and is not called here",
            "", "write `x => " + name + "(x)` to hand it on");
      return;
  }
}

void Binder::ListInto(std::uint32_t target, const std::vector<NodeId>& items, NodeId whole) {
  const std::uint32_t first = builder_->next_register;
  const auto count = static_cast<std::uint32_t>(items.size());
  for (std::uint32_t i = 0; i < count; ++i) NewRegister();
  for (std::uint32_t i = 0; i < count; ++i) ExpressionInto(first + i, items[i]);
  Emit({Op::kMakeList, 0, 0, target, first, count}, SpanOf(whole));
}

Operand Binder::ConvertedOperand(Operand operand, Type type, bool list, std::string_view name,
                                 Span span) {
  if (type == Type::kAny) return operand;
  if ((operand & kConstantBit) && !list) {
    try {
      return AddConstant(Convert(unit().constants[operand & ~kConstantBit], type, measure(), name));
    } catch (const OpFailure& failure) {
      Report(failure, span);
      return operand;
    }
  }
  const std::uint32_t target = (operand & kConstantBit) ? NewRegister() : operand;
  // A named value keeps its register; its converted copy has its own.
  const bool own = target >= builder_->first_temporary;
  const std::uint32_t into = own ? target : NewRegister();
  Emit({list ? Op::kConvertList : Op::kConvert, static_cast<std::uint8_t>(type), scope_->measure,
        into, operand, AddText(name)},
       span);
  return into;
}

Operand Binder::TypedWord(NodeId value, std::string_view words, std::string_view name) {
  if (KindOf(value) == NodeKind::kName) {
    const std::string word = Text(value);
    for (const std::string& known : SplitWords(words)) {
      if (LowerCase(word) == LowerCase(known)) return AddText(known);
    }
    if (!Find(word)) {
      const auto meant = DidYouMean(word, SplitWords(words));
      std::string list;
      for (const std::string& known : SplitWords(words)) list += (list.empty() ? "" : ", ") + known;
      Error(Code::kWrongType, SpanOf(value),
            "`" + std::string(name) + "` takes no word `" + Printable(word) + "`",
            "expected one of " + list, meant ? "did you mean `" + *meant + "`?" : "");
      return AddText(word);
    }
  }
  return ConvertedOperand(Expression(value), Type::kWord, false, name, SpanOf(value));
}

Operand Binder::Typed(const std::vector<NodeId>& values, Type type, bool list,
                      std::string_view words, std::string_view name, NodeId whole) {
  const bool gathers = list || type == Type::kPoint || type == Type::kScale ||
                       type == Type::kSize || type == Type::kElements || type == Type::kPoints;
  if (type == Type::kWord && values.size() == 1 && !list) return TypedWord(values[0], words, name);
  if (type == Type::kName && values.size() == 1 && KindOf(values[0]) == NodeKind::kName) {
    return AddText(Text(values[0]));
  }
  // A number that may also be said by a word; within an expression the word is the whole, 1.
  if (!words.empty() && values.size() == 1 && KindOf(values[0]) == NodeKind::kName &&
      HasWord(words, Text(values[0]))) {
    return AddText(LowerCase(Text(values[0])));
  }
  const auto whole_words = std::exchange(whole_words_, words);
  const auto bound = TypedValues(values, type, list, name, whole, gathers);
  whole_words_ = whole_words;
  return bound;
}

Operand Binder::TypedValues(const std::vector<NodeId>& values, Type type, bool list,
                            std::string_view name, NodeId whole, bool gathers) {
  if (!gathers && values.size() != 1) {
    Span span = SpanOf(values[1]);
    span.end = SpanOf(values.back()).end;
    Error(Code::kWrongCount, span, "`" + std::string(name) + "` takes one value",
          "more than one value");
    return AddConstant(Value());
  }
  Span span = SpanOf(values.front());
  span.end = SpanOf(values.back()).end;
  if (values.size() == 1) {
    return ConvertedOperand(Expression(values[0]), type, list, name, span);
  }
  const std::uint32_t target = NewRegister();
  ListInto(target, values, whole);
  return ConvertedOperand(target, type, list, name, span);
}

}  // namespace tranos::interp
