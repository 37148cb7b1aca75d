// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/photo_file.h"

#include <span>

namespace tranos::camera {

geom::Result<PhotoPtr> PhotoFile::Pixels() const {
  const std::lock_guard lock(decoding_);
  if (pixels_) return pixels_;
  auto photo = DecodePhoto(std::as_bytes(std::span(bytes_.data(), bytes_.size())));
  if (!photo) return tl::unexpected(photo.error());
  pixels_ = std::make_shared<const Photo>(std::move(*photo));
  bytes_ = std::string();
  return pixels_;
}

}  // namespace tranos::camera
