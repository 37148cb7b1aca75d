// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/photo_file.h"

#include <span>

namespace tranos::camera {

PhotoFile::PhotoFile(std::string bytes)
    : make_([held = std::move(bytes)]() -> geom::Result<PhotoPtr> {
        auto photo = DecodePhoto(std::as_bytes(std::span(held.data(), held.size())));
        if (!photo) return tl::unexpected(photo.error());
        return std::make_shared<const Photo>(std::move(*photo));
      }) {}

geom::Result<PhotoPtr> PhotoFile::Pixels() const {
  const std::lock_guard lock(making_);
  if (pixels_) return pixels_;
  auto made = make_();
  if (!made) return tl::unexpected(made.error());
  pixels_ = *std::move(made);
  make_ = nullptr;
  return pixels_;
}

}  // namespace tranos::camera
