// SPDX-License-Identifier: GPL-3.0-or-later
// What one step costs, counted in allocations: the same with ten thousand elements as with a
// thousand, with a long list of names, and with every earlier state kept.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "tests/model/shapes.h"

namespace {
std::size_t allocated_bytes = 0;  // NOLINT: operator new has no other place to count
}  // namespace

void* operator new(std::size_t size) {
  allocated_bytes += size;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace tranos::model {
namespace {

template <class F>
std::size_t BytesOf(const F& f) {
  const std::size_t before = allocated_bytes;
  f();
  return allocated_bytes - before;
}

// Bytes for each of the next 1000 points, the states of which are all kept.
std::size_t BytesPerPoint(State& state, std::vector<State>& kept, bool named) {
  const AttributesPtr attributes = PlainAttributes();
  constexpr int kSteps = 1000;
  kept.reserve(kept.size() + kSteps);
  const std::size_t bytes = BytesOf([&] {
    for (int i = 0; i < kSteps; ++i) {
      const auto id = static_cast<ElementId>(state.model.entries.size());
      Edit edit;
      edit.added.push_back(MakeElement(id, Point{geom::Vec3(i, 0, 0)}, attributes, nullptr, {}));
      state = Apply(std::move(state), edit).state;
      if (named) state.drawing.names.Bind(0, id, state.model.entries);
      kept.push_back(state);
    }
  });
  return bytes / kSteps + sizeof(State);
}

TEST(StepCost, KeepingEveryStateTakesFewBytes) {
  State state;
  std::vector<State> kept;
  const std::size_t first = BytesPerPoint(state, kept, false);
  for (int i = 0; i < 40; ++i) BytesPerPoint(state, kept, false);
  const std::size_t late = BytesPerPoint(state, kept, false);
  // The edit's own list and the list of what was made come and go in each step.
  EXPECT_LT(late, 400u);
  EXPECT_LT(late, first + 32);
}

TEST(StepCost, NamingInALoopIsNotQuadratic) {
  State state;
  std::vector<State> kept;
  const std::size_t first = BytesPerPoint(state, kept, true);
  for (int i = 0; i < 20; ++i) BytesPerPoint(state, kept, true);
  EXPECT_LT(BytesPerPoint(state, kept, true), first + 200);
}

TEST(StepCost, ChangingOneOfManyCopiesAPathOnly) {
  State state = With({}, std::vector<ElementPtr>(40000, MakePoint(1)));
  const State kept = state;
  Edit edit;
  edit.replaced = {WithId(*MakePoint(2), 20000)};
  EXPECT_LT(BytesOf([&] { state = Apply(std::move(state), edit).state; }), 4000u);
  EXPECT_EQ(kept.model.Current(20000)->hash, MakePoint(1)->hash);
  // The path is this state's own now, and is changed in place.
  edit.replaced = {WithId(*MakePoint(3), 20001)};
  EXPECT_LT(BytesOf([&] { state = Apply(std::move(state), edit).state; }), 200u);
}

TEST(StepCost, HashOfAStateAllocatesNothing) {
  State state = With({}, std::vector<ElementPtr>(40000, MakePoint(1)));
  Edit edit;
  std::vector<ElementId> all(40000);
  for (ElementId id = 0; id < 40000; ++id) all[id] = id;
  edit.selection = Selection(all);
  state = Apply(std::move(state), edit).state;
  EXPECT_EQ(BytesOf([&] { HashOf(state); }), 0u);
}

}  // namespace
}  // namespace tranos::model
