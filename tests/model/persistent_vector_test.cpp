// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/persistent_vector.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace tranos::model {
namespace {

std::vector<int> Items(const PersistentVector<int>& vector) {
  std::vector<int> items;
  vector.ForEach([&](int item) { items.push_back(item); });
  return items;
}

void ExpectEqual(const PersistentVector<int>& vector, const std::vector<int>& expected) {
  ASSERT_EQ(vector.size(), expected.size());
  EXPECT_EQ(Items(vector), expected);
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(vector[i], expected[i]);
}

TEST(PersistentVector, GrowsThroughAllLevels) {
  PersistentVector<int> vector;
  std::vector<int> expected;
  for (int i = 0; i < 40000; ++i) {
    vector.Append(i);
    expected.push_back(i);
    ASSERT_EQ(vector.back(), i);
    if (i == 31 || i == 32 || i == 1023 || i == 1024 || i == 1056 || i == 32767 || i == 32800) {
      ExpectEqual(vector, expected);
    }
  }
  ExpectEqual(vector, expected);
}

// Any version may be changed in any order; every other one stays as it was.
TEST(PersistentVector, EveryVersionStaysAsItWas) {
  std::minstd_rand random(7);
  struct Version {
    PersistentVector<int> vector;
    std::vector<int> expected;
  };
  std::vector<Version> versions(1);
  for (int step = 0; step < 400; ++step) {
    Version next = versions[random() % versions.size()];
    const auto burst = random() % 5 == 0 ? random() % 900 : random() % 40;
    for (auto i = burst; i > 0; --i) {
      const int item = static_cast<int>(random());
      if (random() % 3 != 0 || next.expected.empty()) {
        next.vector.Append(item);
        next.expected.push_back(item);
      } else {
        const std::size_t index = random() % next.expected.size();
        next.vector.Set(index, item);
        next.expected[index] = item;
      }
    }
    versions.push_back(std::move(next));
  }
  for (const Version& version : versions) ExpectEqual(version.vector, version.expected);
}

TEST(PersistentVector, OldVersionAppendsWithoutTouchingTheNewer) {
  PersistentVector<int> base;
  for (int i = 0; i < 40; ++i) base.Append(i);
  PersistentVector<int> left = base, right = base;
  left.Append(100);
  right.Append(200);
  right.Append(201);
  EXPECT_EQ(base.size(), 40u);
  EXPECT_EQ(left[40], 100);
  EXPECT_EQ(right[40], 200);
  EXPECT_EQ(right[41], 201);
}

}  // namespace
}  // namespace tranos::model
