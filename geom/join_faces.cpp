// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/join_faces.h"

#include <Eigen/SVD>
#include <algorithm>
#include <numeric>
#include <set>

namespace tranos::geom {

namespace {

constexpr std::size_t kMostCorners = 10'000;
// The sine between planes below which they count as parallel, and meet nowhere near.
constexpr double kParallel = 1e-3;

struct Corner {
  int face;
  std::size_t vertex;
  Vec3 point;
};

struct Pair {
  double distance_m;
  std::size_t a, b;
};

// Sets of corners that are to be one, each face in one of them at most once.
class Clusters {
 public:
  explicit Clusters(const std::vector<Corner>& corners) : parent_(corners.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t i = 0; i < corners.size(); ++i) members_.push_back({i});
    for (const Corner& corner : corners) faces_.push_back({corner.face});
  }
  void Join(std::size_t a, std::size_t b) {
    a = parent_[a], b = parent_[b];
    if (a == b) return;
    for (const int face : faces_[b]) {
      if (faces_[a].contains(face)) return;
    }
    for (const std::size_t member : members_[b]) parent_[member] = a;
    members_[a].insert(members_[a].end(), members_[b].begin(), members_[b].end());
    faces_[a].insert(faces_[b].begin(), faces_[b].end());
    members_[b].clear();
  }
  const std::vector<std::vector<std::size_t>>& members() const { return members_; }

 private:
  std::vector<std::size_t> parent_;
  std::vector<std::vector<std::size_t>> members_;
  std::vector<std::set<int>> faces_;
};

// The point of all planes that is nearest to p.
Vec3 NearestOnAll(const std::vector<Frame>& planes, const Vec3& p) {
  Eigen::MatrixX3d normals(static_cast<Eigen::Index>(planes.size()), 3);
  Eigen::VectorXd heights_m(normals.rows());
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    const Frame& plane = planes[static_cast<std::size_t>(i)];
    normals.row(i) = plane.z().transpose();
    heights_m[i] = plane.z().dot(p - plane.origin);
  }
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(normals, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(kParallel);
  return p - svd.solve(heights_m);
}

}  // namespace

Result<std::vector<Polyline>> JoinFaces(const std::vector<Polyline>& outlines, double within_m) {
  std::vector<Frame> planes;
  std::vector<Corner> corners;
  for (std::size_t f = 0; f < outlines.size(); ++f) {
    const int face = static_cast<int>(f);
    if (!outlines[f].closed || outlines[f].vertices.size() < 3) {
      return tl::unexpected(Error{ErrorCode::kNotClosed, "its outline is open", face});
    }
    const auto plane = PlaneOf(outlines[f]);
    if (!plane) return tl::unexpected(Error{ErrorCode::kNotPlanar, "it is not plane", face});
    planes.push_back(*plane);
    for (std::size_t v = 0; v < outlines[f].vertices.size(); ++v) {
      corners.push_back({face, v, outlines[f].vertices[v]});
    }
    if (corners.size() > kMostCorners)
      return tl::unexpected(Error{ErrorCode::kTooLarge, "there are too many corners", face});
  }
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < corners.size(); ++a) {
    for (std::size_t b = a + 1; b < corners.size(); ++b) {
      const double distance_m = (corners[a].point - corners[b].point).norm();
      if (corners[a].face != corners[b].face && distance_m <= within_m)
        pairs.push_back({distance_m, a, b});
    }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::distance_m);
  Clusters clusters(corners);
  for (const Pair& pair : pairs) clusters.Join(pair.a, pair.b);
  std::vector<Polyline> joined = outlines;
  std::vector<bool> meets(outlines.size(), false);
  for (const std::vector<std::size_t>& members : clusters.members()) {
    if (members.size() < 2) continue;
    Vec3 mean = Vec3::Zero();
    std::vector<Frame> theirs;
    for (const std::size_t member : members) {
      mean += corners[member].point / static_cast<double>(members.size());
      theirs.push_back(planes[static_cast<std::size_t>(corners[member].face)]);
    }
    const Vec3 common = NearestOnAll(theirs, mean);
    for (const std::size_t member : members) {
      const auto face = static_cast<std::size_t>(corners[member].face);
      const double off_m = planes[face].z().dot(common - planes[face].origin);
      if ((common - corners[member].point).norm() > within_m || std::abs(off_m) > 1e-6) {
        return tl::unexpected(Error{ErrorCode::kDoNotMeet,
                                    "its plane does not meet the others near their corners",
                                    corners[member].face});
      }
      joined[face].vertices[corners[member].vertex] = common;
      meets[face] = true;
    }
  }
  for (std::size_t f = 0; f < joined.size(); ++f) {
    if (!meets[f]) {
      return tl::unexpected(Error{
          ErrorCode::kDoNotMeet, "no corner of it is near to another face's", static_cast<int>(f)});
    }
    const std::vector<Vec3>& vertices = joined[f].vertices;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if ((vertices[v] - vertices[(v + 1) % vertices.size()]).norm() > kCoincident_m) continue;
      return tl::unexpected(
          Error{ErrorCode::kDegenerate, "it would lose a corner", static_cast<int>(f)});
    }
  }
  return joined;
}

}  // namespace tranos::geom
