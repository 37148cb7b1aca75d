// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/photograph.h"

#include <cmath>

#include "model/element.h"

namespace tranos::model {

namespace {

// What a solver found differs between machines in its last bits.
constexpr int kSolvedBits = 40;

double Rounded(double number) {
  int exponent = 0;
  const double mantissa = std::frexp(number, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, kSolvedBits)), exponent - kSolvedBits);
}

}  // namespace

bool IsStatedCamera(const Photograph& photograph) {
  return !photograph.attached && photograph.content == Hash128{};
}

bool HasCamera(const Photograph& photograph) {
  return photograph.estimate && photograph.estimate->complete();
}

void AddToHash(Hasher& hasher, const Photograph& photograph) {
  hasher.Text(photograph.file).Hash(photograph.content).Tag(photograph.attached);
  const auto& [size_mm, size_px] = photograph.frame;
  hasher.Ratio(size_mm.x()).Ratio(size_mm.y()).Integer(size_px.x()).Integer(size_px.y());
  for (const camera::Prior& prior : photograph.priors) {
    hasher.Ratio(prior.value).Ratio(prior.sigma);
  }
  hasher.Tag(photograph.estimate != nullptr);
  if (!photograph.estimate) return;
  for (int i = 0; i < camera::kParameters; ++i) {
    const bool free = photograph.estimate->parameters[i].free();
    hasher.Tag(free);
    if (!free) hasher.Ratio(Rounded(photograph.estimate->camera.parameters[i]));
  }
}

void AddToHash(Hasher& hasher, const Trace& trace) {
  hasher.Tag(static_cast<std::uint8_t>(trace.kind)).Integer(trace.axis);
  hasher.Integer(static_cast<std::int64_t>(trace.dots_px.size()));
  for (const geom::Vec2& dot : trace.dots_px) hasher.Ratio(dot.x()).Ratio(dot.y());
  hasher.Integer(static_cast<std::int64_t>(trace.numbers.size()));
  for (const Value& number : trace.numbers) hasher.Length(number.number());
  if (trace.of) hasher.Hash(trace.of->hash);
  hasher.Text(trace.facade).Ratio(trace.noise_px).Ratio(trace.samples);
}

std::string TypeOf(const Trace& trace) {
  switch (trace.kind) {
    case Trace::Kind::kDirection:
      return trace.axis < 0 ? "trace line" : "trace edge";
    case Trace::Kind::kEdge:
    case Trace::Kind::kElement:
      return "trace edge";
    case Trace::Kind::kPoint:
      return "trace point";
    case Trace::Kind::kRectangle:
      return "trace rectangle";
    case Trace::Kind::kRatio:
      return "trace ratio";
    case Trace::Kind::kCircle:
      return "trace circle";
  }
  return "trace";
}

}  // namespace tranos::model
