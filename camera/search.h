// SPDX-License-Identifier: GPL-3.0-or-later
// The search for the likeliest cameras of an adjustment: from rough starts by linear methods to the
// poses of least cost.
#pragma once

#include <span>
#include <vector>

#include "camera/refinement.h"

namespace tranos::camera {

// What an adjustment is about.
struct Task {
  std::span<const Photograph> photographs;
  std::span<const Unknown> unknowns;
  const NumbersOfUnknowns& numbers_of;
  Layout layout;
  RefineOptions refine;
};

// Where the search for the unknowns starts: within their bounds.
Eigen::VectorXd StartsOf(std::span<const Unknown>);

// The state of least cost near one that is nearly right. Errors as Refine's.
geom::Result<Refined> RefineAgain(const Task&, const Refined& near);

// Residuals and derivatives at a state, by the task's noise. Error as Linearise's.
geom::Result<Linearised> LineariseAt(const Task&, const Refined&);

// Angles as they are told, without whole turns.
void Unwind(Eigen::VectorXd& state, int cameras);

// Whether everything traced is before its camera.
bool SeesAll(const Task&, const Refined&);

// Whether priors and data leave nothing of a camera open but, perhaps, where it stood.
bool HasView(const Task&, const Refined&);

struct Adjusted {
  Refined best;
  std::vector<Refined> others;  // poses within noise, of a single photograph
};

// The pose of least cost that has everything traced before the camera, and others within 9 of its
// cost; with several photographs, each one's own pose first, and all together from these. Where the
// view of a photograph is left open, a plausible camera of those that fit. `numbers` are for the
// unknowns `u`, from which the search starts. Errors: kDegenerate: too little is traced; `part`
// counts traces through the photographs.
geom::Result<Adjusted> Adjust(const Task&, const Numbers& numbers, const Eigen::VectorXd& u);

}  // namespace tranos::camera
