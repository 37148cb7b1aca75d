// SPDX-License-Identifier: GPL-3.0-or-later
// A script's statements as a tree that can be compared with another's: layout, comments and the
// choice of separators are gone, and the key-ins that answer a command are part of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interp/source.h"

namespace tranos::session {

inline constexpr std::uint32_t kNoStatement = 0xffffffff;

struct Statement {
  enum Kind : std::uint8_t {
    kScript,
    kCommand,
    kAnswers,
    kSetting,
    kLoop,
    kBlock,
    kOther
  } kind = kOther;
  std::uint64_t head = 0;            // kind and words: what a changed statement keeps
  std::uint64_t hash = 0;            // all of it, with the statements within
  std::vector<std::uint64_t> items;  // its parts, in order
  std::uint32_t parent = kNoStatement;
  std::vector<std::uint32_t> children;
  std::uint32_t begin = 0, end = 0;  // bytes
  std::uint32_t loops = 0;           // how many loops it stands in
};

struct StatementTree {
  std::vector<Statement> statements;  // the script first, parents before what is in them

  // The statement with the key-in that begins here; of a command, the command.
  std::uint32_t At(std::uint32_t offset) const;
  // The block that ends with the brace here.
  std::uint32_t EndingAt(std::uint32_t brace) const;
  // The loops around the statement, outermost first.
  std::vector<std::uint32_t> LoopsAround(std::uint32_t statement) const;

  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      places;  // begin of each key-in, its statement; sorted
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;  // end of each block's brace; sorted
};

// Of the script that was run: the first of the sources, which parses.
StatementTree MakeStatementTree(const interp::Sources& sources, int depth);

}  // namespace tranos::session
