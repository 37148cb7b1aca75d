// SPDX-License-Identifier: GPL-3.0-or-later
// What was computed from unknowns and `+-` literals on the way to `calibrate`, as lists of
// operations and of firings: the numbers of traces, and the elements that they are read off, are
// made again by these alone, with other values.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "interp/program.h"
#include "model/value.h"

namespace tranos::interp {

class Slice {
 public:
  // One operation. A number that came from a source is known by where its derivatives lie: the same
  // for all its copies, and kept alive by the operation that made it.
  struct Operation {
    const CodeUnit* unit;
    std::uint32_t at;                                               // its instruction
    std::vector<std::pair<std::uint32_t, model::Value>> registers;  // what it was given
    model::Value result;
    std::size_t source = kNone;  // the first it added: an unknown, or a literal's error
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  // A data point that came from a source, with what else its place depends on.
  struct Point {
    PointKey kind;
    model::Value values;
    model::Drawing drawing;
    geom::Frame view;
    std::size_t last = kNone;  // of these points, the last one before it
  };
  // A firing that placed an element by such points, or by such keys.
  struct Firing {
    const Command* row;
    Answers answers;
    model::State before;
    std::vector<std::size_t> points;  // of each of the answers'
    model::ElementId placed;
  };

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

  // Notes a data point and gives its index; kNone where it did not come from a source.
  std::size_t NotePoint(PointKey kind, const model::Value& values, const model::Drawing& drawing,
                        const geom::Frame& view, std::size_t last);
  // Notes a firing, if a point or key of it came from a source.
  void NoteFiring(Firing firing);

  // Forgets what leads neither to these numbers nor to these elements.
  void KeepFor(const std::vector<model::Value>& numbers,
               const std::unordered_set<model::ElementId>& elements);
  std::size_t size() const { return operations_.size() + firings_.size(); }
  const std::vector<Firing>& firings() const { return firings_; }
  // What numbers have become, by where the derivatives lay that they had.
  using Known = std::unordered_map<const model::Derivatives*, model::Value>;
  // Every operation carried out anew by `again`, which is given the registers that it reads.
  using Again = std::function<model::Value(const Operation&, model::Value* registers)>;
  Known Evaluated(const Again& again) const;
  // The value with its numbers as they have become.
  static model::Value Now(const model::Value& value, const Known& known);
  // What was answered, with its points and numbers as they have become.
  Answers Now(const Firing& firing, const Known& known) const;

 private:
  bool Knows(const model::Value& value) const;
  geom::Vec3 Now(const Point& point, const Known& known) const;

  std::vector<Operation> operations_;
  std::vector<Point> points_;
  std::vector<Firing> firings_;
  std::unordered_set<const model::Derivatives*> made_;
  std::vector<model::Value> text_values_;
  std::unordered_set<const std::string*> texts_;
};

}  // namespace tranos::interp
