// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/camera_files.h"

#include "camera/fspy.h"
#include "output/camera_formats.h"
#include "output/png.h"

namespace tranos::output {

using camera::PixelShape;
using camera::Unskewed;
using model::CameraFormat;
using model::CameraRequest;

namespace {

const model::Photograph& PhotographOf(const CameraRequest& request) {
  return *std::get<model::PhotographPtr>(request.photograph->geometry);
}

bool MayBeRectangular(const CameraRequest& request) {
  return request.format == CameraFormat::kOpenCv || request.format == CameraFormat::kColmap;
}

Result<Unskewed> UnskewedFor(const CameraRequest& request) {
  const model::Photograph& taken = PhotographOf(request);
  const auto unskewed = camera::UnskewedOf(
      {taken.frame, taken.estimate->camera},
      MayBeRectangular(request) ? PixelShape::kRectangular : PixelShape::kSquare);
  if (!unskewed) return tl::unexpected(Error{unskewed.error().detail, request.photograph->id});
  return *unskewed;
}

struct Paths {
  std::vector<std::string> texts;
  std::string picture;  // "" if there is none beside the texts
  std::string exact;
};

std::string WithoutExtension(const std::string& file) {
  const std::size_t name = file.rfind('/') == file.npos ? 0 : file.rfind('/') + 1;
  const std::size_t dot = file.rfind('.');
  return dot == file.npos || dot <= name ? file : file.substr(0, dot);
}

std::string NameOf(const CameraRequest& request) {
  const std::string name(request.photograph->name_or_empty());
  return name.empty() ? "camera" : name;
}

Paths PathsOf(const CameraRequest& request, const Unskewed& unskewed) {
  const bool is_folder = request.format == CameraFormat::kColmap;
  const std::string& file = request.file;
  const std::string stem = is_folder ? file + "/" + NameOf(request) : WithoutExtension(file);
  if (request.format == CameraFormat::kExact) return {{}, "", file};
  Paths paths{{file}, "", stem + ".camera.json"};
  if (is_folder) {
    paths.texts = {file + "/cameras.txt", file + "/images.txt", file + "/points3D.txt"};
  }
  if (!request.picture || request.format == CameraFormat::kFspyProject) return paths;
  paths.picture = is_folder ? file + "/images/" + NameOf(request) : stem;
  if (unskewed.changed) paths.picture += MayBeRectangular(request) ? "_unskewed" : "_square";
  paths.picture += ".png";
  return paths;
}

Result<std::string> PictureOf(const CameraRequest& request, const Unskewed& unskewed) {
  camera::Photo warped = camera::Warped(*request.picture, unskewed);
  return PngOf({warped.width_px, warped.height_px, std::move(warped.rgb)});
}

// In the order of Paths::texts.
Result<std::vector<std::string>> TextsOf(const CameraRequest& request, const Unskewed& unskewed,
                                         const NamedCamera& named) {
  switch (request.format) {
    case CameraFormat::kFspyJson:
      return std::vector{FspyJsonOf(named)};
    case CameraFormat::kOpenCv:
      return std::vector{OpenCvYamlOf(named)};
    case CameraFormat::kBlender:
      return std::vector{BlenderScriptOf(named)};
    case CameraFormat::kColmap:
      return std::vector{ColmapCamerasOf(named), ColmapImagesOf(named), std::string()};
    case CameraFormat::kFspyProject: {
      if (!request.picture) {
        return tl::unexpected(
            Error{"an fSpy project holds a photograph, and the camera was stated "
                  "without one",
                  request.photograph->id});
      }
      const auto picture = PictureOf(request, unskewed);
      if (!picture) return tl::unexpected(picture.error());
      return std::vector{camera::FspyProjectOf(FspySettingsOf(named), *picture)};
    }
    case CameraFormat::kExact:
      return std::vector<std::string>{};
  }
  return std::vector<std::string>{};
}

}  // namespace

Result<std::vector<std::string>> CameraPathsOf(const CameraRequest& request) {
  const auto unskewed = UnskewedFor(request);
  if (!unskewed) return tl::unexpected(unskewed.error());
  Paths paths = PathsOf(request, *unskewed);
  std::vector<std::string> all = std::move(paths.texts);
  if (!paths.picture.empty()) all.push_back(paths.picture);
  all.push_back(paths.exact);
  return all;
}

Result<std::vector<NamedFile>> CameraFilesOf(const CameraRequest& request) {
  const auto unskewed = UnskewedFor(request);
  if (!unskewed) return tl::unexpected(unskewed.error());
  const Paths paths = PathsOf(request, *unskewed);
  const NamedCamera named{unskewed->view, NameOf(request),
                          paths.picture.substr(paths.picture.rfind('/') + 1)};
  const auto texts = TextsOf(request, *unskewed, named);
  if (!texts) return tl::unexpected(texts.error());
  std::vector<NamedFile> files;
  for (std::size_t i = 0; i < paths.texts.size(); ++i)
    files.push_back({paths.texts[i], (*texts)[i]});
  if (!paths.picture.empty()) {
    const auto picture = PictureOf(request, *unskewed);
    if (!picture) return tl::unexpected(picture.error());
    files.push_back({paths.picture, *picture});
  }
  files.push_back({paths.exact, ExactCameraOf(*request.photograph)});
  return files;
}

}  // namespace tranos::output
