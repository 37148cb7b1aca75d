// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/start.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "camera/conic_rows.h"
#include "camera/dlt.h"

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

// Everything that candidates are made of and judged by.
struct Evidence {
  const Photograph& photograph;
  Conditioning conditioning;
  SpaceTraces traces;
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

struct Candidate {
  ConditionedCamera camera;
  double score;
};

double Square(double x) { return x * x; }

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
    const double rows =
        2.0 * static_cast<double>(evidence.traces.edges.size() + evidence.traces.points.size());
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

// Upright cameras that look in all directions, the position from the traces, the pose and the focal
// length adjusted.
void AddAllDirections(const Evidence& evidence, Candidates* candidates) {
  if (evidence.traces.empty()) return;
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
          const auto position = PositionFromTraces(evidence.traces, inverse, r);
          if (position) tried.Add(ConditionedCamera{inverse, r, *position});
        }
    tried.Sort();
    for (size_t i = 0; i < std::min<size_t>(12, tried.found.size()); ++i)
      candidates->Add(RefinePose(evidence.traces, tried.found[i].camera, focal));
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

std::vector<Camera> Starts(const Photograph& photograph, const Numbers& numbers) {
  if (photograph.traces.empty()) return {};
  const Evidence evidence{photograph,
                          ConditioningOf(photograph.frame),
                          SpaceTracesOf(photograph, numbers),
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
  if (!evidence.traces.empty() && !candidates.Good()) {
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
