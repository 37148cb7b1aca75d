// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "output/picture.h"
#include "output/result.h"

namespace tranos::output {

// The picture as the bytes of a PNG file, 8 bits a channel, without time or text.
Result<std::string> PngOf(const Picture& picture);
// The picture in a PNG file of any kind.
Result<Picture> PictureOfPng(const std::string& png);

}  // namespace tranos::output
