// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/vanishing_directions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "camera/conditioning.h"
#include "camera/default_priors.h"
#include "camera/likelihood.h"
#include "camera/statistics.h"

namespace tranos::camera {
namespace {

constexpr double kDegree = kPi / 180;

// A line in conditioned coordinates, as the angle to a vanishing point needs it.
struct Stroke {
  Vec2 centre, normal;
  Vec3 line;  // homogeneous
  double half_length;
  double angle_sigma;   // rad, of the line alone
  double offset_sigma;  // of its centre, across
  double weight;        // how much it counts
};

std::vector<Stroke> StrokesOf(std::span<const ImageLine> lines, const Conditioning& conditioning) {
  std::vector<Stroke> strokes;
  for (const ImageLine& line : lines) {
    const Vec2 a = conditioning.PointFromDot(line.a_px), b = conditioning.PointFromDot(line.b_px);
    const Vec2 along = (b - a).normalized(), normal(-along.y(), along.x()), centre = 0.5 * (a + b);
    strokes.push_back({centre, normal, Vec3(normal.x(), normal.y(), -normal.dot(centre)),
                       0.5 * (b - a).norm(), line.tilt_sigma_px / line.length_px(),
                       line.centre_sigma_px / conditioning.scale_px, (b - a).norm()});
  }
  // A long edge says more of its direction than the pieces of a pattern, but not in proportion: how
  // parallel a building's edges are does not hang on their length.
  std::vector<double> lengths;
  for (const Stroke& s : strokes) lengths.push_back(s.half_length);
  std::ranges::nth_element(lengths,
                           lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2));
  const double median = lengths.empty() ? 1 : lengths[lengths.size() / 2];
  for (Stroke& s : strokes) s.weight = std::sqrt(std::min(s.half_length / median, 10.0));
  return strokes;
}

// Angles between an edge of a building and its direction, over their deviation, have long tails:
// Student's t with three degrees of freedom.
constexpr double kFreedom = 3;
double Density(double z2) {
  const double height = 2 / (kPi * std::sqrt(kFreedom)), fall = 1 + z2 / kFreedom;
  return height / (fall * fall);
}

// The angle between a line and the direction from its centre to a vanishing point.
struct Miss {
  double z2;         // its square over its variance
  double sigma_rad;  // its deviation
};

// Nothing where the vanishing point is within the line: it is none of it.
std::optional<Miss> MissOf(const Stroke& stroke, const Vec3& v, double parallel_rad) {
  const Vec2 to = v.head<2>() - v.z() * stroke.centre;
  const double distance = to.norm();
  if (distance <= std::abs(v.z()) * stroke.half_length) return std::nullopt;
  const double sine = stroke.normal.dot(to) / distance;
  const double sigma =
      std::hypot(stroke.angle_sigma, parallel_rad, stroke.offset_sigma * v.z() / distance);
  return Miss{sine * sine / (sigma * sigma), sigma};
}

// How much likelier a line is of a direction than of none, for which all angles are alike, if both
// were as frequent.
double Evidence(const std::optional<Miss>& miss) {
  return miss ? Density(miss->z2) * kPi / miss->sigma_rad : 0;
}

// By which least squares is to weigh a residual that is distributed so (Lange, Little and Taylor
// 1989).
double WeightOf(const Miss& miss) { return (kFreedom + 1) / (kFreedom + miss.z2); }

// ---- the first direction

struct Candidate {
  Vec3 point;  // unit vector of conditioned coordinates
  double score;
};

double ScoreOf(std::span<const Stroke> strokes, const Vec3& v, double parallel_rad) {
  double score = 0;
  for (const Stroke& s : strokes)
    score += s.weight * std::log1p(Evidence(MissOf(s, v, parallel_rad)));
  return score;
}

// The vanishing point of the lines that point at `v`, by iterated weighted least squares.
Vec3 Polished(std::span<const Stroke> strokes, Vec3 v, double parallel_rad) {
  for (int i = 0; i < 3; ++i) {
    Mat3 scatter = Mat3::Zero();
    for (const Stroke& s : strokes) {
      const auto miss = MissOf(s, v, parallel_rad);
      const double evidence = Evidence(miss);
      if (evidence < 1e-3) continue;
      const double distance = (v.head<2>() - v.z() * s.centre).norm();
      const double sigma = distance * miss->sigma_rad;
      scatter += evidence / (1 + evidence) * WeightOf(*miss) / (sigma * sigma) * s.line *
                 s.line.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(scatter);
    v = eigen.eigenvectors().col(0);
  }
  return v;
}

std::vector<Candidate> FirstDirections(std::span<const Stroke> strokes,
                                       const DirectionSearch& search, std::size_t most) {
  constexpr int kPairs = 1500;
  const double tolerance = 2 * search.parallel_rad;
  UniformNumbers random(search.seed);
  const auto any = [&]() -> const Stroke& {
    return strokes[static_cast<std::size_t>(random.Next() * static_cast<double>(strokes.size()))];
  };
  std::vector<Candidate> drawn;
  for (int i = 0; i < kPairs; ++i) {
    const Stroke& a = any();
    const Stroke& b = any();
    const Vec3 v = a.line.cross(b.line);
    if (!(v.norm() > 1e-6)) continue;
    const Vec3 unit = v.normalized();
    drawn.push_back({unit, ScoreOf(strokes, unit, tolerance)});
  }
  std::ranges::stable_sort(drawn, std::greater<>(), &Candidate::score);
  std::vector<Candidate> kept;
  const auto is_new = [&](const Vec3& v) {
    return std::ranges::all_of(kept, [&](const Candidate& k) {
      // Seen from twice the half picture's size away.
      const Vec3 a = Vec3(v.x(), v.y(), 2 * v.z()).normalized(),
                 b = Vec3(k.point.x(), k.point.y(), 2 * k.point.z()).normalized();
      return a.cross(b).norm() > 2 * kDegree;
    });
  };
  for (const Candidate& c : drawn) {
    if (kept.size() >= most) break;
    if (!is_new(c.point)) continue;
    const Vec3 v = Polished(strokes, c.point, search.parallel_rad);
    if (is_new(v)) kept.push_back({v, ScoreOf(strokes, v, tolerance)});
  }
  return kept;
}

// ---- the other two

struct Hypothesis {
  Mat3 camera_from_world;  // in no particular order of axes
  double focal;            // conditioned
  double score;
};

constexpr int kTurns = 90;  // of a degree

// What each turn about the first direction scores: lines that point at the first count for that,
// the others where they put one of the other two directions.
std::array<double, kTurns> VotesFor(std::span<const Stroke> strokes,
                                    std::span<const double> first_gain, double focal,
                                    const Vec3& d1, const Vec3& u, const Vec3& w,
                                    double parallel_rad) {
  std::array<double, kTurns> votes{};
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const Stroke& s = strokes[i];
    const Vec3 plane(focal * s.line.x(), focal * s.line.y(), s.line.z());
    const Vec3 along = plane.cross(d1);
    const double size = along.norm();
    if (!(size > 1e-9)) continue;
    const Vec3 direction = along / size, turned = d1.cross(direction);
    // How the angle in the picture changes with the turn.
    const Vec3 v(focal * direction.x(), focal * direction.y(), direction.z());
    const Vec3 by_turn(focal * turned.x(), focal * turned.y(), turned.z());
    const Vec2 to = v.head<2>() - v.z() * s.centre;
    const double distance = to.norm();
    if (distance <= std::abs(v.z()) * s.half_length) continue;
    const double rate =
        std::abs(s.normal.dot(by_turn.head<2>() - by_turn.z() * s.centre)) / distance;
    const double sigma = std::hypot(s.angle_sigma, parallel_rad, s.offset_sigma * v.z() / distance);
    const double peak = kPi / sigma;
    // Turns that differ by less than a bin are one.
    const double width = std::min(std::hypot(sigma / std::max(rate, 1e-9), 0.3 * kDegree), 1.5);
    if (width > 10 * kDegree) continue;
    const double at = std::atan2(direction.dot(w), direction.dot(u)) / kDegree;
    const int reach = static_cast<int>(std::ceil(4 * width / kDegree));
    const int middle = static_cast<int>(std::floor(at));
    for (int t = middle - reach; t <= middle + reach; ++t) {
      const double z = (t + 0.5 - at) * kDegree / width;
      const double gain = std::log1p(peak * Density(z * z)) - first_gain[i];
      if (gain > 0)
        votes[static_cast<std::size_t>(((t % kTurns) + kTurns) % kTurns)] += s.weight * gain;
    }
  }
  return votes;
}

std::vector<Hypothesis> Hypotheses(std::span<const Stroke> strokes,
                                   const std::vector<Candidate>& firsts, double parallel_rad) {
  // From 110° across the longer side to 9°, in steps of a twelfth.
  constexpr double kShortest = 0.7, kLongest = 12, kStep = 1.0833;
  std::vector<Hypothesis> all;
  std::vector<double> gain(strokes.size());
  for (const Candidate& first : firsts) {
    double base = 0;
    for (std::size_t i = 0; i < strokes.size(); ++i)
      gain[i] = std::log1p(Evidence(MissOf(strokes[i], first.point, parallel_rad))),
      base += strokes[i].weight * gain[i];
    for (double focal = kShortest; focal < kLongest; focal *= kStep) {
      const Vec3 d1 =
          Vec3(first.point.x() / focal, first.point.y() / focal, first.point.z()).normalized();
      const Vec3 u = d1.unitOrthogonal(), w = d1.cross(u);
      const auto votes = VotesFor(strokes, gain, focal, d1, u, w, parallel_rad);
      for (int t = 0; t < kTurns; ++t) {
        const double before = votes[(t + kTurns - 1) % kTurns], after = votes[(t + 1) % kTurns];
        if (votes[t] < before || votes[t] <= after) continue;
        const double turn = (t + 0.5) * kDegree;
        Mat3 r;
        r.col(0) = d1;
        r.col(1) = std::cos(turn) * u + std::sin(turn) * w;
        r.col(2) = d1.cross(r.col(1));
        all.push_back({r, focal, base + votes[t]});
      }
    }
  }
  std::ranges::stable_sort(all, std::greater<>(), &Hypothesis::score);
  return all;
}

// Degrees of the least turn between two frames of axes, whatever axes are called.
double TurnBetween(const Mat3& a, const Mat3& b) {
  const Mat3 cosines = (a.transpose() * b).cwiseAbs();
  double trace = 0;  // of the best matching
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (const auto& o : kOrders)
    trace = std::max(trace, cosines(o[0], 0) + cosines(o[1], 1) + cosines(o[2], 2));
  return std::acos(std::clamp(0.5 * (trace - 1), -1.0, 1.0)) / kDegree;
}

// The best that are not nearly the same.
std::vector<Hypothesis> Distinct(const std::vector<Hypothesis>& sorted, std::size_t most) {
  std::vector<Hypothesis> kept;
  for (const Hypothesis& h : sorted) {
    if (kept.size() >= most) break;
    const bool is_new = std::ranges::all_of(kept, [&](const Hypothesis& k) {
      return TurnBetween(h.camera_from_world, k.camera_from_world) > 4 ||
             std::abs(std::log(h.focal / k.focal)) > 0.3;
    });
    if (is_new) kept.push_back(h);
  }
  return kept;
}

// ---- refinement

// Z the most upright, X of the others the more across the line of sight.
Mat3 WithAxesNamed(const Mat3& r) {
  int z = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(r(1, i)) > std::abs(r(1, z))) z = i;
  }
  int x = (z + 1) % 3;
  const int y = (z + 2) % 3;
  if (std::abs(r(2, x)) > std::abs(r(2, y))) x = y;
  Mat3 named;
  named.col(2) = r(1, z) > 0 ? Vec3(-r.col(z)) : Vec3(r.col(z));
  named.col(0) = r(0, x) < 0 ? Vec3(-r.col(x)) : Vec3(r.col(x));
  named.col(1) = named.col(2).cross(named.col(0));
  return named;
}

// Vanishing points of the three axes, conditioned.
Mat3 PointsOf(const Camera& camera, const Frame& frame) {
  const Conditioning conditioning = ConditioningOf(frame);
  Mat3 conditioned_from_dot = Mat3::Identity();
  conditioned_from_dot.topLeftCorner<2, 2>() /= conditioning.scale_px;
  conditioned_from_dot.topRightCorner<2, 1>() = -conditioning.centre_px / conditioning.scale_px;
  return conditioned_from_dot * frame.DotFromFrame() * FrameFromCamera(camera.parameters) *
         CameraFromWorld(camera.parameters);
}

struct Mixture {
  std::array<double, 4> share{0.2, 0.2, 0.2, 0.4};  // of X, Y, Z and none
  double log_likelihood = 0;                        // above that of lines of no direction
};

// What a line may be of an axis, and with which weight it then counts.
struct Membership {
  double probability = 0;
  double weight = 0;
};
using Memberships = std::vector<std::array<Membership, 3>>;

// What each line is, by its probabilities; the shares and the likelihood follow.
Memberships Expect(std::span<const Stroke> strokes, const Mat3& points, double parallel_rad,
                   Mixture& mixture) {
  Memberships belongs(strokes.size());
  std::array<double, 4> sums{1, 1, 1, 1};
  mixture.log_likelihood = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    double all = mixture.share[3], none = 1;
    for (int k = 0; k < 3; ++k) {
      const auto miss = MissOf(strokes[i], points.col(k), parallel_rad);
      belongs[i][k] = {mixture.share[k] * Evidence(miss), miss ? WeightOf(*miss) : 0};
      all += belongs[i][k].probability;
    }
    mixture.log_likelihood += strokes[i].weight * std::log(all);
    for (int k = 0; k < 3; ++k) {
      belongs[i][k].probability /= all;
      none -= belongs[i][k].probability;
      sums[k] += belongs[i][k].probability;
    }
    sums[3] += none;
  }
  for (int k = 0; k < 4; ++k) mixture.share[k] = sums[k] / static_cast<double>(strokes.size() + 4);
  return belongs;
}

// The probabilities when the shares are those of the picture, which its vanishing points settle in
// a few rounds.
Memberships Settled(std::span<const Stroke> strokes, const Mat3& points, double parallel_rad,
                    Mixture& mixture) {
  Expect(strokes, points, parallel_rad, mixture);
  Expect(strokes, points, parallel_rad, mixture);
  return Expect(strokes, points, parallel_rad, mixture);
}

void AddDirections(std::span<const ImageLine> lines, const Memberships& belongs,
                   double parallel_rad, Photograph& photograph) {
  constexpr double kLeast = 0.1;  // below that a line would only take time
  photograph.traces.clear();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const Membership& m = belongs[i][axis];
      if (m.probability < kLeast) continue;
      DirectionTrace trace{AsParallel(lines[i], parallel_rad), axis};
      const double weaker = 1 / std::sqrt(m.probability * m.weight);
      trace.line.centre_sigma_px *= weaker, trace.line.tilt_sigma_px *= weaker;
      photograph.traces.push_back(trace);
    }
  }
}

struct Fitted {
  Camera camera;
  double score = -std::numeric_limits<double>::infinity();
};

// Expectation and maximisation from a hypothesis, with a tolerance that narrows.
Fitted Refined(std::span<const ImageLine> lines, std::span<const Stroke> strokes,
               const Frame& frame, const Hypothesis& start, double parallel_rad) {
  constexpr std::array<double, 6> kTolerances{2, 1.5, 1, 1, 1, 1};
  Photograph photograph;
  photograph.frame = frame;
  std::ranges::copy(DefaultPriors(frame), photograph.priors);
  Mat3 k = FrameFromConditioned(frame) * Vec3(start.focal, start.focal, 1).asDiagonal();
  k(0, 0) = k(1, 1) = 0.5 * (k(0, 0) + k(1, 1));
  Camera camera = CameraOf(k, WithAxesNamed(start.camera_from_world), Vec3::Zero());
  Mixture mixture;
  for (const double wider : kTolerances) {
    const double tolerance = wider * parallel_rad;
    AddDirections(lines, Expect(strokes, PointsOf(camera, frame), tolerance, mixture), tolerance,
                  photograph);
    // Holds a focal length that nothing determines near where it is.
    photograph.priors[kFocal] = {camera[kFocal], 0.5 * camera[kFocal]};
    const CameraFit fit = FitCamera(photograph, {}, camera);
    if (!fit.camera.parameters.allFinite() || !(fit.camera[kFocal] > 0.1 * frame.size_mm.x()) ||
        !(fit.camera[kFocal] < 30 * frame.size_mm.x()))
      break;
    camera = fit.camera;
  }
  Settled(strokes, PointsOf(camera, frame), parallel_rad, mixture);
  double penalty = 0;  // of the priors
  for (int i = kAspect; i < kIntrinsics; ++i) {
    const Prior& prior = photograph.priors[i];
    penalty += std::pow((camera.parameters[i] - prior.value) / prior.sigma, 2);
  }
  return {camera, mixture.log_likelihood - 0.5 * penalty};
}

// Whether so many lines point at one vanishing point although lines of all angles, of which each
// would by chance with the given probability, are all there is. Fewer than one such point in ten
// pictures is to be found among all pairs of `all` lines, by Chernoff's bound of the tail (von Gioi
// and others: a contrario).
bool IsMoreThanChance(int count, double expected, std::size_t all) {
  if (count < 3 || count <= expected) return false;
  const double pairs = 0.5 * static_cast<double>(all) * static_cast<double>(all - 1);
  const double tail = count * std::log(expected / count) + count - expected;
  return std::log(pairs) + tail < std::log(0.1);
}

// Which axes have more lines than chance; each is judged by the lines that are of no other axis.
std::array<bool, 3> SeenAxes(std::span<const Stroke> strokes, const Mat3& points,
                             const std::vector<int>& axis, double parallel_rad) {
  constexpr double kNear = 3;  // deviations
  std::array<bool, 3> seen{};
  for (int k = 0; k < 3; ++k) {
    int count = 0;
    double expected = 0;
    for (std::size_t i = 0; i < strokes.size(); ++i) {
      if (axis[i] != k && axis[i] != kNoAxis) continue;
      const auto miss = MissOf(strokes[i], points.col(k), parallel_rad);
      if (!miss) continue;
      expected += std::min(1.0, 2 * kNear * miss->sigma_rad / kPi);
      count += miss->z2 < kNear * kNear;
    }
    seen[k] = IsMoreThanChance(count, expected, strokes.size());
  }
  return seen;
}

tl::unexpected<geom::Error> Degenerate(const char* detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
}

}  // namespace

ImageLine AsParallel(ImageLine line, double parallel_rad) {
  line.tilt_sigma_px = std::hypot(line.tilt_sigma_px, parallel_rad * line.length_px());
  return line;
}

std::vector<int> AxesOfLines(std::span<const ImageLine> lines, const Frame& frame,
                             const Camera& camera, double parallel_rad) {
  const std::vector<Stroke> strokes = StrokesOf(lines, ConditioningOf(frame));
  Mixture mixture;
  std::vector<int> axes;
  for (const auto& line : Settled(strokes, PointsOf(camera, frame), parallel_rad, mixture)) {
    const auto best = std::ranges::max_element(line, {}, &Membership::probability);
    axes.push_back(best->probability > 0.5 ? static_cast<int>(best - line.begin()) : kNoAxis);
  }
  return axes;
}

geom::Result<VanishingDirections> FindVanishingDirections(std::span<const ImageLine> lines,
                                                          const Frame& frame,
                                                          const DirectionSearch& search) {
  if (lines.size() < 4) return Degenerate("there are fewer than four lines");
  const std::vector<Stroke> all = StrokesOf(lines, ConditioningOf(frame));
  // The longest tell the most; more of them would only take longer to try.
  constexpr std::size_t kTried = 300, kFirsts = 12, kRefined = 8;
  const std::span<const Stroke> tried(all.data(), std::min(kTried, all.size()));
  Fitted best;
  for (const Hypothesis& h :
       Distinct(Hypotheses(tried, FirstDirections(tried, search, kFirsts), search.parallel_rad),
                kRefined)) {
    const Fitted fitted = Refined(lines, all, frame, h, search.parallel_rad);
    if (fitted.score > best.score) best = fitted;
  }
  const char* const kNone = "fewer than two directions have more lines than chance would give them";
  if (!std::isfinite(best.score)) return Degenerate(kNone);

  VanishingDirections found;
  found.camera = CameraOf(FrameFromCamera(best.camera.parameters),
                          WithAxesNamed(CameraFromWorld(best.camera.parameters)), Vec3::Zero());
  found.axis = AxesOfLines(lines, frame, found.camera, search.parallel_rad);
  found.is_seen = SeenAxes(all, PointsOf(found.camera, frame), found.axis, search.parallel_rad);
  for (int& axis : found.axis) {
    if (axis != kNoAxis && !found.is_seen[axis]) axis = kNoAxis;
    if (axis != kNoAxis) ++found.lines[axis];
  }
  if (found.directions() < 2) return Degenerate(kNone);
  return found;
}

}  // namespace tranos::camera
