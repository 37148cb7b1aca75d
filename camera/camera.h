// SPDX-License-Identifier: GPL-3.0-or-later
// The pinhole camera with skew, its eleven parameters, and where it puts points of the world.
// World: X right along the main facade, Y into the scene, Z up, in metres. Camera: x right, y down,
// z forward. Frame: millimetres from the centre of the photograph, x right, y down. Dots: pixels,
// (0, 0) the centre of the top left one, y down.
#pragma once

#include <cmath>

#include "geom/primitives.h"

namespace tranos::camera {

using geom::kPi;
using geom::Vec2;
using geom::Vec3;
using Mat3 = Eigen::Matrix3d;
using ProjectionMatrix = Eigen::Matrix<double, 3, 4>;

// A photograph's size on film and in pixels; pixels need not be square.
struct Frame {
  Vec2 size_mm{36, 24};
  Eigen::Vector2i size_px{3600, 2400};

  Vec2 pitch_mm() const { return size_mm.cwiseQuotient(size_px.cast<double>()); }
  Vec2 centre_px() const { return 0.5 * (size_px.cast<double>() - Vec2::Ones()); }
  Vec2 PointFromDot(const Vec2& dot_px) const {  // mm in the frame
    return (dot_px - centre_px()).cwiseProduct(pitch_mm());
  }
  Vec2 DotFromPoint(const Vec2& point_mm) const {
    return point_mm.cwiseQuotient(pitch_mm()) + centre_px();
  }
  Mat3 DotFromFrame() const;  // the same, on homogeneous coordinates
};

// The camera's parameters in the order of every vector and matrix of them.
enum Parameter : int {
  kFocal,       // f in x, mm
  kAspect,      // r = f_y / f_x
  kPrincipalX,  // mm
  kPrincipalY,  // mm
  kSkew,        // α, the angle between the dot's axes, rad; s = f_x cot α
  kOmega,       // tilt, rad; > 0 looks up
  kPhi,         // pan, rad; > 0 turns left
  kKappa,       // swing, rad
  kX0,          // position, m
  kY0,
  kZ0,
  kParameters
};
inline constexpr int kIntrinsics = 5;  // the first so many
using ParameterVector = Eigen::Matrix<double, kParameters, 1>;
using ParameterMatrix = Eigen::Matrix<double, kParameters, kParameters>;
inline constexpr const char* kParameterNames[kParameters] = {
    "f", "r", "u", "v", "alpha", "omega", "phi", "kappa", "X0", "Y0", "Z0"};

struct Camera {
  ParameterVector parameters =
      (ParameterVector() << 35, 1, 0, 0, kPi / 2, 0, 0, 0, 0, 0, 0).finished();

  double& operator[](Parameter p) { return parameters[p]; }
  double operator[](Parameter p) const { return parameters[p]; }
  Vec3 position_m() const { return parameters.tail<3>(); }
};

// K = [f, f cot α, u; 0, r f, v; 0, 0, 1] in mm, to points of the frame. Templated for derivatives.
template <class T>
Eigen::Matrix<T, 3, 3> FrameFromCamera(const Eigen::Matrix<T, kParameters, 1>& p) {
  using std::cos, std::sin;
  Eigen::Matrix<T, 3, 3> k;
  k << p[kFocal], p[kFocal] * cos(p[kSkew]) / sin(p[kSkew]), p[kPrincipalX],  //
      T(0), p[kAspect] * p[kFocal], p[kPrincipalY],                           //
      T(0), T(0), T(1);
  return k;
}

// R = Rz(κ) Rx(−ω) Ry(φ) B, B = [1 0 0; 0 0 −1; 0 1 0]: directions of the world to the camera.
template <class T>
Eigen::Matrix<T, 3, 3> CameraFromWorld(const Eigen::Matrix<T, kParameters, 1>& p) {
  using std::cos, std::sin;
  const T cw = cos(p[kOmega]), sw = sin(p[kOmega]), cp = cos(p[kPhi]), sp = sin(p[kPhi]);
  const T ck = cos(p[kKappa]), sk = sin(p[kKappa]);
  // Rows of Rx(−ω) Ry(φ) B, then the swing.
  const Eigen::Matrix<T, 1, 3> x(cp, sp, T(0)), y(-sw * sp, sw * cp, -cw), z(-cw * sp, cw * cp, sw);
  Eigen::Matrix<T, 3, 3> r;
  r << ck * x - sk * y, sk * x + ck * y, z;
  return r;
}

// K R [I | −C]: homogeneous points of the world, in metres, to points of the frame, in mm.
ProjectionMatrix FrameFromWorld(const Camera&);
// The same to dots.
ProjectionMatrix DotFromWorld(const Camera&, const Frame&);

// The camera whose K and R these are (K upper triangular with K₃₃ = 1 and positive diagonal, R a
// rotation); κ in (−π, π], ω in [−π/2, π/2].
Camera CameraOf(const Mat3& frame_from_camera, const Mat3& camera_from_world,
                const Vec3& position_m);

// Where a point is in the frame, mm, and how far before the camera, m: behind it where negative.
struct Image {
  Vec2 point_mm;
  double depth_m;
};
Image Project(const Camera&, const Vec3& point_in_world_m);

}  // namespace tranos::camera
