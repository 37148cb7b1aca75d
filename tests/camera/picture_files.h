// SPDX-License-Identifier: GPL-3.0-or-later
// Files of pictures made in memory, for the tests of what reads them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tranos::camera {

// Samples of 16 bits, rows from the top; a file of 8 bits holds their upper halves.
struct Samples {
  int width = 0;
  int height = 0;
  int channels = 3;
  std::vector<std::uint16_t> values;

  std::uint16_t at(int x, int y, int c) const { return values[(y * width + x) * channels + c]; }
};

// A picture whose samples are f(x, y, channel).
Samples Paint(int width, int height, int channels,
              const std::function<std::uint16_t(int, int, int)>& f);

struct PngOptions {
  int bit_depth = 8;
  bool interlaced = false;
  int orientation = 0;    // in eXIf; 0: none is written
  std::string text = {};  // of a compressed chunk before the pixels
};
// Grey, grey with alpha, RGB or RGB with alpha for 1 to 4 channels.
std::string PngFileOf(const Samples&, const PngOptions& = {});
// Indices into 256 colours (i, 255 − i, i / 2), index 0 transparent.
std::string PalettePngFileOf(int width, int height, const std::vector<std::uint8_t>& indices);

struct JpegOptions {
  bool progressive = false;
  int orientation = 0;   // in EXIF; 0: none is written
  bool adobe = true;     // for CMYK: Adobe's marker and inverted samples
  int restart_rows = 0;  // of blocks, between restart markers; 0: there are none
};
// Grey, RGB or CMYK (samples are ink) for 1, 3 or 4 channels; quality 100, no subsampling.
std::string JpegFileOf(const Samples&, const JpegOptions& = {});

struct TiffOptions {
  int bit_depth = 8;
  int orientation = 1;
  int compression = 1;      // TIFF's number
  bool tiled = false;       // by 16 × 16
  bool planes = false;      // each channel apart
  bool associated = false;  // alpha
  bool palette = false;     // one channel: indices into colours like PalettePngFileOf's
};
// Grey, RGB or RGB with alpha for 1, 3 or 4 channels.
std::string TiffFileOf(const Samples&, const TiffOptions& = {});

}  // namespace tranos::camera
