// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/start.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "camera/conic_rows.h"
#include "camera/dlt.h"
#include "camera/likelihood.h"

namespace tranos::camera {
namespace {

constexpr size_t kMost = 8;
constexpr double kUsualFocal = 2.2;  // in half widths of the picture

// The camera without its focal length that is assumed, in conditioned coordinates.
struct Assumed {
  double aspect, alpha;
  Vec2 principal;

  Mat3 Inverse(double focal) const {
    Mat3 k;
    k << focal, focal * std::cos(alpha) / std::sin(alpha), principal.x(),  //
        0, aspect * focal, principal.y(), 0, 0, 1;
    return k.inverse();
  }
};

Assumed AssumedOf(const Photograph& photograph) {
  const auto value = [&](Parameter p, double usual) {
    return photograph.priors[p].sigma > 0 ? photograph.priors[p].value : usual;
  };
  const Mat3 scale = FrameFromConditioned(photograph.frame);
  return {value(kAspect, 1) * scale(0, 0) / scale(1, 1),
          value(kSkew, kPi / 2),
          {value(kPrincipalX, 0) / scale(0, 0), value(kPrincipalY, 0) / scale(1, 1)}};
}

double Square(double x) { return x * x; }

struct SpaceCurve {
  std::vector<Vec3> points_m;
  std::vector<Vec2> dots;  // conditioned
  double weight;           // 1/σ
};

std::vector<SpaceCurve> SpaceCurvesOf(const Photograph& photograph, const Numbers& numbers) {
  const Conditioning conditioning = ConditioningOf(photograph.frame);
  std::vector<SpaceCurve> curves;
  for (const Trace& trace : photograph.traces) {
    const auto* curve = std::get_if<CurveTrace>(&trace);
    if (!curve) continue;
    SpaceCurve& result = curves.emplace_back();
    result.weight = conditioning.scale_px / curve->sigma_px;
    for (int i = 0; i < curve->points; ++i)
      result.points_m.emplace_back(numbers.values.segment<3>(curve->first + 3 * i));
    for (const Vec2& dot : curve->dots_px) result.dots.push_back(conditioning.PointFromDot(dot));
  }
  return curves;
}

// Everything that candidates are made of and judged by.
struct Evidence {
  const Photograph& photograph;
  const Numbers& numbers;
  Conditioning conditioning;
  SpaceTraces traces;
  std::vector<SpaceCurve> curves;
  AxisLines lines;
  ConicRows rows;
  Assumed assumed;
};

// Some of very many, a Fibonacci-like walk through them: no pattern in how they are listed, such as
// every fourth one upright, leaves a kind of them out.
template <class T>
std::vector<T> SomeOf(const std::vector<T>& all, size_t most) {
  if (all.size() <= most) return all;
  constexpr double kGolden = 0.6180339887498949;
  const double share = static_cast<double>(most) / static_cast<double>(all.size());
  std::vector<T> some;
  for (size_t i = 0; i < all.size(); ++i) {
    const double at = static_cast<double>(i) * kGolden;
    if (at - std::floor(at) < share) some.push_back(all[i]);
  }
  return some;
}

// Enough to search widely by; what is found is judged by everything.
Evidence Thinned(const Evidence& evidence) {
  Evidence some = evidence;
  some.traces.edges = SomeOf(evidence.traces.edges, 40);
  some.traces.points = SomeOf(evidence.traces.points, 40);
  for (auto& lines : some.lines) lines = SomeOf(lines, 20);
  return some;
}

// Σ of squared whitened distances of the dots of curves from their images.
double CurveMisfit(const std::vector<SpaceCurve>& curves, const ConditionedCamera& camera) {
  const Mat3 m = camera.inverse_calibration.inverse() * camera.camera_from_world;
  double sum = 0;
  std::vector<Vec2> image;
  for (const SpaceCurve& curve : curves) {
    image.clear();
    for (const Vec3& point : curve.points_m) {
      const Vec3 x = m * (point - camera.position_m);
      if (x.z() > 0) image.push_back(x.hnormalized());
    }
    for (const Vec2& dot : curve.dots) {
      double least = std::numeric_limits<double>::infinity();
      for (size_t i = 0; i + 1 < image.size(); ++i) {
        const Vec2 along = image[i + 1] - image[i];
        const double share =
            std::clamp((dot - image[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (dot - image[i] - share * along).squaredNorm());
      }
      sum += least * Square(curve.weight);
    }
  }
  return sum;
}

struct Candidate {
  ConditionedCamera camera;
  double score;
};

// How far a camera is from usual ones, in deviations of a wide prior or those declared.
double Unusual(const Camera& camera, const Photograph& photograph) {
  const Vec2 half = 0.5 * photograph.frame.size_mm;
  const double usual[kIntrinsics] = {kUsualFocal * half.x(), 1, 0, 0, kPi / 2};
  const double sigma[kIntrinsics] = {0, 0.1, 0.3 * half.x(), 0.3 * half.y(), 2 * kPi / 180};
  double sum = Square(std::log(camera[kFocal] / usual[kFocal]));
  for (int i = 0; i < kIntrinsics; ++i) {
    const Prior& prior = photograph.priors[i];
    if (prior.sigma > 0)
      sum += Square((camera.parameters[i] - prior.value) / prior.sigma);
    else if (sigma[i] > 0)
      sum += Square((camera.parameters[i] - usual[i]) / sigma[i]);
  }
  return sum;
}

double ScoreOf(const Evidence& evidence, const ConditionedCamera& camera) {
  double score = Unusual(CameraOf(camera, evidence.photograph.frame), evidence.photograph);
  if (!evidence.traces.empty()) score += PenaltyOf(evidence.traces, camera);
  score += CurveMisfit(evidence.curves, camera);
  const Mat3 k = camera.inverse_calibration.inverse();
  const Mat3 left = k * camera.camera_from_world;
  for (int axis = 0; axis < 3; ++axis)
    score += PencilMisfit(evidence.lines[static_cast<size_t>(axis)], evidence.conditioning,
                          left.col(axis).normalized());
  const Conic conic = ConicOf(k).normalized();
  for (const Conic& row : evidence.rows.metric) score += Square(row.dot(conic) / row.norm() / 1e-3);
  return score;
}

struct Candidates {
  const Evidence& evidence;
  std::vector<Candidate> found;

  void Add(const ConditionedCamera& camera) {
    if (!camera.inverse_calibration.allFinite() || !camera.position_m.allFinite()) return;
    if (!InFront(evidence.traces, camera)) return;
    const double score = ScoreOf(evidence, camera);
    if (std::isfinite(score)) found.push_back({camera, score});
  }
  void Add(const geom::Result<ConditionedCamera>& camera) {
    if (camera) Add(*camera);
  }
  void Sort() {
    std::stable_sort(found.begin(), found.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
  }
  // Whether the best fits about as well as noise allows.
  bool Good() const {
    double rows =
        2.0 * static_cast<double>(evidence.traces.edges.size() + evidence.traces.points.size());
    for (const SpaceCurve& curve : evidence.curves) rows += static_cast<double>(curve.dots.size());
    return !found.empty() && found[0].score < 10 + 3 * rows;
  }
};

void AddProjection(Candidates* candidates) {
  const auto projection = FitProjection(candidates->evidence.traces);
  if (projection) candidates->Add(DecomposeProjection(*projection));
}

// Constraints of the data first and assumptions for what they leave open; then with the assumptions
// before ever more of the data, for data that are nearly degenerate.
void AddConics(Candidates* candidates) {
  const Evidence& evidence = candidates->evidence;
  const Assumed& assumed = evidence.assumed;
  const std::vector<Conic> data = evidence.rows.all();
  const double cot = std::cos(assumed.alpha) / std::sin(assumed.alpha);
  const std::array<Conic, 2> principal = PrincipalPointRows(assumed.principal);
  const std::vector<Conic> assumptions = {
      SkewRow(assumed.alpha, assumed.aspect),
      Conic((1 + cot * cot) * Conic::Unit(0) - Square(assumed.aspect) * Conic::Unit(2)),
      principal[0], principal[1]};
  for (const size_t first : {0, 1, 2, 4}) {
    std::vector<Conic> rows(assumptions.begin(),
                            assumptions.begin() + static_cast<std::ptrdiff_t>(first));
    rows.insert(rows.end(), data.begin(), data.end());
    rows.insert(rows.end(), assumptions.begin() + static_cast<std::ptrdiff_t>(first),
                assumptions.end());
    const auto k = CalibrationFromRows(IndependentRows(rows, 5));
    if (k) candidates->Add(PoseFromDirections(k->inverse(), evidence.rows.points, evidence.traces));
  }
}

// For focal lengths from a quarter of the picture's width on, the facade's poses and those of the
// vanishing points; the best few with the focal length adjusted.
void AddFocalLengths(const Evidence& evidence, Candidates* candidates) {
  Candidates tried{evidence, {}};
  std::optional<Mat3> h;
  std::vector<Vec2> points, dots;
  const std::optional<double> y_m = FacadeWithMost(evidence.traces);
  if (y_m) {
    if (const auto facade = FacadeHomography(evidence.traces, *y_m)) h = *facade;
    const auto add = [&](const Vec3& point, const Vec2& dot) {
      if (std::abs(point.y() - *y_m) > geom::kCoincident_m) return;
      points.push_back({point.x(), point.z()});
      dots.push_back(dot);
    };
    for (const SpacePoint& p : evidence.traces.points) add(p.point_m, p.at);
    if (h)
      for (const SpaceEdge& e : evidence.traces.edges)
        for (const Vec3& end : {e.from_m, e.to_m})
          add(end, (*h * Vec3(end.x(), end.z(), 1)).hnormalized());
  }
  for (int i = 0; i <= 15; ++i) {
    const Mat3 inverse = evidence.assumed.Inverse(0.5 * std::pow(2, 0.3 * i));
    tried.Add(PoseFromDirections(inverse, evidence.rows.points, evidence.traces));
    if (!h) continue;
    const auto poses = PosesFromHomography(inverse, *h, points, dots, 1);
    if (!poses) continue;
    for (const PoseCandidate& pose : *poses) {
      ConditionedCamera camera = pose.camera;
      camera.position_m.y() += *y_m;
      tried.Add(camera);
    }
  }
  tried.Sort();
  for (size_t i = 0; i < std::min<size_t>(4, tried.found.size()); ++i) {
    candidates->Add(tried.found[i].camera);
    if (!evidence.traces.empty())
      candidates->Add(RefinePose(evidence.traces, tried.found[i].camera, true));
  }
}

// Where curves have their middles and, on the average, their extents; a rotation and a calibration
// given. Dots on a part of a curve are off by as much, which is little beside its distance.
Vec3 PositionFromCurves(const std::vector<SpaceCurve>& curves, const Mat3& inverse, const Mat3& r) {
  Vec3 sum = Vec3::Zero();
  for (const SpaceCurve& curve : curves) {
    Vec3 middle_m = Vec3::Zero();
    Vec2 middle = Vec2::Zero();
    for (const Vec3& point : curve.points_m)
      middle_m += point / static_cast<double>(curve.points_m.size());
    for (const Vec2& dot : curve.dots) middle += dot / static_cast<double>(curve.dots.size());
    double extent_m = 0, extent = 0;
    for (const Vec3& point : curve.points_m)
      extent_m = std::max(extent_m, (r * (point - middle_m)).head<2>().norm());
    const Vec3 ray = inverse * middle.homogeneous();
    for (const Vec2& dot : curve.dots)
      extent = std::max(extent, (inverse * dot.homogeneous() - ray).norm());
    sum += middle_m - extent_m / std::max(extent, 1e-3) * (r.transpose() * ray);
  }
  return sum / static_cast<double>(curves.size());
}

geom::Result<Vec3> PositionOf(const Evidence& evidence, const Mat3& inverse, const Mat3& r) {
  if (evidence.curves.empty()) return PositionFromTraces(evidence.traces, inverse, r);
  const auto position = evidence.traces.empty()
                            ? tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, ""})
                            : PositionFromTraces(evidence.traces, inverse, r);
  return position ? position : PositionFromCurves(evidence.curves, inverse, r);
}

// Upright cameras that look in all directions, the position from the traces, the pose and the focal
// length adjusted; all of the camera where there are curves.
void AddAllDirections(const Evidence& evidence, Candidates* candidates) {
  if (evidence.traces.empty() && evidence.curves.empty()) return;
  for (const bool focal : {false, true}) {
    Candidates tried{evidence, {}};
    for (const double scale : {0.5, 1.0, 2.0})
      for (int tilt = -2; tilt <= 2; ++tilt)
        for (int pan = 0; pan < 12; ++pan) {
          Camera camera;
          camera[kOmega] = tilt * kPi / 9;
          camera[kPhi] = pan * kPi / 6;
          const Mat3 r = CameraFromWorld(camera.parameters);
          const Mat3 inverse = evidence.assumed.Inverse(scale * kUsualFocal);
          const auto position = PositionOf(evidence, inverse, r);
          if (position) tried.Add(ConditionedCamera{inverse, r, *position});
        }
    tried.Sort();
    for (size_t i = 0; i < std::min<size_t>(12, tried.found.size()); ++i) {
      if (evidence.curves.empty()) {
        candidates->Add(RefinePose(evidence.traces, tried.found[i].camera, focal));
        continue;
      }
      const Photograph& photograph = evidence.photograph;
      const Camera start = CameraOf(tried.found[i].camera, photograph.frame);
      const CameraFit fit = FitCamera(Anchored(photograph, start), evidence.numbers, start);
      if (fit.camera.parameters.allFinite())
        candidates->Add(ConditionedCameraOf(fit.camera, photograph.frame));
    }
  }
}

bool Alike(const Camera& a, const Camera& b, const Frame& frame) {
  const double turn =
      (CameraFromWorld(a.parameters) - CameraFromWorld(b.parameters)).cwiseAbs().maxCoeff();
  const double focal = std::abs(std::log(a[kFocal] / b[kFocal]));
  const double moved = (a.position_m() - b.position_m()).norm();
  return turn < 1e-4 && focal < 1e-4 && moved < 1e-4 * (1 + a.position_m().norm()) &&
         (a.parameters - b.parameters).segment<2>(kPrincipalX).norm() < 1e-4 * frame.size_mm.x();
}

}  // namespace

Photograph Anchored(Photograph photograph, const Camera& start) {
  const double width = photograph.frame.size_mm.x();
  const bool is_usual = start[kFocal] > 0.3 * width && start[kFocal] < 10 * width;
  const Prior usual[kIntrinsics] = {
      is_usual ? Prior{start[kFocal], 0.2 * start[kFocal]} : Prior{1.1 * width, 0.3 * width},
      {1, 0.1},
      {0, 0.1 * width},
      {0, 0.1 * width},
      {kPi / 2, 2 * kPi / 180}};
  for (int i = 0; i < kIntrinsics; ++i) {
    if (!(photograph.priors[i].sigma > 0)) photograph.priors[i] = usual[i];
  }
  return photograph;
}

std::vector<Camera> Starts(const Photograph& photograph, const Numbers& numbers) {
  if (photograph.traces.empty()) return {};
  const Evidence evidence{photograph,
                          numbers,
                          ConditioningOf(photograph.frame),
                          SpaceTracesOf(photograph, numbers),
                          SpaceCurvesOf(photograph, numbers),
                          AxisLinesOf(photograph, numbers),
                          ConicRowsOf(photograph, numbers),
                          AssumedOf(photograph)};
  const Evidence search = Thinned(evidence);
  Candidates candidates{evidence, {}};
  AddProjection(&candidates);
  if (!candidates.Good()) {
    AddConics(&candidates);
    AddFocalLengths(search, &candidates);
    candidates.Sort();
  }
  if (!candidates.Good()) {
    AddAllDirections(search, &candidates);
    candidates.Sort();
  }
  if (candidates.found.empty()) {
    const Camera usual;
    candidates.found.push_back(
        {{evidence.assumed.Inverse(kUsualFocal), CameraFromWorld(usual.parameters),
          evidence.traces.centre_m() - Vec3(0, 10, 0)},
         0});
  }
  std::vector<Camera> starts;
  for (const Candidate& candidate : candidates.found) {
    const Camera camera = CameraOf(candidate.camera, photograph.frame);
    const bool known = std::any_of(starts.begin(), starts.end(), [&](const Camera& other) {
      return Alike(camera, other, photograph.frame);
    });
    if (!known) starts.push_back(camera);
    if (starts.size() == kMost) break;
  }
  return starts;
}

}  // namespace tranos::camera
