// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes: reading them as a photograph ends with a picture or an error, and the size told
// beforehand is that of the picture. The cap is low, so that a run spends its time on the formats
// and not on filling memory.
#include <cstdlib>

#include "camera/photo.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::int64_t kMaxPixels = 1 << 16;
  const std::span<const std::byte> file(reinterpret_cast<const std::byte*>(data), size);
  const auto said = tranos::camera::PhotoSizeOf(file, kMaxPixels);
  const auto photo = tranos::camera::DecodePhoto(file, kMaxPixels);
  if (!photo) return 0;
  if (!said || said->width_px != photo->width_px || said->height_px != photo->height_px) abort();
  const std::size_t pixels = std::size_t{1} * photo->width_px * photo->height_px;
  if (pixels > kMaxPixels || photo->rgb.size() != 3 * pixels) abort();
  return 0;
}
