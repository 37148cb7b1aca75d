// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn through a calibrated photograph lies within its stated deviations: the same
// building photographed with other noise each time, as scripts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "interp/run.h"
#include "tests/camera/scenes.h"

namespace tranos::interp {
namespace {

using camera::Vec2;
using camera::Vec3;
using camera::scenes::Noise;

constexpr double kNoise_px = 0.5;

// A script about a house of 10 m by 12 m by 8 m, each of its dots with noise of its own.
class House {
 public:
  explicit House(std::uint64_t seed) : noise_(seed) {
    truth_.parameters << 34, 1.02, 0.4, -0.7, 1.557, 0.157, 0.42, 0.02, 16, -24, 1.7;
    text_ = "attach photo \"house.png\" format=36mm,24mm as house\n";
    const Vec3 corners[] = {{0, 0, 0}, {10, 0, 0}, {10, 0, 8}, {0, 0, 8}, {10, 12, 0}, {10, 12, 8}};
    constexpr int kEdges[][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {1, 4}, {2, 5}, {4, 5}};
    for (const auto& [from, to] : kEdges) {
      text_ += fmt::format("trace edge from={} to={} {} {}\n", Point(corners[from]),
                           Point(corners[to]), Dot(corners[from]), Dot(corners[to]));
    }
    for (const auto& [name, origin, right] : {std::tuple{"front", Vec3(1, 0, 1), Vec3(1, 0, 0)},
                                              std::tuple{"east", Vec3(10, 2, 1), Vec3(0, 1, 0)}}) {
      text_ += fmt::format("trace rectangle a=2 b=3 facade={} {} {} {} {}\n", name, Dot(origin),
                           Dot(origin + 2 * right), Dot(origin + 2 * right + Vec3(0, 0, 3)),
                           Dot(origin + Vec3(0, 0, 3)));
    }
    text_ += "calibrate\n";
  }

  std::string Dot(const Vec3& p) {
    const Vec2 dot = camera::scenes::DotOf(truth_, {}, p) + kNoise_px * noise_.Draw2();
    return fmt::format("dot={:.9f},{:.9f}", dot.x(), dot.y());
  }
  House& operator<<(const std::string& text) {
    text_ += text + "\n";
    return *this;
  }

  void Measure(const std::string& name, const std::string& of) {
    *this << fmt::format("let {0} = ({1}).value\nlet {0}_sigma = ({1}).sigma", name, of);
  }

  // The script's numbers, by name.
  std::map<std::string, double> Numbers() const {
    RunOptions options;
    options.photographs.by_path["house.png"] = {{}, {3600, 2400}};
    const ScriptResult result = RunScript("house.trn", text_, {}, options, {});
    for (const Diagnostic& told : result.diagnostics.list()) ADD_FAILURE() << told.message;
    std::map<std::string, double> numbers;
    for (const auto& [name, value] : result.outcome.lets) numbers[name] = value.number();
    return numbers;
  }

 private:
  static std::string Point(const Vec3& p) { return fmt::format("[{},{},{}]", p.x(), p.y(), p.z()); }
  camera::Camera truth_;
  Noise noise_;
  std::string text_;
};

TEST(Drawn, LiesWithinItsDeviations) {
#ifdef TRANOS_SANITIZED
  constexpr int kSeeds = 20;
#else
  constexpr int kSeeds = 400;
#endif
  const std::map<std::string, double> truth = {{"width", 5},
                                               {"right", 8},
                                               {"depth", 0},
                                               {"area", 6},
                                               {"radius", 1},
                                               {"turn", camera::kPi / 2},
                                               {"across", std::sqrt(20.0)}};
  std::map<std::string, double> covered, squares;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    House house(static_cast<std::uint64_t>(seed));
    house << "set facade front"
          << "place line " + house.Dot({2, 0, 5}) + " " + house.Dot({7, 0, 5}) + " as sill"
          << "place point " + house.Dot({8, 0, 6}) + " as p"
          << "place shape " + house.Dot({3, 0, 1}) + " " + house.Dot({5, 0, 1}) + " " +
                 house.Dot({5, 0, 4}) + " " + house.Dot({3, 0, 4}) + " as door"
          << "place circle edge " + house.Dot({7, 0, 3}) + " " + house.Dot({8, 0, 4}) + " " +
                 house.Dot({9, 0, 3}) + " as oculus"
          << "set facade east"
          << "place line " + house.Dot({10, 3, 5}) + " " + house.Dot({10, 9, 5}) + " as string"
          << "place point " + house.Dot({10, 4, 6}) + " as q";
    house.Measure("width", "sill.length");
    house.Measure("right", "p.position.x");
    house.Measure("depth", "p.position.y");
    house.Measure("area", "door.area");
    house.Measure("radius", "oculus.radius");
    house.Measure("turn", "angle(sill, string)");
    house.Measure("across", "distance(p, q)");
    const std::map<std::string, double> numbers = house.Numbers();
    for (const auto& [name, value] : truth) {
      ASSERT_TRUE(numbers.contains(name));
      const double sigma = numbers.at(name + "_sigma");
      ASSERT_GT(sigma, 0) << name;
      const double error = (numbers.at(name) - value) / sigma;
      covered[name] += std::abs(error) <= 1.96 ? 1.0 / kSeeds : 0;
      squares[name] += error * error / kSeeds;
    }
  }
  for (const auto& [name, share] : covered) {
    EXPECT_NEAR(share, 0.95, 0.03 * std::sqrt(400.0 / kSeeds)) << name;
    EXPECT_NEAR(squares[name], 1, 0.2 * std::sqrt(400.0 / kSeeds)) << name;
  }
}

}  // namespace
}  // namespace tranos::interp
