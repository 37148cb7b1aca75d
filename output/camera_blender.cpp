// SPDX-License-Identifier: GPL-3.0-or-later
// A Python file for Blender.
#include <nlohmann/json.hpp>

#include "output/camera_formats.h"

namespace tranos::output {

using camera::Mat3;
using nlohmann::ordered_json;

namespace {

// What follows the data. Blender's camera looks along −z of its own, y up; the shift is counted in
// the side that the sensor is fitted to.
constexpr std::string_view kScript = R"python(
def picture_file():
    """Where the picture is: beside this file, or beside its text in Blender's editor."""
    places = [globals().get("__file__", "")]
    places += [bpy.path.abspath(text.filepath) for text in bpy.data.texts]
    for place in places:
        path = os.path.join(os.path.dirname(os.path.abspath(place)), DATA["picture"])
        if place and os.path.isfile(path):
            return path
    return None


def make_camera(scene):
    data = bpy.data.cameras.new(DATA["name"])
    data.sensor_fit = DATA["sensor_fit"]
    data.sensor_width = data.sensor_height = DATA["sensor_mm"]
    data.lens = DATA["lens_mm"]
    data.shift_x = DATA["shift_x"]
    data.shift_y = DATA["shift_y"]
    data.clip_start = DATA["clip_start_m"]
    data.clip_end = DATA["clip_end_m"]
    camera = bpy.data.objects.new(DATA["name"], data)
    camera.matrix_world = mathutils.Matrix(DATA["world_from_camera"])
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = DATA["size_px"]
    scene.render.resolution_percentage = 100
    scene.render.pixel_aspect_x = scene.render.pixel_aspect_y = 1
    return camera


def show_picture(camera):
    if not DATA["picture"]:
        return
    path = picture_file()
    if path is None:
        print("the picture is not beside this file:", DATA["picture"])
        return
    background = camera.data.background_images.new()
    background.image = bpy.data.images.load(path)
    background.alpha = 0.5
    camera.data.show_background_images = True


show_picture(make_camera(bpy.context.scene))
)python";

// Text as a Python string: the text is ASCII without control characters, as JSON can be written.
std::string PythonText(const std::string& json) {
  std::string quoted = "'";
  for (const char c : json) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

ordered_json DataOf(const NamedCamera& named) {
  const auto& [frame, seen] = named.framed;
  const Mat3 k = camera::DotFromCamera(named.framed);
  const double width = frame.size_px.x(), height = frame.size_px.y();
  const double side = std::max(width, height);
  const double sensor_mm = frame.size_mm.maxCoeff();
  Mat3 axes = camera::CameraFromWorld(seen.parameters).transpose();
  axes.rightCols<2>() *= -1;
  const geom::Vec3 at = seen.position_m();
  ordered_json pose = ordered_json::array();
  for (int i = 0; i < 3; ++i) pose.push_back({axes(i, 0), axes(i, 1), axes(i, 2), at[i]});
  pose.push_back({0, 0, 0, 1});
  const double reach_m = std::max(100.0, at.norm());
  return {{"name", named.name},
          {"picture", named.picture},
          {"size_px", {frame.size_px.x(), frame.size_px.y()}},
          {"sensor_fit", width >= height ? "HORIZONTAL" : "VERTICAL"},
          {"sensor_mm", sensor_mm},
          {"lens_mm", k(1, 1) / side * sensor_mm},
          {"shift_x", (0.5 * (width - 1) - k(0, 2)) / side},
          {"shift_y", (k(1, 2) - 0.5 * (height - 1)) / side},
          {"clip_start_m", 1e-3 * reach_m},
          {"clip_end_m", 10 * reach_m},
          {"world_from_camera", std::move(pose)}};
}

}  // namespace

std::string BlenderScriptOf(const NamedCamera& named) {
  const std::string json =
      DataOf(named).dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  return "# Sets up a camera in Blender: blender --python FILE, or run it in the text editor.\n"
         "import json\nimport os\n\nimport bpy\nimport mathutils\n\n"
         "DATA = json.loads(" +
         PythonText(json) + ")\n\n" + std::string(kScript);
}

}  // namespace tranos::output
