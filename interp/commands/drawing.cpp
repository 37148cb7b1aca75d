// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/drawing.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "camera/homography.h"
#include "camera/statistics.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"

namespace tranos::interp {

using geom::Vec2;
using geom::Vec3;
using model::ElementPtr;
using model::FacadeOf;
using model::State;

namespace {

// The largest deviation in any direction, by the terms of the camera, the facade and the dot.
double LargestDeviation(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

// How the point moves with what a facade hangs on.
void AddFacadeTerms(const model::Element& facade, const camera::DrawnPoint& drawn,
                    std::map<model::SourceId, Vec3>* terms) {
  if (!facade.moved) return;
  const Vec3 from_origin = drawn.point_m - FacadeOf(facade).plane.origin;
  const Vec3 normal = FacadeOf(facade).plane.z();
  for (const auto& [source, step, forward, back] : *facade.moved) {
    const geom::Frame& a = std::get<model::FacadePtr>(forward)->plane;
    const geom::Frame& b = std::get<model::FacadePtr>(back)->plane;
    const double offset = normal.dot(a.origin - b.origin) - (a.z() - b.z()).dot(from_origin);
    terms->try_emplace(source, Vec3::Zero()).first->second += offset / (2 * step) * drawn.by_offset;
  }
}

}  // namespace

CommandError BadDot(const geom::Error& error, const model::Facade& facade, const Vec2& dot_px) {
  const std::string name = Printable(facade.name);
  const bool is_edge_on = error.detail == camera::kInItsPlane;
  return {.code = Code::kBadDot,
          .message = fmt::format("the dot {:g},{:g} is of no point of the facade `{}`: {}",
                                 dot_px.x(), dot_px.y(), name, error.detail),
          .label = is_edge_on ? "the facade is seen edge-on" : "not on this facade",
          .help = is_edge_on ? "draw it through another photograph"
                             : "`set facade` chooses the facade that the dot lies on"};
}

tl::expected<ElementPtr, CommandError> FacadeNamed(const State& state, std::string_view name,
                                                   Where where) {
  if (ElementPtr found = model::FindFacade(state.model, name)) return found;
  const std::vector<std::string> known = model::FacadeNames(state.model);
  const auto meant = DidYouMean(std::string(name), known);
  std::string list;
  for (const std::string& facade : known) list += (list.empty() ? "`" : ", `") + facade + "`";
  return Fail({.code = Code::kNoFacade,
               .message = fmt::format("no facade is called `{}`", Printable(name)),
               .label = known.empty() ? "there is no facade yet" : "known are " + Printable(list),
               .help = meant ? "did you mean `" + *meant + "`?"
                             : "`trace rectangle … facade=NAME` declares one that `calibrate` "
                               "finds; `construct facade` and `recover facade` make one",
               .where = where});
}

tl::expected<ElementPtr, CommandError> FacadeMeant(const State& state, const Answers& answers) {
  if (answers.Has("facade")) return FacadeNamed(state, answers.Text("facade"), AtKey("facade"));
  const model::Settings& settings = *state.drawing.settings;
  if (settings.facade) {
    if (ElementPtr facade = state.model.Current(settings.facade->id)) return facade;
  }
  return Fail({.code = Code::kNoFacade,
               .message = "a dot is drawn on a facade, and none is set",
               .help = "set facade front"});
}

model::Geometry FacadeGeometry(std::string name, const geom::Frame& plane, int solved) {
  return std::make_shared<const model::Facade>(model::Facade{std::move(name), plane, solved});
}

std::vector<model::Moved> MovedFacade(const std::string& name, const camera::FacadeEstimate& facade,
                                      int solved) {
  std::vector<model::Moved> moved;
  const geom::Frame& plane = facade.plane;
  for (Eigen::Index j = 0; j < facade.deviations.cols(); ++j) {
    const Vec3 by = facade.deviations.col(j);
    if (by.isZero(0)) continue;
    const auto beside = [&](double step) {
      const Vec3 turn = step * (by.y() * plane.x + by.z() * plane.y);
      const Eigen::AngleAxisd turned(turn.norm(),
                                     turn.norm() > 0 ? Vec3(turn.normalized()) : plane.x);
      const geom::Frame frame{plane.origin + step * by.x() * plane.z(), turned * plane.x,
                              turned * plane.y};
      return FacadeGeometry(name, frame, solved);
    };
    moved.push_back({static_cast<model::SourceId>(j), model::kMovedBy, beside(model::kMovedBy),
                     beside(-model::kMovedBy)});
  }
  return moved;
}

tl::expected<ElementPtr, CommandError> CameraMeant(const State& state, const Answers& answers) {
  auto photograph = PhotographMeant(state, answers.Has("photo") ? answers : Answers{});
  if (!photograph) return photograph;
  if (!model::HasCamera(PhotographOf(**photograph))) return Fail(NoCameraYet(**photograph));
  return photograph;
}

std::optional<CommandError> Misfit(double chi2, double dof, std::string_view what) {
  constexpr double kImprobable = 1e-3;
  if (!(dof > 0) || !(camera::ChiSquaredTail(chi2, dof) < kImprobable)) return std::nullopt;
  return CommandError{.code = Code::kDotsMisfit,
                      .message = fmt::format("{}: {:.2g} times as far off as their noise says",
                                             what, std::sqrt(chi2 / dof)),
                      .help = "look at its dots again, or give a larger `noise=`"};
}

double NoiseOf(const State& state, model::ElementId photograph) {
  const double stated_px = state.drawing.settings->noise_px;
  if (stated_px > 0) return stated_px;
  const ElementPtr element = state.model.Current(photograph);
  const auto& estimate = PhotographOf(*element).estimate;
  return estimate && estimate->noise_px > 0 ? estimate->noise_px : 0.5;
}

namespace {

using Terms = std::map<model::SourceId, Vec3>;

PointTerms Sorted(const Terms& terms) { return {terms.begin(), terms.end()}; }

// The first rectangle that was traced on the facade, whose first dot is the facade's origin; null
// if there is none.
ElementPtr FirstRectangle(const State& state, const std::string& facade) {
  ElementPtr found;
  state.model.ForEach([&](const ElementPtr& element) {
    const auto* trace = std::get_if<model::TracePtr>(&element->geometry);
    if (!trace || found || (*trace)->facade != facade) return;
    if ((*trace)->kind == model::Trace::Kind::kRectangle) found = element;
  });
  return found;
}

// What a traced rectangle tells of its plane, whatever camera took it: where a dot is on it, in
// metres to the right and upward from its first dot. Nothing beyond the plane's horizon.
struct RectanglePlane {
  std::array<Vec2, 4> dots_px;
  double a_m, b_m;

  std::optional<Vec2> At(const Vec2& dot_px) const {
    const auto dot_from_metres = camera::HomographyOfRectangle(dots_px, a_m, b_m);
    if (!dot_from_metres) return std::nullopt;
    const Vec3 p = dot_from_metres->inverse() * dot_px.homogeneous();
    const Vec2 metres = p.hnormalized();
    const double depth = dot_from_metres->row(2).dot(metres.homogeneous());
    if (!metres.allFinite() || !(depth * (*dot_from_metres)(2, 2) > 0)) return std::nullopt;
    return metres;
  }
  // Half the difference of two of them, over the step to either side.
  static Vec2 Slope(const RectanglePlane& ahead, const Vec2& dot_ahead,
                    const RectanglePlane& behind, const Vec2& dot_behind, double step) {
    const auto a = ahead.At(dot_ahead), b = behind.At(dot_behind);
    if (!a || !b) return Vec2::Constant(std::numeric_limits<double>::infinity());
    return (*a - *b) / (2 * step);
  }
};

// The point of a facade that a dot is of, where nothing but a rectangle on it is known.
tl::expected<PlacedPoint, CommandError> DrawByRectangle(const State& state,
                                                        const model::Element& photograph,
                                                        const model::Facade& facade,
                                                        const Vec2& dot_px,
                                                        const DotSource& source_of) {
  const ElementPtr element = FirstRectangle(state, facade.name);
  const model::Trace* trace =
      element ? std::get<model::TracePtr>(element->geometry).get() : nullptr;
  if (!trace || trace->photograph != photograph.id) {
    CommandError error = NoCameraYet(photograph);
    error.help =
        "without a camera, dots are drawn on the facade of a traced rectangle alone; more "
        "traces, or a prior, determine one";
    return Fail(std::move(error));
  }
  RectanglePlane known{{}, trace->numbers[0].number(), trace->numbers[1].number()};
  std::copy_n(trace->dots_px.begin(), 4, known.dots_px.begin());
  const auto metres = known.At(dot_px);
  if (!metres) {
    return Fail(
        BadDot({geom::ErrorCode::kOutOfRange, "the dot lies beyond its horizon"}, facade, dot_px));
  }
  const auto in_space = [&](const Vec2& by) {
    return Vec3(by.x() * facade.plane.x + by.y() * facade.plane.y);
  };
  constexpr double kStep_px = 0.01, kShare = 1e-6;
  const double noise_px = NoiseOf(state, photograph.id);
  const double traced_px = trace->noise_px > 0 ? trace->noise_px : noise_px;
  Terms terms;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  const auto add = [&](const std::optional<model::SourceId>& source, const Vec2& slope,
                       double sigma) {
    const Vec3 term = in_space(slope);
    covariance += sigma * sigma * term * term.transpose();
    if (source) terms.try_emplace(*source, Vec3::Zero()).first->second += term;
  };
  const auto next = [](std::optional<model::SourceId> source, int k) {
    if (source) *source += static_cast<model::SourceId>(k);
    return source;
  };
  const auto drawn = source_of(photograph.id, dot_px, noise_px);
  for (int k = 0; k < 2; ++k) {
    const Vec2 by = kStep_px * Vec2::Unit(k);
    add(next(drawn, k), RectanglePlane::Slope(known, dot_px + by, known, dot_px - by, kStep_px),
        noise_px);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      RectanglePlane ahead = known, behind = known;
      ahead.dots_px[corner] += by;
      behind.dots_px[corner] -= by;
      add(next(source_of(photograph.id, trace->dots_px[corner], traced_px), k),
          RectanglePlane::Slope(ahead, dot_px, behind, dot_px, kStep_px), traced_px);
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const model::Derivatives* derivatives = trace->numbers[side].derivatives();
    if (!derivatives || !drawn) continue;
    RectanglePlane ahead = known, behind = known;
    const double step = kShare * trace->numbers[side].number();
    (side == 0 ? ahead.a_m : ahead.b_m) += step;
    (side == 0 ? behind.a_m : behind.b_m) -= step;
    const Vec2 slope = RectanglePlane::Slope(ahead, dot_px, behind, dot_px, step);
    for (const auto& [source, by] : derivatives->terms) add(source, by * slope, 0);
  }
  const double sigma_m = LargestDeviation(covariance);
  const double reach_m = metres->norm() + known.a_m + known.b_m;
  if (!(sigma_m <= camera::kMostUncertain * reach_m)) {
    return Fail({.code = Code::kBadDot,
                 .message = fmt::format("the point of the facade `{}` that the dot {:g},{:g} is of "
                                        "is uncertain by {:.3g} m, {:.3g} m from the rectangle",
                                        Printable(facade.name), dot_px.x(), dot_px.y(), sigma_m,
                                        metres->norm()),
                 .label = "too far from the rectangle for its size",
                 .help = "trace a larger rectangle"});
  }
  return PlacedPoint{facade.plane.origin + in_space(*metres), Sorted(terms)};
}

}  // namespace

tl::expected<PlacedPoint, CommandError> DrawDot(const State& state, const Vec2& dot_px,
                                                const DotSource& source_of) {
  const auto meant = PhotographMeant(state, {});
  if (!meant) return Fail(meant.error());
  if (!PhotographOf(**meant).estimate) return Fail(NoCameraYet(**meant));
  const auto set = FacadeMeant(state, {});
  if (!set) return Fail(set.error());
  const ElementPtr& facade = *set;
  const model::Photograph& photograph = PhotographOf(**meant);
  const camera::Estimate& estimate = *photograph.estimate;
  if (auto error = OutsidePhotograph(photograph.frame, dot_px, Code::kBadDot)) return Fail(*error);
  if (!estimate.complete()) {
    return DrawByRectangle(state, **meant, FacadeOf(*facade), dot_px, source_of);
  }
  const auto drawn =
      camera::DrawOnto(estimate.camera, photograph.frame, FacadeOf(*facade).plane, dot_px);
  if (!drawn) return Fail(BadDot(drawn.error(), FacadeOf(*facade), dot_px));
  const double noise_px = NoiseOf(state, (*meant)->id);
  Terms terms;
  for (Eigen::Index j = 0; j < estimate.deviations.cols(); ++j) {
    const Vec3 term = drawn->by_camera * estimate.deviations.block<camera::kParameters, 1>(0, j);
    if (!term.isZero(0)) terms[static_cast<model::SourceId>(j)] = term;
  }
  AddFacadeTerms(*facade, *drawn, &terms);
  Eigen::Matrix3d covariance = noise_px * noise_px * drawn->by_dot * drawn->by_dot.transpose();
  for (const auto& [source, term] : terms) covariance += term * term.transpose();
  const double sigma_m = LargestDeviation(covariance);
  const double away_m = (drawn->point_m - estimate.camera.position_m()).norm();
  if (!(sigma_m <= camera::kMostUncertain * away_m)) {
    return Fail({.code = Code::kBadDot,
                 .message = fmt::format(
                     "the point of the facade `{}` that the dot {:g},{:g} is of is uncertain by "
                     "{:.3g} m, {:.3g} m from the camera",
                     Printable(FacadeOf(*facade).name), dot_px.x(), dot_px.y(), sigma_m, away_m),
                 .label = "the facade is nearly edge-on here",
                 .help = "draw it through another photograph, or nearer to the camera"});
  }
  PlacedPoint placed{drawn->point_m};
  if (const auto source = source_of((*meant)->id, dot_px, noise_px)) {
    for (model::SourceId k = 0; k < 2; ++k) {
      terms.try_emplace(*source + k, Vec3::Zero()).first->second += drawn->by_dot.col(k);
    }
    placed.terms = Sorted(terms);
  }
  return placed;
}

}  // namespace tranos::interp
