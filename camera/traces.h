// SPDX-License-Identifier: GPL-3.0-or-later
// What was traced on a photograph, as plain values, and the numbers it stands on.
//
// A trace that says where something is in space, or how long, does so by numbers that may depend on
// unknowns: lengths with a deviation, unknown depths. They stand together in `Numbers`, with their
// derivatives by the unknowns, and a trace holds the index of its first number there.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "camera/camera.h"
#include "camera/image_line.h"

namespace tranos::camera {

using NumberIndex = int;  // of the first; a point takes three

// An edge whose direction in space is known: 0, 1, 2 for X, Y, Z.
struct DirectionTrace {
  ImageLine line;
  int axis;
};

// An edge whose place in space is known.
struct EdgeTrace {
  ImageLine line;
  NumberIndex from;  // 3 numbers, m
  NumberIndex to;    // 3 numbers, m
};

// A curve in space (an arc, a dome's rim) as a polyline with `points` vertices; each dot lies on
// its image.
struct CurveTrace {
  std::vector<Vec2> dots_px;
  double sigma_px;
  NumberIndex first;  // 3 × points numbers, m
  int points;
};

// A control point.
struct PointTrace {
  Vec2 dot_px;
  double sigma_px;
  NumberIndex at;  // 3 numbers, m
};

// A rectangle on a facade: dots anticlockwise from bottom left, a along X, b along Z.
struct RectangleTrace {
  Vec2 dots_px[4];
  double sigma_px;
  NumberIndex a;  // m
  NumberIndex b;  // m
  int facade;
};

// Two orthogonal edges in a facade, the first `ratio` times as long as the second: dots 0–1 and
// 2–3.
struct RatioTrace {
  Vec2 dots_px[4];
  double sigma_px;
  NumberIndex ratio;
  int facade;
};

// A circle in a facade, its centre and radius not known.
struct CircleTrace {
  std::vector<Vec2> dots_px;  // five or more
  double sigma_px;
  int facade;
};

using Trace = std::variant<DirectionTrace, EdgeTrace, CurveTrace, PointTrace, RectangleTrace,
                           RatioTrace, CircleTrace>;

// The numbers that traces stand on, for some values of the unknowns.
struct Numbers {
  Eigen::VectorXd values;
  Eigen::MatrixXd by_unknown;  // a row for each number, a column for each unknown
};

// Something that the adjustment solves for, besides the camera.
struct Unknown {
  std::string name;
  double start;
  double sigma = 0;  // of its prior around `start`; 0: none
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string words = {};  // of one without a name: "14 m ± 0.14 m"
};

// What is assumed of the camera beforehand: a value with a deviation; sigma 0: nothing is.
struct Prior {
  double value = 0;
  double sigma = 0;
};

// A photograph with all that was traced on it. Facade 0 is the plane y = 0 if `world_is_fixed` is
// false: then the origin is the first dot of its first rectangle. All others, and every facade
// where the world is fixed by points or edges, are upright planes whose place is to be found.
struct Photograph {
  std::string name;
  Frame frame;
  std::vector<Trace> traces;
  Prior priors[kIntrinsics];
};

}  // namespace tranos::camera
