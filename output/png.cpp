// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/png.h"

#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <vector>

namespace tranos::output {
namespace {

void Append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(data), size);
}

// libpng reports its errors by a jump, over no object that has a destructor.
bool Write(png_structp png, png_infop info, const std::vector<png_bytep>& rows,
           const Picture& picture) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_compression_level(png, 2);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width_px),
               static_cast<png_uint_32>(picture.height_px), 8,
               picture.alpha.empty() ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_write_image(png, const_cast<png_bytepp>(rows.data()));
  png_write_end(png, nullptr);
  return true;
}

// Red, green, blue, alpha of each pixel.
std::vector<std::uint8_t> Joined(const Picture& picture) {
  std::vector<std::uint8_t> joined;
  joined.reserve(4 * picture.alpha.size());
  for (std::size_t i = 0; i < picture.alpha.size(); ++i) {
    const auto first = picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i);
    joined.insert(joined.end(), first, first + 3);
    joined.push_back(picture.alpha[i]);
  }
  return joined;
}

}  // namespace

Result<std::string> PngOf(const Picture& picture) {
  const bool is_opaque = picture.alpha.empty();
  const std::vector<std::uint8_t> joined =
      is_opaque ? std::vector<std::uint8_t>() : Joined(picture);
  const std::uint8_t* const pixels = is_opaque ? picture.rgb.data() : joined.data();
  const std::size_t row_bytes = std::size_t{is_opaque ? 3U : 4U} * picture.width_px;
  std::vector<png_bytep> rows;
  for (int y = 0; y < picture.height_px; ++y) {
    rows.push_back(const_cast<png_bytep>(pixels + row_bytes * y));
  }
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (png) png_set_write_fn(png, &bytes, Append, nullptr);
  const bool written = info && Write(png, info, rows, picture);
  png_destroy_write_struct(&png, &info);
  if (!written) return tl::unexpected(Error{"the picture cannot be written as PNG"});
  return bytes;
}

Result<Picture> PictureOfPng(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size())) {
    image.format = PNG_FORMAT_RGB;
    picture.width_px = static_cast<int>(image.width);
    picture.height_px = static_cast<int>(image.height);
    picture.rgb.resize(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr)) return picture;
  }
  png_image_free(&image);
  return tl::unexpected(Error{std::string("this is no PNG file: ") + image.message});
}

}  // namespace tranos::output
