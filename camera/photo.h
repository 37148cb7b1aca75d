// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs read from the bytes of a file: PNG, JPEG, TIFF. The only door to their libraries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/primitives.h"

namespace tranos::camera {

// Upright, that is, after the orientation that the file states has been applied.
struct PhotoSize {
  int width_px = 0;
  int height_px = 0;
};

// Red, green, blue, a byte each, rows from the top, no padding. Edges and textures need no more
// than 8 bits, and one layout keeps every reader of pixels simple. Of 16 bits the nearest of 256
// levels is kept (in TIFF within one level), of what is transparent what shows over white, of CMYK
// what shows without a colour profile.
struct Photo {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;
};

inline constexpr std::int64_t kMaxPhotoPixels = 200'000'000;

// The photograph in a file whose bytes these are. The format is found from the bytes; of a TIFF
// with several pictures the first is read. The orientation is that of EXIF (JPEG; PNG, where it
// comes before the pixels) or of TIFF's tag. Errors: kUnreadable (not a picture of these formats, a
// variety that is not read, damaged or cut off anywhere that the pixels depend on), kTooLarge (more
// than `max_pixels`, before memory is taken for them). Memory besides the result: once the picture,
// where it must be turned; else a third of it; for a progressive JPEG or a TIFF stored in one piece
// that piece, too. Sources: PNG 1.2, ITU-T T.81, TIFF 6.0, Exif 2.3 (tag 0x0112).
geom::Result<Photo> DecodePhoto(std::span<const std::byte> file,
                                std::int64_t max_pixels = kMaxPhotoPixels);

// Its size from the header alone, no pixel decoded; the same errors as far as the header shows
// them, and where the end of a PNG or JPEG is missing: a file that is cut off is told at once, and
// not by the pictures that cannot be made of it later.
geom::Result<PhotoSize> PhotoSizeOf(std::span<const std::byte> file,
                                    std::int64_t max_pixels = kMaxPhotoPixels);

}  // namespace tranos::camera
