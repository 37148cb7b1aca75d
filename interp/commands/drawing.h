// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing through a photograph: facades by their names, and from a dot to the point that it is of.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "camera/drawing.h"
#include "camera/estimate.h"
#include "interp/command.h"
#include "model/covariance.h"
#include "model/facades.h"

namespace tranos::interp {

// How a point in space moves with the sources that it hangs on, in their order: m for one of each.
using PointTerms = std::vector<std::pair<model::SourceId, geom::Vec3>>;

struct PlacedPoint {
  geom::Vec3 point_m;
  PointTerms terms = {};
};

// The source of a dot's u; that of its v is the next one. Nothing where deviations are not kept.
using DotSource = std::function<std::optional<model::SourceId>(
    model::ElementId photograph, const geom::Vec2& dot_px, double noise_px)>;

// The facade that commands know by this name, as the state has it; E0908 with those there are.
tl::expected<model::ElementPtr, CommandError> FacadeNamed(const model::State& state,
                                                          std::string_view name, Where where = {});

// The facade that dots are drawn on: facade=, or else the one that is set; E0908 where there is
// none.
tl::expected<model::ElementPtr, CommandError> FacadeMeant(const model::State& state,
                                                          const Answers& answers);

model::Geometry FacadeGeometry(std::string name, const geom::Frame& plane, int solved = -1);
// A calibrated facade with each source of the adjustment a step to either side.
std::vector<model::Moved> MovedFacade(const std::string& name, const camera::FacadeEstimate& facade,
                                      int solved);

// The photograph that dots are of, with its camera: E0901 or E0902 where there is none.
tl::expected<model::ElementPtr, CommandError> CameraMeant(const model::State& state,
                                                          const Answers& answers);

// What a dot that is of no point of the facade is told, with a way out.
CommandError BadDot(const geom::Error& error, const model::Facade& facade,
                    const geom::Vec2& dot_px);

// The deviation of each coordinate of a dot of the photograph: the stated one, or as estimated from
// the residuals.
double NoiseOf(const model::State& state, model::ElementId photograph);
// W0013 where the sum of squared residuals, each by its deviation, is improbably large.
std::optional<CommandError> Misfit(double chi2, double dof, std::string_view what);

// The point of the active facade that a dot of the active photograph is of. E0901, E0902 and E0908
// where one of them is missing, E0909 where the dot is outside the photograph, of no point of the
// facade, or of one that is uncertain by more than a tenth of its distance. Where the camera is
// open, dots are drawn on the facade of a traced rectangle alone, by the rectangle's homography.
tl::expected<PlacedPoint, CommandError> DrawDot(const model::State& state, const geom::Vec2& dot_px,
                                                const DotSource& source_of);

}  // namespace tranos::interp
