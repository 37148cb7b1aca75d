// SPDX-License-Identifier: GPL-3.0-or-later
// The smooth surface through a row of curves (L. Piegl, W. Tiller: The NURBS Book, 10.3: skinning).
#include <algorithm>
#include <cmath>

#include "geom/construction.h"
#include "geom/surface_patches.h"

namespace tranos::geom {
namespace {

constexpr int kSamples = 16;  // at which it is seen which way a profile runs

tl::unexpected<Error> At(std::size_t profile, ErrorCode code, std::string detail) {
  return tl::unexpected(Error{code, std::move(detail), static_cast<int>(profile)});
}

// How far the curves lie apart, each seen from its middle.
double Apart(const Curve& a, const Curve& b) {
  std::vector<Vec3> differences;
  Vec3 mean = Vec3::Zero();
  for (int i = 0; i <= kSamples; ++i) {
    const double t = i / double{kSamples};
    differences.emplace_back(PointAt(a, t) - PointAt(b, t));
    mean += differences.back() / (kSamples + 1);
  }
  double sum = 0;
  for (const Vec3& d : differences) sum += (d - mean).squaredNorm();
  return sum;
}

// The mean way from one profile's poles to the next one's.
Result<std::vector<double>> ChordsOf(const std::vector<BsplineCurve>& profiles) {
  std::vector<double> chords;
  for (std::size_t k = 0; k + 1 < profiles.size(); ++k) {
    double sum = 0;
    const std::size_t count = profiles[k].poles.size();
    for (std::size_t i = 0; i < count; ++i) {
      sum += (profiles[k + 1].poles[i] - profiles[k].poles[i]).norm();
    }
    chords.push_back(sum / static_cast<double>(count));
    if (!(chords.back() > kCoincident_m)) {
      return At(k + 1, ErrorCode::kDegenerate, "the profile lies on the one before");
    }
  }
  return chords;
}

}  // namespace

Result<Surface> LoftSurface(const std::vector<Curve>& profiles) {
  std::vector<Curve> row;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    if (auto checked = Check(profiles[i]); !checked) {
      return At(i, checked.error().code, checked.error().detail);
    }
    if (!(Length(profiles[i]) > 0)) {
      return At(i, ErrorCode::kDegenerate, "the profile has no length");
    }
    const Curve turned = Reversed(profiles[i]);
    const bool turn = i > 0 && Apart(turned, row.back()) < Apart(profiles[i], row.back());
    row.push_back(turn ? turned : profiles[i]);
  }
  const std::vector<BsplineCurve> alike = MadeAlike(row);
  const Result<std::vector<double>> chords = ChordsOf(alike);
  if (!chords) return tl::unexpected(chords.error());
  BsplineSurface surface;
  surface.degree_u = alike[0].degree;
  surface.knots_u = alike[0].knots;
  surface.count_u = static_cast<int>(alike[0].poles.size());
  const auto count = static_cast<Eigen::Index>(alike.size());
  for (std::size_t i = 0; i < alike[0].poles.size(); ++i) {
    Eigen::MatrixXd through(count, 4);
    for (Eigen::Index k = 0; k < count; ++k) {
      const BsplineCurve& profile = alike[static_cast<std::size_t>(k)];
      through.row(k) =
          Homogeneous(profile.poles[i], profile.weights.empty() ? 1 : profile.weights[i]);
    }
    const CubicRow cubic = CubicThrough(through, *chords, false);
    surface.knots_v = cubic.knots;
    surface.count_v = static_cast<int>(cubic.poles.rows());
    for (Eigen::Index k = 0; k < cubic.poles.rows(); ++k) {
      const Vec4 pole = cubic.poles.row(k).transpose();
      if (!(pole.w() > 0)) {
        return At(0, ErrorCode::kDegenerate, "the profiles are too unlike for a smooth surface");
      }
      surface.poles.push_back(Projected(pole));
      surface.weights.push_back(pole.w());
    }
  }
  surface.degree_v = 3;
  Surface result = surface;
  if (auto checked = Check(result); !checked) return tl::unexpected(checked.error());
  return result;
}

}  // namespace tranos::geom
