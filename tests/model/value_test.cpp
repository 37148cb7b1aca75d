// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/value.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/model/shapes.h"

namespace tranos::model {
namespace {

std::vector<Value> OneOfEachKind() {
  return {Value(),
          Value::Number(2, kLength),
          Value::Boolean(true),
          Value::Uncertain({2, {{{1, 0.5}}}}, kLength),
          Value::String("apse"),
          Value::List({Value::Number(1), Value::String("a")}),
          Value::Range({1, 2}, kLength),
          Value::Plane({}),
          Value::OfElement(MakePoint(1)),
          Value::OfClosure({std::make_shared<const int>(1)})};
}

Hash128 HashOfValue(const Value& value) {
  Hasher hasher;
  AddToHash(hasher, value);
  return hasher.Finish();
}

TEST(Value, EachKindEqualsItsCopiesOnly) {
  const std::vector<Value> values = OneOfEachKind();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Value copy = values[i];
    for (std::size_t j = 0; j < values.size(); ++j) {
      EXPECT_EQ(Same(copy, values[j]), i == j) << i << " " << j;
      EXPECT_EQ(HashOfValue(copy) == HashOfValue(values[j]), i == j) << i << " " << j;
    }
  }
}

TEST(Value, KeepsWhatItWasMadeOf) {
  const std::vector<Value> values = OneOfEachKind();
  EXPECT_EQ(values[1].number(), 2);
  EXPECT_EQ(values[1].dimension(), kLength);
  EXPECT_EQ(values[1].derivatives(), nullptr);
  EXPECT_TRUE(values[2].boolean());
  EXPECT_EQ(values[3].number(), 2);
  EXPECT_EQ(values[3].derivatives()->terms[0].second, 0.5);
  EXPECT_EQ(values[4].string(), "apse");
  EXPECT_EQ(values[5].list()[1].string(), "a");
  EXPECT_EQ(values[6].range().to, 2);
  EXPECT_EQ(values[7].plane().x, geom::Vec3::UnitX());
  EXPECT_EQ(TypeOf(*values[8].element()), "point");
  EXPECT_EQ(Value::OfPoint({1, 2, 3}).list()[2].number(), 3);
  EXPECT_EQ(Value::OfPoint({1, 2, 3}).list()[2].dimension(), kLength);
}

TEST(Value, CopiesShareAndTheLastOneFrees) {
  const auto code = std::make_shared<const int>(1);
  {
    Value a = Value::OfClosure({code});
    Value b = a;
    Value c = std::move(a);
    EXPECT_TRUE(a.is_none());  // NOLINT(bugprone-use-after-move): a moved-from value is nothing
    EXPECT_EQ(code.use_count(), 2);
    b = c;
    b = Value::List({b, c});
    c = Value::Number(1);
    EXPECT_EQ(code.use_count(), 2);
    const Value& alias = b;
    b = alias;
    b = Value(b.list()[0]);  // the list dies while one of its items is assigned
    EXPECT_EQ(code.use_count(), 2);
    b = Value();
    EXPECT_EQ(code.use_count(), 1);
  }
  EXPECT_EQ(code.use_count(), 1);
}

TEST(Value, AssignmentFromAnItemOfItself) {
  Value list = Value::List({Value::String("inner"), Value::String("other")});
  list = list.list()[0];
  EXPECT_EQ(list.string(), "inner");
}

TEST(Value, DeepFunctionsAndRecordsAreFreedWithoutRecursion) {
  const auto code = std::make_shared<const int>(1);
  Value value = Value::Number(1);
  for (int i = 0; i < 300'000; ++i) {
    value = Value::OfClosure({code, {std::move(value)}});
    value = Value::OfRecord({"nested", {{"inner", std::move(value)}}});
  }
  EXPECT_EQ(code.use_count(), 300'001);
  value = {};
  EXPECT_EQ(code.use_count(), 1);
}

TEST(Value, DeepNestingIsNoRecursion) {
  const auto nest = [] {
    Value value = Value::String("core");
    for (int i = 0; i < 500000; ++i) value = Value::List({std::move(value), Value::Number(i)});
    return value;
  };
  Value a = nest();
  const Value b = nest();
  EXPECT_TRUE(Same(a, b));
  EXPECT_EQ(HashOfValue(a), HashOfValue(b));
  const Value middle = a.list()[0].list()[0];
  a = Value();
  EXPECT_EQ(middle.list().size(), 2u);
}

TEST(Value, ListStructureIsInTheHash) {
  const Value one = Value::Number(1), two = Value::Number(2);
  const Value left = Value::List({Value::List({one}), two});
  const Value right = Value::List({Value::List({one, two})});
  EXPECT_FALSE(Same(left, right));
  EXPECT_NE(HashOfValue(left), HashOfValue(right));
}

TEST(Dimension, IsDescribedInWords) {
  EXPECT_EQ(Describe(kPlain), "a plain number");
  EXPECT_EQ(Describe(kLength), "a length");
  EXPECT_EQ(Describe(kArea), "an area");
  EXPECT_EQ(Describe(kVolume), "a volume");
  EXPECT_EQ(Describe(kAngle), "an angle");
  EXPECT_EQ(Describe({Dimension::kLength, 4}), "length^4");
  EXPECT_EQ(Describe({Dimension::kLength, -1}), "length^-1");
}

}  // namespace
}  // namespace tranos::model
