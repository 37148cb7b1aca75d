// SPDX-License-Identifier: GPL-3.0-or-later
// A state on which rows are carried out one after the other, without a script.
#pragma once

#include <gtest/gtest.h>

#include "interp/command.h"

namespace tranos::interp {

class DrawingBoard {
 public:
  using Keys = std::vector<std::pair<std::string_view, model::Value>>;

  // What the row does to the state, with the state as it is after it.
  CommandResult Do(std::string_view words, std::vector<geom::Vec3> points, Keys keys = {}) {
    Answers answers;
    answers.answered.assign(points.size(), true);
    answers.points = std::move(points);
    answers.keys = std::move(keys);
    return Do(words, std::move(answers));
  }

  CommandResult Do(std::string_view words, Answers answers) {
    const Command* command = FindCommand(words);
    EXPECT_NE(command, nullptr) << words;
    for (const Prompt& prompt : command->prompts) {
      static_cast<void>(prompt);
      if (command->manner == Manner::kGathers) break;
      if (answers.points.size() >= command->prompts.size()) break;
      answers.points.push_back(geom::Vec3::Zero());
      answers.answered.push_back(false);
    }
    if (answers.chosen.empty()) {
      for (const model::ElementId id : state.drawing.selection) {
        answers.chosen.push_back(state.model.Current(id));
      }
    }
    CommandResult result = command->execute(state, answers);
    if (result) state = model::Apply(state, result->edit).state;
    return result;
  }

  // The code of the error that it gives.
  Code ErrorOf(std::string_view words, std::vector<geom::Vec3> points, Keys keys = {}) {
    const CommandResult result = Do(words, std::move(points), std::move(keys));
    EXPECT_FALSE(result.has_value()) << words;
    return result ? Code::kNotYet : result.error().code;
  }

  void ChooseLast() { state.drawing.selection = state.drawing.last; }
  model::ElementPtr Last() const { return state.model.Current(state.drawing.last.back()); }

  void Set(const std::function<void(model::Settings&)>& change) {
    auto settings = std::make_shared<model::Settings>(*state.drawing.settings);
    change(*settings);
    state.drawing.settings = std::move(settings);
  }
  void SetLevel(std::string level) {
    Set([&](model::Settings& settings) {
      auto attributes = std::make_shared<model::Attributes>(*settings.attributes);
      attributes->level = std::move(level);
      settings.attributes = std::move(attributes);
    });
  }

  model::State state;
};

inline model::Value Metres(double length_m) {
  return model::Value::Number(length_m, model::kLength);
}
inline model::Value Degrees(double angle) {
  return model::Value::Number(angle * geom::kPi / 180, model::kAngle);
}
inline model::Value Count(double count) { return model::Value::Number(count); }

}  // namespace tranos::interp
