// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/line_detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "camera/edge_proposals.h"

namespace tranos::camera {
namespace {

constexpr int kLongestSide = 2000, kShortestSide = 16;  // px, of what is searched
constexpr double kSmoothing_px = 1;
// A mean over pixels along an edge that have been smoothed by a Gaussian is as uncertain as one
// over so many times fewer independent ones: the integral of the correlation, 2√π σ.
const double kCorrelated = 2 * std::sqrt(kPi) * kSmoothing_px;
constexpr int kReach = 3;  // across the edge, px: how far off a proposal may be, and a bit

// Where the edge is at one pixel along it.
struct EdgeDot {
  Vec2 at_px;
  double weight;  // the square of the steepness, which the inverse of the variance goes by
};

struct Fit {
  ImageLine line;
  std::vector<EdgeDot> dots;
  double sum_of_weights = 0;
  double spread = 0;  // Σ weight · (along)², px²
  double scatter = 0;  // Σ weight · (across)²: variance of a dot, times its weight and their number
  double from_px = 0;  // along the line, of the first dot, from the centre
  double to_px = 0;    // of the last
  bool bright_left = false;
};

// Catmull and Rom's cubic interpolation; borders repeat.
class Sampler {
 public:
  explicit Sampler(const GreyImage& image) : image_(image) {}

  double operator()(const Vec2& p) const {
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
    const std::array<double, 4> u = Weights(p.x() - x), v = Weights(p.y() - y);
    const bool inside = x >= 1 && y >= 1 && x + 2 < image_.width_px && y + 2 < image_.height_px;
    double sum = 0;
    for (int j = 0; j < 4; ++j) {
      double row = 0;
      const int at_y = inside ? y - 1 + j : std::clamp(y - 1 + j, 0, image_.height_px - 1);
      for (int i = 0; i < 4; ++i) {
        const int at_x = inside ? x - 1 + i : std::clamp(x - 1 + i, 0, image_.width_px - 1);
        row += u[i] * image_.At(at_x, at_y);
      }
      sum += v[j] * row;
    }
    return sum;
  }

  bool Contains(const Vec2& p) const {
    return p.x() >= 0 && p.y() >= 0 && p.x() <= image_.width_px - 1 &&
           p.y() <= image_.height_px - 1;
  }

 private:
  static std::array<double, 4> Weights(double t) {
    const double t2 = t * t, t3 = t2 * t;
    return {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1, -1.5 * t3 + 2 * t2 + 0.5 * t,
            0.5 * t3 - 0.5 * t2};
  }

  const GreyImage& image_;
};

constexpr int kSlopes = 2 * kReach + 1;
using Slopes = std::array<double, kSlopes>;  // of brightness across an edge, at whole pixels

Slopes SlopesAt(const Sampler& sample, const Vec2& at, const Vec2& normal) {
  std::array<double, kSlopes + 2> level;
  for (int s = 0; s < kSlopes + 2; ++s) level[s] = sample(at + (s - kReach - 1) * normal);
  Slopes slopes;
  for (int s = 0; s < kSlopes; ++s) slopes[s] = 0.5 * (level[s + 2] - level[s]);
  return slopes;
}

// The steepest place by the parabola through three logarithms, which is exact for a Gaussian; less
// than `least`, at the end of the reach or where the brightness changes rather along the line, as
// where it crosses another edge, is none.
bool AddDot(const Sampler& sample, const Slopes& slopes, double sign, double least, const Vec2& at,
            const Vec2& normal, std::vector<EdgeDot>& dots) {
  int best = 1;
  for (int s = 2; s < kSlopes - 1; ++s) {
    if (sign * slopes[s] > sign * slopes[best]) best = s;
  }
  const double a = sign * slopes[best - 1], b = sign * slopes[best], c = sign * slopes[best + 1];
  if (b < least || a > b || c > b) return false;
  const double floor = 1e-3 * b;
  const double la = std::log(std::max(a, floor)), lb = std::log(b),
               lc = std::log(std::max(c, floor));
  const double bend = la - 2 * lb + lc;
  const double offset = bend < -1e-9 ? std::clamp(0.5 * (la - lc) / bend, -0.5, 0.5) : 0;
  const Vec2 dot = at + (best - kReach + offset) * normal, along(normal.y(), -normal.x());
  constexpr double kMostAlong = 0.4;  // of the slope across: the edge is within 22° of the line
  if (std::abs(0.5 * (sample(dot + along) - sample(dot - along))) > kMostAlong * b) return false;
  dots.push_back({dot, b * b});
  return true;
}

// Total least squares through the dots, outliers left out; false where fewer than `least` remain.
bool FitDots(Fit& fit, std::size_t least) {
  for (int round = 0; round < 4; ++round) {
    if (fit.dots.size() < least) return false;
    double sum = 0;
    Vec2 centre = Vec2::Zero();
    for (const EdgeDot& d : fit.dots) sum += d.weight, centre += d.weight * d.at_px;
    centre /= sum;
    double xx = 0, xy = 0, yy = 0;
    for (const EdgeDot& d : fit.dots) {
      const Vec2 p = d.at_px - centre;
      xx += d.weight * p.x() * p.x(), xy += d.weight * p.x() * p.y(),
          yy += d.weight * p.y() * p.y();
    }
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    Vec2 along(std::cos(angle), std::sin(angle));
    if (along.dot(fit.line.b_px - fit.line.a_px) < 0) along = -along;
    const Vec2 across(-along.y(), along.x());
    std::vector<double> off;
    off.reserve(fit.dots.size());
    for (const EdgeDot& d : fit.dots) off.push_back(std::abs(across.dot(d.at_px - centre)));
    std::vector<double> sorted = off;
    std::ranges::nth_element(sorted, sorted.begin() + sorted.size() / 2);
    const double limit = std::max(2.5 * 1.4826 * sorted[sorted.size() / 2], 0.05);
    const bool last = round == 3;
    if (!last) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < off.size(); ++i) {
        if (off[i] <= limit) fit.dots[kept++] = fit.dots[i];
      }
      if (kept < fit.dots.size()) {
        fit.dots.resize(kept);
        continue;
      }
    }
    fit.sum_of_weights = sum, fit.spread = 0, fit.scatter = 0;
    fit.from_px = 1e9, fit.to_px = -1e9;
    for (const EdgeDot& d : fit.dots) {
      const double t = along.dot(d.at_px - centre), r = across.dot(d.at_px - centre);
      fit.spread += d.weight * t * t, fit.scatter += d.weight * r * r;
      fit.from_px = std::min(fit.from_px, t), fit.to_px = std::max(fit.to_px, t);
    }
    // As long as a line evenly covered with dots that spread as much, but not beyond them.
    const double half =
        std::min(std::sqrt(3 * fit.spread / sum), std::max(-fit.from_px, fit.to_px));
    fit.line.a_px = centre - half * along, fit.line.b_px = centre + half * along;
    fit.line.dots = static_cast<int>(fit.dots.size());
    return true;
  }
  return false;
}

class Follower {
 public:
  Follower(const GreyImage& smooth, double min_length_px)
      : sample_(smooth), least_(static_cast<std::size_t>(std::max(6.0, 0.7 * min_length_px))) {}

  // The line along a proposal; false where there is hardly an edge.
  bool Follow(const Proposal& proposal, Fit& fit) const {
    Vec2 a = proposal.a_px, b = proposal.b_px;
    for (int round = 0; round < 2; ++round) {
      fit = {};
      fit.line.a_px = a, fit.line.b_px = b;
      const int steps = Locate(a, b, fit);
      if (!FitDots(fit, std::max(least_, static_cast<std::size_t>(steps / 2)))) return false;
      const Vec2 along = (fit.line.b_px - fit.line.a_px).normalized();
      a = fit.line.centre_px() + fit.from_px * along, b = fit.line.centre_px() + fit.to_px * along;
    }
    return true;
  }

 private:
  int Locate(const Vec2& a, const Vec2& b, Fit& fit) const {
    const double length = (b - a).norm();
    const Vec2 along = (b - a) / length, normal(-along.y(), along.x());
    const int steps = std::max(1, static_cast<int>(length) + 1);
    std::vector<Slopes> slopes;
    std::vector<Vec2> places;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const Vec2 at = a + (0.5 * (length - steps + 1) + i) * along;
      if (!sample_.Contains(at)) continue;
      places.push_back(at);
      slopes.push_back(SlopesAt(sample_, at, normal));
      for (int s = -1; s <= 1; ++s) sum += slopes.back()[kReach + s];
    }
    fit.bright_left = sum > 0;
    for (std::size_t i = 0; i < places.size(); ++i)
      AddDot(sample_, slopes[i], sum > 0 ? 1 : -1, kLeastSlope, places[i], normal, fit.dots);
    return steps;
  }

  static constexpr double kLeastSlope = 1;  // levels a pixel, of 256
  Sampler sample_;
  std::size_t least_;
};

double LengthOf(const Fit& fit) { return fit.to_px - fit.from_px; }

// One dot for each pixel along the line that both are on, the steeper.
Fit Joined(const Fit& a, const Fit& b) {
  Fit joined;
  joined.line = a.line, joined.bright_left = a.bright_left;
  const Vec2 along = (a.line.b_px - a.line.a_px).normalized(), origin = a.line.centre_px();
  std::vector<std::pair<int, EdgeDot>> by_place;
  for (const Fit* fit : {&a, &b}) {
    for (const EdgeDot& d : fit->dots)
      by_place.emplace_back(static_cast<int>(std::floor(along.dot(d.at_px - origin))), d);
  }
  std::ranges::stable_sort(by_place, {}, [](const auto& p) { return p.first; });
  for (std::size_t i = 0; i < by_place.size(); ++i) {
    if (i > 0 && by_place[i].first == by_place[i - 1].first) {
      if (by_place[i].second.weight > joined.dots.back().weight)
        joined.dots.back() = by_place[i].second;
      continue;
    }
    joined.dots.push_back(by_place[i].second);
  }
  return joined;
}

// Whether `b`, not the longer, may be a piece of the line `a`: no farther off than an edge is
// followed, the same side bright, overlapping or near.
bool MayContinue(const Fit& a, const Fit& b) {
  const Vec2 along = (a.line.b_px - a.line.a_px).normalized(), across(-along.y(), along.x());
  const Vec2 way = (b.line.b_px - b.line.a_px).normalized();
  const double turn = along.dot(way);
  if (std::abs(turn) < 0.99 || (turn > 0) != (a.bright_left == b.bright_left)) return false;
  const Vec2 to = b.line.centre_px() - a.line.centre_px();
  const double from_end = along.dot(to) + std::min(turn * b.from_px, turn * b.to_px);
  const double to_end = along.dot(to) + std::max(turn * b.from_px, turn * b.to_px);
  const double gap = std::max(from_end - a.to_px, a.from_px - to_end);
  if (gap > std::min(LengthOf(a), LengthOf(b))) return false;
  const double slope = across.dot(way) / turn;
  for (const double t : {from_end, to_end}) {
    const double off = across.dot(to) + slope * (t - along.dot(to));
    if (std::abs(off) > 1.5) return false;
  }
  return true;
}

// Root mean square of the dots' distances from the line, px.
double RootMeanSquare(const Fit& fit) { return std::sqrt(fit.scatter / fit.sum_of_weights); }

// Dots of an edge that is straight do not wander farther; those found along nothing do.
constexpr double kMostScatter_px = 0.5;

// Pieces of one line joined, longest first.
std::vector<Fit> Merged(std::vector<Fit> fits) {
  std::ranges::stable_sort(fits, std::greater<>(), LengthOf);
  std::vector<Fit> merged;
  std::vector<bool> taken(fits.size(), false);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (taken[i]) continue;
    Fit line = std::move(fits[i]);
    bool grown = true;
    while (grown) {
      grown = false;
      for (std::size_t j = i + 1; j < fits.size(); ++j) {
        if (taken[j] || !MayContinue(line, fits[j])) continue;
        Fit joined = Joined(line, fits[j]);
        const std::size_t before = joined.dots.size();
        // A piece beside the line would be left out as an outlier, or bend it.
        if (!FitDots(joined, before * 9 / 10) || RootMeanSquare(joined) > kMostScatter_px) continue;
        line = std::move(joined);
        taken[j] = grown = true;
      }
    }
    merged.push_back(std::move(line));
  }
  return merged;
}

// The variance of a dot times its weight, which is the picture's noise and so much the same for all
// lines: each line's own, and where it has few dots that of the others.
void SetDeviations(std::vector<Fit>& fits) {
  if (fits.empty()) return;
  const auto freedom = [](const Fit& f) {
    return std::max(0.0, static_cast<double>(f.dots.size()) / kCorrelated - 2);
  };
  const auto own = [](const Fit& f) { return f.scatter / static_cast<double>(f.dots.size()); };
  std::vector<double> each;
  for (const Fit& f : fits) each.push_back(own(f));
  std::ranges::nth_element(each, each.begin() + each.size() / 2);
  const double common = each[each.size() / 2];
  constexpr double kCommonCounts = 4;  // degrees of freedom
  for (Fit& f : fits) {
    const double n = freedom(f), correlated = static_cast<double>(f.dots.size()) / (n + 2);
    const double factor = static_cast<double>(f.dots.size()) /
                          std::max(1.0, static_cast<double>(f.dots.size()) - 2 * correlated);
    const double variance =
        (n * own(f) * std::min(factor, 3.0) + kCommonCounts * common) / (n + kCommonCounts);
    f.line.centre_sigma_px = std::sqrt(kCorrelated * variance / f.sum_of_weights);
    f.line.tilt_sigma_px = f.line.length_px() * std::sqrt(kCorrelated * variance / f.spread);
  }
}

}  // namespace

geom::Result<std::vector<ImageLine>> DetectLines(const Photo& photo, const LineDetection& options) {
  if (std::min(photo.width_px, photo.height_px) < kShortestSide)
    return tl::unexpected(geom::Error{geom::ErrorCode::kOutOfRange,
                                      "the photograph is less than 16 pixels wide or high"});
  const int longer = std::max(photo.width_px, photo.height_px);
  const int shorter = std::min(photo.width_px, photo.height_px);
  const int factor =
      std::min((longer + kLongestSide - 1) / kLongestSide, shorter / kShortestSide);
  const double min_px =
      (options.min_length_px > 0 ? options.min_length_px : std::max(12.0, 0.03 * shorter)) / factor;

  const GreyImage grey = GreyOf(photo, factor);
  const GreyImage smooth = Smoothed(grey, kSmoothing_px);
  // Pieces may be joined to what is long enough.
  const double piece_px = std::max(8.0, 0.5 * min_px);
  const Follower follower(smooth, piece_px);
  std::vector<Fit> fits;
  for (const Proposal& proposal : ProposeEdges(grey, piece_px)) {
    Fit fit;
    if (follower.Follow(proposal, fit)) fits.push_back(std::move(fit));
  }
  fits = Merged(std::move(fits));
  SetDeviations(fits);
  std::erase_if(fits, [&](const Fit& f) {
    return LengthOf(f) < min_px || RootMeanSquare(f) > kMostScatter_px;
  });

  std::vector<ImageLine> lines;
  for (const Fit& fit : fits) {
    ImageLine line = fit.line;
    for (Vec2* end : {&line.a_px, &line.b_px})
      *end = (*end + Vec2(0.5, 0.5)) * factor - Vec2(0.5, 0.5);
    line.centre_sigma_px *= factor, line.tilt_sigma_px *= factor;
    lines.push_back(line);
  }
  std::ranges::stable_sort(lines, std::greater<>(), &ImageLine::length_px);
  return lines;
}

}  // namespace tranos::camera
