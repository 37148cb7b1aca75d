// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "camera/photo.h"
#include "model/photo_request.h"
#include "output/result.h"

namespace tranos::output {

// A photograph of the model as it might have been taken and kept: what the camera sees under sun
// and sky (exposure.h), on a plate that was printed and has aged (print.h). The same request gives
// the same bytes, with any number of threads. Errors of Expose.
Result<camera::Photo> TakePhotograph(const model::PhotoRequest& request, int threads);

}  // namespace tranos::output
