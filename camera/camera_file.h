// SPDX-License-Identifier: GPL-3.0-or-later
// A camera that another program, or a run of this one, has written into a file.
#pragma once

#include <cstddef>
#include <span>

#include "camera/framed_camera.h"

namespace tranos::camera {

// The camera in an fSpy project, in the JSON that fSpy exports, or in the JSON of an exact camera
// (`tranos_camera`: size_px, format_mm, K in pixels, R and t_m). Nothing if it is a project that
// was saved without a solution. Errors: those of FspyProjectIn,
// CameraInFspy and FramedCameraOf; kUnreadable for an exact camera that is not complete.
geom::Result<std::optional<FramedCamera>> CameraInFile(std::span<const std::byte> file);

}  // namespace tranos::camera
