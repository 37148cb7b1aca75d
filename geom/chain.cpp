// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

Vec3 StartOf(const Curve& curve) { return PointAt(curve, 0); }
Vec3 EndOf(const Curve& curve) { return PointAt(curve, 1); }

// Where a closed curve's repeated start is: a polyline that says `closed` ends where it starts.
void Append(const Curve& curve, Chain& chain) {
  std::visit(Overloaded{[&](const Chain& c) {
                          chain.segments.insert(chain.segments.end(), c.segments.begin(),
                                                c.segments.end());
                        },
                        [&](const auto& c) { chain.segments.push_back(c); }},
             curve);
}

}  // namespace

Result<Chain> JoinChain(const std::vector<Curve>& curves, double tolerance_m) {
  if (curves.empty()) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "there are no curves to join"});
  }
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (auto checked = Check(curves[i]); !checked) {
      checked.error().part = static_cast<int>(i);
      return tl::unexpected(checked.error());
    }
  }
  auto meet = [&](const Vec3& a, const Vec3& b) { return (a - b).norm() <= tolerance_m; };
  auto reaches = [&](const Vec3& end, const Curve& next) {
    return meet(end, StartOf(next)) || meet(end, EndOf(next));
  };
  Chain chain;
  const bool turn = curves.size() > 1 && !reaches(EndOf(curves[0]), curves[1]) &&
                    reaches(StartOf(curves[0]), curves[1]);
  const Curve first = turn ? Reversed(curves[0]) : curves[0];
  Append(first, chain);
  const Vec3 start = StartOf(first);
  Vec3 end = EndOf(first);
  for (std::size_t i = 1; i < curves.size(); ++i) {
    if (!reaches(end, curves[i])) {
      return tl::unexpected(Error{ErrorCode::kDoNotMeet, "the ends of two neighbours lie apart",
                                  static_cast<int>(i)});
    }
    const Curve next = meet(end, StartOf(curves[i])) ? curves[i] : Reversed(curves[i]);
    Append(next, chain);
    end = EndOf(next);
  }
  chain.closed = meet(start, end) && Length(chain) > 2 * tolerance_m;
  return chain;
}

}  // namespace tranos::geom
