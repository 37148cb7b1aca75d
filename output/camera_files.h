// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras for other programs.
#pragma once

#include <string>
#include <vector>

#include "model/edit.h"
#include "output/result.h"

namespace tranos::output {

struct NamedFile {
  std::string path;  // below the output folder
  std::string bytes;
};

// The files that a request gives: first those of the format, then the picture that goes with them,
// where it is not within, and always `….camera.json`, the camera as it is, with its 3 × 4 matrix.
// Where the other program cannot hold skew (OpenCV, COLMAP), or pixels that are not square (fSpy,
// Blender), camera and picture are those of `camera::Unskewed`, and the picture's name says so.
// Errors: an fSpy project without a photograph, a picture too large.
Result<std::vector<NamedFile>> CameraFilesOf(const model::CameraRequest&);

// The paths of those files, without making them.
Result<std::vector<std::string>> CameraPathsOf(const model::CameraRequest&);

}  // namespace tranos::output
