// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/adjustment.h"

#include <algorithm>

#include "camera/facade_plane.h"
#include "camera/residuals.h"
#include "camera/space_traces.h"

namespace tranos::camera {

FacadePlane PlaneOf(const Layout& layout, const Numbers& numbers, int facade,
                    const Eigen::VectorXd& state) {
  const NumberIndex given = layout.facade_number[facade];
  if (given >= 0) return {numbers.values[given], numbers.values[given + 1]};
  const int column = layout.facade_column[facade];
  return column < 0 ? FacadePlane{} : FacadePlane{state[column], state[column + 1]};
}

namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;  // clang 14 does not find it by itself

int FacadeOf(const Trace& trace) {
  return std::visit(
      Overloaded{[](const RectangleTrace& t) { return t.facade; },
                 [](const RatioTrace& t) { return t.facade; },
                 [](const CircleTrace& t) { return t.facade; }, [](const auto&) { return -1; }},
      trace);
}

int NuisancesOf(const Trace& trace) {
  return std::visit(
      Overloaded{[](const RectangleTrace&) { return 2; }, [](const RatioTrace&) { return 6; },
                 [](const CircleTrace&) { return 3; }, [](const auto&) { return 0; }},
      trace);
}

int ResidualsOf(const Trace& trace) {
  return std::visit(
      Overloaded{[](const DirectionTrace&) { return 1; },
                 [](const CurveTrace& t) { return static_cast<int>(t.dots_px.size()); },
                 [](const CircleTrace& t) { return static_cast<int>(t.dots_px.size()); },
                 [](const RectangleTrace&) { return 8; }, [](const RatioTrace&) { return 8; },
                 [](const auto&) { return 2; }},
      trace);
}

// Writes the rows of one photograph's traces.
class Writer {
 public:
  Writer(const Layout& layout, const Numbers& numbers, const Eigen::VectorXd& state,
         double noise_scale, Linearised& to)
      : layout_(layout), numbers_(numbers), state_(state), weight_(1 / noise_scale), to_(to) {}

  void Write(const View& view, const Trace& trace, const TraceRows& rows) {
    row_ = rows.first_row;
    camera_column_ = kParameters * rows.photograph;
    column_ = layout_.trace_column[rows.photograph][rows.trace];
    std::visit([&](const auto& t) { Write(view, t); }, trace);
  }

 private:
  Vec3 PointOf(NumberIndex first) const { return numbers_.values.segment<3>(first); }

  // The next row: the residual and its derivative by the camera.
  void Put(const Residual& r) {
    to_.residuals[row_] = weight_ * r.value;
    to_.jacobian.block<1, kParameters>(row_, camera_column_) = weight_ * r.by_camera;
    ++row_;
  }
  // The last row's derivative by the number.
  void ByNumber(NumberIndex number, double derivative) {
    if (layout_.unknowns == 0) return;
    to_.jacobian.row(row_ - 1).segment(layout_.unknown_column(), layout_.unknowns) +=
        weight_ * derivative * numbers_.by_unknown.row(number);
  }
  void ByPointOf(NumberIndex first, const Vec3& derivative) {
    for (int i = 0; i < 3; ++i) ByNumber(first + i, derivative[i]);
  }
  void ByNuisance(int column, double derivative) {
    to_.jacobian(row_ - 1, column) += weight_ * derivative;
  }

  // The last row's derivative by where the facade is; `p` is the point on it.
  void ByPlane(int facade, const Vec2& p, const Vec3& derivative) {
    const int column = layout_.facade_column[facade];
    const NumberIndex given = layout_.facade_number[facade];
    if (column < 0 && given < 0) return;
    const FacadePlane plane = PlaneOf(layout_, numbers_, facade, state_);
    const double by_azimuth = derivative.dot(plane.ByAzimuth(p));
    const double by_distance = derivative.dot(plane.away());
    if (given >= 0) {
      ByNumber(given, by_azimuth);
      ByNumber(given + 1, by_distance);
    } else {
      ByNuisance(column, by_azimuth);
      ByNuisance(column + 1, by_distance);
    }
  }

  void Write(const View& view, const EdgeTrace& trace) {
    for (const Residual& r :
         EdgeResiduals(view, trace.line, PointOf(trace.from), PointOf(trace.to))) {
      Put(r);
      ByPointOf(trace.from, r.by_point[0]);
      ByPointOf(trace.to, r.by_point[1]);
    }
  }

  void Write(const View& view, const DirectionTrace& trace) {
    Put(DirectionResidual(view, trace.line, Vec3::Unit(trace.axis)));
  }

  void Write(const View& view, const PointTrace& trace) {
    for (const Residual& r :
         PointResiduals(view, trace.dot_px, trace.sigma_px, PointOf(trace.at))) {
      Put(r);
      ByPointOf(trace.at, r.by_point[0]);
    }
  }

  void Write(const View& view, const CurveTrace& trace) {
    std::vector<Seen> polyline;
    for (int i = 0; i < trace.points; ++i) {
      polyline.push_back(See(view, PointOf(trace.first + 3 * i)));
    }
    for (const Vec2& dot : trace.dots_px) {
      const CurveResidual r = ResidualOfCurve(view, dot, trace.sigma_px, polyline);
      Put(r.residual);
      if (r.segment < 0) {
        to_.residuals[row_ - 1] = std::numeric_limits<double>::infinity();
        continue;
      }
      for (int k = 0; k < 2; ++k) {
        ByPointOf(trace.first + 3 * (r.segment + k), r.residual.by_point[k]);
      }
    }
  }

  // Two rows for a dot of a point on a facade; `by` adds the derivatives by what the point's
  // coordinates there depend on.
  template <class By>
  void WritePoint(const View& view, int facade, const Vec2& p, const Vec2& dot, double sigma,
                  const By& by) {
    const FacadePlane plane = PlaneOf(layout_, numbers_, facade, state_);
    for (const Residual& r : PointResiduals(view, dot, sigma, plane.Point(p))) {
      Put(r);
      ByPlane(facade, p, r.by_point[0]);
      by(Vec2(r.by_point[0].dot(plane.right()), r.by_point[0].z()));
    }
  }

  void Write(const View& view, const RectangleTrace& trace) {
    const Vec2 at = column_ < 0 ? Vec2(Vec2::Zero()) : Vec2(state_.segment<2>(column_));
    const Vec2 size(numbers_.values[trace.a], numbers_.values[trace.b]);
    for (int i = 0; i < 4; ++i) {
      const Vec2 share(i == 1 || i == 2 ? 1 : 0, i >= 2 ? 1 : 0);
      WritePoint(view, trace.facade, at + share.cwiseProduct(size), trace.dots_px[i],
                 trace.sigma_px, [&](const Vec2& g) {
                   ByNumber(trace.a, share.x() * g.x());
                   ByNumber(trace.b, share.y() * g.y());
                   if (column_ < 0) return;
                   ByNuisance(column_, g.x());
                   ByNuisance(column_ + 1, g.y());
                 });
    }
  }

  void Write(const View& view, const RatioTrace& trace) {
    const Vec2 start = state_.segment<2>(column_), edge = state_.segment<2>(column_ + 2);
    const Vec2 second = state_.segment<2>(column_ + 4);
    const double ratio = numbers_.values[trace.ratio], turn = TurnOf(trace);
    const Vec2 across = turn / ratio * Vec2(-edge.y(), edge.x());
    for (int i = 0; i < 2; ++i) {
      WritePoint(view, trace.facade, start + i * edge, trace.dots_px[i], trace.sigma_px,
                 [&](const Vec2& g) {
                   for (int k = 0; k < 2; ++k) {
                     ByNuisance(column_ + k, g[k]);
                     ByNuisance(column_ + 2 + k, i * g[k]);
                   }
                 });
    }
    for (int i = 0; i < 2; ++i) {
      WritePoint(view, trace.facade, second + i * across, trace.dots_px[2 + i], trace.sigma_px,
                 [&](const Vec2& g) {
                   ByNuisance(column_ + 4, g.x());
                   ByNuisance(column_ + 5, g.y());
                   ByNuisance(column_ + 2, i * turn / ratio * g.y());
                   ByNuisance(column_ + 3, -i * turn / ratio * g.x());
                   ByNumber(trace.ratio, -i * g.dot(across) / ratio);
                 });
    }
  }

  void Write(const View& view, const CircleTrace& trace) {
    const FacadePlane plane = PlaneOf(layout_, numbers_, trace.facade, state_);
    const Vec2 centre = state_.segment<2>(column_);
    const double radius = state_[column_ + 2];
    for (const Vec2& dot : trace.dots_px) {
      const CircleResidual r = ResidualOfCircle(view, dot, trace.sigma_px, plane.Point(centre),
                                                plane.right(), Vec3::UnitZ(), radius);
      const Vec2 out(std::cos(r.angle_rad), std::sin(r.angle_rad));
      const Vec3& by_point = r.residual.by_point[0];
      const Vec2 g(by_point.dot(plane.right()), by_point.z());
      Put(r.residual);
      ByPlane(trace.facade, centre + radius * out, by_point);
      ByNuisance(column_, g.x());
      ByNuisance(column_ + 1, g.y());
      ByNuisance(column_ + 2, g.dot(out));
    }
  }

  const Layout& layout_;
  const Numbers& numbers_;
  const Eigen::VectorXd& state_;
  double weight_;
  Linearised& to_;
  int row_ = 0;
  int camera_column_ = 0;
  int column_ = -1;
};

void StartShape(const View& view, const FacadePlane& plane, const Trace& trace, int column,
                Eigen::VectorXd& state) {
  if (column < 0) return;
  const auto on_facade = [&](const Vec2& dot) { return plane.Meet(view, dot); };
  if (const auto* rectangle = std::get_if<RectangleTrace>(&trace)) {
    state.segment<2>(column) = on_facade(rectangle->dots_px[0]);
  } else if (const auto* ratio = std::get_if<RatioTrace>(&trace)) {
    const Vec2 start = on_facade(ratio->dots_px[0]);
    state.segment<2>(column) = start;
    state.segment<2>(column + 2) = on_facade(ratio->dots_px[1]) - start;
    state.segment<2>(column + 4) = on_facade(ratio->dots_px[2]);
  } else if (const auto* circle = std::get_if<CircleTrace>(&trace)) {
    std::vector<Vec2> points;
    for (const Vec2& dot : circle->dots_px) points.push_back(on_facade(dot));
    const PlaneCircle fit = FitCircle(points);
    state.segment<2>(column) = fit.centre;
    state[column + 2] = fit.radius;
  }
}

}  // namespace

bool WorldIsFixed(std::span<const Photograph> photographs) {
  return std::ranges::any_of(photographs,
                             [](const Photograph& photograph) { return WorldIsFixed(photograph); });
}

Layout LayoutOf(std::span<const Photograph> photographs, std::span<const Unknown> unknowns,
                std::span<const NumberIndex> given_planes) {
  Layout layout;
  layout.cameras = static_cast<int>(photographs.size());
  layout.unknowns = static_cast<int>(unknowns.size());
  layout.columns = layout.nuisance_column();
  const auto take = [&](int columns) {
    layout.columns += columns;
    return layout.columns - columns;
  };
  const auto given = [&](std::size_t facade) {
    return facade < given_planes.size() ? given_planes[facade] : -1;
  };
  const bool fixed = WorldIsFixed(photographs);
  bool origin_is_taken = fixed;
  std::vector<bool> used;
  for (int p = 0; p < layout.cameras; ++p) {
    layout.trace_column.emplace_back();
    for (int t = 0; t < static_cast<int>(photographs[p].traces.size()); ++t) {
      const Trace& trace = photographs[p].traces[t];
      const int facade = FacadeOf(trace), rows = ResidualsOf(trace);
      if (facade >= static_cast<int>(used.size())) used.resize(facade + 1, false);
      if (facade >= 0) used[facade] = true;
      const bool is_origin = !origin_is_taken && facade == 0 && given(0) < 0 &&
                             std::holds_alternative<RectangleTrace>(trace);
      origin_is_taken = origin_is_taken || is_origin;
      const int nuisances = is_origin ? 0 : NuisancesOf(trace);
      layout.trace_column[p].push_back(nuisances > 0 ? take(nuisances) : -1);
      layout.traces.push_back({p, t, layout.trace_rows, rows});
      layout.trace_rows += rows;
    }
    for (const Prior& prior : photographs[p].priors) {
      layout.camera_prior_rows += prior.sigma > 0 ? 1 : 0;
    }
  }
  for (int f = 0; f < static_cast<int>(used.size()); ++f) {
    layout.facade_number.push_back(given(static_cast<std::size_t>(f)));
    const bool is_free = used[f] && (fixed || f > 0) && layout.facade_number.back() < 0;
    layout.facade_column.push_back(is_free ? take(2) : -1);
  }
  for (const Unknown& unknown : unknowns) layout.unknown_prior_rows += unknown.sigma > 0 ? 1 : 0;
  return layout;
}

Eigen::VectorXd StartState(std::span<const Photograph> photographs, const Layout& layout,
                           const Numbers& numbers, std::span<const Camera> cameras,
                           const Eigen::VectorXd& unknowns) {
  Eigen::VectorXd state = Eigen::VectorXd::Zero(layout.columns);
  std::vector<View> views;
  for (int p = 0; p < layout.cameras; ++p) {
    state.segment<kParameters>(kParameters * p) = cameras[p].parameters;
    views.push_back(ViewOf(cameras[p].parameters, photographs[p].frame));
  }
  state.segment(layout.unknown_column(), layout.unknowns) = unknowns;
  std::vector<FacadePlane> planes(layout.facade_column.size());
  for (int f = 0; f < static_cast<int>(planes.size()); ++f) {
    const int column = layout.facade_column[f];
    if (column < 0) {
      planes[f] = PlaneOf(layout, numbers, f, state);
      continue;
    }
    std::vector<OnFacade> on_facade;
    for (int p = 0; p < layout.cameras; ++p) {
      for (const Trace& trace : photographs[p].traces) {
        if (FacadeOf(trace) == f) on_facade.push_back({&views[p], &trace});
      }
    }
    planes[f] = LikelyPlane(on_facade, numbers);
    state[column] = planes[f].azimuth_rad;
    state[column + 1] = planes[f].distance_m;
  }
  for (const TraceRows& rows : layout.traces) {
    const Trace& trace = photographs[rows.photograph].traces[rows.trace];
    const int facade = FacadeOf(trace);
    if (facade < 0) continue;
    StartShape(views[rows.photograph], planes[facade], trace,
               layout.trace_column[rows.photograph][rows.trace], state);
  }
  return state;
}

bool SeesFacades(std::span<const Photograph> photographs, const Layout& layout,
                 const Numbers& numbers, const Eigen::VectorXd& state) {
  return std::ranges::all_of(layout.traces, [&](const TraceRows& rows) {
    const Photograph& photograph = photographs[rows.photograph];
    const Trace& trace = photograph.traces[rows.trace];
    const int facade = FacadeOf(trace);
    if (facade < 0) return true;
    const View view = ViewOf(CameraAt(state, rows.photograph).parameters, photograph.frame);
    const FacadePlane plane = PlaneOf(layout, numbers, facade, state);
    const int column = layout.trace_column[rows.photograph][rows.trace];
    const Vec2 at = column < 0 ? Vec2(Vec2::Zero()) : Vec2(state.segment<2>(column));
    const auto* rectangle = std::get_if<RectangleTrace>(&trace);
    const Vec2 size = rectangle ? Vec2(numbers.values[rectangle->a], numbers.values[rectangle->b])
                                : Vec2(Vec2::Zero());
    return See(view, plane.Point(at)).dot.z() > 0 && See(view, plane.Point(at + size)).dot.z() > 0;
  });
}

Mat3 DotFromRectangle(const Photograph& photograph, const TraceRows& rows, const Layout& layout,
                      const Numbers& numbers, const Eigen::VectorXd& state) {
  const FacadePlane plane =
      PlaneOf(layout, numbers, FacadeOf(photograph.traces[rows.trace]), state);
  const int column = layout.trace_column[rows.photograph][rows.trace];
  const Vec2 first = column < 0 ? Vec2(Vec2::Zero()) : Vec2(state.segment<2>(column));
  Eigen::Matrix<double, 4, 3> world_from_rectangle;
  world_from_rectangle << plane.right(), Vec3::UnitZ(), plane.Point(first), 0, 0, 1;
  return DotFromWorld(CameraAt(state, rows.photograph), photograph.frame) * world_from_rectangle;
}

geom::Result<Linearised> Linearise(std::span<const Photograph> photographs,
                                   std::span<const Unknown> unknowns, const Layout& layout,
                                   const Numbers& numbers, const Eigen::VectorXd& state,
                                   double noise_scale) {
  Linearised to{Eigen::VectorXd::Zero(layout.rows()),
                Eigen::MatrixXd::Zero(layout.rows(), layout.columns)};
  Writer writer(layout, numbers, state, noise_scale, to);
  std::vector<View> views;
  for (int p = 0; p < layout.cameras; ++p) {
    views.push_back(ViewOf(CameraAt(state, p).parameters, photographs[p].frame));
  }
  for (const TraceRows& rows : layout.traces) {
    writer.Write(views[rows.photograph], photographs[rows.photograph].traces[rows.trace], rows);
  }
  int row = layout.trace_rows;
  const auto assume = [&](int column, double value, double sigma) {
    if (!(sigma > 0)) return;
    to.residuals[row] = (state[column] - value) / sigma;
    to.jacobian(row++, column) = 1 / sigma;
  };
  for (int i = 0; i < layout.unknowns; ++i) {
    assume(layout.unknown_column() + i, unknowns[i].start, unknowns[i].sigma);
  }
  for (int p = 0; p < layout.cameras; ++p) {
    for (int i = 0; i < kIntrinsics; ++i) {
      const Prior& prior = photographs[p].priors[i];
      assume(kParameters * p + i, prior.value, prior.sigma);
    }
  }
  if (to.residuals.allFinite() && to.jacobian.allFinite()) return to;
  for (std::size_t i = 0; i < layout.traces.size(); ++i) {
    const TraceRows& rows = layout.traces[i];
    if (to.residuals.segment(rows.first_row, rows.rows).allFinite() &&
        to.jacobian.middleRows(rows.first_row, rows.rows).allFinite()) {
      continue;
    }
    return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate,
                                      "the camera has no image of what is traced",
                                      static_cast<int>(i)});
  }
  return tl::unexpected(
      geom::Error{geom::ErrorCode::kDegenerate, "an unknown or a prior is not finite"});
}

}  // namespace tranos::camera
