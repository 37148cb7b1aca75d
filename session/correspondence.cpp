// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/correspondence.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "model/solid_hash.h"

namespace tranos::session {

namespace {

using geom::Vec3;

constexpr int kCurveSamples = 32;
constexpr int kSurfaceSamples = 8;

// What does not change when an element is moved, hashed; and points that tell its place.
class Skeleton {
 public:
  explicit Skeleton(const model::Element& element) { Add(element, geom::Affine::Identity()); }
  model::Hash128 Structure() const { return hasher_.Finish(); }
  const std::vector<Vec3>& points() const { return points_; }

 private:
  void Add(const model::Element& element, const geom::Affine&) {
    hasher_.Text(model::TypeOf(element));
    std::visit([this](const auto& geometry) { Part(geometry); }, element.geometry);
  }
  void Part(const model::Point& point) { points_.push_back(point.position); }
  void Part(const model::CurvePtr& curve) {
    std::visit([this](const auto& shape) { Part(shape); }, *curve);
  }
  void Part(const model::SurfacePtr& surface) {
    std::visit([this](const auto& shape) { Part(shape); }, *surface);
  }
  void Part(const model::SolidPtr& solid) { Add(*solid); }
  void Part(const model::RegionPtr& region) {
    geom::ForEachOutline(*region, [this](const geom::Curve& outline, bool is_hole) {
      hasher_.Tag(is_hole).Integer(static_cast<std::int64_t>(outline.index()));
      std::visit([this](const auto& shape) { Part(shape); }, outline);
    });
  }
  void Part(const model::TextPtr& text) {
    hasher_.Text(text->content).Length(text->height_m);
    Frame(text->frame, 1);
  }
  void Part(const model::GroupPtr& group) {
    for (const model::ElementPtr& member : group->members) {
      model::AddToHash(hasher_, *member->attributes);
      hasher_.Text(member->name_or_empty());
      Add(*member, geom::Affine::Identity());
    }
  }
  void Part(const model::InstancePtr& instance) {
    hasher_.Hash(instance->prototype->hash);
    const geom::Affine& world = instance->world_from_prototype;
    points_.push_back(world.translation());
    for (int i = 0; i < 3; ++i) points_.push_back(world.translation() + world.linear().col(i));
  }
  void Part(const model::PhotographPtr&) {}
  void Part(const model::TracePtr&) {}
  void Part(const model::FacadePtr& facade) { Frame(facade->plane, 1); }
  void Part(const model::OrthophotoPtr& made) { Frame(made->plane, made->pixel_m); }
  void Part(const geom::Line& line) {
    points_.push_back(line.start);
    points_.push_back(line.end);
  }
  void Part(const geom::Arc& arc) {
    hasher_.Length(arc.radius).Angle(arc.sweep_rad);
    Frame(arc.frame, arc.radius);
  }
  void Part(const geom::Circle& circle) {
    hasher_.Length(circle.radius);
    Frame(circle.frame, circle.radius);
  }
  void Part(const geom::Polyline& polyline) {
    hasher_.Tag(polyline.closed);
    Points(polyline.vertices);
  }
  void Part(const geom::BsplineCurve& curve) {
    hasher_.Integer(curve.degree);
    Ratios(curve.knots);
    Ratios(curve.weights);
    Points(curve.poles);
  }
  void Part(const geom::Chain& chain) {
    hasher_.Tag(chain.closed);
    for (const geom::Segment& segment : chain.segments) {
      hasher_.Integer(static_cast<std::int64_t>(segment.index()));
      std::visit([this](const auto& shape) { Part(shape); }, segment);
    }
  }
  void Part(const geom::BsplineSurface& surface) {
    hasher_.Integer(surface.degree_u).Integer(surface.degree_v).Integer(surface.count_u);
    Ratios(surface.knots_u);
    Ratios(surface.knots_v);
    Ratios(surface.weights);
    Points(surface.poles);
  }
  void Part(const geom::CoonsPatch& patch) {
    for (const auto* side : {&patch.south, &patch.north, &patch.west, &patch.east}) Part(*side);
  }
  // Its meshes, each moved to where it stands; what is made of more than so many is told by its
  // content alone.
  void Add(const geom::Solid& solid) {
    constexpr int kMostNodes = 10'000;
    struct Placed {
      const geom::Solid* solid;
      geom::Affine world_from_solid;
    };
    std::vector<Placed> open = {{&solid, geom::Affine::Identity()}};
    for (int nodes = 0; !open.empty(); ++nodes) {
      if (nodes == kMostNodes) {
        hasher_.Hash(model::HashOf(solid));
        return;
      }
      const Placed next = open.back();
      open.pop_back();
      const geom::Solid::Node& node = next.solid->node();
      if (node.kind != geom::Solid::Kind::kTransformed) {
        hasher_.Tag(static_cast<std::uint8_t>(node.kind));
        hasher_.Integer(static_cast<std::int64_t>(node.mesh.triangles.size()));
      }
      for (const Vec3& p : node.mesh.positions) points_.push_back(next.world_from_solid * p);
      for (const geom::Solid& part : node.parts) {
        open.push_back({&part, next.world_from_solid * node.target_from_source});
      }
    }
  }
  void Frame(const geom::Frame& frame, double size) {
    points_.push_back(frame.origin);
    points_.push_back(frame.origin + size * frame.x);
    points_.push_back(frame.origin + size * frame.y);
  }
  void Points(const std::vector<Vec3>& points) {
    hasher_.Integer(static_cast<std::int64_t>(points.size()));
    points_.insert(points_.end(), points.begin(), points.end());
  }
  void Ratios(const std::vector<double>& numbers) {
    hasher_.Integer(static_cast<std::int64_t>(numbers.size()));
    for (const double number : numbers) hasher_.Ratio(number);
  }

  model::Hasher hasher_;
  std::vector<Vec3> points_;
};

double ToleranceOf(const std::vector<Vec3>& points) {
  double largest = 1;
  for (const Vec3& point : points) largest = std::max(largest, point.cwiseAbs().maxCoeff());
  return 4e-9 * largest;
}

double LargestResidual(const std::vector<Vec3>& p, const std::vector<Vec3>& q,
                       const Eigen::Matrix3d& turn, const Vec3& shift) {
  double largest = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    largest = std::max(largest, (turn * p[i] + shift - q[i]).norm());
  return largest;
}

// Whether some rotation and translation carries p onto q.
bool IsRigid(const std::vector<Vec3>& p, const std::vector<Vec3>& q, double tolerance) {
  Vec3 centre_p = Vec3::Zero(), centre_q = Vec3::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) centre_p += p[i], centre_q += q[i];
  centre_p /= static_cast<double>(p.size());
  centre_q /= static_cast<double>(p.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < p.size(); ++i)
    covariance += (q[i] - centre_q) * (p[i] - centre_p).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d signs = Eigen::Matrix3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs(2, 2) = -1;
  const Eigen::Matrix3d turn = svd.matrixU() * signs * svd.matrixV().transpose();
  return LargestResidual(p, q, turn, centre_q - turn * centre_p) <= tolerance;
}

// The parts of an element that are drawn, each in the world.
std::vector<model::Geometry> LeavesOf(const model::Element& element) {
  std::vector<model::Geometry> leaves;
  model::ForEachLeaf(element, [&](const model::Element& leaf, const geom::Affine& world,
                                  const model::Attributes&) {
    const bool in_place = world.matrix() == geom::Affine::Identity().matrix();
    leaves.push_back(in_place ? leaf.geometry : model::Transformed(leaf, world)->geometry);
  });
  return leaves;
}

double Largest(const std::vector<Vec3>& p, const std::vector<Vec3>& q) {
  return LargestResidual(p, q, Eigen::Matrix3d::Identity(), Vec3::Zero());
}

double CurveDistance(const geom::Curve& a, const geom::Curve& b) {
  const auto *p = std::get_if<geom::Polyline>(&a), *q = std::get_if<geom::Polyline>(&b);
  if (p && q && p->vertices.size() == q->vertices.size()) return Largest(p->vertices, q->vertices);
  const bool straight =
      std::holds_alternative<geom::Line>(a) && std::holds_alternative<geom::Line>(b);
  const int samples = straight ? 1 : kCurveSamples;
  double largest = 0;
  for (int i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples;
    largest = std::max(largest, (geom::PointAt(a, t) - geom::PointAt(b, t)).norm());
  }
  return largest;
}

double SurfaceDistance(const geom::Surface& a, const geom::Surface& b) {
  const auto *p = std::get_if<geom::BsplineSurface>(&a), *q = std::get_if<geom::BsplineSurface>(&b);
  if (p && q && p->poles.size() == q->poles.size() && p->count_u == q->count_u)
    return Largest(p->poles, q->poles);
  double largest = 0;
  for (int i = 0; i <= kSurfaceSamples; ++i) {
    for (int j = 0; j <= kSurfaceSamples; ++j) {
      const double u = static_cast<double>(i) / kSurfaceSamples,
                   v = static_cast<double>(j) / kSurfaceSamples;
      largest = std::max(largest, (geom::PointAt(a, u, v) - geom::PointAt(b, u, v)).norm());
    }
  }
  return largest;
}

// Of solids with the same facets.
std::optional<double> SolidDistance(const geom::Solid& a, const geom::Solid& b) {
  const auto p = a.Facets(), q = b.Facets();
  if (!p || !q || (*p)->triangles != (*q)->triangles) return std::nullopt;
  return Largest((*p)->positions, (*q)->positions);
}

// Nothing where they have other numbers of outlines.
std::optional<double> RegionDistance(const geom::Region& a, const geom::Region& b) {
  std::vector<const geom::Curve*> outlines;
  geom::ForEachOutline(a, [&](const geom::Curve& outline, bool) { outlines.push_back(&outline); });
  std::size_t index = 0;
  double largest = 0;
  geom::ForEachOutline(b, [&](const geom::Curve& outline, bool) {
    if (index < outlines.size()) {
      largest = std::max(largest, CurveDistance(*outlines[index], outline));
    }
    ++index;
  });
  if (index != outlines.size()) return std::nullopt;
  return largest;
}

double TextDistance(const geom::Text& a, const geom::Text& b) {
  const auto corner = [](const geom::Text& text, double x, double y) {
    return Vec3(text.frame.origin + text.height_m * (x * text.frame.x + y * text.frame.y));
  };
  double largest = 0;
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}) {
    largest = std::max(largest, (corner(a, x, y) - corner(b, x, y)).norm());
  }
  return largest;
}

std::optional<double> LeafDistance(const model::Geometry& a, const model::Geometry& b) {
  if (a.index() != b.index()) return std::nullopt;
  if (const auto* p = std::get_if<model::Point>(&a))
    return (p->position - std::get<model::Point>(b).position).norm();
  if (const auto* p = std::get_if<model::CurvePtr>(&a))
    return CurveDistance(**p, *std::get<model::CurvePtr>(b));
  if (const auto* p = std::get_if<model::SurfacePtr>(&a))
    return SurfaceDistance(**p, *std::get<model::SurfacePtr>(b));
  if (const auto* p = std::get_if<model::SolidPtr>(&a))
    return SolidDistance(**p, *std::get<model::SolidPtr>(b));
  if (const auto* p = std::get_if<model::RegionPtr>(&a))
    return RegionDistance(**p, *std::get<model::RegionPtr>(b));
  if (const auto* p = std::get_if<model::TextPtr>(&a))
    return TextDistance(**p, *std::get<model::TextPtr>(b));
  return std::nullopt;
}

}  // namespace

std::optional<Displacement> RigidDisplacement(const model::Element& a, const model::Element& b) {
  if (a.geometry.index() != b.geometry.index()) return std::nullopt;
  const Skeleton p(a), q(b);
  if (p.points().size() != q.points().size() || p.points().empty() ||
      p.Structure() != q.Structure())
    return std::nullopt;
  const double tolerance = ToleranceOf(q.points());
  const Vec3 shift = q.points()[0] - p.points()[0];
  const double by_shift =
      LargestResidual(p.points(), q.points(), Eigen::Matrix3d::Identity(), shift);
  if (by_shift <= tolerance) return Displacement{shift.norm(), shift};
  if (!IsRigid(p.points(), q.points(), tolerance)) return std::nullopt;
  return Displacement{LargestDistance(a, b).value_or(Largest(p.points(), q.points())),
                      std::nullopt};
}

model::Hash128 ShapeHash(const model::Element& element) { return Skeleton(element).Structure(); }
std::size_t ShapePoints(const model::Element& element) { return Skeleton(element).points().size(); }

model::Hash128 GeometryHash(const model::Element& element) {
  static const auto kUsual = std::make_shared<const model::Attributes>();
  return model::MakeElement(0, element.geometry, kUsual, nullptr, {})->hash;
}

std::optional<double> LargestDistance(const model::Element& a, const model::Element& b) {
  const auto p = LeavesOf(a), q = LeavesOf(b);
  if (p.size() != q.size()) return std::nullopt;
  double largest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto distance = LeafDistance(p[i], q[i]);
    if (!distance) return std::nullopt;
    largest = std::max(largest, *distance);
  }
  return largest;
}

}  // namespace tranos::session
