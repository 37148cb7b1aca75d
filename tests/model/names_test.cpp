// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/names.h"

#include <gtest/gtest.h>

#include "tests/model/shapes.h"

namespace tranos::model {
namespace {

TEST(Names, WhatWasNeverSetIsNotGiven) {
  const Names names;
  EXPECT_FALSE(names[3].given);
  EXPECT_EQ(names.hash(), Hash128{});
}

TEST(Names, StandForElementsInOrder) {
  const State state = With({}, {MakePoint(0), MakePoint(1)});
  Names names;
  names.Bind(2, 1, state.model.entries);
  names.Bind(2, 0, state.model.entries);
  EXPECT_FALSE(names[1].given);
  ASSERT_EQ(names[2].ids.size(), 2u);
  EXPECT_EQ(names[2].ids[0], 1u);
  Names other;
  other.Bind(2, 0, state.model.entries);
  other.Bind(2, 1, state.model.entries);
  EXPECT_NE(names.hash(), other.hash());
}

TEST(Names, SetTakesBackWhatWasThere) {
  const State state = With({}, {MakePoint(0), MakePoint(1), MakePoint(2)});
  Names names;
  names.Bind(0, 2, state.model.entries);
  const Names before = names;
  names.Bind(0, 0, state.model.entries);
  names.Bind(1, 1, state.model.entries);
  names.Set(0, before[0], state.model.entries);
  EXPECT_EQ(before[0].ids.size(), 1u);
  EXPECT_NE(names.hash(), before.hash());
  names.Set(1, {}, state.model.entries);
  EXPECT_EQ(names.hash(), before.hash());
}

TEST(Names, AnEmptyListIsGiven) {
  Names names;
  names.Set(0, {{}, true}, {});
  EXPECT_TRUE(names[0].given);
  EXPECT_NE(names.hash(), Hash128{});
}

TEST(Names, OfAnOuterScopeAreRehashedWhenPutBack) {
  State state = With({}, {MakePoint(0)});
  state.drawing.names.Bind(0, 0, state.model.entries);
  Names outer = std::exchange(state.drawing.names, {});
  Edit edit;
  edit.replaced = {Transformed(*state.model.Current(0), Translation(1))};
  state = Apply(state, edit).state;
  const Hash128 stale = outer.hash();
  outer.Rehash(state.model.entries);
  EXPECT_NE(outer.hash(), stale);
  Names fresh;
  fresh.Bind(0, 0, state.model.entries);
  EXPECT_EQ(outer.hash(), fresh.hash());
}

}  // namespace
}  // namespace tranos::model
