// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of elements: sums, boxes and nearest points over the leaves of groups and instances.
#include <algorithm>
#include <cmath>

#include "model/element.h"

namespace tranos::model {

namespace {

// The factor by which a transform scales every length alike; nothing if it stretches or shears.
std::optional<double> ScaleOf(const geom::Affine& target_from_source) {
  const Eigen::Matrix3d linear = target_from_source.linear();
  const Eigen::Matrix3d square = linear.transpose() * linear;
  const double scale_squared = square.trace() / 3;
  const double error = (square - scale_squared * Eigen::Matrix3d::Identity()).norm();
  if (!(error <= 1e-13 * scale_squared)) return std::nullopt;
  return std::sqrt(scale_squared);
}

// A transform that maps axes to axes maps the tight box to the tight box.
bool MapsAxesToAxes(const geom::Affine& target_from_source) {
  const Eigen::Matrix3d linear = target_from_source.linear();
  return (linear.array() != 0).rowwise().count().maxCoeff() <= 1;
}

geom::Box Mapped(const geom::Box& box, const geom::Affine& target_from_source) {
  geom::Box result;
  if (box.empty()) return result;
  result.Add(target_from_source * box.min);
  result.Add(target_from_source * box.max);
  return result;
}

template <class Shape>
geom::Box BoxOf(const Shape& shape, const geom::Affine& world_from_shape) {
  if (MapsAxesToAxes(world_from_shape)) {
    return Mapped(geom::BoundingBox(shape), world_from_shape);
  }
  return geom::BoundingBox(geom::Transformed(shape, world_from_shape));
}
// A solid's is of its facets once there are any, and around them before.
geom::Box BoxOf(const geom::Solid& solid, const geom::Affine& world_from_shape) {
  if (MapsAxesToAxes(world_from_shape)) return Mapped(solid.Bounds(), world_from_shape);
  const std::shared_ptr<const geom::TriangleMesh> facets = solid.node().facets;
  if (!facets) return solid.Transformed(world_from_shape).Bounds();
  geom::Box box;
  for (const geom::Vec3& p : facets->positions) box.Add(world_from_shape * p);
  return box;
}
geom::Box BoxOf(const Point& point, const geom::Affine& world_from_shape) {
  geom::Box box;
  box.Add(world_from_shape * point.position);
  return box;
}

// Calls f(shape, world_from_shape) for the shape of every leaf: a point, a curve, a surface, a
// region, a solid or a text.
template <class F>
void ForEachShape(const Element& element, const F& f) {
  ForEachLeaf(element, [&](const Element& leaf, const geom::Affine& world, const Attributes&) {
    if (const auto* point = std::get_if<Point>(&leaf.geometry)) f(*point, world, leaf);
    if (const auto* curve = std::get_if<CurvePtr>(&leaf.geometry)) f(**curve, world, leaf);
    if (const auto* surface = std::get_if<SurfacePtr>(&leaf.geometry)) f(**surface, world, leaf);
    if (const auto* solid = std::get_if<SolidPtr>(&leaf.geometry)) f(**solid, world, leaf);
    if (const auto* region = std::get_if<RegionPtr>(&leaf.geometry)) f(**region, world, leaf);
    if (const auto* text = std::get_if<TextPtr>(&leaf.geometry)) f(**text, world, leaf);
  });
}

void AddTo(std::optional<double>& sum, std::optional<double> measure) {
  if (measure) sum = sum.value_or(0) + *measure;
}

// measure(shape) in the world, where it grows with the power-th power of the scale.
template <class Shape, class Measure>
double MeasureInWorld(const Shape& shape, const geom::Affine& world_from_shape, int power,
                      const Measure& measure) {
  if (const std::optional<double> scale = ScaleOf(world_from_shape)) {
    return std::pow(*scale, power) * measure(shape);
  }
  return measure(geom::Transformed(shape, world_from_shape));
}

// Of the body that the facets of a closed surface enclose.
double EnclosedVolume(const geom::Mesh& mesh) {
  double sixfold = 0;
  for (const auto& triangle : mesh.triangles) {
    sixfold += mesh.positions[triangle[0]].dot(
        mesh.positions[triangle[1]].cross(mesh.positions[triangle[2]]));
  }
  return std::abs(sixfold) / 6;
}

std::optional<double> AreaInWorld(const geom::Solid& solid, const geom::Affine& world_from_solid) {
  const auto facets = solid.Facets();
  if (!facets) return std::nullopt;
  if (const std::optional<double> scale = ScaleOf(world_from_solid)) {
    return *scale * *scale * geom::Area(**facets);
  }
  return geom::Area(geom::Transformed(**facets, world_from_solid));
}

geom::Nearest NearestTo(const geom::Solid& solid, const geom::Vec3& p) {
  const auto facets = solid.Facets();
  if (facets) return geom::NearestPoint(**facets, p);
  return {p, std::numeric_limits<double>::infinity(), 0};
}
geom::Nearest NearestTo(const Point& point, const geom::Vec3& p) {
  return {point.position, (point.position - p).norm(), 0};
}
template <class Shape>
geom::Nearest NearestTo(const Shape& shape, const geom::Vec3& p) {
  return geom::NearestPoint(shape, p);
}
geom::Nearest NearestTo(const geom::Text& text, const geom::Vec3& p) {
  geom::Nearest best = NearestTo(Point{text.frame.origin}, p);
  for (std::vector<geom::Vec3>& stroke : geom::Strokes(text)) {
    if (stroke.size() < 2) continue;
    const geom::Nearest on_stroke =
        geom::NearestPoint(geom::Curve(geom::Polyline{std::move(stroke), false}), p);
    if (on_stroke.distance_m < best.distance_m) best = on_stroke;
  }
  return best;
}

Point TransformedShape(const Point& point, const geom::Affine& world_from_shape) {
  return {world_from_shape * point.position};
}
geom::Solid TransformedShape(const geom::Solid& solid, const geom::Affine& world_from_shape) {
  return solid.Transformed(world_from_shape);
}
template <class Shape>
Shape TransformedShape(const Shape& shape, const geom::Affine& world_from_shape) {
  return geom::Transformed(shape, world_from_shape);
}

// Under a similarity the question is taken to the shape, which is cheaper than the reverse.
template <class Shape>
geom::Nearest NearestInWorld(const Shape& shape, const geom::Affine& world_from_shape,
                             const geom::Vec3& p) {
  const std::optional<double> scale = ScaleOf(world_from_shape);
  if (!scale || *scale == 0) return NearestTo(TransformedShape(shape, world_from_shape), p);
  geom::Nearest nearest = NearestTo(shape, world_from_shape.inverse() * p);
  nearest.point = world_from_shape * nearest.point;
  nearest.distance_m *= *scale;
  return nearest;
}

}  // namespace

geom::Box BoundingBox(const Element& element) {
  geom::Box box;
  ForEachShape(element, [&](const auto& shape, const geom::Affine& world, const Element&) {
    box.Add(BoxOf(shape, world));
  });
  return box;
}

std::optional<double> Length(const Element& element) {
  std::optional<double> sum;
  ForEachShape(
      element, [&]<class Shape>(const Shape& shape, const geom::Affine& world, const Element&) {
        if constexpr (std::is_same_v<Shape, geom::Curve>) {
          AddTo(sum, MeasureInWorld(shape, world, 1,
                                    [](const geom::Curve& curve) { return geom::Length(curve); }));
        }
      });
  return sum;
}

std::optional<double> Area(const Element& element) {
  std::optional<double> sum;
  ForEachShape(
      element, [&]<class Shape>(const Shape& shape, const geom::Affine& world, const Element&) {
        if constexpr (std::is_same_v<Shape, geom::Surface> || std::is_same_v<Shape, geom::Region>) {
          AddTo(sum, MeasureInWorld(shape, world, 2,
                                    [](const Shape& face) { return geom::Area(face); }));
        } else if constexpr (std::is_same_v<Shape, geom::Curve>) {
          if (!geom::IsClosed(shape) || !geom::EnclosedArea(shape)) return;
          AddTo(sum, MeasureInWorld(shape, world, 2, [](const geom::Curve& curve) {
                  return geom::EnclosedArea(curve).value_or(0);
                }));
        } else if constexpr (std::is_same_v<Shape, geom::Solid>) {
          AddTo(sum, AreaInWorld(shape, world));
        }
      });
  return sum;
}

std::optional<double> Volume(const Element& element) {
  std::optional<double> sum;
  ForEachShape(element, [&]<class Shape>(const Shape& shape, const geom::Affine& world,
                                         const Element& leaf) {
    if constexpr (std::is_same_v<Shape, geom::Surface>) {
      if (!geom::IsClosed(shape)) return;
      const geom::Result<geom::Mesh> mesh = geom::Tessellate(shape, leaf.tolerance);
      if (!mesh) return;
      AddTo(sum, std::abs(world.linear().determinant()) * EnclosedVolume(*mesh));
    } else if constexpr (std::is_same_v<Shape, geom::Solid>) {
      const auto facets = shape.Facets();
      if (!facets) return;
      const double volume_m3 = shape.FilledVolume().value_or(geom::Volume(**facets));
      AddTo(sum, std::abs(world.linear().determinant()) * volume_m3);
    }
  });
  return sum;
}

std::optional<double> FilledVolume(const Element& element) {
  std::vector<geom::PlacedSolid> solids;
  ForEachShape(element,
               [&]<class Shape>(const Shape& shape, const geom::Affine& world, const Element&) {
                 if constexpr (std::is_same_v<Shape, geom::Solid>) solids.push_back({shape, world});
               });
  if (solids.empty()) return std::nullopt;
  const geom::Result<double> volume_m3 = geom::FilledVolume(solids);
  return volume_m3 ? std::optional(*volume_m3) : std::nullopt;
}

geom::Nearest NearestPoint(const Element& element, const geom::Vec3& p) {
  geom::Nearest best;
  best.distance_m = std::numeric_limits<double>::infinity();
  if (const auto* facade = std::get_if<FacadePtr>(&element.geometry)) {
    const geom::Frame& plane = (*facade)->plane;
    const double height_m = plane.z().dot(p - plane.origin);
    return {p - height_m * plane.z(), std::abs(height_m), 0};
  }
  ForEachShape(element, [&](const auto& shape, const geom::Affine& world, const Element&) {
    const geom::Nearest nearest = NearestInWorld(shape, world, p);
    if (nearest.distance_m < best.distance_m) best = nearest;
  });
  return best;
}

}  // namespace tranos::model
