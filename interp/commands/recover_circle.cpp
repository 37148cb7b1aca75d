// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/recover_circle.h"

#include "camera/circle_fit.h"
#include "interp/commands/drawing.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"

namespace tranos::interp {

using geom::Frame;
using geom::Vec2;
using geom::Vec3;
using model::State;

namespace {

struct Seen {
  camera::FittedCircle circle;
  Frame plane;  // of the facade, moved to the circle's centre
};

tl::expected<Seen, CommandError> FitTo(const State& state, const Answers& answers) {
  const auto meant = CameraMeant(state, answers);
  if (!meant) return Fail(meant.error());
  const auto facade = FacadeMeant(state, answers);
  if (!facade) return Fail(facade.error());
  const model::Photograph& photograph = PhotographOf(**meant);
  std::vector<Vec2> dots_px;
  for (std::size_t i = 0; i < answers.points.size(); ++i) {
    dots_px.emplace_back(answers.points[i].head<2>());
    if (auto error = OutsidePhotograph(photograph.frame, dots_px[i], Code::kBadDot)) {
      error->where = AtPoint(static_cast<int>(i));
      return Fail(*error);
    }
  }
  Frame plane = model::FacadeOf(**facade).plane;
  auto circle = camera::FitCircleSeen(photograph.estimate->camera, photograph.frame, plane, dots_px,
                                      NoiseOf(state, (*meant)->id));
  if (circle) {
    plane.origin = plane.ToWorld({circle->centre_m.x(), circle->centre_m.y(), 0});
    return Seen{*std::move(circle), plane};
  }
  const int part = circle.error().part;
  if (part >= 0) {
    CommandError error =
        BadDot(circle.error(), model::FacadeOf(**facade), dots_px[static_cast<std::size_t>(part)]);
    error.where = AtPoint(part);
    return Fail(std::move(error));
  }
  return Fail({.code = Code::kBadDot,
               .message = circle.error().detail,
               .label = "no circle is told by them",
               .help = "more dots, over a longer part of the arch"});
}

CommandResult Made(const State& state, const Answers& answers, const Seen& seen,
                   geom::Curve curve) {
  CommandResult made = Make(state, CurveGeometry(std::move(curve)));
  const double dof = static_cast<double>(answers.points.size()) - 3;
  const auto misfit = Misfit(seen.circle.chi2, dof, "the dots lie on no circle");
  if (made && misfit) made->warnings.push_back(*misfit);
  return made;
}

}  // namespace

CommandResult RecoverCircle(const State& state, const Answers& answers) {
  const auto seen = FitTo(state, answers);
  if (!seen) return Fail(seen.error());
  return Made(state, answers, *seen, geom::Circle{seen->plane, seen->circle.radius_m});
}

CommandResult RecoverArc(const State& state, const Answers& answers) {
  const auto seen = FitTo(state, answers);
  if (!seen) return Fail(seen.error());
  const std::vector<double>& angles_rad = seen->circle.angles_rad;
  double sweep_rad = 0;
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    sweep_rad += std::remainder(angles_rad[i] - angles_rad[i - 1], 2 * geom::kPi);
  }
  if (!(std::abs(sweep_rad) < 2 * geom::kPi) ||
      std::abs(sweep_rad) * seen->circle.radius_m <= geom::kCoincident_m) {
    return Fail({.code = Code::kBadDot,
                 .message = "the dots go round the whole circle, and make no arc of it",
                 .help = "`recover circle` makes the whole of it; an arc's dots go one way, from "
                         "one end to the other"});
  }
  const Frame& plane = seen->plane;
  Frame frame = plane;
  frame.x = std::cos(angles_rad[0]) * plane.x + std::sin(angles_rad[0]) * plane.y;
  frame.y = std::cos(angles_rad[0]) * plane.y - std::sin(angles_rad[0]) * plane.x;
  if (sweep_rad < 0) frame.y = -frame.y;
  return Made(state, answers, *seen, geom::Arc{frame, seen->circle.radius_m, std::abs(sweep_rad)});
}

}  // namespace tranos::interp
