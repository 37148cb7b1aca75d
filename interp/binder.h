// SPDX-License-Identifier: GPL-3.0-or-later
// From syntax tree to program: names become registers, words become rows. Private to this room.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "interp/arithmetic.h"
#include "interp/failure.h"
#include "interp/run.h"
#include "interp/syntax.h"

namespace tranos::interp {

struct Symbol {
  enum Kind : std::uint8_t { kRegister, kElementName, kFunction } kind = kRegister;
  std::uint32_t unit = 0;           // the code unit of the register, or of the function
  std::uint32_t index = 0;          // register, or index in the name scope
  std::uint32_t scope = 0;          // name scope of an element name
  std::int64_t turn_register = -1;  // of an element name given in this loop: where the turn began
  bool as_list = false;             // an element name given in a loop that has ended
  int parameters = 0;               // of a function
  std::optional<model::Dimension> dimension = {};  // where it is known before running
  Span declared = {};
  std::uint32_t file = 0;
};

// One lexical block.
struct Scope {
  std::unordered_map<std::string, Symbol> symbols;
  std::map<std::string, std::uint32_t, std::less<>> definitions;  // words → index
  Scope* parent = nullptr;
  std::uint32_t name_scope = 0;
  bool opens_names = false;                // a script, group or definition: `as` names belong here
  std::map<std::string, Span> interfaces;  // of a definition
  bool is_turn = false;                    // a loop's body
  std::map<std::string, std::uint32_t> turn_registers;  // of a loop: name → where its turn began
  std::uint16_t measure = 0;                            // the working unit from here on
  const Command* command = nullptr;                     // the nearest command before, in this block
  std::uint32_t command_statement = 0;
  bool closed_to_commands = false;  // a group or definition: commands outside are not reached
};

class Binder {
 public:
  Binder(std::shared_ptr<Sources> sources, const BindOptions& options, const Host& host);
  Bound BindScript(const SyntaxTree& tree);
  Bound BindFamily(const LibraryFamily& family);

 private:
  // A unit of code being written.
  struct Builder {
    std::uint32_t id;
    Builder* parent = nullptr;
    std::uint32_t next_register = 0;
    std::uint32_t first_temporary = 0;  // registers from here on are the statement's own
  };
  // Restores what a block changed of the binder.
  struct ScopeGuard;
  // A family of the library: all is declared, and an element's body bound when it is reached.
  struct Family {
    Scope scope;
    const SyntaxTree* tree = nullptr;
    std::map<NodeId, std::uint32_t> predeclared;
    std::map<std::uint32_t, NodeId> unbound;  // definition → where it stands
  };
  // Puts the binder at the top of a family, and back.
  struct Elsewhere;

  // Statements (bind_statement.cpp).
  void BindStatements(const std::vector<NodeId>& statements);
  void BindStatement(NodeId id);
  void BindBlockBody(NodeId block);
  void BindPlainBlock(NodeId block);
  bool Draws(NodeId block) const;
  void BindLet(NodeId id);
  void BindUnit(NodeId id);
  void BindForCount(NodeId id);
  void BindForEach(NodeId id);
  void CheckUnnamed(const std::map<std::string, Span>& given);
  void BindTurn(NodeId block, Scope* scope, const std::map<std::string, Span>& given);
  void LeaveLoop(const Scope& turn, const std::map<std::string, Span>& given);
  void BindIf(NodeId id);
  void BindGroup(NodeId id);
  std::size_t BindHypotheses(const std::vector<NodeId>& statements, std::size_t first);
  void BindUse(NodeId id);
  void BindUsedFile(NodeId id, const std::string& path);
  void Import(const Scope& used, const std::string& path, Span span);
  void BindAssert(NodeId id);
  void BindUnknown(NodeId id);
  // The standard library (bind_library.cpp).
  const Library& library() const;
  const Command* LibraryCommand(std::string_view words);
  Family& FamilyOf(const LibraryFamily& family);
  void DeclareFamily(const LibraryFamily& family, Family* bound);
  void BindElement(Family* family, std::uint32_t definition);
  void BindLibraryUse(NodeId string, const std::string& path);
  // Definitions (bind_definition.cpp).
  void Predeclare(const std::vector<NodeId>& statements);
  void PredeclareFunction(NodeId id);
  void PredeclareDefinition(NodeId id);
  std::optional<DefinedParameter> DeclareParameter(NodeId param);
  void BindFunction(NodeId id);
  void BindDefine(NodeId id);
  void BindParameterStatement(NodeId id);
  void BindGivenValue(const DefinedParameter& declared, const std::string& given,
                      std::uint32_t reg);
  void BindInterface(NodeId id);
  void DeclareInterface(NodeId name_node);
  void EmitParameter(NodeId param, const DefinedParameter& declared, std::uint32_t reg);
  void EmitRangeCheck(NodeId param, const DefinedParameter& declared, std::uint32_t reg);
  // Commands (bind_command.cpp).
  void BindCommand(NodeId id);
  void BindArguments(const std::vector<NodeId>& args, std::size_t first, const Command* row,
                     std::uint32_t statement);
  bool BindWord(NodeId id, const Command* row);  // false after an error
  bool BeginsCommand(std::string_view word) const;
  void BindKeyIn(NodeId id, std::uint32_t statement);
  void BindPoint(NodeId id, const PointKeyRow& row, const std::vector<NodeId>& values);
  void BindSetting(NodeId id, const SettingRow& row, const std::vector<NodeId>& values);
  void BindNaming(NodeId id);
  const Command* LookUpCommand(const std::vector<NodeId>& words, std::size_t* used);
  void UnknownCommand(const std::vector<NodeId>& words);
  void UnknownKey(NodeId word, const Command* row);
  std::uint32_t UseOf(const Command* row, std::int32_t definition);
  Scope* CommandScope();
  // Expressions (bind_expression.cpp).
  Operand Expression(NodeId id);
  void ExpressionInto(std::uint32_t target, NodeId id);
  void BinaryInto(std::uint32_t target, NodeId id);
  void LogicInto(std::uint32_t target, NodeId id);
  void ConditionalInto(std::uint32_t target, NodeId id);
  void CallInto(std::uint32_t target, NodeId id);
  void LambdaInto(std::uint32_t target, NodeId id);
  std::vector<NodeId> FreeNames(NodeId lambda) const;
  void StringInto(std::uint32_t target, NodeId id);
  void NameInto(std::uint32_t target, NodeId id);
  void ListInto(std::uint32_t target, const std::vector<NodeId>& items, NodeId whole);
  std::optional<model::Value> Constant(NodeId id);
  std::optional<model::Value> NumberConstant(NodeId id, bool percent_is_share = true);
  std::optional<model::Dimension> StaticDimension(NodeId id, int depth = 0);
  std::vector<NodeId> Spine(NodeId id, NodeId* leftmost) const;
  // The values of a key as one operand of the declared type.
  Operand Typed(const std::vector<NodeId>& values, Type type, bool list, std::string_view words,
                std::string_view name, NodeId whole);
  Operand TypedValues(const std::vector<NodeId>& values, Type type, bool list,
                      std::string_view name, NodeId whole, bool gathers);
  Operand TypedWord(NodeId value, std::string_view words, std::string_view name);
  Operand ConvertedOperand(Operand operand, Type type, bool list, std::string_view name, Span span);

  // Scopes and code.
  const Symbol* Find(const std::string& name) const;
  void Declare(const std::string& name, Symbol symbol, Span span);
  bool CheckName(std::string_view name, Span span);
  std::uint32_t NameIndex(std::uint32_t scope, const std::string& name);
  Scope* NamesScope();
  // Where a name given here is known: the turn of the nearest loop, or that scope.
  Scope* NamesOwner() const;
  std::uint32_t NewRegister();
  std::uint32_t NewUnit(std::string name);
  std::uint32_t Emit(Instruction instruction, Span span);
  std::uint32_t Here() const { return static_cast<std::uint32_t>(unit().code.size()); }
  void Patch(std::uint32_t at, std::uint32_t target);
  Operand AddConstant(model::Value value);
  Operand AddText(std::string_view text) {
    return AddConstant(model::Value::String(std::string(text)));
  }
  CodeUnit& unit() { return program_->units[builder_->id]; }
  const CodeUnit& unit() const { return program_->units[builder_->id]; }
  const Unit& measure() const { return program_->measures[scope_->measure]; }
  std::optional<std::uint16_t> FindMeasure(std::string_view name) const;

  // Source and diagnostics.
  const SyntaxTree& tree() const { return *tree_; }
  std::string Text(NodeId id) const;  // of a word or name in its normal form
  std::string Lower(NodeId id) const;
  Span SpanOf(NodeId id) const { return tree_->SpanOf(id); }
  std::vector<NodeId> Kids(NodeId id) const { return tree_->Children(id); }
  NodeKind KindOf(NodeId id) const { return (*tree_)[id].kind; }
  Span OperatorSpan(NodeId binary) const;
  void Error(Code code, Span span, std::string message, std::string label = {},
             std::string help = {}, std::vector<Note> notes = {});
  void Report(const OpFailure& failure, Span span);
  std::vector<std::string> VisibleNames() const;
  Diagnostic UnknownHypothesis(const SyntaxTree& script) const;

  std::shared_ptr<Program> program_;
  const BindOptions& options_;
  const Host& host_;
  Diagnostics diagnostics_;
  const SyntaxTree* tree_ = nullptr;
  Scope* scope_ = nullptr;
  Builder* builder_ = nullptr;
  std::uint32_t statement_ = 0;  // counts statements, to tell a key's own
  SourceList constant_sources_;
  std::map<NodeId, std::uint32_t> let_registers_;  // of lets in a block that has functions
  std::map<NodeId, std::uint32_t>
      predeclared_;  // define or function node → definition or unit, in this file
  // Files used: path → its top-level scope, null while it is being bound.
  std::map<std::string, std::unique_ptr<Scope>> used_;
  std::deque<SyntaxTree> used_trees_;
  std::map<const LibraryFamily*, Family> families_;  // that the script reaches
  bool in_library_ = false;
  bool in_used_file_ = false;
  bool at_top_ = true;
  std::string_view whole_words_;  // words that stand for 1 in the key being bound: `centre`
  bool in_definition_ = false;
  Definition* defining_ = nullptr;  // the one whose body is being bound
  int depth_ = 0;                   // of the expression being bound
  std::set<std::string> declared_parameters_;
  std::vector<NodeId> hypotheses_;  // the names of all alternatives
  std::unordered_map<const Command*, std::uint32_t> uses_;
  std::unordered_map<std::uint32_t, std::unordered_map<std::string, std::uint32_t>> name_indices_;
};

std::string LowerCase(std::string_view text);

}  // namespace tranos::interp
