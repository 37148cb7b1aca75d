// SPDX-License-Identifier: GPL-3.0-or-later
// OpenCV's YAML, COLMAP's text, and the camera as it is.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "camera/parameter_table.h"
#include "output/camera_formats.h"

namespace tranos::output {

using camera::Mat3;
using geom::Vec3;
using nlohmann::ordered_json;

namespace {

// In double quotes, with the escapes that OpenCV's reader knows; what it does not is left out.
std::string YamlText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (static_cast<unsigned char>(c) >= ' ' && c != '\x7f') {
      quoted += c;
    }
  }
  return quoted + "\"";
}

template <class Matrix>
std::string YamlMatrix(std::string_view key, const Matrix& m) {
  std::string data;
  for (int i = 0; i < m.rows(); ++i) {
    for (int j = 0; j < m.cols(); ++j) {
      // A number of OpenCV's holds a point, or it is read as an integer.
      std::string number = fmt::format("{}", m(i, j));
      if (number.find_first_of(".e") == std::string::npos) number += ".";
      data += (data.empty() ? "" : j == 0 ? ",\n       " : ", ") + number;
    }
  }
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n",
                     key, m.rows(), m.cols(), data);
}

// K of a camera without skew; what is left of it is rounding.
Mat3 WithoutSkew(const camera::FramedCamera& framed) {
  Mat3 k = camera::DotFromCamera(framed);
  k(0, 1) = 0;
  return k;
}

struct Pose {
  Mat3 camera_from_world;
  Vec3 translation_m;
};
Pose PoseOf(const camera::Camera& camera) {
  const Mat3 r = camera::CameraFromWorld(camera.parameters);
  return {r, -r * camera.position_m()};
}

template <class Matrix>
ordered_json RowsOf(const Matrix& m) {
  ordered_json rows = ordered_json::array();
  for (int i = 0; i < m.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (int j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

ordered_json ParametersJson(const camera::Camera& camera) {
  const auto of = [&](camera::Parameter p) {
    return camera[p] / camera::kParameterRows[p].per_unit;
  };
  return {{"f_mm", of(camera::kFocal)},
          {"aspect", of(camera::kAspect)},
          {"principal_mm", {of(camera::kPrincipalX), of(camera::kPrincipalY)}},
          {"skew_deg", of(camera::kSkew)},
          {"omega_deg", of(camera::kOmega)},
          {"phi_deg", of(camera::kPhi)},
          {"kappa_deg", of(camera::kKappa)},
          {"position_m", {of(camera::kX0), of(camera::kY0), of(camera::kZ0)}}};
}

}  // namespace

std::string OpenCvYamlOf(const NamedCamera& named) {
  const auto& [frame, seen] = named.framed;
  const auto [r, t] = PoseOf(seen);
  std::string yaml = "%YAML:1.0\n---\n";
  yaml += fmt::format("camera_name: {}\n", YamlText(named.name));
  if (!named.picture.empty()) yaml += fmt::format("image_file: {}\n", YamlText(named.picture));
  yaml += fmt::format("image_width: {}\nimage_height: {}\n", frame.size_px.x(), frame.size_px.y());
  yaml += YamlMatrix("camera_matrix", WithoutSkew(named.framed));
  yaml += YamlMatrix("distortion_coefficients", Eigen::Matrix<double, 1, 5>::Zero());
  yaml += YamlMatrix("rotation", r);
  yaml += YamlMatrix("translation", t);
  return yaml;
}

std::string ColmapCamerasOf(const NamedCamera& named) {
  const Mat3 k = WithoutSkew(named.framed);
  const Eigen::Vector2i size = named.framed.frame.size_px;
  return fmt::format("1 PINHOLE {} {} {} {} {} {}\n", size.x(), size.y(), k(0, 0), k(1, 1),
                     k(0, 2) + 0.5, k(1, 2) + 0.5);
}

std::string ColmapImagesOf(const NamedCamera& named) {
  const auto [r, t] = PoseOf(named.framed.camera);
  const Eigen::Quaterniond q(r);
  return fmt::format("1 {} {} {} {} {} {} {} 1 {}\n\n", q.w(), q.x(), q.y(), q.z(), t.x(), t.y(),
                     t.z(), named.picture.empty() ? named.name + ".png" : named.picture);
}

std::string ExactCameraOf(const model::Element& photograph) {
  const model::Photograph& taken = *std::get<model::PhotographPtr>(photograph.geometry);
  const camera::FramedCamera framed{taken.frame, taken.estimate->camera};
  const auto [r, t] = PoseOf(framed.camera);
  ordered_json json = {{"tranos_camera", 1},
                       {"name", photograph.name_or_empty()},
                       {"photograph", taken.file},
                       {"size_px", {taken.frame.size_px.x(), taken.frame.size_px.y()}},
                       {"format_mm", {taken.frame.size_mm.x(), taken.frame.size_mm.y()}}};
  json.update(ParametersJson(framed.camera));
  json["K"] = RowsOf(camera::DotFromCamera(framed));
  json["R"] = RowsOf(r);
  json["t_m"] = {t.x(), t.y(), t.z()};
  json["P"] = RowsOf(camera::DotFromWorld(framed.camera, framed.frame));
  for (const auto& [key, shape] : {std::pair{"unskewed", camera::PixelShape::kRectangular},
                                   {"square", camera::PixelShape::kSquare}}) {
    const auto view = camera::UnskewedOf(framed, shape);
    if (!view) continue;
    const Eigen::Vector2i size = view->view.frame.size_px;
    json[key] = {{"changed", view->changed},
                 {"size_px", {size.x(), size.y()}},
                 {"K", RowsOf(WithoutSkew(view->view))},
                 {"new_dot_from_dot", RowsOf(view->new_dot_from_dot)}};
  }
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace tranos::output
