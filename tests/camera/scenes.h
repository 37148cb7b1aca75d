// SPDX-License-Identifier: GPL-3.0-or-later
// A building with everything on it that can be traced, photographed by a stated camera, and normal
// noise that is the same on every machine.
#pragma once

#include <random>

#include "camera/traces.h"
#include "tests/camera/cuboid.h"

namespace tranos::camera::scenes {

// Normal numbers by Box and Muller.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}
  double Draw() {
    const auto uniform = [&] {
      return (static_cast<double>(engine_() >> 11) + 0.5) / 9007199254740992.0;
    };
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * kPi * uniform());
  }
  Vec2 Draw2() {
    const double x = Draw();
    return {x, Draw()};
  }

 private:
  std::mt19937_64 engine_;
};

inline Vec2 DotOf(const Camera& camera, const Frame& frame, const Vec3& point_m) {
  return frame.DotFromPoint(Project(camera, point_m).point_mm);
}

// Collects numbers that do not depend on unknowns.
struct NumberList {
  std::vector<double> values;

  NumberIndex Add(const Vec3& p) {
    values.insert(values.end(), {p.x(), p.y(), p.z()});
    return static_cast<int>(values.size()) - 3;
  }
  NumberIndex Add(double x) {
    values.push_back(x);
    return static_cast<int>(values.size()) - 1;
  }
  Numbers numbers(int unknowns = 0) const {
    const auto n = static_cast<Eigen::Index>(values.size());
    return {Eigen::Map<const Eigen::VectorXd>(values.data(), n),
            Eigen::MatrixXd::Zero(n, unknowns)};
  }
};

// A line of two dots with deviation `sigma_px` each, moved across by noise that suits it.
inline ImageLine LineOf(const Vec2& a_px, const Vec2& b_px, double sigma_px) {
  return {a_px, b_px, sigma_px / std::sqrt(2.0), sigma_px * std::sqrt(2.0)};
}

// On an upright facade through `origin_m`, turned by `azimuth_rad` from X.
struct Wall {
  Vec3 origin_m;
  double azimuth_rad;
  int facade;

  Vec3 At(double right, double up) const {
    return origin_m + right * Vec3(std::cos(azimuth_rad), std::sin(azimuth_rad), 0) +
           Vec3(0, 0, up);
  }
};

struct Scene {
  Camera truth;
  Photograph photograph;
  NumberList list;
  double sigma_px = 0.5;

  Vec2 Dot(const Vec3& p) const { return DotOf(truth, photograph.frame, p); }
  void Edge(const Vec3& from, const Vec3& to) {
    photograph.traces.emplace_back(
        EdgeTrace{LineOf(Dot(from), Dot(to), sigma_px), list.Add(from), list.Add(to)});
  }
  void Direction(const Vec3& from, const Vec3& to, int axis) {
    photograph.traces.emplace_back(DirectionTrace{LineOf(Dot(from), Dot(to), sigma_px), axis});
  }
  void Point(const Vec3& at) {
    photograph.traces.emplace_back(PointTrace{Dot(at), sigma_px, list.Add(at)});
  }
  void Rectangle(const Wall& wall, double right, double up, double a, double b) {
    photograph.traces.emplace_back(
        RectangleTrace{{Dot(wall.At(right, up)), Dot(wall.At(right + a, up)),
                        Dot(wall.At(right + a, up + b)), Dot(wall.At(right, up + b))},
                       sigma_px,
                       list.Add(a),
                       list.Add(b),
                       wall.facade});
  }
  // A horizontal edge and an upright one elsewhere.
  void Ratio(const Wall& wall, double right, double up, double a, double b) {
    photograph.traces.emplace_back(
        RatioTrace{{Dot(wall.At(right, up)), Dot(wall.At(right + a, up)),
                    Dot(wall.At(right + a + 0.5, up)), Dot(wall.At(right + a + 0.5, up + b))},
                   sigma_px,
                   list.Add(a / b),
                   wall.facade});
  }
  void Circle(const Wall& wall, double right, double up, double radius, int dots) {
    CircleTrace circle{{}, sigma_px, wall.facade};
    for (int i = 0; i < dots; ++i) {
      const double t = 0.3 + 2 * kPi * i / dots;
      circle.dots_px.push_back(
          Dot(wall.At(right + radius * std::cos(t), up + radius * std::sin(t))));
    }
    photograph.traces.emplace_back(circle);
  }
  // Half a circle of height `rise` over `span`, traced at every third of its chords' middles.
  void Arch(const Wall& wall, double right, double up, double radius, int chords) {
    CurveTrace curve{{}, sigma_px, 0, chords + 1};
    std::vector<Vec3> points;
    for (int i = 0; i <= chords; ++i) {
      const double t = kPi * i / chords;
      points.push_back(wall.At(right - radius * std::cos(t), up + radius * std::sin(t)));
      const NumberIndex index = list.Add(points.back());
      if (i == 0) curve.first = index;
    }
    for (int i = 0; i + 1 < static_cast<int>(points.size()); i += 3) {
      curve.dots_px.push_back(0.5 * (Dot(points[i]) + Dot(points[i + 1])));
    }
    photograph.traces.emplace_back(curve);
  }
};

// The main front y = 0 and an east front, seen from the right, with one of everything. The camera
// is skewed, off-centre and tilted.
inline Scene Townhouse(double sigma_px = 0.5) {
  Scene s;
  s.sigma_px = sigma_px;
  s.truth.parameters << 34, 1.02, 0.4, -0.7, 89.2 * kPi / 180, 9 * kPi / 180, 24 * kPi / 180,
      1.1 * kPi / 180, 16, -24, 1.7;
  const Wall front{Vec3(0, 0, 0), 0, 0}, east{Vec3(10, 0, 0), kPi / 2, 1};
  s.Edge({0, 0, 0}, {10, 0, 0});
  s.Edge({10, 0, 0}, {10, 0, 8});
  s.Edge({0, 0, 8}, {10, 0, 8});
  s.Edge({0, 0, 0}, {0, 0, 8});
  s.Edge({10, 0, 8}, {10, 12, 8});
  s.Direction({10, 0, 4}, {10, 12, 4}, 1);
  s.Direction({1, 0, 5}, {9, 0, 5}, 0);
  s.Direction({10, 6, 0}, {10, 6, 8}, 2);
  s.Point({5, 0, 11});
  s.Point({10, 12, 0});
  s.Rectangle(front, 1, 1, 2, 3);
  s.Rectangle(east, 2, 1, 1.5, 2.5);
  s.Ratio(east, 5, 4, 2, 1.5);
  s.Circle(front, 6, 6, 1, 7);
  s.Arch(front, 5, 1, 1.2, 24);
  return s;
}

}  // namespace tranos::camera::scenes
