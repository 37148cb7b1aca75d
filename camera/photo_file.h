// SPDX-License-Identifier: GPL-3.0-or-later
// A photograph that is decoded, or taken, when its pixels are first asked for.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "camera/photo.h"

namespace tranos::camera {

using PhotoPtr = std::shared_ptr<const Photo>;

// The bytes of a file, pixels that came from nowhere else, or what makes them. Many may hold it and
// ask for its pixels at once: they are made one time and are the same object for all.
class PhotoFile {
 public:
  using Maker = std::function<geom::Result<PhotoPtr>()>;
  explicit PhotoFile(Maker make) : make_(std::move(make)) {}
  explicit PhotoFile(std::string bytes);
  explicit PhotoFile(PhotoPtr pixels) : pixels_(std::move(pixels)) {}

  // Upright, 8 bits a channel. Errors of DecodePhoto, or of what makes them.
  geom::Result<PhotoPtr> Pixels() const;

 private:
  mutable std::mutex making_;
  mutable Maker make_;  // given back, with all it holds, once the pixels are there
  mutable PhotoPtr pixels_;
};

}  // namespace tranos::camera
