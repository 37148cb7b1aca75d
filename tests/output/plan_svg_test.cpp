// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/plan_svg.h"

#include <gtest/gtest.h>

#include "tests/output/models.h"

namespace tranos::output {
namespace {

using geom::Vec3;

std::string SvgOf(std::vector<model::ElementPtr> elements) {
  return PlanSvgOf(ModelOf(std::move(elements)), 100).value();
}
std::size_t Count(const std::string& text, std::string_view word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++count;
  return count;
}
model::Attributes Styled(int linestyle, int weight = 1) {
  model::Attributes attributes;
  attributes.linestyle = linestyle;
  attributes.weight = weight;
  return attributes;
}

TEST(PlanSvg, IsSeenFromTheTopWithYUpwards) {
  // The square is fitted with 5 % on each side; heights do not count.
  const std::string svg = SvgOf({LineOf(Vec3(0, 0, 7), Vec3(9, 9, 1))});
  EXPECT_NE(svg.find("d=\"M5 95L95 5\""), svg.npos) << svg;
}

TEST(PlanSvg, WhatMeetsGoesOnAndCloses) {
  const Vec3 a(0, 0, 0), b(9, 0, 0), c(9, 9, 0), d(0, 9, 0);
  const std::string svg = SvgOf({LineOf(a, b), LineOf(c, b), LineOf(c, d), LineOf(a, d)});
  EXPECT_NE(svg.find("d=\"M5 95L95 95L95 5L5 5Z\""), svg.npos) << svg;
}

TEST(PlanSvg, EachStyleIsAPathOfItsOwn) {
  const Vec3 a(0, 0, 0), b(9, 0, 0), c(9, 9, 0);
  const std::string svg =
      SvgOf({LineOf(a, b), LineOf(b, c, Styled(2)), LineOf(a, c, Styled(2, 2))});
  EXPECT_EQ(Count(svg, "<path"), 3u);
  EXPECT_EQ(Count(svg, "stroke-dasharray=\"8 5\""), 1u);
  EXPECT_EQ(Count(svg, "stroke-dasharray=\"16 10\""), 1u);  // dashes grow with the weight
  EXPECT_EQ(Count(svg, "stroke-width=\"2\""), 1u);
}

TEST(PlanSvg, ACircleKeepsToItsChordTolerance) {
  const auto circle = std::make_shared<const geom::Curve>(
      *geom::ArcThrough(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0)));
  const std::string svg = SvgOf({ElementOf(circle)});
  EXPECT_GT(Count(svg, "L"), 15u);
  EXPECT_LT(Count(svg, "L"), 60u);
}

TEST(PlanSvg, SurfacesAndHiddenLevelsAreLeftOut) {
  EXPECT_EQ(Count(SvgOf({SphereOf()}), "<path"), 0u);
  model::Edit edit;
  edit.added = {LineOf(Vec3(0, 0, 0), Vec3(1, 1, 0))};
  edit.hidden_levels = {"1"};
  const model::Model hidden = model::Apply(model::State{}, edit).state.model;
  EXPECT_EQ(Count(PlanSvgOf(hidden, 100).value(), "<path"), 0u);
  EXPECT_EQ(Count(PlanSvgOf(model::Model{}, 100).value(), "</svg>"), 1u);
}

}  // namespace
}  // namespace tranos::output
