// SPDX-License-Identifier: GPL-3.0-or-later
// trim, extend, divide: curves cut shorter, made longer, cut into parts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geom/crossing.h"
#include "geom/curve_part.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/pick.h"

namespace tranos::interp {

using geom::Curve;
using geom::Vec3;
using model::Element;
using model::ElementPtr;
using model::State;

namespace {

constexpr int kMostParts = 10'000;
// Of two directions along a curve, a step that is surely beyond rounding.
constexpr double kApart = 1e-12;

// The curve that the data point means: `of=`, or the one it picks.
struct Meant {
  ElementPtr element;
  const Curve& curve() const { return *std::get<model::CurvePtr>(element->geometry); }
};

CommandError NoCurve(const Element& element, std::string_view verb, Where where) {
  return {
      .code = Code::kWrongElement,
      .message = fmt::format("`{}` works on curves, and this is {}", verb, NameForMessage(element)),
      .where = where};
}

tl::expected<Meant, CommandError> MeantBy(const State& state, const Answers& answers,
                                          std::string_view verb) {
  ElementPtr element;
  Where where = AtPoint(0);
  if (answers.Has("of")) {
    const auto listed = ListedBy(state, answers, "of");
    if (!listed) return Fail(listed.error());
    element = listed->front();
    where = AtKey("of");
  } else {
    const PickResult pick = Pick(state, answers.points[0]);
    if (!pick.within) {
      return Fail({.code = Code::kNothingThere,
                   .message = "no curve lies here",
                   .help = "pick the curve, or give it: `of=NAME`",
                   .where = where});
    }
    element = pick.element;
  }
  if (!std::holds_alternative<model::CurvePtr>(element->geometry)) {
    return Fail(NoCurve(*element, verb, where));
  }
  return Meant{element};
}

// The curves that a key lists; those of groups and placed elements, too.
tl::expected<std::vector<Curve>, CommandError> CurvesBy(const State& state, const Answers& answers,
                                                        std::string_view key,
                                                        std::string_view verb) {
  const auto listed = ListedBy(state, answers, key);
  if (!listed) return Fail(listed.error());
  std::vector<Curve> curves;
  for (const ElementPtr& element : *listed) {
    const std::size_t before = curves.size();
    model::ForEachLeaf(
        *element, [&](const Element& leaf, const geom::Affine& world, const model::Attributes&) {
          const auto* curve = std::get_if<model::CurvePtr>(&leaf.geometry);
          if (curve) curves.push_back(geom::Transformed(**curve, world));
        });
    if (curves.size() == before) return Fail(NoCurve(*element, verb, AtKey(key)));
  }
  return curves;
}

std::vector<double> CutsBy(const Curve& curve, const std::vector<Curve>& others) {
  std::vector<double> cuts;
  for (const Curve& other : others) {
    for (const geom::Crossing& crossing : geom::Crossings(curve, other)) {
      cuts.push_back(crossing.t_a);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

ElementPtr WithCurve(const Element& element, Curve curve) {
  return model::WithGeometry(element, CurveGeometry(std::move(curve)));
}

// A further part of the element, with its settings and a name of its own to come.
ElementPtr PartOf(const Element& element, Curve curve) {
  return model::MakeElement(model::kNoElement, CurveGeometry(std::move(curve)), element.attributes,
                            nullptr, element.tolerance);
}

// What is left when the stretch that holds `t` is taken out between the cuts beside it; the cuts
// ascend. Nothing if all of the curve would go.
std::vector<Curve> WithoutStretch(const Curve& curve, const std::vector<double>& cuts, double t) {
  const auto above = std::upper_bound(cuts.begin(), cuts.end(), t);
  const bool has_below = above != cuts.begin(), has_above = above != cuts.end();
  std::vector<Curve> left;
  const auto keep = [&](double from, double to) {
    if (auto part = geom::PartOf(curve, from, to)) left.push_back(*std::move(part));
  };
  if (geom::IsClosed(curve)) {
    if (cuts.size() < 2) return left;
    const double from = has_above ? *above : cuts.front();
    const double to = has_below ? *(above - 1) : cuts.back();
    keep(from, to);
    return left;
  }
  if (has_below && *(above - 1) > kApart) keep(0, *(above - 1));
  if (has_above && *above < 1 - kApart) keep(*above, 1);
  return left;
}

CommandResult Trim(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto meant = MeantBy(state, answers, "trim");
  if (!meant) return Fail(meant.error());
  const auto cutters = CurvesBy(state, answers, "by", "trim");
  if (!cutters) return Fail(cutters.error());
  const std::vector<double> cuts = CutsBy(meant->curve(), *cutters);
  const double t = geom::NearestPoint(meant->curve(), answers.points[0]).t;
  std::vector<Curve> left = WithoutStretch(meant->curve(), cuts, t);
  if (left.empty()) {
    const bool once = !cuts.empty() && geom::IsClosed(meant->curve());
    return Fail({.code = Code::kDoNotMeet,
                 .message = once ? "a closed curve is cut in two places, and this is crossed in one"
                                 : "nothing crosses the curve beside this point",
                 .label = "all of the curve would go",
                 .help = "`delete` takes a whole curve",
                 .where = AtKey("by")});
  }
  Fired fired;
  fired.edit.replaced.push_back(WithCurve(*meant->element, std::move(left[0])));
  if (left.size() > 1) fired.edit.added.push_back(PartOf(*meant->element, std::move(left[1])));
  return fired;
}

CommandResult Extend(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const bool to = answers.Has("to"), by_length = answers.Has("length");
  if (to == by_length) {
    return Fail({.code = to ? Code::kWrongWords : Code::kMissingValue,
                 .message = to ? "a curve is lengthened `to=` others or by a `length=`, not both"
                               : "how far?",
                 .help = "extend to=NAME, or extend length=1m",
                 .where = to ? AtKey("length") : Where{}});
  }
  const auto meant = MeantBy(state, answers, "extend");
  if (!meant) return Fail(meant.error());
  const Curve& curve = meant->curve();
  const Vec3& p = answers.points[0];
  const bool at_start = (geom::PointAt(curve, 0) - p).norm() < (geom::PointAt(curve, 1) - p).norm();
  const geom::CurveEnd end = at_start ? geom::CurveEnd::kStart : geom::CurveEnd::kEnd;
  geom::Result<Curve> longer = curve;
  if (to) {
    const auto others = CurvesBy(state, answers, "to", "extend");
    if (!others) return Fail(others.error());
    longer = geom::LengthenedTo(curve, end, *others);
  } else {
    longer = geom::LengthenedBy(curve, end, answers.Number("length"));
  }
  if (!longer) {
    const bool misses = longer.error().code == geom::ErrorCode::kDoNotMeet;
    const Where where = misses ? AtKey("to") : by_length ? AtKey("length") : AtPoint(0);
    return Fail(FromGeom(longer.error(), "a longer curve", where));
  }
  Fired fired;
  fired.edit.replaced.push_back(WithCurve(*meant->element, *std::move(longer)));
  return fired;
}

tl::expected<std::vector<double>, CommandError> PlacesToDivide(const Answers& answers,
                                                               const Curve& curve,
                                                               const std::vector<Curve>& others) {
  if (answers.Has("parts")) {
    return geom::EqualParameters(curve, static_cast<int>(answers.Number("parts")));
  }
  if (answers.Has("by")) return CutsBy(curve, others);
  std::vector<double> places;
  for (const Vec3& p : answers.Points("at")) {
    const geom::Nearest nearest = geom::NearestPoint(curve, p);
    if (nearest.distance_m > geom::kMeeting_m) {
      return Fail({.code = Code::kDoNotMeet,
                   .message = "the curve is divided at points on it, and this one lies off it",
                   .help = "`project(p, NAME)` is the nearest point of the curve",
                   .where = AtKey("at")});
    }
    places.push_back(nearest.t);
  }
  return places;
}

std::optional<CommandError> BadDivision(const Answers& answers) {
  const int ways = answers.Has("parts") + answers.Has("by") + answers.Has("at");
  if (ways != 1) {
    return CommandError{
        .code = ways == 0 ? Code::kMissingValue : Code::kWrongWords,
        .message = "a curve is divided into `parts=`, `by=` other curves, or `at=` points",
        .help = "divide of=NAME parts=4"};
  }
  if (answers.Has("parts") &&
      !(answers.Number("parts") >= 2 && answers.Number("parts") <= kMostParts)) {
    return CommandError{.code = Code::kOutOfRange,
                        .message = fmt::format("a curve is divided into 2 to {} parts", kMostParts),
                        .where = AtKey("parts")};
  }
  return std::nullopt;
}

CommandResult Divide(const State& state, const Answers& answers) {
  if (auto error = BadDivision(answers)) return Fail(*error);
  if (auto error = TooFar(answers)) return Fail(*error);
  if (auto error = NothingChosen(answers)) return Fail(*error);
  const auto curves = CurvesOf(answers, "a part of a curve");
  if (!curves) return Fail(curves.error());
  std::vector<Curve> others;
  if (answers.Has("by")) {
    auto found = CurvesBy(state, answers, "by", "divide");
    if (!found) return Fail(found.error());
    others = *std::move(found);
  }
  Fired fired;
  for (std::size_t i = 0; i < curves->size(); ++i) {
    const auto places = PlacesToDivide(answers, (*curves)[i], others);
    if (!places) return Fail(places.error());
    std::vector<Curve> parts = geom::Divided((*curves)[i], *places);
    if (parts.size() < 2 && !(geom::IsClosed((*curves)[i]) && !places->empty())) {
      return Fail({.code = Code::kDoNotMeet,
                   .message = "nothing divides the curve",
                   .where = answers.Has("by") ? AtKey("by") : AtKey("at")});
    }
    for (Curve& part : parts) {
      fired.edit.added.push_back(PartOf(*answers.chosen[i], std::move(part)));
    }
  }
  Consume(answers, &fired.edit);
  return fired;
}

constexpr Prompt kTrimPrompts[] = {{"the part to cut off"}};
constexpr Prompt kExtendPrompts[] = {{"near the end to lengthen"}};
constexpr Prompt kDividePrompts[] = {{"curve, or a point off everything to accept"}};
constexpr Key kOfCurve = {"of", Type::kElement, "the curve, in place of the one picked"};
constexpr Key kTrimKeys[] = {kOfCurve,
                             {"by", Type::kElements, "the curves that cut", {}, {}, -1, true}};
constexpr Key kExtendKeys[] = {
    kOfCurve,
    {"to", Type::kElements, "the curves of which it is lengthened to the first it meets"},
    {"length", Type::kLength, "by how much it is lengthened"}};
constexpr Key kDivideKeys[] = {kOf,
                               {"parts", Type::kCount, "into so many parts of equal length"},
                               {"by", Type::kElements, "where these curves cross it"},
                               {"at", Type::kPoints, "at these points on it"},
                               kKeep};

#define TRANOS_CROSS "place line xy=0,0,0 dl=4 as sill; place line xy=3,-1,0 dl=0,2 as post\n"

constexpr Example kTrimExamples[] = {
    {TRANOS_CROSS "trim by=post xy=3.5,0,0", "sill.length == 3m"},
    {TRANOS_CROSS "trim of=sill by=post xy=0,9,0", "sill.start.x within 3m +- 0.000001m"},
    {TRANOS_CROSS "trim by=sill xy=9,9,0", "E0405"},
    {"place line xy=0,0,0 dl=4 as a; place line xy=0,1,0 dl=4 as b; trim of=a by=b xy=0,0,0",
     "E0502"}};
constexpr Example kExtendExamples[] = {
    {TRANOS_CROSS "place line xy=0,1,0 dl=2,0 as beam; extend to=post xy=2,1,0",
     "beam.end.x within 3m +- 0.000001m"},
    {TRANOS_CROSS "extend of=sill length=1 xy=0,0,0", "sill.start.x within -1m +- 0.000001m"},
    {TRANOS_CROSS "extend of=post to=sill xy=3,1,0", "E0502"},
    {TRANOS_CROSS "extend of=sill length=0 xy=0,0,0", "E0212"},
    {TRANOS_CROSS "extend of=sill xy=0,0,0", "E0220"}};
constexpr Example kDivideExamples[] = {
    {"place circle radius=2 xy=0,0,0 as rim; divide of=rim parts=4 as quarters",
     "len(quarters) == 4 and quarters[0].length within 3.14159265m +- 0.00000001m"},
    {TRANOS_CROSS "divide of=sill by=post as parts", "parts[0].length within 3m +- 0.000001m"},
    {TRANOS_CROSS "divide of=sill at=[[1, 0, 0], [2, 0, 0]] keep=true as parts", "len(parts) == 3"},
    {TRANOS_CROSS "divide of=sill parts=1", "E0212"},
    {TRANOS_CROSS "divide of=sill at=[[1, 1, 0]]", "E0502"}};

constexpr Command kCommands[] = {
    {.words = "trim",
     .family = "manipulate",
     .summary =
         "Takes out of a curve the part at the data point, up to where others cross it; a part "
         "from its middle leaves two curves.",
     .manner = Manner::kPlaces,
     .prompts = kTrimPrompts,
     .keys = kTrimKeys,
     .examples = kTrimExamples,
     .execute = Trim},
    {.words = "extend",
     .family = "manipulate",
     .summary =
         "Lengthens a curve at the end nearer to the data point, to the first of others that it "
         "meets or by a length: lines straight ahead, arcs round their centres.",
     .manner = Manner::kPlaces,
     .prompts = kExtendPrompts,
     .keys = kExtendKeys,
     .examples = kExtendExamples,
     .execute = Extend},
    {.words = "divide",
     .family = "manipulate",
     .summary = "Cuts curves into parts: equal ones, or where others cross them, or at points.",
     .manner = Manner::kPicks,
     .prompts = kDividePrompts,
     .keys = kDivideKeys,
     .examples = kDivideExamples,
     .execute = Divide},
};

}  // namespace

std::span<const Command> CutCommands() { return kCommands; }

}  // namespace tranos::interp
