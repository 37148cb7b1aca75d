// SPDX-License-Identifier: GPL-3.0-or-later
// Where a photograph may have straight edges: the only door to OpenCV's picture processing.
#pragma once

#include <vector>

#include "camera/camera.h"
#include "camera/photo.h"

namespace tranos::camera {

// Brightness from 0 to 255, rows from the top, no padding.
struct GreyImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> levels;

  float At(int x, int y) const { return levels[static_cast<std::size_t>(y) * width_px + x]; }
};

// The photograph's luma (ITU-R BT.601), each pixel the mean of `factor` × `factor` of the
// photograph's; what is left over at the right and lower borders is not used.
GreyImage GreyOf(const Photo& photo, int factor);

// The same after Gaussian smoothing with this deviation.
GreyImage Smoothed(const GreyImage& image, double sigma_px);

struct Proposal {
  Vec2 a_px, b_px;
};

// Straight pieces of edges, right to a pixel or two, many of them more than once: by the line
// segment detector (von Gioi, Jakubowicz, Morel and Randall 2010), and by Canny's edges and the
// progressive probabilistic Hough transform (the paper's Step A; Matas, Galambos and Kittler 2000).
// None is shorter than `min_length_px`. The same picture gives the same pieces in the same order,
// with any number of threads.
std::vector<Proposal> ProposeEdges(const GreyImage& image, double min_length_px);

}  // namespace tranos::camera
