// SPDX-License-Identifier: GPL-3.0-or-later
// A photograph that is decoded when its pixels are first asked for.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "camera/photo.h"

namespace tranos::camera {

using PhotoPtr = std::shared_ptr<const Photo>;

// The bytes of a file, or pixels that came from nowhere else. Many may hold it and ask for its
// pixels at once: they are decoded one time and are the same object for all.
class PhotoFile {
 public:
  explicit PhotoFile(std::string bytes) : bytes_(std::move(bytes)) {}
  explicit PhotoFile(PhotoPtr pixels) : pixels_(std::move(pixels)) {}

  // Upright, 8 bits a channel. Errors of DecodePhoto.
  geom::Result<PhotoPtr> Pixels() const;

 private:
  mutable std::mutex decoding_;
  mutable std::string bytes_;  // given back once the pixels are there
  mutable PhotoPtr pixels_;
};

}  // namespace tranos::camera
