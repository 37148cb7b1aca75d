// SPDX-License-Identifier: GPL-3.0-or-later
// undo, redo, mark: carried out by whoever keeps the earlier states, so these rows have no
// function.
#include "interp/commands/families.h"

namespace tranos::interp {

namespace {

constexpr Key kMarkKeys[] = {{"name", Type::kString, "the mark's name", {}, {}, -1, true}};

constexpr Example kUndoExamples[] = {{"place line xy=0,0,0 dl=10 dl=5; undo", "last.length == 10m"},
                                     {"undo", "E0408"}};
constexpr Example kUndoMarkExamples[] = {
    {"place point xy=1,0,0; mark \"a\"; place point xy=2,0,0 xy=3,0,0; undo mark \"a\"",
     "last.bbox.max.x == 1m"},
    {"undo mark \"b\"", "E0409"}};
constexpr Example kRedoExamples[] = {
    {"place point xy=1,0,0 xy=2,0,0; undo; redo", "last.bbox.max.x == 2m"}, {"redo", "E0408"}};
constexpr Example kMarkExamples[] = {
    {"mark \"start\"; place point xy=1,0,0", "last.bbox.max.x == 1m"}, {"mark", "E0220"}};

constexpr Command kCommands[] = {
    {.words = "undo",
     .family = "history",
     .summary =
         "Takes back the latest firing that changed the model, with the names it gave, `last` and "
         "the selection.",
     .examples = kUndoExamples,
     .history = HistoryStep::kUndo},
    {.words = "undo mark",
     .family = "history",
     .summary = "Goes back to a mark set before.",
     .keys = kMarkKeys,
     .string_key = "name",
     .examples = kUndoMarkExamples,
     .history = HistoryStep::kUndo},
    {.words = "redo",
     .family = "history",
     .summary = "Does again what was undone last, unless something was made since.",
     .examples = kRedoExamples,
     .history = HistoryStep::kRedo},
    {.words = "mark",
     .family = "history",
     .summary = "Sets a mark to which `undo mark` goes back.",
     .keys = kMarkKeys,
     .string_key = "name",
     .examples = kMarkExamples,
     .history = HistoryStep::kMark},
};

}  // namespace

std::span<const Command> HistoryCommands() { return kCommands; }

}  // namespace tranos::interp
