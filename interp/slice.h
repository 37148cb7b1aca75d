// SPDX-License-Identifier: GPL-3.0-or-later
// What was computed from unknowns and `+-` literals on the way to `calibrate`, as a list of
// operations: the numbers of traces are computed again by these alone, with other values.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "interp/program.h"
#include "model/value.h"

namespace tranos::interp {

class Slice {
 public:
  // One operation. A number that came from a source is known by where its
  // derivatives lie: the same for all its copies, and kept alive by the operation that made it.
  struct Operation {
    const CodeUnit* unit;
    std::uint32_t at;                                               // its instruction
    std::vector<std::pair<std::uint32_t, model::Value>> registers;  // what it was given
    model::Value result;
    std::size_t source = kNone;  // the first it added: an unknown, or a literal's error
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  // The registers that an instruction computes from, with their values; nothing for one that only
  // hands on what others computed, or calls a function whose operations are noted by themselves.
  using Registers = std::vector<std::pair<std::uint32_t, model::Value>>;
  static std::optional<Registers> ReadBy(const Instruction& instruction,
                                         const model::Value* registers);
  // Notes an operation, unless its result is made of numbers that others made.
  void Note(Operation operation);
  // Text that an unknown's value was put into.
  void NoteText(const model::Value& text);
  bool HoldsText(const model::Value& text) const { return texts_.contains(&text.string()); }

  // Forgets what does not lead to these numbers.
  void KeepFor(const std::vector<model::Value>& numbers);
  std::size_t size() const { return operations_.size(); }
  // The numbers, every operation carried out anew by `again`, which is given the registers that it
  // reads.
  using Again = std::function<model::Value(const Operation&, model::Value* registers)>;
  std::vector<model::Value> Evaluated(const std::vector<model::Value>& numbers,
                                      const Again& again) const;

 private:
  bool Knows(const model::Value& value) const;

  std::vector<Operation> operations_;
  std::unordered_set<const model::Derivatives*> made_;
  std::vector<model::Value> text_values_;
  std::unordered_set<const std::string*> texts_;
};

}  // namespace tranos::interp
