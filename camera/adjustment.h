// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that is adjusted at once: the cameras, the unknowns, and what the traces on facades
// bring with them; and the whitened residuals of all of it with their derivatives.
//
// The state is one vector: eleven parameters for each photograph, the unknowns, the nuisances. A
// facade is an upright plane with two nuisances, its azimuth from X (rad) and its distance along
// its normal from the world's origin (m); a rectangle on it has the place of its first dot (m, m),
// a ratio the place of its first edge, that edge, and the place of its second (m each), a circle
// its centre and radius (m). Facades are the same ones in all photographs. A facade whose place is
// given has no nuisances of its own: its azimuth and distance are numbers, which may hang on
// unknowns.
#pragma once

#include <span>

#include "camera/facade_plane.h"
#include "camera/traces.h"

namespace tranos::camera {

struct TraceRows {
  int photograph;
  int trace;
  int first_row;
  int rows;
};

// Where each quantity stands in the state and each residual among the rows: traces first, then the
// priors of unknowns, then those of the cameras.
struct Layout {
  int cameras = 0;
  int unknowns = 0;
  int columns = 0;
  int trace_rows = 0;
  int unknown_prior_rows = 0;
  int camera_prior_rows = 0;
  std::vector<int> facade_column;  // by facade; −1 for the plane y = 0, and where it is given
  std::vector<NumberIndex> facade_number;      // of the azimuth; −1 where it is not given
  std::vector<std::vector<int>> trace_column;  // by photograph and trace; −1: no nuisances
  std::vector<TraceRows> traces;

  int unknown_column() const { return kParameters * cameras; }
  int nuisance_column() const { return unknown_column() + unknowns; }
  int data_rows() const { return trace_rows + unknown_prior_rows; }
  int rows() const { return data_rows() + camera_prior_rows; }
};

// Whether points or edges with a place in space fix the world; if not, facade 0 is y = 0 and the
// first dot of its first rectangle is the origin.
bool WorldIsFixed(std::span<const Photograph>);

// `given_planes` by facade, as Layout's `facade_number`; none beyond its end.
Layout LayoutOf(std::span<const Photograph>, std::span<const Unknown>,
                std::span<const NumberIndex> given_planes = {});

// The state for cameras and unknowns, with the nuisances that suit them: each facade turned and
// placed so that what was traced on it comes nearest to its stated shape, each shape where the rays
// of its dots meet the facade.
Eigen::VectorXd StartState(std::span<const Photograph>, const Layout&, const Numbers&,
                           std::span<const Camera>, const Eigen::VectorXd& unknowns);

// Whitened residuals and their derivatives by the state: rows × columns.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};
// Deviations of dots are `noise_scale` times the stated ones. Error kDegenerate: something is where
// it has no image.
geom::Result<Linearised> Linearise(std::span<const Photograph>, std::span<const Unknown>,
                                   const Layout&, const Numbers&, const Eigen::VectorXd& state,
                                   double noise_scale = 1);

// Whether what is traced on facades is before the cameras.
bool SeesFacades(std::span<const Photograph>, const Layout&, const Numbers&,
                 const Eigen::VectorXd& state);

// Where the facade with this index is.
FacadePlane PlaneOf(const Layout&, const Numbers&, int facade, const Eigen::VectorXd& state);

// Dots from metres on the facade of the rectangle with these rows, to the right and upward from its
// first dot.
Mat3 DotFromRectangle(const Photograph&, const TraceRows&, const Layout&, const Numbers&,
                      const Eigen::VectorXd& state);

inline Camera CameraAt(const Eigen::VectorXd& state, int photograph) {
  return {state.segment<kParameters>(kParameters * photograph)};
}

}  // namespace tranos::camera
