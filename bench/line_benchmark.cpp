// SPDX-License-Identifier: GPL-3.0-or-later
// dev
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>

#include "camera/calibrate.h"
#include "camera/line_detection.h"
#include "camera/vanishing_directions.h"
#include "tests/camera/real/results.h"

namespace tranos::camera { double DebugScore(std::span<const ImageLine> lines, const Frame& frame, const Camera& truth, const DirectionSearch& search, Camera* out); }
namespace tranos::bench {
using namespace camera;
using camera::real::Known;
double Env(const char* n, double d) { const char* s = std::getenv(n); return s ? atof(s) : d; }
Photo Read(const std::filesystem::path& p) {
  std::ifstream f(p, std::ios::binary);
  std::vector<char> b((std::istreambuf_iterator<char>(f)), {});
  return *DecodePhoto(std::as_bytes(std::span(b)));
}
void Draw(const std::string& file, Photo photo, const std::vector<ImageLine>& lines, const std::vector<int>& axis, int z) {
  Photo big; big.width_px = z*photo.width_px; big.height_px = z*photo.height_px; big.rgb.resize(std::size_t(3)*z*z*photo.width_px*photo.height_px);
  for (int y = 0; y < big.height_px; ++y) for (int x = 0; x < big.width_px; ++x) { int g = 0; for (int c = 0; c < 3; ++c) g += photo.rgb[3*((y/z)*photo.width_px + x/z)+c]; for (int c = 0; c < 3; ++c) big.rgb[3*(y*big.width_px+x)+c] = std::uint8_t(90 + g/6); }
  const std::uint8_t col[4][3] = {{255,0,0},{0,220,0},{40,80,255},{255,255,0}};
  for (std::size_t i = 0; i < lines.size(); ++i) { const int n = int(2*z*lines[i].length_px()); for (int t = 0; t <= n; ++t) { Vec2 p = lines[i].a_px + (lines[i].b_px-lines[i].a_px)*t/n; int x = int(z*(p.x()+0.5)), y = int(z*(p.y()+0.5)); if (x>=0&&y>=0&&x<big.width_px&&y<big.height_px) for (int c=0;c<3;++c) big.rgb[3*(y*big.width_px+x)+c] = col[axis[i]<0?3:axis[i]][c]; } }
  std::ofstream o(file, std::ios::binary); o << "P6\n" << big.width_px << " " << big.height_px << "\n255\n"; o.write((const char*)big.rgb.data(), std::ssize(big.rgb));
}
struct Score { bool ok = false; double dir = 180, horizon = 9, focal = 9; double chi = 0, e0 = 0, e1 = 0; };
Score Solve(const Known& known, std::vector<ImageLine> lines, const std::vector<int>& axis) {
  real::Traced traced;
  traced.photograph.frame = known.frame;
  const double floor = Env("FLOOR", 0.4) * kPi / 180; const int mode = static_cast<int>(Env("MODE", 0));
  for (std::size_t i = 0; i < lines.size(); ++i) if (axis[i] >= 0) {
    ImageLine l = lines[i];
    if (mode == 0) l.tilt_sigma_px = std::hypot(l.tilt_sigma_px, floor * l.length_px());
    if (mode == 1) l = *FitImageLine({l.a_px, l.b_px}, 0.5, std::max(2.0, std::floor(l.length_px())));
    if (mode == 3) { const double tilt = std::hypot(l.tilt_sigma_px, floor * l.length_px()); l = *FitImageLine({l.a_px, l.b_px}, 0.5, std::clamp(std::round(12 * 0.25 / (tilt * tilt)), 2.0, std::max(2.0, std::floor(l.length_px())))); }
    if (mode == 2) l = *FitImageLine({l.a_px, l.b_px}, 0.5);
    traced.photograph.traces.push_back(DirectionTrace{l, axis[i]});
  }
  real::AssumeDefaults(traced.photograph);
  CalibrateOptions o; o.noise_is_estimated = Env("EST", 1); o.loss = Env("HUBER", 1) ? Loss::kHuber : Loss::kNone;
  auto e = Calibrate(traced.photograph, {}, o);
  while (!e && e.error().part >= 0 && e.error().detail.find("same as") != std::string::npos) {
    traced.photograph.traces.erase(traced.photograph.traces.begin() + e.error().part);
    e = Calibrate(traced.photograph, {}, o);
  }
  if (!e) { fmt::print("  REFUSED {}\n", e.error().detail); return {}; }
  Score s; s.ok = true; s.chi = e->chi2 / std::max(1, e->dof);
  const Mat3 r = CameraFromWorld(e->camera.parameters);
  const Mat3& t = known.camera_from_world;
  const auto ang = [](const Vec3& a, const Vec3& b) { return std::acos(std::min(1.0, std::abs(a.normalized().dot(b.normalized())))) * 180 / kPi; };
  double one = std::max(ang(r.col(0), t.col(0)), ang(r.col(1), t.col(1))), two = std::max(ang(r.col(0), t.col(1)), ang(r.col(1), t.col(0)));
  s.dir = std::max(std::min(one, two), ang(r.col(2), t.col(2)));
  s.focal = std::abs(e->camera[kFocal] / known.frame.pitch_mm().x() / known.focal_px - 1);
  const Mat3 kf = known.frame.DotFromFrame() * FrameFromCamera(e->camera.parameters);
  Mat3 kt = Mat3::Identity(); kt(0,0)=kt(1,1)=known.focal_px; kt(0,2)=known.principal_px.x(); kt(1,2)=known.principal_px.y();
  const Vec3 hf = kf.inverse().transpose() * r.col(2), ht = kt.inverse().transpose() * t.col(2);
  double worst = 0;
  for (double x : {0.0, known.frame.size_px.x() - 1.0}) worst = std::max(worst, std::abs((hf.x()*x+hf.z())/hf.y() - (ht.x()*x+ht.z())/ht.y()));
  { double x = 0; s.e0 = (hf.x()*x+hf.z())/hf.y() - (ht.x()*x+ht.z())/ht.y(); x = known.frame.size_px.x() - 1; s.e1 = (hf.x()*x+hf.z())/hf.y() - (ht.x()*x+ht.z())/ht.y(); s.e0 = -s.e0; s.e1 = -s.e1; }
  s.horizon = worst / known.frame.size_px.y();
  return s;
}
void Print(const char* name, std::vector<Score> v) {
  double n = static_cast<double>(v.size()), d1 = 0, d2 = 0, d5 = 0, auc = 0; std::vector<double> f;
  for (auto& s : v) { d1 += s.dir <= 1; d2 += s.dir <= 2; d5 += s.dir <= 5; auc += std::max(0.0, 1 - s.horizon / 0.25); f.push_back(s.focal); }
  std::sort(f.begin(), f.end());
  fmt::print("{}: dir<=1 {:.1f} <=2 {:.1f} <=5 {:.1f}  AUC {:.2f}  f med {:.2f} q3 {:.2f} 90 {:.2f}\n", name, 100*d1/n, 100*d2/n, 100*d5/n, 100*auc/n, 100*real::Quantile(f,.5), 100*real::Quantile(f,.75), 100*real::Quantile(f,.9));
}
}
int main(int argc, char** argv) {
  using namespace tranos::bench;
  auto data = real::DataFolder();
  const bool castle = argc > 1 && std::string(argv[1]) == "castle";
  auto known = castle ? real::Castle(*data) : real::YorkUrban(*data);
  std::vector<Score> a, b, c, lab; double td = 0, tv = 0, total = 0;
  for (auto& k : known) {
    if (argc > 2 && k.name != argv[2]) continue;
    auto photo = Read(castle ? *data / "strecha" / "castle-P30" / (k.name + ".jpg") : *data / "york_urban" / "images" / (k.name + ".jpg"));
    auto t0 = std::chrono::steady_clock::now();
    LineDetection ld; ld.min_length_px = Env("MINLEN", 0);
    auto lines = DetectLines(photo, ld);
    { const double k1 = Env("K1", 0); for (auto& l : *lines) for (Vec2* e : {&l.a_px, &l.b_px}) { Vec2 cc = k.frame.centre_px(), d = *e - cc; double r2 = d.squaredNorm() / cc.squaredNorm(); *e = cc + d * (1 + k1 * r2); } }
    auto t1 = std::chrono::steady_clock::now();
    DirectionSearch ds; ds.seed = static_cast<std::uint64_t>(Env("SEED", 1)); ds.parallel_rad = Env("PAR", 0.5) * kPi / 180;
    auto v = FindVanishingDirections(*lines, k.frame, ds);
    auto t2 = std::chrono::steady_clock::now();
    td += std::chrono::duration<double>(t1 - t0).count(); tv += std::chrono::duration<double>(t2 - t1).count();
    Score s; if (v) s = Solve(k, *lines, v->axis); else fmt::print("  refused: {}\n", v.error().detail);
    Mat3 kf = Mat3::Identity(); const double p = k.frame.pitch_mm().x(); Vec2 pp = k.frame.PointFromDot(k.principal_px);
    kf(0,0)=kf(1,1)=k.focal_px*p; kf(0,2)=pp.x(); kf(1,2)=pp.y();
    Mat3 r = k.camera_from_world; if (r.determinant() < 0) r.col(1) = -r.col(1);
    auto axes = AxesOfLines(*lines, k.frame, CameraOf(kf, r, Vec3::Zero()), ds.parallel_rad);
    Score o = Solve(k, *lines, axes);
    Camera g; double tg = DebugScore(*lines, k.frame, CameraOf(kf, r, Vec3::Zero()), ds, &g), tf = 0.0; DebugScore(*lines, k.frame, CameraOf(kf, r, Vec3::Zero()), ds, &g); Score sg = Solve(k, *lines, AxesOfLines(*lines, k.frame, g, ds.parallel_rad)); c.push_back(sg); { std::vector<ImageLine> ll; std::vector<int> la; for (auto& g2 : k.segments) { auto l = FitImageLine({g2.a_px, g2.b_px}, 0.5); if (l) ll.push_back(*l), la.push_back(g2.axis); } lab.push_back(Solve(k, ll, la)); if (lab.back().horizon > 0.03 || sg.horizon > 0.03) fmt::print("   label dir {:.2f} hor {:.2f} ({:.1f} {:.1f} px) found ({:.1f} {:.1f})\n", lab.back().dir, 100*lab.back().horizon, lab.back().e0, lab.back().e1, s.e0, s.e1); } total += tg;
    fmt::print("   score from truth {:.1f} (dir {:.2f} hor {:.2f} f {:.1f}) from found {:.1f}\n", tg, sg.dir, 100*sg.horizon, 100*sg.focal, tf);
    if (std::getenv("DRAW")) { Draw("/tmp/found.ppm", photo, *lines, v->axis, 2); Draw("/tmp/oracle.ppm", photo, *lines, axes, 2); }
    a.push_back(s); b.push_back(o);
    if (!castle) { }
    fmt::print("{} n {} [{} {} {}] dir {:.2f} hor {:.2f} f {:.1f}% chi {:.1f} | oracle dir {:.2f} hor {:.2f} f {:.1f}%\n", k.name, lines->size(), v?v->lines[0]:0, v?v->lines[1]:0, v?v->lines[2]:0, s.dir, 100*s.horizon, 100*s.focal, s.chi, o.dir, 100*o.horizon, 100*o.focal);
  }
  Print("found ", a); Print("oracle", b); Print("from truth", c); Print("labels", lab); fmt::print("total {:.1f}\n", total);
  fmt::print("detect {:.1f} ms, vp {:.1f} ms\n", 1000*td/static_cast<double>(a.size()), 1000*tv/static_cast<double>(a.size()));
}
