// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/distortion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

namespace tranos::camera {
namespace {

using Eigen::Matrix2d;
using geom::Error;
using geom::ErrorCode;

// A dot relative to the centre, in units of the distortion.
Vec2 Relative(const Distortion& d, const Frame& frame, const Vec2& dot_px) {
  return (frame.PointFromDot(dot_px) - d.centre_mm).cwiseQuotient(d.unit_mm);
}

Vec2 DotOf(const Distortion& d, const Frame& frame, const Vec2& relative) {
  return frame.DotFromPoint(relative.cwiseProduct(d.unit_mm) + d.centre_mm);
}

double Distorted(const Distortion& d, double r) {
  const double s = r * r;
  return r * (1 + s * (d.k1 + s * d.k2));
}

double Slope(const Distortion& d, double r) {
  const double s = r * r;
  return 1 + s * (3 * d.k1 + s * 5 * d.k2);
}

// The least r > 0 where the slope is 0; infinite where it never is.
double FoldRadius(const Distortion& d) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double a = 5 * d.k2, b = 3 * d.k1, root = b * b - 4 * a;
  if (root < 0) return kNever;
  // 1 + b s + a s² = 0 as s = −2 / (b ± √root), which holds for a = 0, too.
  double least = kNever;
  for (const double sign : {-1., 1.}) {
    const double s = -2 / (b + sign * std::sqrt(root));
    if (s > 0) least = std::min(least, s);
  }
  return std::sqrt(least);
}

// The r that is distorted to r_seen: Newton's steps, kept between bounds that enclose it.
std::optional<double> Undistorted(const Distortion& d, double r_seen) {
  double low = 0, high = FoldRadius(d);
  if (std::isinf(high)) {
    for (high = std::max(1., r_seen); Distorted(d, high) <= r_seen;) high *= 2;
  }
  if (!(r_seen < Distorted(d, high))) return std::nullopt;
  double r = std::min(r_seen, 0.5 * (low + high));
  for (int i = 0; i < 200; ++i) {
    const double off = Distorted(d, r) - r_seen;
    (off > 0 ? high : low) = r;
    double next = r - off / Slope(d, r);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::abs(next - r);
    r = next;
    if (step <= 1e-15 * r) break;
  }
  return r;
}

// A dot with the distortion taken away, and how that depends on the dot, k1 and k2.
struct Straightened {
  Vec2 dot_px;
  Matrix2d by_dot;
  Eigen::Matrix2d by_k;  // a column for each
};

std::optional<Straightened> Straighten(const Distortion& d, const Frame& frame,
                                       const Vec2& dot_px) {
  const Vec2 seen = Relative(d, frame, dot_px);
  const double r_seen = seen.norm();
  if (r_seen == 0) return Straightened{dot_px, Matrix2d::Identity(), Matrix2d::Zero()};
  const auto r = Undistorted(d, r_seen);
  if (!r) return std::nullopt;
  const double shrink = *r / r_seen, slope = Slope(d, *r);
  const Vec2 outward = seen / r_seen, dots = d.unit_mm.cwiseQuotient(frame.pitch_mm());
  const Matrix2d by_seen =
      shrink * Matrix2d::Identity() + (1 / slope - shrink) * outward * outward.transpose();
  Straightened s;
  s.dot_px = DotOf(d, frame, shrink * seen);
  s.by_dot = dots.asDiagonal() * by_seen * dots.cwiseInverse().asDiagonal();
  const double cube = *r * *r * *r;
  s.by_k.col(0) = dots.cwiseProduct(outward) * (-cube / slope);
  s.by_k.col(1) = dots.cwiseProduct(outward) * (-cube * *r * *r / slope);
  return s;
}

// What a line says of k1 and k2 once its own two parameters are eliminated.
struct Information {
  Matrix2d normal = Matrix2d::Zero();
  Vec2 gradient = Vec2::Zero();
  double misfit = 0;

  void Add(const Information& i) {
    normal += i.normal;
    gradient += i.gradient;
    misfit += i.misfit;
  }
};

// The unit normal of the line through weighted dots by total least squares, and their centroid.
struct FittedLine {
  Vec2 normal;
  Vec2 centroid;
};

FittedLine LineOf(const std::vector<Straightened>& dots, const std::vector<double>& weights) {
  double weight = 0;
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < dots.size(); ++i) {
    weight += weights[i];
    sum += weights[i] * dots[i].dot_px;
  }
  const Vec2 centroid = sum / weight;
  Matrix2d scatter = Matrix2d::Zero();
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const Vec2 off = dots[i].dot_px - centroid;
    scatter += weights[i] * off * off.transpose();
  }
  return {Eigen::SelfAdjointEigenSolver<Matrix2d>(scatter).eigenvectors().col(0), centroid};
}

// A dot's noise across the line is that of the photograph, stretched as the dot was moved.
std::vector<double> Weights(const std::vector<Straightened>& dots, const Vec2& normal,
                            double sigma_px) {
  std::vector<double> weights;
  for (const Straightened& s : dots) {
    weights.push_back(1 / ((s.by_dot.transpose() * normal).squaredNorm() * sigma_px * sigma_px));
  }
  return weights;
}

std::optional<Information> InformationOf(const PlumbLine& line, const Distortion& d,
                                         const Frame& frame) {
  std::vector<Straightened> dots;
  for (const Vec2& dot : line.dots_px) {
    const auto s = Straighten(d, frame, dot);
    if (!s) return std::nullopt;
    dots.push_back(*s);
  }
  std::vector<double> weights(dots.size(), 1);
  FittedLine fit = LineOf(dots, weights);
  for (int pass = 0; pass < 3; ++pass) {
    weights = Weights(dots, fit.normal, line.sigma_px);
    fit = LineOf(dots, weights);
  }
  const Vec2 along(-fit.normal.y(), fit.normal.x());
  const Vec2 centre = frame.DotFromPoint(d.centre_mm);
  const double from_centre = fit.normal.dot(fit.centroid - centre);
  Information info;
  Matrix2d lines = Matrix2d::Zero(), mixed = Matrix2d::Zero();
  Vec2 line_gradient = Vec2::Zero();
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const Vec2 off = dots[i].dot_px - fit.centroid, out = dots[i].dot_px - centre;
    const double distance = fit.normal.dot(off);
    // Taken at the dot's foot on the line: of a line through the centre its own noise would else
    // seem to tell something.
    const double slant = fit.normal.dot(out);
    Eigen::RowVector2d by_k = fit.normal.transpose() * dots[i].by_k;
    if (slant != 0) by_k *= from_centre / slant;
    const Eigen::RowVector2d by_line(along.dot(off), 1);
    info.normal += weights[i] * by_k.transpose() * by_k;
    mixed += weights[i] * by_k.transpose() * by_line;
    lines += weights[i] * by_line.transpose() * by_line;
    info.gradient += weights[i] * distance * by_k.transpose();
    line_gradient += weights[i] * distance * by_line.transpose();
    info.misfit += weights[i] * distance * distance;
  }
  const Matrix2d eliminate = lines.ldlt().solve(mixed.transpose()).transpose();
  info.normal -= eliminate * mixed.transpose();
  info.gradient -= eliminate * line_gradient;
  return info;
}

std::optional<Information> InformationOf(std::span<const PlumbLine> lines, const Distortion& d,
                                         const Frame& frame) {
  Information sum;
  for (const PlumbLine& line : lines) {
    const auto info = InformationOf(line, d, frame);
    if (!info) return std::nullopt;
    sum.Add(*info);
  }
  return sum;
}

tl::unexpected<Error> Degenerate(std::string detail, int part = -1) {
  return tl::unexpected(Error{ErrorCode::kDegenerate, std::move(detail), part});
}

std::optional<Error> FaultOf(std::span<const PlumbLine> lines, const Vec2& centre_mm, int terms) {
  if (terms != 1 && terms != 2) return Error{ErrorCode::kOutOfRange, "one or two terms, no other"};
  if (!centre_mm.allFinite()) return Error{ErrorCode::kOutOfRange, "the centre is no point"};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int part = static_cast<int>(i);
    if (lines[i].dots_px.size() < 3) {
      return Error{ErrorCode::kDegenerate, "a line of fewer than three dots is always straight",
                   part};
    }
    if (!(lines[i].sigma_px > 0)) {
      return Error{ErrorCode::kOutOfRange, "a dot's deviation must be above 0", part};
    }
    bool is_one = true;
    for (const Vec2& dot : lines[i].dots_px) {
      if (!dot.allFinite()) return Error{ErrorCode::kOutOfRange, "a dot is no point", part};
      is_one = is_one && dot == lines[i].dots_px[0];
    }
    if (is_one) return Error{ErrorCode::kDegenerate, "the line's dots are all one", part};
  }
  return std::nullopt;
}

// A deviation of k as large as this leaves the corners anywhere.
constexpr double kUseless = 0.25;

// The inverse of the information on the terms sought, or what is not determined.
geom::Result<Matrix2d> CovarianceOf(const Matrix2d& information, int terms) {
  const double of_k1 = information(0, 0);
  if (!(of_k1 * kUseless * kUseless > 1)) {
    return Degenerate(
        "the distortion is not determined: lines through the lens's centre stay straight; trace "
        "long lines near the picture's edges");
  }
  Matrix2d covariance = Matrix2d::Zero();
  covariance(0, 0) = 1 / of_k1;
  if (terms == 1) return covariance;
  const double determinant = information.determinant();
  // What is known of k1 and of k2 when the other is free.
  const double alone = determinant / information(1, 1), other = determinant / of_k1;
  if (!(std::min(alone, other) * kUseless * kUseless > 1)) {
    return Degenerate(
        "k1 and k2 are not determined, as they trade off: the lines' dots lie at too few distances "
        "from the centre; ask for one term");
  }
  return Matrix2d(information.inverse());
}

struct Found {
  Distortion distortion;
  Information information;
};

// Gauss–Newton in k1 and k2, the lines fitted anew at each step; a step that makes the fit worse is
// halved.
geom::Result<Found> Descend(std::span<const PlumbLine> lines, const Frame& frame, Distortion d,
                            int terms) {
  auto info = InformationOf(lines, d, frame);
  for (int iteration = 0; info && iteration < 100; ++iteration) {
    const auto covariance = CovarianceOf(info->normal, terms);
    if (!covariance) return tl::unexpected(covariance.error());
    Vec2 step = -*covariance * info->gradient;
    // The step's square in deviations: a thousandth of one, or the rounding of exact dots.
    const double gain = -step.dot(info->gradient);
    if (gain < std::max(1e-9 * info->misfit, 1e-20)) return Found{d, *info};
    for (int halving = 0;; ++halving) {
      Distortion moved = d;
      moved.k1 += step.x();
      moved.k2 += step.y();
      const auto after = InformationOf(lines, moved, frame);
      if (after && after->misfit < info->misfit) {
        d = moved;
        info = after;
        break;
      }
      // No smaller misfit along the step: within rounding it is the least.
      if (halving == 40) return Found{d, *info};
      step *= 0.5;
    }
  }
  return Degenerate("the fit of the distortion does not converge");
}

}  // namespace

Vec2 DistortDot(const Distortion& d, const Frame& frame, const Vec2& dot_px) {
  const Vec2 relative = Relative(d, frame, dot_px);
  const double s = relative.squaredNorm();
  return DotOf(d, frame, (1 + s * (d.k1 + s * d.k2)) * relative);
}

geom::Result<Vec2> UndistortDot(const Distortion& d, const Frame& frame, const Vec2& dot_px) {
  const auto s = Straighten(d, frame, dot_px);
  if (!s) {
    return tl::unexpected(
        Error{ErrorCode::kOutOfRange, "the dot lies where the distortion folds the picture"});
  }
  return s->dot_px;
}

geom::Result<DistortionFit> FitDistortion(std::span<const PlumbLine> lines, const Frame& frame,
                                          const Vec2& centre_mm, int terms) {
  if (const auto fault = FaultOf(lines, centre_mm, terms)) return tl::unexpected(*fault);
  Distortion start;
  start.centre_mm = centre_mm;
  start.unit_mm = Vec2::Constant(0.5 * frame.size_mm.norm());
  const auto found = Descend(lines, frame, start, terms);
  if (!found) return tl::unexpected(found.error());
  const auto covariance = CovarianceOf(found->information.normal, terms);
  if (!covariance) return tl::unexpected(covariance.error());
  int degrees = -terms;
  for (const PlumbLine& line : lines) degrees += static_cast<int>(line.dots_px.size()) - 2;
  return DistortionFit{found->distortion, *covariance, found->information.misfit, degrees};
}

}  // namespace tranos::camera
