// SPDX-License-Identifier: GPL-3.0-or-later
// A bound program: names are slots, commands are rows, and each unit of code is one flat list of
// instructions for the machine in machine.cpp.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "interp/command.h"
#include "interp/source.h"
#include "interp/type.h"
#include "model/value.h"

namespace tranos::interp {

// An operand is a register, or a constant of the unit where the top bit is set.
using Operand = std::uint32_t;
inline constexpr Operand kConstantBit = 0x80000000;

// a is the target register where there is one; b, c are operands unless said otherwise; n is the
// working unit's index where a bare number may be read in it.
enum class Op : std::uint8_t {
  kMove,  // a ← b
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kModulo,
  kPower,
  kEqual,
  kNotEqual,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kWithin,
  kConsistent,
  kNegate,
  kNot,           // a ← op b
  kCheckBoolean,  // b must be a boolean; a ← b
  kMakeRange,     // a ← b..c
  kPlusMinus,     // a ← b ± c; flags 1: c is relative
  kMakeList,      // a ← the c registers from b on
  kMakeString,    // a ← the pieces at registers from b on, c of them
  kFormat,        // a ← text of b; flags: 1 + decimals, 0 for none given
  kMember,        // a ← b.name (constant c)
  kIndex,         // a ← b[c]
  kConvert,       // a ← b as the type in flags; c: constant with the name for the message
  kConvertList,   // … each item of the list b
  kCallBuiltin,  // a ← builtin number flags|n… (index c) of registers from b on; next word: count
  kCallFunction,  // a ← unit c of registers from b on
  kCallValue,     // a ← closure in register b − 1 … of registers from b on; c: count
  kCallMember,  // a ← method named in register b − 1 of register b − 2, of the c registers from b
                // on
  kMakeClosure,  // a ← closure of unit b; c: first register of the captured values
  kLoadOuter,    // a ← register c of the innermost activation of unit b
  kLoadName,     // a ← what a name stands for: scope b, index c; flags 1: from register n on
  kLoadLast,     // a ← last
  kJump,         // to a
  kJumpIfFalse,  // to a, unless b is true
  kJumpIfGiven,  // to a, if register b is not none
  kForCount,     // registers a (from), a+1 (to), a+2 (step) checked; jumps to c if there is no turn
  kForCountNext,  // … the next turn's value to register b, and on to the next word, or to c
  kForEach,       // registers a (list), a+1 (index); jumps to c if empty
  kForEachNext,  // … the next item to register b, its index to register n (if not 0xffff), or to c
  kCountName,    // a ← how many elements the name (scope b, index c) has now
  kCheckUnnamed,  // an error if the name (scope b, index c) stands for something already
  kReturn,        // the value b
  kHalt,
  // Effects
  kStart,         // the command row a of the program's uses, defines after them
  kOption,        // an option word or asked-for name: constant a
  kBareString,    // a bare string: constant/register b
  kParameterKey,  // key number a of the active command ← b
  kPoint,         // a data point of kind flags, of c values from register b on
  kSetting,       // setting number flags ← b
  kReset,
  kName,  // as: scope b, index c, constant a (the name)
  kEndStatement,
  kEndCommand,  // the active command ends (a block's end, a file's end)
  kBlockBegin,  // flags: 1 restores settings at its end
  kBlockEnd,
  kGroupBegin,  // name scope a
  kGroupEnd,    // flags 1: named: scope b, index c, constant a
  kInterface,   // constant a: name; b: first register of (key constant, value) pairs, c of them
  kAssert,  // a: index of the assertion; b: the condition; c: first of value, expected (or none)
  kCheckRange,  // register a within b (a range or list); c: constant with the name
  kUnknown,     // a ← the unknown number c with start b
};

struct Instruction {
  Op op;
  std::uint8_t flags = 0;
  std::uint16_t n = 0;
  std::uint32_t a = 0, b = 0, c = 0;
};

// In a kJumpIfFalse's flags: of `and` and `or`, which choose a value and no branch.
inline constexpr std::uint8_t kOnlyAValue = 1;
// In a kPoint's flags: operand b is the whole point, and not the first of c registers.
inline constexpr std::uint8_t kPackedPoint = 0x80;

enum class PointKey : std::uint8_t { kXy, kAx, kDl, kDi, kDx, kDot, kOn };
enum class SettingKey : std::uint8_t {
  kColour,
  kLinestyle,
  kWeight,
  kLevel,
  kAngle,
  kScale,
  kDepth,
  kMaterial,
  kEvidence,
  kSource,
  kChord,
  kFacets,
  kLocate,
  kUnit,
  kNoise,
};
struct SettingRow {
  std::string_view key;
  SettingKey setting;
  Type type;
  std::string_view words;  // of a closed list
  std::string_view summary;
  std::string_view standard;
};
std::span<const SettingRow> AllSettings();
const SettingRow* FindSetting(std::string_view key);  // lower case
struct PointKeyRow {
  std::string_view key;
  PointKey kind;
  int least, most;
  std::string_view summary;
};
std::span<const PointKeyRow> AllPointKeys();
const PointKeyRow* FindPointKey(std::string_view key);

// A unit of measure; `factor` turns a number of it into SI.
struct Unit {
  std::string name;
  model::Dimension dimension;
  double factor = 1;
  double shares = 0;  // a power of ten that makes `factor` a whole number; 0 where there is none
};

struct CodeUnit {
  std::string name;  // of the function or definition; "" for the script
  std::vector<Instruction> code;
  std::vector<Span> spans;                                              // one for each instruction
  std::unordered_map<std::uint32_t, std::vector<Span>> argument_spans;  // of calls
  std::vector<model::Value> constants;
  std::uint32_t registers = 0;
  std::uint32_t parameters = 0;  // the first registers; a closure's captured values come after them
  std::uint32_t captured = 0;
  std::uint32_t body = 0;  // a definition's: where its parameters are ready and the body begins
  // What it reads of activations around it: (unit, register), directly.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> outer;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> outer_names;  // (name scope, index)
  std::vector<std::uint32_t> calls;                                  // units it calls or places
};

struct NameScope {
  std::vector<std::string> names;
};

struct DefinedParameter {
  std::string name;
  Type type;
  bool list = false;
  std::string words;     // of a word: "outline|shell|masonry"
  std::string standard;  // text of the default, "" if none
  std::string range;     // text of the range
  std::string summary;
  Span span;
};
// Where others meet a defined element.
struct DefinedInterface {
  std::string name;
  std::vector<std::string> measures;
};
// A define or the parameters of a script: what help, binding and placing know of it.
struct Definition {
  std::string words;  // "place dome cruciform", lower case
  std::string summary;
  std::vector<DefinedParameter> parameters;
  std::vector<DefinedInterface> interfaces;
  std::uint32_t unit = 0;
  std::uint32_t scope = 0;  // its name scope
  Span span;                // of its words
  Span whole;               // of its text, up to the closing brace
  std::vector<Key> keys;    // as a built-in's, pointing into `parameters`
  Command row;
};

struct AssertInfo {
  std::string text;     // the expression, as written
  std::string message;  // "" if none
  bool compares = false;
  Span span;
};
struct UnknownInfo {
  std::string name;
  Span span;
  bool is_free = false;            // it has no start of its own
  std::uint32_t range = kNoRange;  // the register of its bounds
  static constexpr std::uint32_t kNoRange = 0xffffffff;
};

struct Program {
  std::shared_ptr<Sources> sources;
  std::vector<Unit> measures;     // units of measure
  std::deque<CodeUnit> units;     // 0: the script
  std::vector<NameScope> scopes;  // 0: the script's
  std::deque<Definition> definitions;
  std::vector<const Command*> rows;  // command rows used by kStart: built-in ones, and definitions'
  std::vector<std::int32_t> row_definition;  // index into definitions, or -1
  std::vector<AssertInfo> asserts;
  std::vector<UnknownInfo> unknowns;
  bool calibrates = false;                                  // `calibrate` stands in it
  std::vector<DefinedParameter> parameters;                 // of the script
  std::vector<std::pair<std::string, std::uint32_t>> lets;  // registers of the script's own names
  std::uint32_t hypotheses_matched = 0;
};

}  // namespace tranos::interp
