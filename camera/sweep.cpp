// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/sweep.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

namespace tranos::camera {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

tl::unexpected<geom::Error> Degenerate(const char* detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
}

// Four edges side by side, so that four are projected at once; the last ones may be copies without
// weight. Lines through space are Plücker's, by moment and way.
using Array4 = Eigen::Array4d;
struct FourEdges {
  std::array<Array4, 3> moment, way;
  Array4 ax, ay, bx, by;
  Array4 centre_weight, tilt_weight;
};

std::vector<FourEdges> InFours(const std::vector<SpaceEdge>& edges) {
  std::vector<FourEdges> fours((edges.size() + 3) / 4);
  for (size_t i = 0; i < 4 * fours.size(); ++i) {
    const bool is_copy = i >= edges.size();
    const SpaceEdge& e = edges[is_copy ? 0 : i];
    FourEdges& four = fours[i / 4];
    const auto k = static_cast<Eigen::Index>(i % 4);
    const Vec3 moment = e.from_m.cross(e.to_m), way = e.to_m - e.from_m;
    for (size_t axis = 0; axis < 3; ++axis) {
      four.moment[axis][k] = moment[static_cast<Eigen::Index>(axis)];
      four.way[axis][k] = way[static_cast<Eigen::Index>(axis)];
    }
    four.ax[k] = e.a.x(), four.ay[k] = e.a.y(), four.bx[k] = e.b.x(), four.by[k] = e.b.y();
    four.centre_weight[k] = is_copy ? 0 : e.centre_weight;
    four.tilt_weight[k] = is_copy ? 0 : e.tilt_weight;
  }
  return fours;
}

// As PenaltyOf (space_traces.h).
double PenaltyOf(const std::vector<FourEdges>& fours, const ConditionedCamera& camera) {
  const Mat3 to_line = camera.inverse_calibration.transpose() * camera.camera_from_world;
  const Vec3& c = camera.position_m;
  Array4 sum = Array4::Zero();
  for (const FourEdges& e : fours) {
    const auto& [mx, my, mz] = e.moment;
    const auto& [wx, wy, wz] = e.way;
    const Array4 x = mx - (c.y() * wz - c.z() * wy), y = my - (c.z() * wx - c.x() * wz),
                 z = mz - (c.x() * wy - c.y() * wx);
    const Array4 l = to_line(0, 0) * x + to_line(0, 1) * y + to_line(0, 2) * z;
    const Array4 m = to_line(1, 0) * x + to_line(1, 1) * y + to_line(1, 2) * z;
    const Array4 n = to_line(2, 0) * x + to_line(2, 1) * y + to_line(2, 2) * z;
    const Array4 a = l * e.ax + m * e.ay + n, b = l * e.bx + m * e.by + n;
    const Array4 centre = 0.5 * (a + b) * e.centre_weight, tilt = (b - a) * e.tilt_weight;
    sum += (centre * centre + tilt * tilt) / (l * l + m * m);
  }
  return sum.sum();
}

// What is the same for all angles.
struct Sweep {
  SkewFamily family;
  Mat3 axes;        // vanishing points, signed; the one not known is zero
  int third;        // that one, or −1
  bool orthogonal;  // whether the constraints hold them to be so
  Eigen::Matrix<double, 3, 9> centre_from_left;  // P's fourth column from its others
  SpaceTraces traces;                            // about `origin_m`
  std::vector<FourEdges> edges;                  // of these
  SpaceTraces points;                            // of these
  Vec3 origin_m;
};

struct Candidate {
  ConditionedCamera camera;
  double penalty = kInfinity;
};

Mat3 InverseOfUpper(const Mat3& u) {  // with last entry 1
  const double a = 1 / u(0, 0), b = 1 / u(1, 1);
  Mat3 inverse;
  inverse << a, -u(0, 1) * a * b, (u(0, 1) * u(1, 2) * b - u(0, 2)) * a,  //
      0, b, -u(1, 2) * b, 0, 0, 1;
  return inverse;
}

Candidate At(const Sweep& sweep, double alpha) {
  Candidate best;
  const SkewRoots roots = CalibrationsAtSkew(sweep.family, alpha);
  for (int i = 0; i < roots.count; ++i) {
    const Mat3& inverse = roots.inverse[static_cast<size_t>(i)];
    Mat3 r = inverse * sweep.axes;
    if (sweep.third >= 0)
      r.col(sweep.third) = r.col((sweep.third + 1) % 3).cross(r.col((sweep.third + 2) % 3));
    r.colwise().normalize();
    // The constraints make the columns orthogonal but for rounding; where they do not, one step
    // towards the nearest rotation.
    if (!sweep.orthogonal) r = (0.5 * r * (3 * Mat3::Identity() - r.transpose() * r)).eval();
    const Mat3 left = InverseOfUpper(inverse) * r;
    const Vec3 last = sweep.centre_from_left * left.reshaped();
    const ConditionedCamera camera{inverse, r, -r.transpose() * (inverse * last)};
    double penalty = PenaltyOf(sweep.edges, camera);
    if (!sweep.points.empty()) penalty += PenaltyOf(sweep.points, camera);
    if (penalty < best.penalty) best = {camera, penalty};
  }
  return best;
}

geom::Result<Sweep> Prepare(const Photograph& photograph, const Numbers& numbers) {
  Sweep sweep;
  sweep.traces = SpaceTracesOf(photograph, numbers);
  if (sweep.traces.empty())
    return Degenerate("the penalty needs edges in space, control points or a rectangle");
  const ConicRows rows = ConicRowsOf(photograph, numbers);
  const geom::Result<SkewFamily> family = SkewFamilyOf(IndependentRows(rows.all(), 4));
  if (!family) return tl::unexpected(family.error());
  sweep.family = *family;
  sweep.orthogonal = IndependentRows(rows.orthogonal, 3).size() == rows.orthogonal.size();
  const std::optional<Mat3> inverse = InverseCalibration(family->without_skew);
  if (!inverse) return Degenerate("no real camera without skew fulfils the four constraints");
  const geom::Result<ConditionedCamera> reference =
      PoseFromDirections(*inverse, rows.points, sweep.traces);
  if (!reference) return tl::unexpected(reference.error());

  sweep.third = -1;
  for (int i = 0; i < 3; ++i) {
    const auto& point = rows.points[static_cast<size_t>(i)];
    if (!point) sweep.third = i;
    const Vec3 axis = point ? *point : Vec3(Vec3::Zero());
    const double sign = reference->camera_from_world.col(i).dot(*inverse * axis);
    sweep.axes.col(i) = sign < 0 ? Vec3(-axis) : axis;
  }

  sweep.origin_m = sweep.traces.centre_m();
  for (SpaceEdge& e : sweep.traces.edges) e.from_m -= sweep.origin_m, e.to_m -= sweep.origin_m;
  for (SpacePoint& p : sweep.traces.points) p.point_m -= sweep.origin_m;
  sweep.edges = InFours(sweep.traces.edges);
  sweep.points.points = sweep.traces.points;
  ProjectionMatrix projection;
  projection.leftCols<3>() = inverse->inverse() * reference->camera_from_world;
  projection.col(3) = -projection.leftCols<3>() * (reference->position_m - sweep.origin_m);
  const ProjectionRows linear = ProjectionRowsOf(sweep.traces, &projection);
  sweep.centre_from_left = -linear.rightCols<3>().colPivHouseholderQr().solve(linear.leftCols<9>());
  return sweep;
}

// The least penalty between two angles around a third that is lower, by parabolas and, where these
// do not help, the golden section.
Candidate Refine(const Sweep& sweep, double low, double alpha, double high, Candidate best) {
  double at_low = At(sweep, low).penalty, at_high = At(sweep, high).penalty;
  for (int i = 0; i < 30 && high - low > 1e-13; ++i) {
    const double left = alpha - low, right = high - alpha;
    const double p = (at_low - best.penalty) / left, q = (at_high - best.penalty) / right;
    // The vertex of the parabola through the three.
    double next = alpha + 0.5 * (p * right - q * left) / (p + q);
    if (!(next > low && next < high) || std::abs(next - alpha) < 1e-15 || i % 4 == 3)
      next = right > left ? alpha + 0.38 * right : alpha - 0.38 * left;
    const Candidate candidate = At(sweep, next);
    const bool better = candidate.penalty < best.penalty;
    const bool converged = better && best.penalty - candidate.penalty <= 1e-9 * candidate.penalty;
    if (better) {
      (next > alpha ? low : high) = alpha;
      (next > alpha ? at_low : at_high) = best.penalty;
      alpha = next, best = candidate;
    } else {
      (next > alpha ? high : low) = next;
      (next > alpha ? at_high : at_low) = candidate.penalty;
    }
    if (converged) break;
  }
  return best;
}

}  // namespace

geom::Result<SweepResult> CalibrateSweep(const Photograph& photograph, const Numbers& numbers,
                                         const SkewRange& range) {
  if (range.count < 1 || !(range.from_rad > 0) || !(range.step_rad > 0) ||
      !(range.at(range.count - 1) < kPi))
    return tl::unexpected(
        geom::Error{geom::ErrorCode::kOutOfRange, "skew angles must be between 0° and 180°"});
  const geom::Result<Sweep> sweep = Prepare(photograph, numbers);
  if (!sweep) return tl::unexpected(sweep.error());
  SweepResult result;
  result.curve.reserve(static_cast<size_t>(range.count));
  Candidate best;
  int lowest = 0;
  for (int i = 0; i < range.count; ++i) {
    const Candidate candidate = At(*sweep, range.at(i));
    result.curve.push_back({range.at(i), candidate.penalty});
    if (candidate.penalty < best.penalty) best = candidate, lowest = i;
  }
  if (!std::isfinite(best.penalty))
    return Degenerate("no real camera fulfils the four constraints with a skew of the range");
  result.at_end = lowest == 0 || lowest == range.count - 1;
  if (!result.at_end)
    best = Refine(*sweep, range.at(lowest - 1), range.at(lowest), range.at(lowest + 1), best);
  if (!InFront(sweep->traces, best.camera))
    return Degenerate("what is traced would be behind the camera");
  best.camera.position_m += sweep->origin_m;
  best.camera.camera_from_world = NearestRotation(best.camera.camera_from_world);
  result.camera = CameraOf(best.camera, photograph.frame);
  result.penalty = best.penalty;
  return result;
}

}  // namespace tranos::camera
