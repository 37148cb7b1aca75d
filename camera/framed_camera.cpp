// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/framed_camera.h"

#include <Eigen/SVD>

namespace tranos::camera {

namespace {

constexpr double kRotationTolerance = 1e-3;
constexpr double kFarthest_px = 1e9;  // of a focal length or a principal point
constexpr double kFarthest_m = 1e9;

tl::unexpected<geom::Error> Refused(std::string detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kOutOfRange, std::move(detail)});
}

bool IsCameraMatrix(const Mat3& k) {
  const bool is_triangular = k(1, 0) == 0 && k(2, 0) == 0 && k(2, 1) == 0;
  const double ratio = k(1, 1) / k(0, 0);
  return is_triangular && k(0, 0) > 1e-6 && k(1, 1) > 1e-6 && ratio > 1e-3 && ratio < 1e3 &&
         std::abs(k(0, 1)) < 50 * k(0, 0) && k.cwiseAbs().maxCoeff() < kFarthest_px;
}

}  // namespace

Frame FrameOfPixels(const Eigen::Vector2i& size_px) {
  return {size_px.cast<double>() * (kFilmIfUnknown_mm / size_px.maxCoeff()), size_px};
}

Mat3 DotFromCamera(const FramedCamera& framed) {
  return framed.frame.DotFromFrame() * FrameFromCamera(framed.camera.parameters);
}

geom::Result<FramedCamera> FramedCameraOf(const Frame& frame, const Mat3& dot_from_camera,
                                          const Mat3& camera_from_world, const Vec3& position_m) {
  if (!dot_from_camera.allFinite() || !camera_from_world.allFinite() || !position_m.allFinite()) {
    return Refused("it holds numbers that are not finite");
  }
  const Mat3 k = dot_from_camera / dot_from_camera(2, 2);
  if (!k.allFinite() || !IsCameraMatrix(k)) return Refused("its K is no camera's");
  if (!(position_m.norm() < kFarthest_m)) return Refused("its position is out of reach");
  const Eigen::JacobiSVD<Mat3> svd(camera_from_world, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 r = svd.matrixU() * svd.matrixV().transpose();
  if (!((svd.singularValues() - Vec3::Ones()).norm() < kRotationTolerance) || r.determinant() < 0) {
    return Refused("its rotation is none");
  }
  const Mat3 frame_from_camera = frame.DotFromFrame().inverse() * k;
  return FramedCamera{frame, CameraOf(frame_from_camera, r, position_m)};
}

}  // namespace tranos::camera
