// SPDX-License-Identifier: GPL-3.0-or-later
// The syntax tree: complete (with its comments it prints back), flat and small. A node is twenty
// bytes in one vector; children are linked by index, so that a script of 100 000 lines stays light.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interp/source.h"

namespace tranos::interp {

using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = 0xffffffff;

// After each kind: its children, in order. `…?` may be absent, `…*` any number.
enum class NodeKind : std::uint8_t {
  kScript,      // statement*
  kBlock,       // statement*
  kLet,         // Name, expr
  kUnit,        // Name, expr
  kFunction,    // Name, Params (Name*), expr
  kDefine,      // Words (Name+), String?, Param*, Block
  kParam,       // Name, Type, Default?, Range?, String?
  kInterface,   // Name, KeyIn*
  kParameter,   // Param
  kUnknown,     // Name, Type?, expr, Range?
  kForCount,    // Name, expr from, expr to, Step?, Block
  kForEach,     // Name, Name? (index, name: `for i, x in`), expr, Block
  kIf,          // expr, Block, (If | Block)?
  kGroup,       // Name?, Block
  kHypothesis,  // Name, Block
  kUse,         // String
  kAssert,      // expr, String?
  kCommand,     // Word+ and arguments: (KeyIn | Reset | Naming | Word | String | Number)*
  kKeyIns,      // (KeyIn | Reset | Naming) and arguments, as above
  // Parts
  kWords,    // Name+
  kParams,   // Name*
  kType,     // Name; detail 1: `list of`
  kDefault,  // expr
  kRange,    // expr+ (the values after `in`)
  kStep,     // expr
  kKeyIn,    // Word, expr+
  kReset,    // –
  kNaming,   // Name
  kWord,     // – (a bare word)
  kName,     // – (a declared or used name)
  // Expressions
  kConditional,  // if, then, else
  kLambda,       // Name, expr
  kBinary,       // left, right; detail: Operator
  kUnary,        // operand; detail: Operator (kNegate, kNot)
  kMember,       // expr, Name
  kCall,         // expr callee, argument*
  kIndex,        // expr, expr
  kNumber,       // – (with its unit or %; NumberOf reads it)
  kString,       // (StringText | StringValue)*
  kStringText,   // – (raw text; escapes as written)
  kStringValue,  // expr; detail: 1 + the digits after `:`, 0 when not given
  kTrue,
  kFalse,
  kLast,
  kParen,  // expr
  kList,   // expr*
  kError,  // – (a place where parsing failed; there is a diagnostic)
};

enum class Operator : std::uint8_t {
  kOr,
  kAnd,
  kNot,
  kEqual,
  kNotEqual,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kWithin,
  kConsistent,
  kRange,
  kPlusMinus,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kModulo,
  kNegate,
  kPower,
};

struct Node {
  NodeKind kind;
  std::uint8_t detail = 0;
  std::uint32_t begin = 0, end = 0;  // bytes of the file
  NodeId first_child = kNoNode;
  NodeId next = kNoNode;  // the next child of the same parent
};

struct Comment {
  std::uint32_t begin, end;  // from `#` to before the newline
};

struct SyntaxTree {
  std::uint32_t file = 0;  // index into Sources
  std::vector<Node> nodes;
  NodeId root = kNoNode;
  std::vector<Comment> comments;  // in order

  const Node& operator[](NodeId id) const { return nodes[id]; }
  Span SpanOf(NodeId id) const { return {file, nodes[id].begin, nodes[id].end}; }
  std::vector<NodeId> Children(NodeId id) const {
    std::vector<NodeId> out;
    for (NodeId c = nodes[id].first_child; c != kNoNode; c = nodes[c].next) out.push_back(c);
    return out;
  }
};

// The value and the unit of a kNumber's text: "35.5m" is {35.5, "m"}, "2%" is {2, "%"}.
struct NumberLiteral {
  double value;
  std::string_view unit;
};
NumberLiteral NumberOf(std::string_view text);

// The text that a kStringText stands for, escapes resolved.
std::string UnescapeStringText(std::string_view raw);

// A word's text in Unicode's form C: two spellings of an accented name are one name.
std::string NormalWord(std::string_view word);

}  // namespace tranos::interp
