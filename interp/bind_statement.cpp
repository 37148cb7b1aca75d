// SPDX-License-Identifier: GPL-3.0-or-later
// Statements to instructions.
#include <algorithm>

#include "interp/binder.h"

namespace tranos::interp {

using model::Value;

// A block within: its scope, and what the registers were before it.
struct Binder::ScopeGuard {
  explicit ScopeGuard(Binder* b) : binder(b), outer(b->scope_), mark(b->builder_->next_register) {
    scope.parent = outer;
    scope.name_scope = outer->name_scope;
    scope.measure = outer->measure;
    binder->scope_ = &scope;
    was_top = std::exchange(binder->at_top_, false);
  }
  ~ScopeGuard() {
    binder->scope_ = outer;
    binder->builder_->next_register = mark;
    binder->at_top_ = was_top;
  }
  ScopeGuard(const ScopeGuard&) = delete;
  ScopeGuard& operator=(const ScopeGuard&) = delete;
  Binder* binder;
  Scope* outer;
  std::uint32_t mark;
  bool was_top;
  Scope scope;
};

void Binder::BindStatements(const std::vector<NodeId>& statements) {
  Predeclare(statements);
  for (std::size_t i = 0; i < statements.size();) {
    if (KindOf(statements[i]) == NodeKind::kHypothesis) {
      i = BindHypotheses(statements, i);
    } else {
      BindStatement(statements[i++]);
    }
  }
}

void Binder::BindStatement(NodeId id) {
  ++statement_;
  builder_->first_temporary = builder_->next_register;
  const std::uint32_t mark = builder_->next_register;
  const NodeKind kind = KindOf(id);
  if (in_used_file_ && at_top_ && kind != NodeKind::kLet && kind != NodeKind::kUnit &&
      kind != NodeKind::kFunction && kind != NodeKind::kDefine && kind != NodeKind::kUse) {
    Error(Code::kMisplaced, SpanOf(id),
          "a used file holds functions, definitions, units and lets alone",
          "this statement would be run", "move it into the script");
    return;
  }
  if (in_library_ && at_top_ && (kind == NodeKind::kLet || kind == NodeKind::kUnit)) {
    Error(Code::kMisplaced, SpanOf(id), "a family holds functions and definitions alone", "",
          "a function without parameters gives a constant: function golden() = (1 + sqrt(5))/2");
    return;
  }
  switch (kind) {
    case NodeKind::kLet:
      return BindLet(id);  // keeps its register
    case NodeKind::kParameter:
      return BindParameterStatement(id);
    case NodeKind::kUnknown:
      return BindUnknown(id);
    case NodeKind::kUse:
      return BindUse(id);
    case NodeKind::kUnit:
      BindUnit(id);
      break;
    case NodeKind::kFunction:
      BindFunction(id);
      break;
    case NodeKind::kDefine:
      BindDefine(id);
      break;
    case NodeKind::kInterface:
      BindInterface(id);
      break;
    case NodeKind::kForCount:
      BindForCount(id);
      break;
    case NodeKind::kForEach:
      BindForEach(id);
      break;
    case NodeKind::kIf:
      BindIf(id);
      break;
    case NodeKind::kGroup:
      BindGroup(id);
      break;
    case NodeKind::kAssert:
      BindAssert(id);
      break;
    case NodeKind::kBlock:
      BindPlainBlock(id);
      break;
    case NodeKind::kCommand:
      BindCommand(id);
      break;
    case NodeKind::kKeyIns:
      BindArguments(Kids(id), 0, nullptr, statement_);
      break;
    default:
      break;  // an error node, reported by the parser
  }
  builder_->next_register = mark;
}

// Whether anything in the block touches the drawing: only then is there something to restore at its
// end.
bool Binder::Draws(NodeId block) const {
  std::vector<NodeId> pending{block};
  while (!pending.empty()) {
    const NodeId id = pending.back();
    pending.pop_back();
    switch (KindOf(id)) {
      case NodeKind::kCommand:
      case NodeKind::kKeyIns:
      case NodeKind::kGroup:
        return true;
      case NodeKind::kScript:
      case NodeKind::kBlock:
      case NodeKind::kForCount:
      case NodeKind::kForEach:
      case NodeKind::kIf:
      case NodeKind::kHypothesis:
        for (NodeId kid = tree()[id].first_child; kid != kNoNode; kid = tree()[kid].next)
          pending.push_back(kid);
        break;
      default:
        break;
    }
  }
  return false;
}

// The statements of a block, settings restored at its end.
void Binder::BindBlockBody(NodeId block) {
  const bool draws = Draws(block);
  if (draws) Emit({Op::kBlockBegin, 1}, SpanOf(block));
  BindStatements(Kids(block));
  if (!draws) return;
  Span end = SpanOf(block);
  end.begin = end.end > 0 ? end.end - 1 : 0;
  Emit({Op::kBlockEnd, 1}, end);
}

void Binder::BindPlainBlock(NodeId block) {
  ScopeGuard guard(this);
  BindBlockBody(block);
}

void Binder::BindLet(NodeId id) {
  const auto kids = Kids(id);
  const std::string name = Text(kids[0]);
  const auto reserved = let_registers_.find(id);
  const std::uint32_t reg = reserved != let_registers_.end() ? reserved->second : NewRegister();
  const auto dimension = StaticDimension(kids[1]);
  ExpressionInto(reg, kids[1]);
  Declare(name, {.unit = builder_->id, .index = reg, .dimension = dimension}, SpanOf(kids[0]));
}

// Units must be known before the script runs, so that literals are constants.
void Binder::BindUnit(NodeId id) {
  const auto kids = Kids(id);
  const std::string name = Text(kids[0]);
  std::optional<Value> value = Constant(kids[1]);
  if (!value && KindOf(kids[1]) == NodeKind::kBinary) {
    const auto sides = Kids(kids[1]);
    const auto left = Constant(sides[0]), right = Constant(sides[1]);
    const auto op = static_cast<Operator>(tree()[kids[1]].detail);
    if (left && right && (op == Operator::kMultiply || op == Operator::kDivide)) {
      try {
        value = Binary(op == Operator::kMultiply ? Op::kMultiply : Op::kDivide, *left, *right,
                       {&measure(), &constant_sources_});
      } catch (const OpFailure& failure) {
        return Report(failure, OperatorSpan(kids[1]));
      }
    }
  }
  if (!value || !value->is_number() || !(value->number() > 0)) {
    return Error(Code::kNotConstant, SpanOf(kids[1]), "a unit is a positive constant",
                 "expected a literal such as 0.648m");
  }
  if (FindMeasure(name)) {
    return Error(Code::kBoundTwice, SpanOf(kids[0]), "`" + name + "` is a unit already");
  }
  if (program_->measures.size() >= 0xffff) {
    return Error(Code::kOutOfRange, SpanOf(kids[0]), "there are too many units", "at most 65535");
  }
  program_->measures.push_back(WithShares({name, value->dimension(), value->number()}));
}

namespace {

// The names given by `as` in a block for the scope around it: not those in groups or definitions
// within, but the groups' own.
void CollectNames(const SyntaxTree& tree, const Sources& sources, NodeId root,
                  std::map<std::string, Span>* names) {
  std::vector<NodeId> pending{root};
  while (!pending.empty()) {
    const NodeId id = pending.back();
    pending.pop_back();
    const NodeKind kind = tree[id].kind;
    if (kind == NodeKind::kDefine || kind == NodeKind::kFunction) continue;
    if (kind == NodeKind::kNaming || kind == NodeKind::kGroup) {
      const NodeId name = tree[id].first_child;
      if (name != kNoNode && tree[name].kind == NodeKind::kName) {
        names->emplace(NormalWord(sources.Slice(tree.SpanOf(name))), tree.SpanOf(name));
      }
      continue;
    }
    for (NodeId kid = tree[id].first_child; kid != kNoNode; kid = tree[kid].next)
      pending.push_back(kid);
  }
}

}  // namespace

// A name is given at one place: a loop's are new when the outermost loop begins.
void Binder::CheckUnnamed(const std::map<std::string, Span>& given) {
  for (const Scope* scope = scope_; scope && !scope->opens_names; scope = scope->parent) {
    if (scope->is_turn) return;
  }
  const std::uint32_t name_scope = NamesScope()->name_scope;
  for (const auto& [name, span] : given) {
    Emit({Op::kCheckUnnamed, 0, 0, 0, name_scope, NameIndex(name_scope, name)}, span);
  }
}

// One turn of a loop: settings at its `{` come back at its `}`, and names given in it mean this
// turn's.
void Binder::BindTurn(NodeId block, Scope* scope, const std::map<std::string, Span>& given) {
  scope->is_turn = true;
  const std::uint32_t name_scope = NamesScope()->name_scope;
  for (const auto& [name, span] : given) {
    const std::uint32_t reg = NewRegister();
    scope->turn_registers[name] = reg;
    Emit({Op::kCountName, 0, 0, reg, name_scope, NameIndex(name_scope, name)}, SpanOf(block));
  }
  BindBlockBody(block);
}

// After a loop its names are lists; within a loop around it, of that one's turn.
void Binder::LeaveLoop(const Scope& turn, const std::map<std::string, Span>& given) {
  for (const auto& [name, span] : given) {
    const auto found = turn.symbols.find(name);
    if (found == turn.symbols.end() || found->second.kind != Symbol::kElementName) continue;
    Symbol symbol = found->second;
    symbol.as_list = true;
    symbol.turn_register = -1;
    Scope* owner = NamesOwner();
    if (owner->is_turn) {
      const auto reg = owner->turn_registers.find(name);
      if (reg != owner->turn_registers.end()) symbol.turn_register = reg->second;
    }
    owner->symbols[name] = symbol;
  }
}

void Binder::BindForCount(NodeId id) {
  const auto kids = Kids(id);
  std::map<std::string, Span> given;
  CollectNames(tree(), *program_->sources, kids.back(), &given);
  CheckUnnamed(given);
  {
    ScopeGuard guard(this);
    const std::uint32_t state = NewRegister();  // from, to, step, in turn number
    for (int i = 0; i < 3; ++i) NewRegister();
    const std::uint32_t variable = NewRegister();
    ExpressionInto(state, kids[1]);
    ExpressionInto(state + 1, kids[2]);
    if (kids.size() == 5) {
      ExpressionInto(state + 2, tree()[kids[3]].first_child);
    } else {
      Emit({Op::kMove, 0, 0, state + 2, AddConstant(Value()), 0}, SpanOf(id));
    }
    Declare(Text(kids[0]),
            {.unit = builder_->id, .index = variable, .dimension = StaticDimension(kids[1])},
            SpanOf(kids[0]));
    Span head = SpanOf(kids[1]);
    head.end = SpanOf(kids[kids.size() - 2]).end;
    const std::uint32_t begin = Emit({Op::kForCount, 0, scope_->measure, state, variable, 0}, head);
    const std::uint32_t body = Here();
    BindTurn(kids.back(), scope_, given);
    Emit({Op::kForCountNext, 0, 0, state, variable, body}, head);
    Patch(begin, Here());
    Scope turn = std::move(guard.scope);
    scope_ = guard.outer;
    LeaveLoop(turn, given);
  }
}

void Binder::BindForEach(NodeId id) {
  const auto kids = Kids(id);
  std::map<std::string, Span> given;
  CollectNames(tree(), *program_->sources, kids.back(), &given);
  CheckUnnamed(given);
  {
    ScopeGuard guard(this);
    const bool indexed = kids.size() == 4;
    const std::uint32_t state = NewRegister();  // list, index
    NewRegister();
    const std::uint32_t index = NewRegister();
    const std::uint32_t item = NewRegister();
    ExpressionInto(state, kids[kids.size() - 2]);
    if (indexed)
      Declare(Text(kids[0]), {.unit = builder_->id, .index = index, .dimension = model::kPlain},
              SpanOf(kids[0]));
    const NodeId item_name = kids[indexed ? 1 : 0];
    Declare(Text(item_name), {.unit = builder_->id, .index = item}, SpanOf(item_name));
    const Span head = SpanOf(kids[kids.size() - 2]);
    const std::uint32_t begin = Emit({Op::kForEach, 0, 0, state, item, 0}, head);
    const std::uint32_t body = Here();
    BindTurn(kids.back(), scope_, given);
    Emit({Op::kForEachNext, 0, 0, state, item, body}, head);
    Patch(begin, Here());
    Scope turn = std::move(guard.scope);
    scope_ = guard.outer;
    LeaveLoop(turn, given);
  }
}

void Binder::BindIf(NodeId id) {
  // A chain of `else if` is walked, not nested: it may be long.
  std::vector<std::uint32_t> to_end;
  for (NodeId at = id; at != kNoNode;) {
    if (KindOf(at) == NodeKind::kBlock) {
      BindPlainBlock(at);
      break;
    }
    const auto kids = Kids(at);
    const Operand condition = Expression(kids[0]);
    const std::uint32_t skip = Emit({Op::kJumpIfFalse, 0, 0, 0, condition, 0}, SpanOf(kids[0]));
    BindPlainBlock(kids[1]);
    if (kids.size() > 2) to_end.push_back(Emit({Op::kJump}, SpanOf(at)));
    Patch(skip, Here());
    at = kids.size() > 2 ? kids[2] : kNoNode;
  }
  for (std::uint32_t jump : to_end) Patch(jump, Here());
}

void Binder::BindGroup(NodeId id) {
  const auto kids = Kids(id);
  const NodeId block = kids.back();
  program_->scopes.emplace_back();
  const auto inner = static_cast<std::uint32_t>(program_->scopes.size() - 1);
  Emit({Op::kGroupBegin, 0, 0, inner, 0, 0}, SpanOf(id));
  {
    ScopeGuard guard(this);
    guard.scope.name_scope = inner;
    guard.scope.opens_names = true;
    guard.scope.closed_to_commands = true;
    BindStatements(Kids(block));
  }
  Span end = SpanOf(block);
  end.begin = end.end > 0 ? end.end - 1 : 0;
  Emit({Op::kGroupEnd}, end);
  if (kids.size() == 2) BindNaming(id);
}

// Hypotheses that follow one another are alternatives: one is run, the others are only checked.
std::size_t Binder::BindHypotheses(const std::vector<NodeId>& statements, std::size_t first) {
  std::size_t end = first;
  std::size_t chosen = first;
  while (end < statements.size() && KindOf(statements[end]) == NodeKind::kHypothesis) {
    hypotheses_.push_back(Kids(statements[end])[0]);
    if (!options_.hypothesis.empty() && Text(Kids(statements[end])[0]) == options_.hypothesis) {
      chosen = end;
      ++program_->hypotheses_matched;
    }
    ++end;
  }
  for (std::size_t i = first; i < end; ++i) {
    const NodeId block = Kids(statements[i])[1];
    ++statement_;
    if (i == chosen) {
      Emit({Op::kBlockBegin, 0}, SpanOf(statements[i]));
      BindStatements(Kids(block));
      Emit({Op::kBlockEnd, 0}, SpanOf(statements[i]));
      continue;
    }
    // Jumped over: bound for its diagnostics alone.
    const std::uint32_t over = Emit({Op::kJump}, SpanOf(statements[i]));
    {
      ScopeGuard guard(this);
      at_top_ = guard.was_top;  // what may stand in the chosen one may stand here
      BindStatements(Kids(block));
    }
    Patch(over, Here());
  }
  return end;
}

void Binder::BindAssert(NodeId id) {
  const auto kids = Kids(id);
  NodeId condition = kids[0];
  while (KindOf(condition) == NodeKind::kParen) condition = tree()[condition].first_child;
  AssertInfo info;
  info.text = Text(kids[0]);
  info.span = SpanOf(kids[0]);
  if (kids.size() > 1) {
    const NodeId message = kids[1];
    for (NodeId piece : Kids(message)) {
      info.message +=
          KindOf(piece) == NodeKind::kStringText ? UnescapeStringText(Text(piece)) : Text(piece);
    }
  }
  const std::uint32_t result = NewRegister();
  const std::uint32_t sides = NewRegister();
  NewRegister();
  const std::uint32_t message = NewRegister();
  const auto op = static_cast<Operator>(tree()[condition].detail);
  info.compares = KindOf(condition) == NodeKind::kBinary && op >= Operator::kEqual &&
                  op <= Operator::kConsistent;
  if (info.compares) {
    const auto parts = Kids(condition);
    ExpressionInto(sides, parts[0]);
    ExpressionInto(sides + 1, parts[1]);
    const Op ops[] = {Op::kEqual,   Op::kNotEqual,     Op::kLess,   Op::kLessEqual,
                      Op::kGreater, Op::kGreaterEqual, Op::kWithin, Op::kConsistent};
    Emit({ops[static_cast<int>(op) - static_cast<int>(Operator::kEqual)], 0, scope_->measure,
          result, sides, sides + 1},
         OperatorSpan(condition));
  } else {
    ExpressionInto(result, kids[0]);
    Emit({Op::kCheckBoolean, 0, 0, result, result, 0}, SpanOf(kids[0]));
  }
  if (kids.size() > 1) {
    ExpressionInto(message, kids[1]);
  } else {
    Emit({Op::kMove, 0, 0, message, AddText(""), 0}, SpanOf(id));
  }
  program_->asserts.push_back(std::move(info));
  Emit({Op::kAssert, 0, scope_->measure, static_cast<std::uint32_t>(program_->asserts.size() - 1),
        result, sides},
       SpanOf(kids[0]));
}

void Binder::BindUnknown(NodeId id) {
  const auto kids = Kids(id);
  if (!at_top_ || in_used_file_ || in_definition_) {
    return Error(Code::kMisplaced, SpanOf(id), "`unknown` stands at the top of a script",
                 "inside a block here");
  }
  builder_->next_register = unit().registers;  // one that nothing has used: empty until it is bound
  Type type = Type::kNumber;
  bool typed = false;
  std::size_t at = 1;
  if (KindOf(kids[at]) == NodeKind::kType) {
    const NodeId name = tree()[kids[at]].first_child;
    const auto named = TypeNamed(Lower(name));
    if (!named)
      return Error(Code::kUnknownType, SpanOf(name), "there is no type `" + Text(name) + "`");
    type = *named;
    typed = true;
    ++at;
  }
  const NodeId start = kids[at];
  const std::uint32_t reg = NewRegister();
  program_->unknowns.push_back({Text(kids[0]), SpanOf(kids[0])});
  const auto number = static_cast<std::uint32_t>(program_->unknowns.size() - 1);
  if (KindOf(start) == NodeKind::kName && Text(start) == "free" && !Find("free")) {
    program_->unknowns[number].is_free = true;
    Emit({Op::kMove, 0, 0, reg, AddConstant(Value::Number(1)), 0}, SpanOf(start));
  } else {
    ExpressionInto(reg, start);
  }
  if (typed) {
    Emit({Op::kConvert, static_cast<std::uint8_t>(type), scope_->measure, reg, reg,
          AddText(Text(kids[0]))},
         SpanOf(start));
  }
  if (at + 1 < kids.size()) {
    const std::uint32_t range = NewRegister();
    ExpressionInto(range, tree()[kids[at + 1]].first_child);
    Emit({Op::kCheckRange, 0, scope_->measure, reg, range, AddText(Text(kids[0]))}, SpanOf(start));
    program_->unknowns[number].range = range;
  }
  Emit({Op::kUnknown, 0, 0, reg, reg, number}, SpanOf(kids[0]));
  Declare(Text(kids[0]), {.unit = builder_->id, .index = reg, .dimension = StaticDimension(start)},
          SpanOf(kids[0]));
}

namespace {

// The path without `.` and with `..` resolved where something stands before it.
std::string NormalPath(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= path.size();) {
    const std::size_t slash = std::min(path.find('/', at), path.size());
    const std::string part = path.substr(at, slash - at);
    at = slash + 1;
    if (part.empty() || part == ".") continue;
    if (part == ".." && !parts.empty() && parts.back() != "..") {
      parts.pop_back();
    } else {
      parts.push_back(part);
    }
  }
  std::string out = path.starts_with('/') ? "/" : "";
  for (std::size_t i = 0; i < parts.size(); ++i) out += (i ? "/" : "") + parts[i];
  return out;
}

}  // namespace

void Binder::BindUse(NodeId id) {
  if (!at_top_ || in_definition_) {
    return Error(Code::kMisplaced, SpanOf(id), "`use` stands at the top of a script",
                 "inside a block here");
  }
  const NodeId string = Kids(id)[0];
  const auto written = Constant(string);
  if (!written) {
    return Error(Code::kNotConstant, SpanOf(string), "a file to use is named by a plain string");
  }
  // Paths are relative to the file that names them.
  const std::string& from = program_->sources->files[tree_->file].path;
  std::string path = written->string();
  if (in_library_) return BindLibraryUse(string, path);
  const std::size_t slash = from.rfind('/');
  if (in_used_file_ && slash != std::string::npos && !path.starts_with('/'))
    path = from.substr(0, slash + 1) + path;
  BindUsedFile(id, NormalPath(path));
}

void Binder::BindUsedFile(NodeId id, const std::string& path) {
  const NodeId string = Kids(id)[0];
  auto found = used_.find(path);
  if (found != used_.end() && !found->second) {
    return Error(Code::kUseCircle, SpanOf(string),
                 "`" + Printable(path) + "` uses itself, directly or through others");
  }
  if (found == used_.end()) {
    auto bytes =
        host_.read ? host_.read(path)
                   : tl::make_unexpected(HostError{HostError::kMissing, "there are no files here"});
    if (!bytes) {
      const Code code =
          bytes.error().kind == HostError::kOutside ? Code::kOutsideSandbox : Code::kCannotRead;
      return Error(code, SpanOf(string), "`" + Printable(path) + "` cannot be read",
                   bytes.error().detail);
    }
    used_[path] = nullptr;
    program_->sources->files.push_back(MakeSource(path, std::move(*bytes)));
    const auto file = static_cast<std::uint32_t>(program_->sources->files.size() - 1);
    const std::size_t bad = FirstInvalidUtf8(program_->sources->files[file].text);
    if (bad != std::string::npos) {
      const auto at = static_cast<std::uint32_t>(bad);
      return Error(Code::kNotUtf8, {file, at, at + 1}, "`" + Printable(path) + "` is not UTF-8");
    }
    Diagnostics parsing;
    used_trees_.push_back(Parse(*program_->sources, file, {options_.depth}, &parsing));
    for (const Diagnostic& diagnostic : parsing.list()) diagnostics_.Add(diagnostic);
    auto scope = std::make_unique<Scope>();
    scope->opens_names = true;
    scope->closed_to_commands = true;
    if (!parsing.has_errors()) {
      const SyntaxTree* const outer_tree = std::exchange(tree_, &used_trees_.back());
      Scope* const outer_scope = std::exchange(scope_, scope.get());
      const bool was_used = std::exchange(in_used_file_, true);
      const auto predeclared = std::exchange(predeclared_, {});
      const auto let_registers = std::exchange(let_registers_, {});
      builder_->next_register = unit().registers;  // its lets are empty until they are bound
      BindStatements(tree_->Children(tree_->root));
      predeclared_ = predeclared;
      let_registers_ = let_registers;
      in_used_file_ = was_used;
      scope_ = outer_scope;
      tree_ = outer_tree;
    }
    found = used_.insert_or_assign(path, std::move(scope)).first;
  }
  Import(*found->second, path, SpanOf(string));
}

// Makes what a used file binds known here.
void Binder::Import(const Scope& used, const std::string& path, Span span) {
  for (const auto& [name, symbol] : used.symbols) {
    const auto known = scope_->symbols.find(name);
    if (known != scope_->symbols.end() && !(known->second.declared == symbol.declared)) {
      Error(Code::kBoundTwice, span, "`" + name + "` of `" + Printable(path) + "` is bound already",
            "", "rename one of the two",
            {{known->second.declared, "bound here"}, {symbol.declared, "and here"}});
      continue;
    }
    scope_->symbols.emplace(name, symbol);
  }
  for (const auto& [words, definition] : used.definitions) {
    const auto known = scope_->definitions.find(words);
    if (known != scope_->definitions.end() && known->second != definition) {
      Error(Code::kBoundTwice, span,
            "`" + words + "` of `" + Printable(path) + "` is defined already");
      continue;
    }
    scope_->definitions.emplace(words, definition);
  }
}

}  // namespace tranos::interp
