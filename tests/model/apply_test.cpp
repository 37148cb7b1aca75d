// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <set>

#include "tests/model/shapes.h"

namespace tranos::model {
namespace {

Hash128 SumOfElements(const Model& model) {
  Hash128 sum;
  model.ForEach([&](const ElementPtr& element) { sum = sum + element->hash; });
  return sum;
}

// What Apply keeps up to date, computed from nothing.
void CheckAgainstRebuild(const State& state) {
  std::size_t live = 0;
  for (ElementId id = 0; id < state.model.entries.size(); ++id) {
    const Entry& entry = state.model.entries[id];
    live += entry.standing == Standing::kInModel;
    RC_ASSERT((entry.standing == Standing::kDeleted) == (entry.element == nullptr));
    if (!entry.element) continue;
    RC_ASSERT(entry.element->id == id);
    if (const auto* group = std::get_if<GroupPtr>(&entry.element->geometry)) {
      Hash128 members;
      for (const ElementPtr& member : (*group)->members) {
        RC_ASSERT(state.model.entries[member->id].owner == id);
        if (entry.standing != Standing::kConsumed) {
          RC_ASSERT(state.model.Current(member->id) == member);
        }
      }
    }
  }
  RC_ASSERT(state.model.live == live);
  RC_ASSERT(state.model.hash == SumOfElements(state.model));
  Names names = state.drawing.names;
  names.Rehash(state.model.entries);
  RC_ASSERT(names.hash() == state.drawing.names.hash());
  for (const Selection& chosen : {state.drawing.selection, state.drawing.last}) {
    const Selection fresh(std::vector<ElementId>(chosen.begin(), chosen.end()));
    RC_ASSERT(fresh.HashIn(state.model.entries) == chosen.HashIn(state.model.entries));
  }
  for (const ElementId id : state.drawing.selection) RC_ASSERT(state.model.InModel(id));
}

std::vector<ElementId> IdsStanding(const State& state, Standing standing) {
  std::vector<ElementId> ids;
  for (ElementId id = 0; id < state.model.entries.size(); ++id) {
    if (state.model.entries[id].standing == standing) ids.push_back(id);
  }
  return ids;
}

std::vector<ElementId> SomeOf(const std::vector<ElementId>& ids, std::size_t at_most) {
  std::set<ElementId> chosen;
  for (std::size_t i = 0; i < at_most && !ids.empty(); ++i) {
    chosen.insert(*rc::gen::elementOf(ids));
  }
  return {chosen.begin(), chosen.end()};
}

Edit Grouping(const State& state, const std::vector<ElementId>& ids) {
  Edit edit;
  std::vector<ElementPtr> members;
  for (const ElementId id : ids) members.push_back(state.model.Current(id));
  edit.grouped = ids;
  edit.added.push_back(MakeGroupOf(members, {{"first", {members[0]}, false}}));
  return edit;
}

Edit AnyEdit(const State& state) {
  Edit edit;
  const std::vector<ElementId> live = IdsStanding(state, Standing::kInModel);
  const std::vector<ElementId> members = IdsStanding(state, Standing::kMember);
  const int kind = *rc::gen::inRange(0, 10);
  if (kind < 3 || live.empty()) {
    for (int i = *rc::gen::inRange(1, 4); i > 0; --i) {
      edit.added.push_back(MakePoint(*rc::gen::inRange(0, 5)));
    }
    edit.selection = Selection{kAddedBase};
    return edit;
  }
  const std::vector<ElementId> some = SomeOf(live, 3);
  const ElementPtr one = state.model.Current(some[0]);
  const auto* group = std::get_if<GroupPtr>(&one->geometry);
  if (kind == 3) {
    for (const ElementId id : some) {
      edit.replaced.push_back(Transformed(*state.model.Current(id), Translation(1)));
    }
  } else if (kind == 4) {
    edit.deleted = some;
  } else if (kind == 5) {
    edit.consumed = some;
  } else if (kind == 6) {
    edit = Grouping(state, some);
  } else if (kind == 7) {
    edit.added.push_back(Transformed(*one, Translation(0, 1)));
  } else if (kind == 8 && group) {
    edit.deleted = {one->id};
    edit.released = (*group)->members;
  } else if (!members.empty()) {
    const ElementId member = *rc::gen::elementOf(members);
    if (*rc::gen::arbitrary<bool>()) {
      edit.replaced = {Transformed(*state.model.Current(member), Translation(0, 0, 1))};
    } else {
      edit.deleted = {member};
    }
  }
  if (*rc::gen::inRange(0, 3) == 0) edit.selection = Selection(SomeOf(live, 4));
  return edit;
}

TEST(Apply, AgreesWithARebuildAndKeepsEarlierStates) {
  EXPECT_TRUE(rc::check([] {
    State state;
    std::vector<std::pair<State, Hash128>> kept;
    for (int step = *rc::gen::inRange(1, 60); step > 0; --step) {
      kept.emplace_back(state, HashOf(state));
      Applied applied = Apply(state, AnyEdit(state));
      state = std::move(applied.state);
      for (const ElementId id : applied.made_or_changed) {
        if (*rc::gen::inRange(0, 2)) {
          state.drawing.names.Bind(*rc::gen::inRange<std::size_t>(0, 5), id, state.model.entries);
        }
      }
      CheckAgainstRebuild(state);
    }
    for (const auto& [earlier, hash] : kept) {
      CheckAgainstRebuild(earlier);
      RC_ASSERT(HashOf(earlier) == hash);
    }
  }));
}

TEST(Apply, GivesIdsInOrderAndResolvesTheSelection) {
  State state = With({}, {MakePoint(0)});
  Edit edit;
  edit.added = {MakePoint(1), MakePoint(2)};
  edit.selection = Selection{kAddedBase + 1, 0};
  const Applied applied = Apply(state, edit);
  EXPECT_EQ(applied.made_or_changed, (std::vector<ElementId>{1, 2}));
  EXPECT_EQ(applied.state.drawing.selection, (Selection{2, 0}));
  EXPECT_EQ(applied.state.drawing.last, (Selection{1, 2}));
  EXPECT_EQ(applied.state.model.entries[2].element->hash, MakePoint(2)->hash);
}

TEST(Apply, ConsumedKeepsItsGeometryAndLeavesModelAndSelection) {
  State state = With({}, {MakePoint(0), MakePoint(1)});
  Edit edit;
  edit.selection = Selection{0, 1};
  state = Apply(state, edit).state;
  edit = {};
  edit.consumed = {0};
  state = Apply(state, edit).state;
  EXPECT_FALSE(state.model.InModel(0));
  ASSERT_NE(state.model.Current(0), nullptr);
  EXPECT_EQ(state.drawing.selection, Selection{1});
  EXPECT_EQ(state.model.hash, MakePoint(1)->hash);
  EXPECT_EQ(state.drawing.last, (Selection{0, 1}));
}

TEST(Apply, MovingAGroupMovesWhatItsMembersAre) {
  State state = With({}, {MakePoint(0), MakePoint(5)});
  state = Apply(state, Grouping(state, {0, 1})).state;
  EXPECT_EQ(state.model.live, 1u);
  Edit edit;
  edit.replaced = {Transformed(*state.model.Current(2), Translation(10))};
  state = Apply(state, edit).state;
  EXPECT_EQ(BoundingBox(*state.model.Current(1)).min.x(), 15);
  EXPECT_EQ(state.model.entries[1].standing, Standing::kMember);
  const Group& group = *std::get<GroupPtr>(state.model.Current(2)->geometry);
  EXPECT_EQ(group.names[0].elements[0], group.members[0]);
}

TEST(Apply, ChangedMemberChangesEveryGroupAroundIt) {
  State state = With({}, {MakePoint(0), MakePoint(5)});
  state = Apply(state, Grouping(state, {0, 1})).state;
  state = Apply(state, Grouping(state, {2})).state;
  Edit edit;
  edit.replaced = {Transformed(*state.model.Current(1), Translation(1))};
  state = Apply(state, edit).state;
  EXPECT_EQ(BoundingBox(*state.model.Current(3)).max.x(), 6);
  edit = {};
  edit.deleted = {1};
  state = Apply(state, edit).state;
  EXPECT_EQ(BoundingBox(*state.model.Current(3)).max.x(), 0);
  EXPECT_EQ(state.model.hash, state.model.Current(3)->hash);
}

TEST(Apply, CopyOfAGroupHasMembersOfItsOwn) {
  State state = With({}, {MakePoint(0), MakePoint(5)});
  state = Apply(state, Grouping(state, {0, 1})).state;
  state = With(state, {Transformed(*state.model.Current(2), Translation(0, 1))});
  const auto& copies = std::get<GroupPtr>(state.model.Current(3)->geometry)->members;
  EXPECT_EQ(copies[0]->id, 4u);
  EXPECT_EQ(copies[1]->id, 5u);
  EXPECT_EQ(state.model.Current(5), copies[1]);
  EXPECT_EQ(state.model.entries[5].owner, 3u);
  EXPECT_EQ(BoundingBox(*state.model.Current(1)).max.y(), 0);
}

TEST(Apply, DeletingAGroupTakesItsMembersAndDroppingReleasesThem) {
  State state = With({}, {MakePoint(0), MakePoint(5)});
  state = Apply(state, Grouping(state, {0, 1})).state;
  Edit edit;
  edit.deleted = {2};
  EXPECT_EQ(Apply(state, edit).state.model.Current(0), nullptr);
  edit.released = std::get<GroupPtr>(state.model.Current(2)->geometry)->members;
  const State dropped = Apply(state, edit).state;
  EXPECT_TRUE(dropped.model.InModel(0));
  EXPECT_TRUE(dropped.model.InModel(1));
  EXPECT_EQ(dropped.model.hash, With({}, {MakePoint(0), MakePoint(5)}).model.hash);
}

TEST(Apply, SettingsViewAndLevelsAreReplaced) {
  Edit edit;
  Settings settings;
  settings.depth_m = 3;
  edit.settings = std::make_shared<const Settings>(settings);
  edit.view = View{.mode = RenderMode::kHidden, .antialias = true, .direction = "front"};
  edit.hidden_levels = std::vector<std::string>{"roof"};
  edit.last_point = geom::Vec3(1, 2, 3);
  const State state = Apply({}, edit).state;
  EXPECT_EQ(state.drawing.settings->depth_m, 3);
  EXPECT_EQ(state.drawing.view->direction, "front");
  EXPECT_FALSE(state.model.LevelIsOn("roof"));
  EXPECT_TRUE(state.model.LevelIsOn("1"));
  EXPECT_EQ(state.drawing.last_point, geom::Vec3(1, 2, 3));
}

}  // namespace
}  // namespace tranos::model
