// SPDX-License-Identifier: GPL-3.0-or-later
#include "elements.h"

namespace tranos::interp {
namespace {

TEST(Member, OfPlainValues) {
  Bench bench;
  ExpectSame(bench.Get(P(1, 2, 3), "z"), M(3));
  ExpectSame(bench.Get(L({N(1), N(2)}), "y"), N(2));
  ExpectSame(bench.Get(R(1, 2, model::kLength), "to"), M(2));
  ExpectSame(bench.Get(Value::Plane({}), "normal"), L({N(0), N(0), N(1)}));
  ExpectSame(bench.Get(Value::Plane(At({1, 2, 3})), "origin"), P(1, 2, 3));
  const auto failure = [&](const Value& value, std::string_view name) {
    return FailureOf([&] { bench.Get(value, name); });
  };
  EXPECT_EQ(failure(L({N(1), N(2)}), "z").code, Code::kUnknownMember);
  EXPECT_EQ(failure(L({S("a"), S("b")}), "x").code, Code::kUnknownMember);
  EXPECT_EQ(failure(S("a"), "length").code, Code::kUnknownMember);
  EXPECT_EQ(failure(Value(), "x").code, Code::kUnknownMember);
  EXPECT_NE(failure(N(1), "valeu").help.find("did you mean `value`?"), std::string::npos);
  EXPECT_NE(failure(L({LineOf({0, 0, 0}, {1, 0, 0})}), "length").help.find("list[0]"),
            std::string::npos);
}

TEST(Member, MeasuresAndSnapsOfCurves) {
  Bench bench;
  const Value line = LineOf({0, 0, 0}, {4, 0, 0});
  ExpectSame(bench.Get(line, "length"), M(4));
  ExpectSame(bench.Get(line, "start"), P(0, 0, 0));
  ExpectSame(bench.Get(line, "end"), P(4, 0, 0));
  ExpectSame(bench.Get(line, "mid"), P(2, 0, 0));
  ExpectSame(bench.Get(line, "direction"), L({N(1), N(0), N(0)}));
  ExpectSame(bench.Get(line, "type"), S("line"));
  ExpectSame(bench.Get(line, "colour"), N(0));
  ExpectSame(bench.Get(line, "evidence"), S(""));
  ExpectSame(bench.Get(bench.Get(bench.Get(line, "bbox"), "max"), "x"), M(4));
  ExpectSame(bench.Get(bench.Get(line, "bbox"), "size"), P(4, 0, 0));
  const Value arc = ArcOf({1, 2, 3}, 5, 1.5);
  ExpectSame(bench.Get(arc, "centre"), P(1, 2, 3));
  ExpectSame(bench.Get(arc, "radius"), M(5));
  ExpectSame(bench.Get(arc, "sweep"), Value::Number(1.5, model::kAngle));
  const Value square = ShapeOf({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  EXPECT_LT((PointOf(bench.Get(square, "centroid")) - geom::Vec3(1, 1, 0)).norm(), 1e-12);
  EXPECT_EQ(bench.Get(square, "vertices").list().size(), 4u);
  ExpectSame(bench.Get(PointOfElement({1, 2, 3}), "position"), P(1, 2, 3));
}

TEST(Member, RefusesWhatIsNotThere) {
  Bench bench;
  const Value line = LineOf({0, 0, 0}, {4, 0, 0});
  const auto failure = [&](const Value& value, std::string_view name) {
    return FailureOf([&] { bench.Get(value, name); });
  };
  const OpFailure unknown = failure(line, "lenght");
  EXPECT_EQ(unknown.code, Code::kUnknownMember);
  EXPECT_NE(unknown.help.find("did you mean `length`?"), std::string::npos) << unknown.help;
  EXPECT_NE(unknown.help.find("mid"), std::string::npos) << unknown.help;
  EXPECT_EQ(failure(line, "volume").code, Code::kNotClosed);
  EXPECT_EQ(failure(line, "area").code, Code::kNotClosed);
  EXPECT_EQ(failure(line, "radius").code, Code::kUnknownMember);
  EXPECT_EQ(failure(line, "plane").code, Code::kNotPlanar);
  EXPECT_EQ(failure(GroupOf({}), "bbox").code, Code::kWrongElement);
}

TEST(CallMember, GivesPointsAlong) {
  Bench bench;
  const Value line = LineOf({0, 0, 0}, {4, 0, 0});
  ExpectSame(bench.GetCall(line, "at", {N(0.25)}), P(1, 0, 0));
  EXPECT_EQ(FailureOf([&] { bench.GetCall(line, "at", {N(2)}); }).code, Code::kOutOfRange);
  EXPECT_EQ(FailureOf([&] { bench.GetCall(line, "at", {}); }).code, Code::kWrongCount);
  EXPECT_EQ(FailureOf([&] { bench.GetCall(line, "length", {}); }).code, Code::kWrongType);
  EXPECT_EQ(FailureOf([&] {
              bench.GetCall(line, "point", {N(0), N(0)});
            }).code,
            Code::kUnknownMember);
  const Value floor = RuledOf({{0, 0, 0}, {4, 0, 0}}, {{0, 3, 0}, {4, 3, 0}});
  EXPECT_LT((PointOf(bench.GetCall(floor, "point", {N(1), N(1)})) - geom::Vec3(4, 3, 0)).norm(),
            1e-12);
  EXPECT_NEAR(std::abs(bench.GetCall(floor, "normal", {N(0.5), N(0.5)}).list()[2].number()), 1,
              1e-12);
}

// A placed element: twice as large, and moved.
Value Placed() {
  model::Prototype prototype;
  prototype.words = "arch";
  const model::ElementPtr sill = LineOf({0, 0, 0}, {4, 0, 0}).element();
  prototype.parts = {sill};
  prototype.names = {{"sill", {sill}, false}, {"steps", {sill, sill}, true}};
  prototype.parameters = {{"span", M(4)}};
  model::Interface crown{
      "crown", At({2, 0, 1}), {{"radius", M(3)}, {"opening", M2(2)}, {"sides", N(8)}}};
  prototype.interfaces = {crown};
  geom::Affine world_from_prototype = geom::Affine::Identity();
  world_from_prototype.translate(geom::Vec3(10, 0, 0));
  world_from_prototype.scale(2);
  return Value::OfElement(Made(std::make_shared<const model::Instance>(
      model::Instance{model::MakePrototype(std::move(prototype)), world_from_prototype})));
}

TEST(Member, OfPlacedElements) {
  Bench bench;
  const Value arch = Placed();
  ExpectSame(bench.Get(arch, "span"), M(4));
  const Value sill = bench.Get(arch, "sill");
  ExpectSame(bench.Get(sill, "start"), P(10, 0, 0));
  ExpectSame(bench.Get(sill, "end"), P(18, 0, 0));
  EXPECT_EQ(sill.element()->id, model::kNoElement);
  EXPECT_EQ(bench.Get(arch, "steps").list().size(), 2u);
  const Value crown = bench.Get(arch, "crown");
  ExpectSame(bench.Get(crown, "at"), P(14, 0, 2));
  ExpectSame(bench.Get(crown, "axis"), L({N(0), N(0), N(1)}));
  ExpectSame(bench.Get(crown, "radius"), M(6));
  ExpectSame(bench.Get(crown, "opening"), M2(8));
  ExpectSame(bench.Get(crown, "sides"), N(8));
  ExpectSame(bench.Get(arch, "length"), M(8));
  ExpectSame(bench.Get(bench.GetCall(arch, "face", {S("crown")}), "name"), S("crown"));
  EXPECT_EQ(FailureOf([&] { bench.GetCall(arch, "face", {S("crwn")}); }).code,
            Code::kUnknownMember);
  EXPECT_EQ(FailureOf([&] { bench.Get(crown, "radios"); }).code, Code::kUnknownMember);
  EXPECT_EQ(Describe(crown), "an interface");
}

TEST(CurrentElement, FollowsTheModel) {
  Bench bench;
  model::Edit add;
  add.added = {LineOf({0, 0, 0}, {4, 0, 0}).element()};
  model::Applied applied = model::Apply(bench.state, add);
  const model::ElementPtr named = applied.state.model.Current(0);
  model::Edit change;
  change.replaced = {model::WithGeometry(*named, LineOf({0, 0, 0}, {9, 0, 0}).element()->geometry)};
  bench.state = model::Apply(applied.state, change).state;
  ExpectSame(bench.Get(Value::OfElement(named), "length"), M(9));
  EXPECT_TRUE(
      bench.Op2(Op::kEqual, Value::OfElement(named), Value::OfElement(bench.state.model.Current(0)))
          .boolean());
  model::Edit consume;
  consume.consumed = {0};
  bench.state = model::Apply(bench.state, consume).state;
  ExpectSame(bench.Get(Value::OfElement(named), "length"), M(9));  // its geometry is still there
  model::Edit remove;
  remove.deleted = {0};
  bench.state = model::Apply(applied.state, remove).state;
  EXPECT_EQ(FailureOf([&] { bench.Get(Value::OfElement(named), "length"); }).code,
            Code::kNoLongerThere);
}

TEST(Member, OfGroups) {
  Bench bench;
  const Value group =
      GroupOf({{"x", LineOf({0, 0, 0}, {4, 0, 0})}, {"y", LineOf({0, 0, 0}, {0, 3, 0})}});
  ExpectSame(bench.Get(bench.Get(group, "y"), "length"), M(3));
  ExpectSame(bench.Get(group, "length"), M(7));
  EXPECT_NE(FailureOf([&] { bench.Get(group, "z"); }).help.find("it has x, y, length"),
            std::string::npos);
}

TEST(Member, StretchedInterfacesHaveNoLengths) {
  Bench bench;
  const model::ElementPtr placed = Placed().element();
  geom::Affine stretch = geom::Affine::Identity();
  stretch.linear().diagonal() << 1, 2, 1;
  const Value arch = Value::OfElement(model::Transformed(*placed, stretch));
  const Value crown = bench.Get(arch, "crown");
  ExpectSame(bench.Get(crown, "sides"), N(8));
  EXPECT_EQ(FailureOf([&] { bench.Get(crown, "radius"); }).code, Code::kUnknownMember);
}

}  // namespace
}  // namespace tranos::interp
