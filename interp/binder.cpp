// SPDX-License-Identifier: GPL-3.0-or-later
// Scopes, names, registers and diagnostics of the binder.
#include "interp/binder.h"

#include <algorithm>

#include "interp/functions.h"

namespace tranos::interp {

namespace {

const std::vector<Unit>& StandardMeasures() {
  using model::Dimension;
  const auto power = [](int n) {
    return Dimension{Dimension::kLength, static_cast<std::int8_t>(n)};
  };
  static const std::vector<Unit> kMeasures = [&] {
    std::vector<Unit> units;
    const std::pair<const char*, double> lengths[] = {{"m", 1},     {"cm", 0.01},   {"mm", 0.001},
                                                      {"km", 1000}, {"ft", 0.3048}, {"in", 0.0254}};
    for (const auto& [name, metres] : lengths) {
      units.push_back({name, power(1), metres});
      units.push_back({std::string(name) + "2", power(2), metres * metres});
      units.push_back({std::string(name) + "3", power(3), metres * metres * metres});
    }
    units.push_back({"deg", model::kAngle, geom::kPi / 180});
    units.push_back({"rad", model::kAngle, 1});
    units.push_back({"px", model::kPixel, 1});
    for (Unit& unit : units) unit = WithShares(unit);
    return units;
  }();
  return kMeasures;
}

const std::set<std::string, std::less<>>& ReservedNames() {
  static const std::set<std::string, std::less<>> kReserved = [] {
    std::set<std::string, std::less<>> names{
        "let",    "unit",  "function", "define", "parameter", "interface",  "unknown",
        "for",    "if",    "then",     "else",   "group",     "hypothesis", "use",
        "assert", "and",   "or",       "not",    "within",    "consistent", "in",
        "true",   "false", "last",     "reset",  "as"};
    for (const PointKeyRow& row : AllPointKeys()) names.emplace(row.key);
    for (const SettingRow& row : AllSettings()) names.emplace(row.key);
    return names;
  }();
  return kReserved;
}

}  // namespace

std::string LowerCase(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

Binder::Binder(std::shared_ptr<Sources> sources, const BindOptions& options, const Host& host)
    : program_(std::make_shared<Program>()), options_(options), host_(host) {
  program_->sources = std::move(sources);
  program_->measures = StandardMeasures();
  program_->units.emplace_back();
  program_->scopes.emplace_back();
}

Bound Binder::BindScript(const SyntaxTree& script) {
  tree_ = &script;
  Builder builder{0, nullptr, 0, 0};
  Scope scope;
  scope.opens_names = true;
  builder_ = &builder;
  scope_ = &scope;
  BindStatements(script.Children(script.root));
  const auto end = static_cast<std::uint32_t>(program_->sources->files[script.file].text.size());
  const Span last{script.file, end, end};
  Emit({Op::kEndCommand}, last);
  Emit({Op::kHalt}, last);
  for (const auto& [name, symbol] : scope.symbols) {
    if (symbol.kind == Symbol::kRegister && symbol.unit == 0)
      program_->lets.emplace_back(name, symbol.index);
  }
  std::sort(program_->lets.begin(), program_->lets.end());
  Bound bound{program_, std::move(diagnostics_), {}};
  for (const auto& [name, text] : options_.parameters) {
    if (!declared_parameters_.contains(name)) bound.undeclared.push_back(name);
  }
  if (!options_.hypothesis.empty() && program_->hypotheses_matched == 0) {
    bound.diagnostics.Add(UnknownHypothesis(script));
  }
  return bound;
}

Bound Binder::BindFamily(const LibraryFamily& family) {
  Builder builder{0, nullptr, 0, 0};
  builder_ = &builder;
  Family& bound = FamilyOf(family);
  while (!bound.unbound.empty()) BindElement(&bound, bound.unbound.begin()->first);
  Emit({Op::kHalt}, {});
  return {program_, std::move(diagnostics_), {}};
}

Diagnostic Binder::UnknownHypothesis(const SyntaxTree& script) const {
  const std::string asked = "`" + Printable(options_.hypothesis) + "`";
  if (hypotheses_.empty()) {
    return {Code::kUnknownHypothesis,
            {script.file, 0, 0},
            "the script has no hypothesis " + asked,
            "",
            "it has no `hypothesis` at all: run it without --hypothesis"};
  }
  std::vector<std::string> names;
  std::string list;
  for (const NodeId name : hypotheses_) {
    names.push_back(Text(name));
    list += (list.empty() ? "" : ", ") + names.back();
  }
  const auto meant = DidYouMean(options_.hypothesis, names);
  return {Code::kUnknownHypothesis, SpanOf(hypotheses_[0]), "the script has no hypothesis " + asked,
          "expected one of " + list, meant ? "did you mean `" + *meant + "`?" : ""};
}

const Symbol* Binder::Find(const std::string& name) const {
  for (const Scope* scope = scope_; scope; scope = scope->parent) {
    const auto found = scope->symbols.find(name);
    if (found != scope->symbols.end()) return &found->second;
  }
  return nullptr;
}

bool Binder::CheckName(std::string_view name, Span span) {
  if (!ReservedNames().contains(name)) return true;
  Error(Code::kReservedName, span, "`" + std::string(name) + "` is reserved", "not a name",
        "choose another name, such as `" + std::string(name) + "_1`");
  return false;
}

void Binder::Declare(const std::string& name, Symbol symbol, Span span) {
  if (!CheckName(name, span)) return;
  symbol.declared = span;
  const auto found = scope_->symbols.find(name);
  if (found != scope_->symbols.end()) {
    Error(Code::kBoundTwice, span, "`" + name + "` is bound already in this block",
          "bound again here", "choose another name; a block within may bind it anew",
          {{found->second.declared, "first bound here"}});
    return;
  }
  scope_->symbols.emplace(name, symbol);
}

Scope* Binder::NamesScope() {
  Scope* scope = scope_;
  while (!scope->opens_names) scope = scope->parent;
  return scope;
}

Scope* Binder::NamesOwner() const {
  Scope* owner = scope_;
  while (!owner->opens_names && !owner->is_turn) owner = owner->parent;
  return owner;
}

std::uint32_t Binder::NameIndex(std::uint32_t scope, const std::string& name) {
  auto& names = program_->scopes[scope].names;
  auto& index = name_indices_[scope];
  const auto [at, is_new] = index.emplace(name, static_cast<std::uint32_t>(names.size()));
  if (is_new) names.push_back(name);
  return at->second;
}

std::uint32_t Binder::NewRegister() {
  const std::uint32_t reg = builder_->next_register++;
  unit().registers = std::max(unit().registers, builder_->next_register);
  return reg;
}

std::uint32_t Binder::NewUnit(std::string name) {
  program_->units.emplace_back();
  program_->units.back().name = std::move(name);
  return static_cast<std::uint32_t>(program_->units.size() - 1);
}

std::uint32_t Binder::Emit(Instruction instruction, Span span) {
  unit().code.push_back(instruction);
  unit().spans.push_back(span);
  return Here() - 1;
}

// Fills in the target of a jump emitted before it was known.
void Binder::Patch(std::uint32_t at, std::uint32_t target) {
  Instruction& instruction = unit().code[at];
  const bool in_a = instruction.op == Op::kJump || instruction.op == Op::kJumpIfFalse ||
                    instruction.op == Op::kJumpIfGiven;
  (in_a ? instruction.a : instruction.c) = target;
}

Operand Binder::AddConstant(model::Value value) {
  unit().constants.push_back(std::move(value));
  return static_cast<Operand>(unit().constants.size() - 1) | kConstantBit;
}

std::optional<std::uint16_t> Binder::FindMeasure(std::string_view name) const {
  for (std::size_t i = program_->measures.size(); i-- > 0;) {
    if (program_->measures[i].name == name) return static_cast<std::uint16_t>(i);
  }
  return std::nullopt;
}

std::string Binder::Text(NodeId id) const {
  const std::string_view raw = program_->sources->Slice(tree_->SpanOf(id));
  return KindOf(id) == NodeKind::kName || KindOf(id) == NodeKind::kWord ? NormalWord(raw)
                                                                        : std::string(raw);
}

std::string Binder::Lower(NodeId id) const { return LowerCase(Text(id)); }

// The operator of a binary expression: what stands between its sides, brackets and comments aside.
Span Binder::OperatorSpan(NodeId binary) const {
  const Node& node = tree()[binary];
  const Node& left = tree()[node.first_child];
  const Node& right = tree()[left.next];
  const std::string& text = program_->sources->files[tree_->file].text;
  std::uint32_t begin = left.end, end = right.begin;
  while (begin < end && (text[begin] == ' ' || text[begin] == '\t')) ++begin;
  std::uint32_t stop = begin;
  while (stop < end && text[stop] != ' ' && text[stop] != '\t' && text[stop] != '\n' &&
         text[stop] != '\r' && text[stop] != '#') {
    ++stop;
  }
  if (stop == begin) return SpanOf(binary);
  return {tree_->file, begin, stop};
}

void Binder::Error(Code code, Span span, std::string message, std::string label, std::string help,
                   std::vector<Note> notes) {
  diagnostics_.Add(
      {code, span, std::move(message), std::move(label), std::move(help), std::move(notes)});
}

void Binder::Report(const OpFailure& failure, Span span) {
  Error(failure.code, span, failure.message, failure.label, failure.help);
}

std::vector<std::string> Binder::VisibleNames() const {
  std::vector<std::string> names;
  for (const Scope* scope = scope_; scope; scope = scope->parent) {
    for (const auto& [name, symbol] : scope->symbols) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

Bound Bind(std::shared_ptr<Sources> sources, const SyntaxTree& tree, const BindOptions& options,
           const Host& host) {
  return Binder(std::move(sources), options, host).BindScript(tree);
}

Bound BindFamily(const Library& library, const LibraryFamily& family) {
  auto sources = std::make_shared<Sources>();
  sources->files.push_back(MakeSource("", ""));
  BindOptions options;
  options.library = &library;
  return Binder(std::move(sources), options, {}).BindFamily(family);
}

}  // namespace tranos::interp
