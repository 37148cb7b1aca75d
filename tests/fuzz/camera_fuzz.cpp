// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes: reading them as another program's camera ends with one whose numbers are finite, with
// none, or with an error that says why.
#include <cstdlib>

#include "camera/camera_file.h"
#include "camera/fspy.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> file(reinterpret_cast<const std::byte*>(data), size);
  const auto read = tranos::camera::CameraInFile(file);
  if (!read && read.error().detail.empty()) abort();
  if (read && *read && !(*read)->camera.parameters.allFinite()) abort();
  return 0;
}
