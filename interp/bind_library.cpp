// SPDX-License-Identifier: GPL-3.0-or-later
// The standard library: a family is parsed when its first element is reached, and an element bound
// when it is.
#include "interp/binder.h"

namespace tranos::interp {

struct Binder::Elsewhere {
  Elsewhere(Binder* b, Family* family)
      : binder(b),
        // Families leave no code in the script's unit.
        top{0, nullptr, b->program_->units[0].registers, b->program_->units[0].registers},
        tree(std::exchange(b->tree_, family->tree)),
        scope(std::exchange(b->scope_, &family->scope)),
        builder(std::exchange(b->builder_, &top)),
        statement(b->statement_),
        predeclared(std::exchange(b->predeclared_, family->predeclared)),
        let_registers(std::exchange(b->let_registers_, {})),
        whole_words(std::exchange(b->whole_words_, {})),
        depth(std::exchange(b->depth_, 0)),
        in_used_file(std::exchange(b->in_used_file_, true)),
        in_library(std::exchange(b->in_library_, true)),
        in_definition(std::exchange(b->in_definition_, false)),
        at_top(std::exchange(b->at_top_, true)) {}
  ~Elsewhere() {
    binder->tree_ = tree;
    binder->scope_ = scope;
    binder->builder_ = builder;
    binder->statement_ = statement;
    binder->predeclared_ = std::move(predeclared);
    binder->let_registers_ = std::move(let_registers);
    binder->whole_words_ = whole_words;
    binder->depth_ = depth;
    binder->in_used_file_ = in_used_file;
    binder->in_library_ = in_library;
    binder->in_definition_ = in_definition;
    binder->at_top_ = at_top;
  }
  Elsewhere(const Elsewhere&) = delete;
  Elsewhere& operator=(const Elsewhere&) = delete;

  Binder* binder;
  Builder top;
  const SyntaxTree* tree;
  Scope* scope;
  Builder* builder;
  std::uint32_t statement;
  std::map<NodeId, std::uint32_t> predeclared;
  std::map<NodeId, std::uint32_t> let_registers;
  std::string_view whole_words;
  int depth;
  bool in_used_file, in_library, in_definition, at_top;
};

const Library& Binder::library() const {
  return options_.library ? *options_.library : StandardLibrary();
}

// The library's definition of these words, or null.
const Command* Binder::LibraryCommand(std::string_view words) {
  if (!words.starts_with("place ")) return nullptr;
  const LibraryFamily* family = library().Defining(words);
  if (!family) return nullptr;
  Family& bound = FamilyOf(*family);
  const auto found = bound.scope.definitions.find(words);
  if (found == bound.scope.definitions.end()) return nullptr;
  BindElement(&bound, found->second);
  return &program_->definitions[found->second].row;
}

Binder::Family& Binder::FamilyOf(const LibraryFamily& family) {
  const auto [found, is_new] = families_.try_emplace(&family);
  if (is_new) DeclareFamily(family, &found->second);
  return found->second;
}

void Binder::DeclareFamily(const LibraryFamily& family, Family* bound) {
  bound->scope.opens_names = true;
  bound->scope.closed_to_commands = true;
  const auto file = static_cast<std::uint32_t>(program_->sources->files.size());
  program_->sources->files.push_back(MakeSource(family.path(), std::string(family.text)));
  program_->sources->files.back().of_library = true;
  Diagnostics parsing;
  used_trees_.push_back(Parse(*program_->sources, file, {options_.depth}, &parsing));
  diagnostics_.Append(parsing);
  if (parsing.has_errors()) return;
  bound->tree = &used_trees_.back();
  const Elsewhere elsewhere(this, bound);
  const std::vector<NodeId> statements = Kids(tree_->root);
  Predeclare(statements);
  bound->predeclared = predeclared_;
  for (const auto& [node, index] : predeclared_) {
    if (KindOf(node) == NodeKind::kDefine) bound->unbound.emplace(index, node);
  }
  for (const NodeId statement : statements) {
    if (KindOf(statement) != NodeKind::kDefine) BindStatement(statement);
  }
}

// Elements may place one another in circles: each is bound once, and what a family defines is
// declared before.
void Binder::BindElement(Family* family, std::uint32_t definition) {
  const auto node = family->unbound.extract(definition);
  if (node.empty()) return;
  const Elsewhere elsewhere(this, family);
  BindStatement(node.mapped());
}

// `use "profiles.trn"` in a family: that family's functions are known here, too.
void Binder::BindLibraryUse(NodeId string, const std::string& path) {
  const LibraryFamily* family =
      path.ends_with(".trn") ? library().Named(path.substr(0, path.size() - 4)) : nullptr;
  if (!family) {
    return Error(Code::kCannotRead, SpanOf(string),
                 "the library has no family `" + Printable(path) + "`");
  }
  Import(FamilyOf(*family).scope, family->path(), SpanOf(string));
}

}  // namespace tranos::interp
