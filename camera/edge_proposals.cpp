// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/edge_proposals.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tranos::camera {
namespace {

// The header of a matrix over the image's own memory.
cv::Mat MatrixOver(const GreyImage& image) {
  return {image.height_px, image.width_px, CV_32F, const_cast<float*>(image.levels.data())};
}

void AddSegments(const cv::Mat& bytes, double min_length_px, std::vector<Proposal>& proposals) {
  std::vector<cv::Vec4f> found;
  cv::createLineSegmentDetector(cv::LSD_REFINE_STD)->detect(bytes, found);
  // It counts from the first pixel's corner.
  const Vec2 from_corner(-0.5, -0.5);
  for (const cv::Vec4f& s : found) {
    const Vec2 a(s[0], s[1]), b(s[2], s[3]);
    if ((b - a).norm() >= min_length_px) proposals.push_back({a + from_corner, b + from_corner});
  }
}

// The gradient's magnitude that a share of the pixels exceeds.
double MagnitudeOfStrongest(const cv::Mat& dx, const cv::Mat& dy, double share) {
  std::vector<float> magnitudes;
  magnitudes.reserve(dx.total());
  for (int y = 0; y < dx.rows; ++y) {
    for (int x = 0; x < dx.cols; ++x) {
      const float gx = dx.at<short>(y, x), gy = dy.at<short>(y, x);
      magnitudes.push_back(gx * gx + gy * gy);
    }
  }
  const auto at = static_cast<std::ptrdiff_t>((1 - share) * static_cast<double>(dx.total() - 1));
  std::ranges::nth_element(magnitudes, magnitudes.begin() + at);
  return std::sqrt(magnitudes[static_cast<std::size_t>(at)]);
}

void AddHough(const cv::Mat& smooth, double min_length_px, std::vector<Proposal>& proposals) {
  cv::Mat dx, dy, edges;
  cv::Sobel(smooth, dx, CV_16S, 1, 0);
  cv::Sobel(smooth, dy, CV_16S, 0, 1);
  // An edge's pixels are the strongest tenth at most; what continues one may be weaker by half.
  const double high = std::max(20.0, MagnitudeOfStrongest(dx, dy, 0.1));
  cv::Canny(dx, dy, edges, 0.5 * high, high, true);
  std::vector<cv::Vec4i> found;
  // More votes than noise gives a line of the picture by chance; gaps of two pixels.
  const int votes = std::max(20, static_cast<int>(0.8 * min_length_px));
  cv::HoughLinesP(edges, found, 1, CV_PI / 360, votes, min_length_px, 2);
  for (const cv::Vec4i& s : found) proposals.push_back({Vec2(s[0], s[1]), Vec2(s[2], s[3])});
}

}  // namespace

GreyImage GreyOf(const Photo& photo, int factor) {
  GreyImage grey{photo.width_px / factor, photo.height_px / factor, {}};
  grey.levels.resize(static_cast<std::size_t>(grey.width_px) * grey.height_px);
  const float weight = 1.0F / (1000.0F * static_cast<float>(factor * factor));
  for (int y = 0; y < grey.height_px; ++y) {
    for (int x = 0; x < grey.width_px; ++x) {
      std::uint64_t sum = 0;
      for (int row = 0; row < factor; ++row) {
        const std::uint8_t* pixel =
            &photo.rgb[3 * ((std::size_t{1} * y * factor + row) * photo.width_px +
                            std::size_t{1} * x * factor)];
        for (int i = 0; i < factor; ++i, pixel += 3)
          sum += 299U * pixel[0] + 587U * pixel[1] + 114U * pixel[2];
      }
      grey.levels[static_cast<std::size_t>(y) * grey.width_px + x] =
          weight * static_cast<float>(sum);
    }
  }
  return grey;
}

GreyImage Smoothed(const GreyImage& image, double sigma_px) {
  GreyImage smooth{image.width_px, image.height_px, std::vector<float>(image.levels.size())};
  cv::Mat out = MatrixOver(smooth);
  cv::GaussianBlur(MatrixOver(image), out, {}, sigma_px, sigma_px, cv::BORDER_REPLICATE);
  return smooth;
}

std::vector<Proposal> ProposeEdges(const GreyImage& image, double min_length_px) {
  std::vector<Proposal> proposals;
  cv::Mat bytes, smooth;
  MatrixOver(image).convertTo(bytes, CV_8U);
  cv::GaussianBlur(bytes, smooth, {}, 1, 1, cv::BORDER_REPLICATE);
  AddSegments(bytes, min_length_px, proposals);
  AddHough(smooth, min_length_px, proposals);
  return proposals;
}

}  // namespace tranos::camera
