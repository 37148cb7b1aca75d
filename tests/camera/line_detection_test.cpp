// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/line_detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace tranos::camera {
namespace {

using Brightness = std::function<double(const Vec2&)>;  // 0 to 255, at a dot

// Each pixel the mean of 3 × 3 places in it; with normal noise of so many levels.
Photo Drawn(int width, int height, const Brightness& brightness, double noise = 0,
            std::uint64_t seed = 1) {
  constexpr int kParts = 3;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Photo photo{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = 0; j < kParts; ++j) {
        for (int i = 0; i < kParts; ++i)
          sum += brightness({x - 0.5 + (i + 0.5) / kParts, y - 0.5 + (j + 0.5) / kParts});
      }
      const double level = sum / (kParts * kParts) + noise * normal(random);
      photo.rgb.insert(photo.rgb.end(), 3,
                       static_cast<std::uint8_t>(std::clamp(std::round(level), 0.0, 255.0)));
    }
  }
  return photo;
}

struct Bar {
  Vec2 a, b;
  double width;

  Vec2 along() const { return (b - a).normalized(); }
  Vec2 across() const { return {-along().y(), along().x()}; }
  double length() const { return (b - a).norm(); }
  // From 0 outside to 1 inside, as a lens blurs it.
  double Cover(const Vec2& p) const {
    constexpr double kBlur_px = 0.6;
    const auto step = [](double inside) {
      return 0.5 * std::erfc(-inside / (kBlur_px * std::sqrt(2)));
    };
    const double t = along().dot(p - a), s = across().dot(p - a);
    return step(t) * step(length() - t) * step(0.5 * width - std::abs(s));
  }
};

Bar BarAt(double degrees, const Vec2& centre = {150.3, 99.8}, double length = 160) {
  const double angle = degrees * kPi / 180;
  const Vec2 half = 0.5 * length * Vec2(std::cos(angle), std::sin(angle));
  return {centre - half, centre + half, 40};
}

Brightness Picture(const Bar& bar) {
  return [bar](const Vec2& p) { return 60 + 130 * bar.Cover(p); };
}

// Where a line is, seen from a long edge of the bar: offset of its centre and tilt over its length.
struct Off {
  double centre, tilt, past_end;
};
Off OffEdge(const ImageLine& line, const Bar& bar, double side) {
  const auto off = [&](const Vec2& p) {
    return bar.across().dot(p - bar.a) - 0.5 * side * bar.width;
  };
  const double from = bar.along().dot(line.a_px - bar.a), to = bar.along().dot(line.b_px - bar.a);
  return {off(line.centre_px()), off(line.b_px) - off(line.a_px),
          std::max(std::abs(std::min(from, to)), std::abs(std::max(from, to) - bar.length()))};
}

// Those along the bar.
std::vector<ImageLine> LongEdges(const std::vector<ImageLine>& lines, const Bar& bar) {
  std::vector<ImageLine> found;
  std::ranges::copy_if(lines, std::back_inserter(found), [&](const ImageLine& line) {
    return line.length_px() > 0.5 * bar.length() &&
           std::abs((line.b_px - line.a_px).normalized().dot(bar.across())) < 0.05;
  });
  return found;
}

double SideOf(const ImageLine& line, const Bar& bar) {
  return bar.across().dot(line.centre_px() - bar.a) > 0 ? 1 : -1;
}

TEST(DetectLines, FindsTheEdgesOfABarOnceEachAndToAPartOfAPixel) {
  for (const double degrees : {0.0, 3.0, 17.5, 45.0, 71.0, 90.0, 128.0}) {
    const Bar bar = BarAt(degrees);
    const auto lines = DetectLines(Drawn(300, 200, Picture(bar)));
    ASSERT_TRUE(lines);
    EXPECT_EQ(lines->size(), 4u) << degrees;
    const auto edges = LongEdges(*lines, bar);
    ASSERT_EQ(edges.size(), 2u) << degrees;
    EXPECT_NE(SideOf(edges[0], bar), SideOf(edges[1], bar));
    for (const ImageLine& line : edges) {
      const Off off = OffEdge(line, bar, SideOf(line, bar));
      EXPECT_LT(std::abs(off.centre), 0.03) << degrees;
      EXPECT_LT(std::abs(off.tilt), 0.05) << degrees;
      EXPECT_LT(off.past_end, 15) << degrees;  // corners are rounded
    }
  }
}

// Errors over stated deviations, two for each edge: their mean square is 1 for normal numbers.
TEST(DetectLines, StatesDeviationsThatItsErrorsHave) {
  for (const double noise : {3.0, 10.0}) {
    double centre = 0, tilt = 0;
    int edges = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      const Bar bar = BarAt(10 + 0.7 * static_cast<double>(seed));
      const auto lines = DetectLines(Drawn(300, 200, Picture(bar), noise, seed));
      ASSERT_TRUE(lines);
      for (const ImageLine& line : LongEdges(*lines, bar)) {
        const Off off = OffEdge(line, bar, SideOf(line, bar));
        centre += std::pow(off.centre / line.centre_sigma_px, 2);
        tilt += std::pow(off.tilt / line.tilt_sigma_px, 2);
        ++edges;
      }
    }
    EXPECT_EQ(edges, 120) << noise;
    // χ² of 120 degrees of freedom over that is within 0.66 and 1.4 in 99.5 %; deviations that are
    // themselves estimated widen it.
    EXPECT_GT(centre / edges, 0.7) << noise;
    EXPECT_LT(centre / edges, 1.4) << noise;
    EXPECT_GT(tilt / edges, 0.7) << noise;
    EXPECT_LT(tilt / edges, 1.4) << noise;
  }
}

TEST(DetectLines, JoinsTheLineBehindAPostAndKeepsParallelOnesApart) {
  const Bar bar{{20, 100}, {280, 100}, 60};
  const Brightness with_post = [&](const Vec2& p) {
    return p.x() > 130 && p.x() < 150 ? 120.0 : 60 + 130 * bar.Cover(p);
  };
  const auto lines = DetectLines(Drawn(300, 200, with_post));
  ASSERT_TRUE(lines);
  const auto edges = LongEdges(*lines, bar);
  ASSERT_EQ(edges.size(), 2u);
  for (const ImageLine& line : edges) EXPECT_GT(line.length_px(), 240);

  // Two edges four pixels apart, the same side bright, are two.
  const Brightness steps = [](const Vec2& p) {
    return p.y() < 90 ? 40.0 : p.y() < 94 ? 110.0 : 180.0;
  };
  const auto apart = DetectLines(Drawn(300, 200, steps));
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->size(), 2u);
}

TEST(DetectLines, FindsNothingWhereNothingIsStraight) {
  const auto blank = DetectLines(Drawn(200, 150, [](const Vec2&) { return 128.0; }));
  ASSERT_TRUE(blank);
  EXPECT_TRUE(blank->empty());
  const auto ramp = DetectLines(Drawn(200, 150, [](const Vec2& p) { return 50 + 0.3 * p.x(); }));
  ASSERT_TRUE(ramp);
  EXPECT_TRUE(ramp->empty());
  const auto noise = DetectLines(Drawn(
      300, 300, [](const Vec2&) { return 128.0; }, 20));
  ASSERT_TRUE(noise);
  // By chance some pieces of it are straight, but none far.
  for (const ImageLine& line : *noise) EXPECT_LT(line.length_px(), 30);
}

TEST(DetectLines, RefusesWhatIsTooSmallAndTakesTheSmallest) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(15, 200), std::pair(200, 15)}) {
    const auto lines = DetectLines(Drawn(width, height, [](const Vec2&) { return 0.0; }));
    ASSERT_FALSE(lines);
    EXPECT_EQ(lines.error().code, geom::ErrorCode::kOutOfRange);
  }
  for (const auto& [width, height] : {std::pair(16, 16), std::pair(9000, 20)}) {
    const auto lines =
        DetectLines(Drawn(width, height, [](const Vec2& p) { return p.x() > 8 ? 200 : 20; }));
    EXPECT_TRUE(lines);
  }
}

TEST(DetectLines, OfALargePhotographAreInItsOwnPixels) {
  const Bar bar{{400, 200}, {2000, 260}, 200};
  const auto lines = DetectLines(Drawn(2400, 500, Picture(bar)));
  ASSERT_TRUE(lines);
  const auto edges = LongEdges(*lines, bar);
  ASSERT_EQ(edges.size(), 2u);
  for (const ImageLine& line : edges) {
    const Off off = OffEdge(line, bar, SideOf(line, bar));
    EXPECT_LT(std::abs(off.centre), 0.05);
    EXPECT_LT(std::abs(off.tilt), 0.1);
  }
}

TEST(DetectLines, OfOnePhotographAreTheSameAndSortedByLength) {
  const Photo photo = Drawn(300, 200, Picture(BarAt(31)), 8);
  const auto first = DetectLines(photo), second = DetectLines(photo);
  ASSERT_TRUE(first && second);
  ASSERT_EQ(first->size(), second->size());
  for (std::size_t i = 0; i < first->size(); ++i) {
    EXPECT_EQ((*first)[i].a_px, (*second)[i].a_px);
    EXPECT_EQ((*first)[i].tilt_sigma_px, (*second)[i].tilt_sigma_px);
    if (i == 0) continue;
    EXPECT_LE((*first)[i].length_px(), (*first)[i - 1].length_px());
  }
}

}  // namespace
}  // namespace tranos::camera
