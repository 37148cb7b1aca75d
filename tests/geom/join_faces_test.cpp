// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/join_faces.h"

#include <gtest/gtest.h>

namespace tranos::geom {
namespace {

Polyline Face(std::vector<Vec3> vertices) { return {std::move(vertices), true}; }

// A house of 4 m by 3 m, 2 m to the eaves and 3 m to the ridge; each face is off in its own plane
// by a few millimetres.
std::vector<Polyline> House(double off) {
  const double o = off;
  const Vec3 slope = off * Vec3(0, 1.5, 1).normalized();
  return {Face({{o, 0, 0}, {4, 0, o}, {4 - o, 0, 2}, {0, 0, 2 - o}}),
          Face({{4, 0, 0}, {4, 3, o}, {4, 3, 2}, {4, 1.5 + o, 3}, {4, o, 2}}),
          Face({{4, 3, 0}, {o, 3, 0}, {0, 3, 2 + o}, {4, 3, 2}}),
          Face({{0, 3 + o, 0}, {0, 0, 0}, {0, 0, 2}, {0, 1.5, 3 - o}, {0, 3, 2}}),
          Face({Vec3(0, 0, 2) + slope, {4, 0, 2}, {4 + o, 1.5, 3}, {0, 1.5, 3}}),
          Face({{0, 3, 2}, {-o, 1.5, 3}, {4, 1.5, 3}, {4 + o, 3, 2}}),
          Face({{0, 0, 0}, {o, 3, 0}, {4, 3, 0}, {4, o, 0}})};
}

TEST(JoinFaces, GiveOneCornerWhereThreePlanesMeet) {
  const auto joined = JoinFaces(House(0.004), 0.02);
  ASSERT_TRUE(joined);
  const std::vector<Polyline> exact = House(0);
  for (std::size_t f = 0; f < exact.size(); ++f) {
    for (std::size_t v = 0; v < exact[f].vertices.size(); ++v) {
      EXPECT_LT(((*joined)[f].vertices[v] - exact[f].vertices[v]).norm(), 1e-9) << f << ' ' << v;
    }
  }
}

TEST(JoinFaces, OnALineOfTwoPlanesTheMeanIsTaken) {
  const auto joined = JoinFaces({Face({{0, 0, 0}, {2, 0, 0}, {2, 0, 1.02}, {0, 0, 1}}),
                                 Face({{2, 0.01, 0.04}, {2, 2, 0}, {2, 2, 1}, {2, 0, 0.98}})},
                                0.05);
  ASSERT_TRUE(joined);
  EXPECT_LT(((*joined)[0].vertices[1] - Vec3(2, 0, 0.02)).norm(), 1e-9);
  EXPECT_EQ((*joined)[0].vertices[1], (*joined)[1].vertices[0]);
  EXPECT_LT(((*joined)[1].vertices[3] - Vec3(2, 0, 1)).norm(), 1e-9);
  EXPECT_EQ((*joined)[0].vertices[0], Vec3(0, 0, 0));  // where no other face is, nothing moves
}

TEST(JoinFaces, FaultsAreNamed) {
  const Polyline front = Face({{0, 0, 0}, {2, 0, 0}, {2, 0, 1}});
  const auto failure = [](const std::vector<Polyline>& faces) {
    const auto joined = JoinFaces(faces, 0.05);
    EXPECT_FALSE(joined);
    return joined ? Error{} : joined.error();
  };
  EXPECT_EQ(failure({front, Face({{5, 0, 0}, {5, 1, 0}, {5, 1, 1}})}).code, ErrorCode::kDoNotMeet);
  EXPECT_EQ(failure({front, {{{2, 0, 0}, {2, 1, 0}, {2, 1, 1}}, false}}).code,
            ErrorCode::kNotClosed);
  const Error bent = failure({front, Face({{2, 0, 0}, {2, 1, 0}, {2, 1, 1}, {2.2, 0, 1}})});
  EXPECT_EQ(bent.code, ErrorCode::kNotPlanar);
  EXPECT_EQ(bent.part, 1);
  // Parallel planes a centimetre apart meet nowhere.
  EXPECT_EQ(failure({front, Face({{0, 0.01, 0}, {2, 0.01, 0}, {2, 0.01, 1}})}).code,
            ErrorCode::kDoNotMeet);
}

}  // namespace
}  // namespace tranos::geom
