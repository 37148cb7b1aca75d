// SPDX-License-Identifier: GPL-3.0-or-later
// Undo is an earlier state: after k undos the model is that of the script without its last k steps.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "interp/run.h"

namespace tranos::interp {
namespace {

std::string Joined(const std::vector<std::string>& steps, std::size_t count) {
  std::string text = "aa=30\nplace point xy=0,0,0\n";
  for (std::size_t i = 0; i < count; ++i) text += steps[i] + "\n";
  return text;
}

model::Hash128 HashAfter(const std::string& text) {
  const ScriptResult result = RunScript("undo.trn", text, {}, {}, {});
  for (const Diagnostic& diagnostic : result.diagnostics.list()) {
    if (diagnostic.severity() == Severity::kError) {
      ADD_FAILURE() << RenderText(diagnostic, *result.sources, false) << "\n" << text;
    }
  }
  return result.outcome.state.model.hash;
}

// Statements that change the model in one firing each.
rc::Gen<std::string> Step() {
  const auto coordinate =
      rc::gen::map(rc::gen::inRange(-50, 50), [](int n) { return std::to_string(n); });
  const auto point = rc::gen::map(
      rc::gen::tuple(coordinate, coordinate, coordinate),
      [](const auto& p) { return std::get<0>(p) + "," + std::get<1>(p) + "," + std::get<2>(p); });
  const auto with = [](std::string before, std::string after) {
    return [before, after](const std::string& p) { return before + p + after; };
  };
  return rc::gen::oneOf(
      rc::gen::map(point, with("place point xy=", "")),
      rc::gen::map(point, with("place line xy=", " dl=3,4")),
      rc::gen::map(point, with("place circle center az=0 radius=2 xy=", "; undo; redo")),
      rc::gen::map(point, with("group { place point xy=", "; place line xy=0,0 dl=5 as beam }")),
      rc::gen::map(point, with("choose all; copy xy=0,0,0 xy=", "")),
      rc::gen::map(point, with("choose last; move xy=0,0,0 xy=", "")),
      rc::gen::map(point, with("choose all; rotate copy xy=", "")),
      rc::gen::just<std::string>("choose last; scale as=2 xy=0,0"),
      rc::gen::just<std::string>("co=3; choose all; modify"));
}

RC_GTEST_PROP(Undo, GoesBackStepByStep, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 7);
  const auto steps = *rc::gen::container<std::vector<std::string>>(count, Step());
  const auto undone = *rc::gen::inRange<std::size_t>(1, count + 1);
  std::string text = Joined(steps, count);
  for (std::size_t i = 0; i < undone; ++i) text += "undo\n";
  // A step may leave a model as it was (a move by nothing), and is undone all the same.
  RC_ASSERT(HashAfter(text) == HashAfter(Joined(steps, count - undone)));
  for (std::size_t i = 0; i < undone; ++i) text += "redo\n";
  RC_ASSERT(HashAfter(text) == HashAfter(Joined(steps, count)));
}

}  // namespace
}  // namespace tranos::interp
