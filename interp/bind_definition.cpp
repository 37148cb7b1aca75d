// SPDX-License-Identifier: GPL-3.0-or-later
// Functions, definitions, parameters and interfaces.
#include <algorithm>

#include "interp/binder.h"

namespace tranos::interp {

using model::Value;

namespace {

constexpr Prompt kWhere[] = {{"where"}};

std::optional<model::Dimension> DimensionOf(Type type) {
  switch (type) {
    case Type::kNumber:
    case Type::kCount:
      return model::kPlain;
    case Type::kLength:
      return model::kLength;
    case Type::kArea:
      return model::kArea;
    case Type::kVolume:
      return model::kVolume;
    case Type::kAngle:
      return model::kAngle;
    default:
      return std::nullopt;
  }
}

}  // namespace

// Functions and definitions are known in their whole block, so they are declared before its
// statements are bound.
void Binder::Predeclare(const std::vector<NodeId>& statements) {
  const bool has_code = std::any_of(statements.begin(), statements.end(), [&](NodeId id) {
    return KindOf(id) == NodeKind::kFunction || KindOf(id) == NodeKind::kDefine;
  });
  std::vector<NodeId> lets;
  for (NodeId id : statements) {
    if (KindOf(id) == NodeKind::kLet) lets.push_back(id);
    if (KindOf(id) != NodeKind::kHypothesis) continue;
    for (NodeId inner : Kids(Kids(id)[1])) {
      if (KindOf(inner) == NodeKind::kLet) lets.push_back(inner);
    }
  }
  for (NodeId id : has_code ? lets : std::vector<NodeId>{}) {
    // A function may be called before a let that it uses: the let's register is its own from the
    // block's beginning, and empty until it is bound.
    if (let_registers_.contains(id)) continue;
    const std::uint32_t reg = NewRegister();
    let_registers_[id] = reg;
    Emit({Op::kMove, 0, 0, reg, AddConstant(Value()), 0}, SpanOf(id));
  }
  for (NodeId id : statements) {
    if (KindOf(id) == NodeKind::kFunction) PredeclareFunction(id);
    if (KindOf(id) == NodeKind::kDefine) PredeclareDefinition(id);
  }
}

void Binder::PredeclareFunction(NodeId id) {
  const auto kids = Kids(id);
  const std::uint32_t inner = NewUnit(Text(kids[0]));
  predeclared_[id] = inner;
  const int parameters = static_cast<int>(Kids(kids[1]).size());
  program_->units[inner].parameters = static_cast<std::uint32_t>(parameters);
  Declare(Text(kids[0]), {.kind = Symbol::kFunction, .unit = inner, .parameters = parameters},
          SpanOf(kids[0]));
}

void Binder::BindFunction(NodeId id) {
  const auto kids = Kids(id);
  const auto found = predeclared_.find(id);
  if (found == predeclared_.end()) return;
  Builder builder{found->second, builder_, 0, 0};
  Scope scope;
  scope.parent = scope_;
  scope.name_scope = scope_->name_scope;
  Builder* const outer_builder = std::exchange(builder_, &builder);
  Scope* const outer_scope = std::exchange(scope_, &scope);
  for (NodeId parameter : Kids(kids[1])) {
    Declare(Text(parameter), {.unit = builder.id, .index = NewRegister()}, SpanOf(parameter));
  }
  builder.first_temporary = builder.next_register;
  const Operand result = Expression(kids[2]);
  Emit({Op::kReturn, 0, 0, 0, result, 0}, SpanOf(kids[2]));
  builder_ = outer_builder;
  scope_ = outer_scope;
}

std::optional<DefinedParameter> Binder::DeclareParameter(NodeId param) {
  const auto kids = Kids(param);
  DefinedParameter out;
  out.name = Text(kids[0]);
  out.span = SpanOf(kids[0]);
  const NodeId type_node = kids[1];
  const NodeId type_name = tree()[type_node].first_child;
  const auto type = TypeNamed(Lower(type_name));
  if (!type) {
    const auto meant = DidYouMean(Lower(type_name), TypeNames());
    Error(Code::kUnknownType, SpanOf(type_name), "there is no type `" + Text(type_name) + "`", "",
          meant ? "did you mean `" + *meant + "`?" : "tranos explain E0210");
    return std::nullopt;
  }
  out.type = *type;
  out.list = tree()[type_node].detail == 1;
  for (std::size_t i = 2; i < kids.size(); ++i) {
    const NodeKind kind = KindOf(kids[i]);
    const NodeId first = tree()[kids[i]].first_child;
    if (kind == NodeKind::kDefault && first != kNoNode) out.standard = Text(first);
    if (kind == NodeKind::kRange) {
      for (NodeId value : Kids(kids[i])) {
        if (!out.range.empty()) out.range += ", ";
        out.range += Text(value);
        if (out.type == Type::kWord) out.words += (out.words.empty() ? "" : "|") + Text(value);
      }
    }
    if (kind == NodeKind::kString) {
      if (const auto text = Constant(kids[i])) out.summary = text->string();
    }
  }
  if (out.type == Type::kWord && out.words.empty()) {
    Error(Code::kMissingValue, out.span,
          "the parameter `" + out.name + "` is a word, but its words are not listed", "",
          "list them: " + out.name + " : word = shell in outline, shell; or make it a `string`");
    return std::nullopt;
  }
  return out;
}

void Binder::PredeclareDefinition(NodeId id) {
  const auto kids = Kids(id);
  Definition definition;
  for (NodeId word : Kids(kids[0])) {
    definition.words += (definition.words.empty() ? "" : " ") + Lower(word);
  }
  definition.span = SpanOf(kids[0]);
  definition.whole = SpanOf(id);
  if (definition.words == "place") {
    Error(Code::kReservedName, definition.span,
          "a definition's words are `place` and what is placed", "", "define place dome");
    return;
  }
  if (definition.words.rfind("place ", 0) != 0) {
    Error(Code::kReservedName, definition.span, "a definition's words begin with `place`", "",
          "define place " + definition.words);
    return;
  }
  if (const Command* built_in = FindCommand(definition.words)) {
    Error(Code::kBuiltinWords, definition.span,
          "`" + std::string(built_in->words) + "` is a command already", "",
          "add a word: `" + definition.words + " …`");
    return;
  }
  if (scope_->definitions.contains(definition.words)) {
    Error(Code::kBoundTwice, definition.span,
          "`" + definition.words + "` is defined already in this block");
    return;
  }
  for (std::size_t i = 1; i < kids.size(); ++i) {
    if (KindOf(kids[i]) == NodeKind::kString) {
      if (const auto text = Constant(kids[i])) definition.summary = text->string();
    } else if (KindOf(kids[i]) == NodeKind::kParam) {
      auto parameter = DeclareParameter(kids[i]);
      if (!parameter) return;
      definition.parameters.push_back(std::move(*parameter));
    }
  }
  definition.unit = NewUnit(definition.words);
  program_->scopes.emplace_back();
  definition.scope = static_cast<std::uint32_t>(program_->scopes.size() - 1);
  program_->units[definition.unit].parameters =
      static_cast<std::uint32_t>(definition.parameters.size());
  const auto index = static_cast<std::uint32_t>(program_->definitions.size());
  const std::string words = definition.words;
  program_->definitions.push_back(std::move(definition));
  Definition& placed = program_->definitions.back();
  for (const DefinedParameter& parameter : placed.parameters) {
    placed.keys.push_back({.name = parameter.name,
                           .type = parameter.type,
                           .summary = parameter.summary,
                           .words = parameter.words,
                           .standard = parameter.standard,
                           .required = parameter.standard.empty(),
                           .list = parameter.list});
  }
  placed.row = {.words = placed.words,
                .family = "place",
                .summary = placed.summary,
                .manner = Manner::kPlaces,
                .prompts = kWhere,
                .keys = placed.keys};
  scope_->definitions.emplace(words, index);
  predeclared_[id] = index;
}

void Binder::EmitParameter(NodeId param, const DefinedParameter& declared, std::uint32_t reg) {
  const std::uint32_t given = Emit({Op::kJumpIfGiven, 0, 0, 0, reg, 0}, declared.span);
  for (NodeId kid : Kids(param)) {
    if (KindOf(kid) != NodeKind::kDefault) continue;
    const Operand value =
        Typed(Kids(kid), declared.type, declared.list, declared.words, declared.name, kid);
    if (value != reg) Emit({Op::kMove, 0, 0, reg, value, 0}, SpanOf(kid));
  }
  Patch(given, Here());
  EmitRangeCheck(param, declared, reg);
}

void Binder::EmitRangeCheck(NodeId param, const DefinedParameter& declared, std::uint32_t reg) {
  for (NodeId kid : Kids(param)) {
    if (KindOf(kid) != NodeKind::kRange) continue;
    const auto values = Kids(kid);
    Operand range;
    if (declared.type == Type::kWord) {
      std::vector<Value> words;
      for (const std::string& word : SplitWords(declared.words))
        words.push_back(Value::String(word));
      range = AddConstant(Value::List(std::move(words)));
    } else if (values.size() == 1) {
      range = Expression(values[0]);
    } else {
      range = NewRegister();
      ListInto(range, values, kid);
    }
    Emit({Op::kCheckRange, 0, scope_->measure, reg, range, AddText(declared.name)}, declared.span);
  }
}

void Binder::BindDefine(NodeId id) {
  const auto found = predeclared_.find(id);
  if (found == predeclared_.end()) return;
  Definition& definition = program_->definitions[found->second];
  const auto kids = Kids(id);
  Builder builder{definition.unit, builder_, 0, 0};
  Scope scope;
  scope.parent = scope_;
  scope.name_scope = definition.scope;
  scope.opens_names = true;
  scope.closed_to_commands = true;
  Builder* const outer_builder = std::exchange(builder_, &builder);
  Scope* const outer_scope = std::exchange(scope_, &scope);
  const bool was_top = std::exchange(at_top_, false);
  const bool was_in = std::exchange(in_definition_, true);
  Definition* const outer_definition = std::exchange(defining_, &definition);
  for (std::size_t i = 0; i < definition.parameters.size(); ++i) NewRegister();
  std::size_t number = 0;
  for (NodeId kid : kids) {
    if (KindOf(kid) != NodeKind::kParam) continue;
    const DefinedParameter& parameter = definition.parameters[number];
    const std::uint32_t mark = builder.next_register;
    builder.first_temporary = mark;
    EmitParameter(kid, parameter, static_cast<std::uint32_t>(number));
    builder.next_register = mark;
    Declare(parameter.name,
            {.unit = builder.id,
             .index = static_cast<std::uint32_t>(number),
             .dimension = parameter.list ? std::nullopt : DimensionOf(parameter.type)},
            parameter.span);
    ++number;
  }
  Emit({Op::kHalt}, definition.span);
  unit().body = Here();
  BindStatements(Kids(kids.back()));
  Span end = SpanOf(kids.back());
  end.begin = end.end > 0 ? end.end - 1 : 0;
  Emit({Op::kEndCommand}, end);
  Emit({Op::kHalt}, end);
  at_top_ = was_top;
  in_definition_ = was_in;
  defining_ = outer_definition;
  builder_ = outer_builder;
  scope_ = outer_scope;
}

// The value of -D is bound as a text of its own, so that its errors show where it was given.
void Binder::BindGivenValue(const DefinedParameter& declared, const std::string& given,
                            std::uint32_t reg) {
  program_->sources->files.push_back(MakeSource("-D", declared.name + "=" + given));
  const auto file = static_cast<std::uint32_t>(program_->sources->files.size() - 1);
  Diagnostics parsing;
  used_trees_.push_back(Parse(*program_->sources, file, {options_.depth}, &parsing));
  for (const Diagnostic& diagnostic : parsing.list()) diagnostics_.Add(diagnostic);
  const SyntaxTree* const script = std::exchange(tree_, &used_trees_.back());
  if (!parsing.has_errors()) {
    const auto statements = Kids(tree_->root);
    const auto keys = statements.size() == 1 ? Kids(statements[0]) : std::vector<NodeId>{};
    if (keys.size() == 1 && KindOf(keys[0]) == NodeKind::kKeyIn) {
      auto values = Kids(keys[0]);
      values.erase(values.begin());
      const Operand operand =
          Typed(values, declared.type, declared.list, declared.words, declared.name, keys[0]);
      Emit({Op::kMove, 0, 0, reg, operand, 0}, SpanOf(keys[0]));
    } else {
      Error(Code::kUnexpectedToken, SpanOf(tree_->root),
            "-D gives a parameter its value, and nothing else",
            "expected a value such as -D " + declared.name + "=14m");
    }
  }
  tree_ = script;
}

void Binder::BindParameterStatement(NodeId id) {
  const NodeId param = Kids(id)[0];
  if (!at_top_ || in_used_file_ || in_definition_) {
    return Error(Code::kMisplaced, SpanOf(id), "`parameter` stands at the top of a script",
                 "inside a block here", "a definition's parameters stand before its `{`");
  }
  const auto declared = DeclareParameter(param);
  if (!declared) return;
  builder_->next_register = unit().registers;  // one that nothing has used: empty until it is bound
  const std::uint32_t reg = NewRegister();
  builder_->first_temporary = builder_->next_register;
  declared_parameters_.insert(declared->name);
  const std::string* given = nullptr;
  for (const auto& [name, text] : options_.parameters) {
    if (name == declared->name) given = &text;
  }
  if (given) {
    BindGivenValue(*declared, *given, reg);
    EmitRangeCheck(param, *declared, reg);
  } else if (declared->standard.empty()) {
    Error(Code::kMissingValue, declared->span,
          "the parameter `" + declared->name + "` has no value", "",
          "give it a default, or run with -D " + declared->name + "=…");
  } else {
    Emit({Op::kMove, 0, 0, reg, AddConstant(Value()), 0}, declared->span);
    EmitParameter(param, *declared, reg);
  }
  Declare(declared->name,
          {.unit = builder_->id, .index = reg, .dimension = DimensionOf(declared->type)},
          declared->span);
  program_->parameters.push_back(*declared);
  builder_->next_register = reg + 1;
}

// Parameters, parts and interfaces are members side by side, so that no two share a name.
void Binder::DeclareInterface(NodeId name_node) {
  const std::string name = Text(name_node);
  const Span span = SpanOf(name_node);
  if (!CheckName(name, span)) return;
  Scope* const owner = NamesScope();
  const auto refuse = [&](std::string_view kind, Span declared) {
    Error(Code::kBoundTwice, span, "`" + name + "` is " + std::string(kind) + " already",
          "named again here", "parameters, parts and interfaces have names of their own",
          {{declared, "declared here"}});
  };
  const auto found = owner->symbols.find(name);
  if (found != owner->symbols.end()) {
    const Symbol& symbol = found->second;
    if (symbol.kind == Symbol::kElementName) return refuse("a part", symbol.declared);
    if (symbol.unit == builder_->id && symbol.index < unit().parameters)
      return refuse("a parameter", symbol.declared);
  }
  owner->interfaces.emplace(name, span);
}

void Binder::BindInterface(NodeId id) {
  const auto kids = Kids(id);
  if (!in_definition_) {
    return Error(Code::kMisplaced, SpanOf(id), "`interface` stands in a definition",
                 "outside of one here");
  }
  DeclareInterface(kids[0]);
  DefinedInterface declared{Text(kids[0]), {}};
  const auto count = static_cast<std::uint32_t>(kids.size() - 1);
  const std::uint32_t first = builder_->next_register;
  for (std::uint32_t i = 0; i < 2 * count; ++i) NewRegister();
  bool has_place = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    auto parts = Kids(kids[i + 1]);
    const std::string key = Text(parts[0]);
    const std::string lower = LowerCase(key);
    parts.erase(parts.begin());
    const bool is_direction = lower == "axis" || lower == "dir";
    has_place |= lower == "at";
    const bool is_frame = is_direction || lower == "at";
    if (!is_frame) {
      CheckName(key, SpanOf(Kids(kids[i + 1])[0]));
      declared.measures.push_back(key);
    }
    if (lower == "name" || lower == "plane") {
      Error(Code::kReservedName, SpanOf(Kids(kids[i + 1])[0]),
            "an interface has a `" + lower + "` of its own", "",
            "choose another name for the measure");
    }
    const Operand value =
        Typed(parts, is_frame ? Type::kPoint : Type::kAny, false, "", key, kids[i + 1]);
    Emit({Op::kMove, 0, 0, first + 2 * i, AddText(is_frame ? lower : key), 0}, SpanOf(kids[i + 1]));
    Emit({Op::kMove, 0, 0, first + 2 * i + 1, value, 0}, SpanOf(kids[i + 1]));
  }
  if (!has_place) {
    Error(Code::kMissingValue, SpanOf(id), "an interface needs its place", "",
          "interface NAME at=[x, y, z]");
  }
  Emit({Op::kInterface, 0, 0, AddText(declared.name), first, count}, SpanOf(kids[0]));
  // Branches may each have an interface of one name.
  std::vector<DefinedInterface>& known = defining_->interfaces;
  if (std::none_of(known.begin(), known.end(),
                   [&](const DefinedInterface& other) { return other.name == declared.name; })) {
    known.push_back(std::move(declared));
  }
}

}  // namespace tranos::interp
