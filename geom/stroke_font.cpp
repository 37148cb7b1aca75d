// SPDX-License-Identifier: GPL-3.0-or-later
// The Hershey fonts were originally created by Dr. A. V. Hershey while working at the U. S.
// National Bureau of Standards; the format of the font data was created by James Hurt, Cognition,
// Inc. Each line of it: glyph number, count of pairs, the pair of the left and right side, then
// pairs of points, a letter for each coordinate ('R' is zero, y runs down); " R" lifts the pen.
#include "geom/stroke_font.h"

#include <cmath>
#include <cstdint>

#include "geom/futural_font.inc"

namespace tranos::geom {
namespace {

constexpr double kBaseLine = 9, kCapitalHeight = 21;
constexpr double kLinePitch = 1.6;  // of the height
constexpr char32_t kFirst = U' ', kLast = U'~';
constexpr std::string_view kBox = "    0  6JZLFXFX[L[LF";

std::string_view GlyphOf(char32_t character) {
  if (character < kFirst || character > kLast) return kBox;
  std::string_view rest = kFuturalFont;
  for (char32_t skipped = kFirst; skipped < character && !rest.empty(); ++skipped) {
    const std::size_t end = rest.find('\n');
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  const std::string_view glyph = rest.substr(0, rest.find('\n'));
  return glyph.size() < 10 ? kBox : glyph;
}

// The next character of UTF-8 text, removed from its front; a malformed byte counts as a
// character without a glyph.
char32_t TakeCharacter(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text.front());
  text.remove_prefix(1);
  if (lead < 0x80) return lead;
  const std::size_t more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 0;
  for (std::size_t i = 0; i < more && !text.empty(); ++i) {
    if ((static_cast<unsigned char>(text.front()) & 0xc0) != 0x80) break;
    text.remove_prefix(1);
  }
  return 0xfffd;
}

double Coordinate(char letter) { return letter - 'R'; }

// The glyph's strokes with its left side at `pen`, in units of the font; returns its width.
template <class Emit>
double DrawGlyph(std::string_view glyph, const Emit& emit) {
  const double left = Coordinate(glyph[8]), right = Coordinate(glyph[9]);
  std::vector<Vec2> stroke;
  for (std::size_t i = 10; i + 1 < glyph.size(); i += 2) {
    if (glyph[i] == ' ') {
      emit(stroke);
      stroke.clear();
      continue;
    }
    stroke.push_back({Coordinate(glyph[i]) - left, kBaseLine - Coordinate(glyph[i + 1])});
  }
  emit(stroke);
  return right - left;
}

bool IsDrawable(const Text& text) {
  return text.frame.origin.allFinite() && text.frame.x.allFinite() && text.frame.y.allFinite() &&
         std::isfinite(text.height_m);
}

}  // namespace

std::vector<std::vector<Vec3>> Strokes(const Text& text) {
  std::vector<std::vector<Vec3>> strokes;
  if (!IsDrawable(text)) return strokes;
  const double scale = text.height_m / kCapitalHeight;
  Vec2 pen = Vec2::Zero();
  auto emit = [&](const std::vector<Vec2>& stroke) {
    if (stroke.empty()) return;
    std::vector<Vec3>& out = strokes.emplace_back();
    for (const Vec2& p : stroke) {
      const Vec2 at = scale * (pen + p);
      out.push_back(text.frame.origin + at.x() * text.frame.x + at.y() * text.frame.y);
    }
  };
  std::string_view rest = text.content;
  while (!rest.empty()) {
    const char32_t character = TakeCharacter(rest);
    if (character == U'\n') {
      pen = {0, pen.y() - kLinePitch * kCapitalHeight};
    } else {
      pen.x() += DrawGlyph(GlyphOf(character), emit);
    }
  }
  return strokes;
}

Box BoundingBox(const Text& text) {
  Box box;
  for (const auto& stroke : Strokes(text)) {
    for (const Vec3& p : stroke) box.Add(p);
  }
  if (box.empty() && text.frame.origin.allFinite()) box.Add(text.frame.origin);
  return box;
}

Text Transformed(const Text& text, const Affine& m) {
  Text image = text;
  image.frame.origin = m * text.frame.origin;
  const Vec3 x = m.linear() * text.frame.x, y = m.linear() * text.frame.y;
  image.height_m = text.height_m * y.norm();
  const Vec3 upright = y - y.dot(x.normalized()) * x.normalized();
  if (x.norm() > 0 && upright.norm() > 0) {
    image.frame.x = x.normalized();
    image.frame.y = upright.normalized();
  }
  return image;
}

}  // namespace tranos::geom
