// SPDX-License-Identifier: GPL-3.0-or-later
// A camera without skew as the texts that other programs read. Every name in them is escaped.
#pragma once

#include <string>

#include "camera/unskewed.h"
#include "model/element.h"

namespace tranos::output {

// A camera that another program can hold, and what it is called.
struct NamedCamera {
  camera::FramedCamera framed;
  std::string name;
  std::string picture;  // the file's name beside the text; "" if there is none
};

// fSpy: what it exports as JSON, and the settings of a project whose own solution is this camera
// (its control lines point at the vanishing points of two axes, its reference distance gives the
// scale; where the world's origin is not before the camera, fSpy's solution keeps K and R alone).
std::string FspyJsonOf(const NamedCamera&);
std::string FspySettingsOf(const NamedCamera&);
// OpenCV's FileStorage: image_width, image_height, camera_matrix, distortion_coefficients (zeros),
// rotation and translation (camera from world).
std::string OpenCvYamlOf(const NamedCamera&);
// COLMAP: (0, 0) is the corner of the top left pixel. The picture's name must hold no white space.
std::string ColmapCamerasOf(const NamedCamera&);
std::string ColmapImagesOf(const NamedCamera&);
// A Python file that makes the camera in Blender's scene, sets the size of the picture and shows it
// behind. Its data are one literal of JSON.
std::string BlenderScriptOf(const NamedCamera&);
// The camera as it is, JSON: the parameters as reports name them, K, R, t and P = K [R | t] to
// dots; and where dots are in the pictures without skew and with square pixels.
std::string ExactCameraOf(const model::Element& photograph);

}  // namespace tranos::output
