// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/write.h"

#include <array>

#include "output/gltf.h"
#include "output/picture.h"
#include "output/png.h"
#include "output/stl.h"

namespace tranos::output {
namespace {

// A format joins by a row.
struct ModelFormat {
  std::string_view extension;
  Result<std::string> (*write)(const model::ExportRequest&, int threads);
};
constexpr std::array kModelFormats = {
    ModelFormat{".glb",
                [](const model::ExportRequest& request, int threads) {
                  return GlbOf(request.model,
                               {.photographs = request.photographs, .threads = threads});
                }},
    ModelFormat{".stl",
                [](const model::ExportRequest& request, int) { return StlOf(request.model); }},
};
struct PictureFormat {
  std::string_view extension;
  Result<std::string> (*write)(const Picture&);
};
constexpr std::array kPictureFormats = {
    PictureFormat{".png", PngOf},
};

std::string LowerExtension(std::string_view file) {
  const std::size_t name = file.rfind('/') == file.npos ? 0 : file.rfind('/') + 1;
  const std::size_t dot = file.rfind('.');
  if (dot == file.npos || dot < name) return "";
  std::string extension(file.substr(dot));
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

template <class Formats>
Result<const typename Formats::value_type*> FormatOf(const Formats& formats, std::string_view file,
                                                     std::string_view what) {
  const std::string extension = LowerExtension(file);
  std::string known;
  for (const auto& format : formats) {
    if (format.extension == extension) return &format;
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
  }
  return tl::unexpected(Error{"\"" + std::string(file) + "\" has no extension of " +
                              std::string(what) + " that can be written; there are " + known});
}

}  // namespace

Result<std::string> ExportOf(const model::ExportRequest& request, int threads) {
  const auto format = FormatOf(kModelFormats, request.file, "a model");
  if (!format) return tl::unexpected(format.error());
  return (*format)->write(request, threads);
}

Result<std::string> PictureFileOf(const model::RenderRequest& request, int threads) {
  const std::string_view file = request.file.empty() ? ".png" : std::string_view(request.file);
  const auto format = FormatOf(kPictureFormats, file, "a picture");
  if (!format) return tl::unexpected(format.error());
  const Result<Picture> picture = Render(request, threads);
  if (!picture) return tl::unexpected(picture.error());
  return (*format)->write(*picture);
}

}  // namespace tranos::output
