// SPDX-License-Identifier: GPL-3.0-or-later
// choose: what is chosen, replaced, added to or dropped from.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "interp/commands/families.h"
#include "interp/commands/fence.h"
#include "interp/commands/firing.h"
#include "interp/pick.h"

namespace tranos::interp {

using model::Element;
using model::ElementId;
using model::ElementPtr;
using model::State;

namespace {

enum class Change { kReplace, kAdd, kDrop };
using Found = tl::expected<std::vector<ElementId>, CommandError>;
using Search = Found (*)(const State&, const Answers&);

std::vector<ElementId> ChosenNow(const State& state) {
  return {state.drawing.selection.begin(), state.drawing.selection.end()};
}

// The old ones first, each once, in the order of choosing.
std::vector<ElementId> With(std::vector<ElementId> before, const std::vector<ElementId>& found) {
  std::unordered_set<ElementId> seen(before.begin(), before.end());
  for (const ElementId id : found) {
    if (seen.insert(id).second) before.push_back(id);
  }
  return before;
}

std::vector<ElementId> Without(std::vector<ElementId> before, const std::vector<ElementId>& found) {
  const std::unordered_set<ElementId> dropped(found.begin(), found.end());
  std::erase_if(before, [&](ElementId id) { return dropped.contains(id); });
  return before;
}

Fired Choose(const State& state, Change change, const std::vector<ElementId>& found) {
  Fired fired;
  fired.edit.selection =
      model::Selection(change == Change::kReplace ? With({}, found)
                       : change == Change::kAdd   ? With(ChosenNow(state), found)
                                                  : Without(ChosenNow(state), found));
  return fired;
}

template <Search kSearch, Change kChange>
CommandResult Carry(const State& state, const Answers& answers) {
  const Found found = kSearch(state, answers);
  if (!found) return Fail(found.error());
  return Choose(state, kChange, *found);
}

CommandError Missed(const State& state, const PickResult& pick) {
  const model::Settings& settings = *state.drawing.settings;
  CommandError error = {.code = Code::kNothingThere,
                        .message = fmt::format("no element within {} of this point",
                                               InWords(settings.locate_tolerance_m, settings)),
                        .label = "there is no element in the model",
                        .where = {Where::kPoint, 0, {}}};
  if (pick.element) {
    error.label = fmt::format("the nearest is {}, {} away", NameForMessage(*pick.element),
                              InWords(pick.distance_m, settings));
    error.help = "`lt=` sets the locate tolerance";
  }
  return error;
}

CommandError Ambiguous(const PickResult& pick) {
  return {.code = Code::kAmbiguousPick,
          .message = "several elements are equally near to this point",
          .label = fmt::format("{} was taken, which was made last", NameForMessage(*pick.element)),
          .help = "pick at another place, or choose by name",
          .where = {Where::kPoint, 0, {}}};
}

// The first point of `choose element` replaces the selection, the following ones add.
template <Change kChange>
CommandResult ChooseElement(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const PickResult pick = Pick(state, answers.points[0]);
  if (!pick.within) return Fail(Missed(state, pick));
  const bool adds = kChange == Change::kReplace && !answers.first;
  Fired fired = Choose(state, adds ? Change::kAdd : kChange, {pick.element->id});
  if (pick.ambiguous) fired.warnings.push_back(Ambiguous(pick));
  return fired;
}

template <class F>
std::vector<ElementId> Visible(const State& state, F&& matches) {
  std::vector<ElementId> ids;
  state.model.ForEach([&](const ElementPtr& element) {
    if (IsVisible(state.model, *element) && matches(*element)) ids.push_back(element->id);
  });
  return ids;
}

Found All(const State& state, const Answers&) {
  return Visible(state, [](const Element& element) { return model::IsBuilt(element); });
}

Found None(const State&, const Answers&) { return std::vector<ElementId>{}; }

Found Last(const State& state, const Answers&) {
  std::vector<ElementId> ids;
  for (const ElementId id : state.drawing.last) {
    if (state.model.InModel(id)) ids.push_back(id);
  }
  if (!ids.empty()) return ids;
  return Fail({.code = Code::kNothingChosen,
               .message = "there is no `last`",
               .label = "nothing was made yet, or it was used up"});
}

Found InFence(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto fence = MakeFence(answers.points, state.drawing.settings->plane);
  if (!fence) return Fail(fence.error());
  const bool overlap = answers.HasWord("overlap");
  const std::vector<ElementId> ids =
      Visible(state, [&](const Element& element) { return fence->Takes(element, overlap); });
  if (!ids.empty()) return ids;
  return Fail({.code = Code::kNothingChosen,
               .message = overlap ? "nothing touches the fence" : "nothing lies inside the fence",
               .help = overlap ? "" : "`choose fence overlap` also takes what crosses it"});
}

// The names asked for: bare words, a bare string, or the key.
tl::expected<std::vector<std::string>, CommandError> NamesAsked(const Answers& answers,
                                                                std::string_view key) {
  std::vector<std::string> names = answers.words;
  const std::string given = answers.Text(key);
  if (!given.empty()) names.push_back(given);
  if (!names.empty()) return names;
  return Fail({.code = Code::kMissingValue,
               .message = fmt::format("choose which {}?", key),
               .help = fmt::format("write its name after `choose {}`", key)});
}

// Every part of the element has one of the names.
template <class F>
bool EveryLeaf(const Element& element, const std::vector<std::string>& names, F&& name_of) {
  bool every = true;
  model::ForEachLeaf(
      element, [&](const Element&, const geom::Affine&, const model::Attributes& attributes) {
        every = every && std::find(names.begin(), names.end(), name_of(attributes)) != names.end();
      });
  return every;
}

Where NameWhere(const Answers& answers, std::string_view key) {
  return answers.Has(key) ? Where{Where::kKey, 0, key} : Where{};
}

// Those that `matches` takes; what there is instead (by `names_of`) is offered when there are none.
template <class M, class N>
Found ByName(const State& state, const Answers& answers, std::string_view key, M&& matches,
             N&& names_of) {
  const auto names = NamesAsked(answers, key);
  if (!names) return Fail(names.error());
  std::vector<ElementId> ids =
      Visible(state, [&](const Element& element) { return matches(element, *names); });
  if (!ids.empty()) return ids;
  std::vector<std::string> candidates;
  state.model.ForEach([&](const ElementPtr& element) { names_of(*element, &candidates); });
  const auto meant = DidYouMean(names->back(), candidates);
  return Fail({.code = Code::kNothingChosen,
               .message = fmt::format("no visible element has the {} `{}`", key, names->back()),
               .help = meant ? fmt::format("did you mean `{}`?", *meant) : "",
               .where = NameWhere(answers, key)});
}

template <class F>
Found ByAttribute(const State& state, const Answers& answers, std::string_view key, F&& name_of) {
  return ByName(
      state, answers, key,
      [&](const Element& element, const std::vector<std::string>& names) {
        return EveryLeaf(element, names, name_of);
      },
      [&](const Element& element, std::vector<std::string>* candidates) {
        model::ForEachLeaf(
            element, [&](const Element&, const geom::Affine&, const model::Attributes& attributes) {
              candidates->emplace_back(name_of(attributes));
            });
      });
}

Found OnLevel(const State& state, const Answers& answers) {
  return ByAttribute(state, answers, "level",
                     [](const model::Attributes& attributes) { return attributes.level; });
}

Found OfMaterial(const State& state, const Answers& answers) {
  return ByAttribute(state, answers, "material",
                     [](const model::Attributes& attributes) { return attributes.material; });
}

Found OfEvidence(const State& state, const Answers& answers) {
  for (const std::string& word : answers.words) {
    if (model::EvidenceOf(word)) continue;
    return Fail({.code = Code::kUnknownWord,
                 .message = fmt::format("`{}` is no kind of evidence", Printable(word)),
                 .help = "measured, photo, excavation, document, symmetry, analogy, conjecture"});
  }
  return ByAttribute(state, answers, "evidence", [](const model::Attributes& attributes) {
    return std::string(model::WordOf(attributes.evidence));
  });
}

Found Named(const State& state, const Answers& answers) {
  return ByName(
      state, answers, "name",
      [](const Element& element, const std::vector<std::string>& names) {
        return std::find(names.begin(), names.end(), element.name_or_empty()) != names.end();
      },
      [](const Element& element, std::vector<std::string>* candidates) {
        if (element.name) candidates->push_back(*element.name);
      });
}

// A type may be of several words: `choose type dome cruciform`.
Found OfType(const State& state, const Answers& answers) {
  Answers joined = answers;
  joined.words.clear();
  for (const std::string& word : answers.words) {
    if (joined.words.empty()) {
      joined.words.push_back(word);
    } else {
      joined.words.front() += " " + word;
    }
  }
  return ByName(
      state, joined, "type",
      [](const Element& element, const std::vector<std::string>& names) {
        return std::find(names.begin(), names.end(), model::TypeOf(element)) != names.end();
      },
      [](const Element& element, std::vector<std::string>* candidates) {
        candidates->push_back(model::TypeOf(element));
      });
}

constexpr Prompt kElementPrompts[] = {{"element"}};
constexpr Prompt kFencePrompts[] = {{"corner of the fence"}};

constexpr Key kLevelKeys[] = {{"level", Type::kLabel, "the level's name"}};
constexpr Key kNameKeys[] = {{"name", Type::kString, "the element's name"}};
constexpr Key kTypeKeys[] = {{"type", Type::kString, "line, arc, circle, surface, dome …"}};
constexpr Key kMaterialKeys[] = {{"material", Type::kLabel, "the material's name"}};
constexpr Key kEvidenceKeys[] = {
    {"evidence", Type::kWord, "why elements stand where they stand",
     "measured|photo|excavation|document|symmetry|analogy|conjecture"}};

#define TRANOS_MOVED "\nmove xy=0,0,0 dl=1"

constexpr Example kElement[] = {
    {"place line xy=0,0,0 dl=10; choose element xy=5,0,0; copy xy=0,0,0 dl=0,3",
     "last.bbox.max.y == 3m"},
    {"place line xy=0,0,0 dl=10; choose element xy=5,1,0", "E0405"}};
constexpr Example kAddElement[] = {
    {"place point xy=0,0,0 xy=5,0,0; choose element xy=0,0,0; choose add element "
     "xy=5,0,0" TRANOS_MOVED,
     "len(last) == 2"},
    {"choose add element xy=0,0,0", "E0405"}};
constexpr Example kDropElement[] = {
    {"place point xy=0,0,0 xy=5,0,0; choose all; choose drop element xy=5,0,0" TRANOS_MOVED,
     "last.bbox.max.x == 1m"},
    {"choose drop element xy=0,0,0", "E0405"}};
constexpr Example kAll[] = {
    {"place point xy=0,0,0 xy=1,0,0; choose all" TRANOS_MOVED, "len(last) == 2"},
    {"choose all" TRANOS_MOVED, "E0404"}};
constexpr Example kAddAll[] = {
    {"place point xy=0,0,0 xy=1,0,0; choose last; choose add all" TRANOS_MOVED,
     "last[0].bbox.max.x == 2m"},
    {"choose add all" TRANOS_MOVED, "E0404"}};
constexpr Example kDropAll[] = {
    {"place point xy=0,0,0; choose all; choose drop all; choose add last" TRANOS_MOVED,
     "last.bbox.max.x == 1m"},
    {"place point xy=0,0,0; choose all; choose drop all" TRANOS_MOVED, "E0404"}};
constexpr Example kNone[] = {
    {"place point xy=0,0,0 xy=7,0,0; choose all; choose none; choose add element "
     "xy=7,0,0" TRANOS_MOVED,
     "last.bbox.max.x == 8m"},
    {"place point xy=0,0,0; choose all; choose none" TRANOS_MOVED, "E0404"}};
constexpr Example kLevel[] = {
    {"place point xy=0,0,0; lv=\"roof\"; place point xy=5,0,0; choose level roof" TRANOS_MOVED,
     "last.bbox.max.x == 6m"},
    {"place point xy=0,0,0; choose level attic", "E0404"}};
constexpr Example kAddLevel[] = {
    {"place point xy=0,0,0; lv=\"roof\"; place point xy=5,0,0; choose element xy=0,0,0\n"
     "choose add level roof" TRANOS_MOVED,
     "len(last) == 2"},
    {"choose add level attic", "E0404"}};
constexpr Example kDropLevel[] = {
    {"place point xy=0,0,0; lv=\"roof\"; place point xy=5,0,0; choose all\n"
     "choose drop level roof" TRANOS_MOVED,
     "last.bbox.max.x == 1m"},
    {"choose drop level attic", "E0404"}};
constexpr Example kName[] = {
    {"place point xy=2,0,0 as peg; place point xy=9,0,0; choose name peg" TRANOS_MOVED,
     "last.bbox.max.x == 3m"},
    {"place point xy=2,0,0 as peg; choose name pegs", "E0404"}};
constexpr Example kAddName[] = {
    {"place point xy=2,0,0 as peg; place point xy=9,0,0; choose last; choose add name "
     "peg" TRANOS_MOVED,
     "len(last) == 2"},
    {"choose add name peg", "E0404"}};
constexpr Example kDropName[] = {
    {"place point xy=2,0,0 as peg; place point xy=9,0,0; choose all; choose drop name "
     "peg" TRANOS_MOVED,
     "last.bbox.max.x == 10m"},
    {"choose drop name peg", "E0404"}};
constexpr Example kType[] = {
    {"place point xy=2,0,0; place line xy=0,0,0 dl=4; choose type line" TRANOS_MOVED,
     "last.bbox.max.x == 5m"},
    {"place point xy=2,0,0; choose type circle", "E0404"}};
constexpr Example kAddType[] = {
    {"place point xy=2,0,0; place line xy=0,0,0 dl=4; choose last; choose add type "
     "point" TRANOS_MOVED,
     "len(last) == 2"},
    {"choose add type circle", "E0404"}};
constexpr Example kDropType[] = {
    {"place point xy=2,0,0; place line xy=0,0,0 dl=4; choose all; choose drop type "
     "line" TRANOS_MOVED,
     "last.bbox.max.x == 3m"},
    {"choose drop type circle", "E0404"}};
constexpr Example kMaterial[] = {
    {"mt=\"stone\"; place point xy=2,0,0; mt=\"lead\"; place point xy=9,0,0; choose material "
     "stone" TRANOS_MOVED,
     "last.bbox.max.x == 3m"},
    {"place point xy=2,0,0; choose material brick", "E0404"}};
constexpr Example kAddMaterial[] = {
    {"mt=\"stone\"; place point xy=2,0,0; mt=\"lead\"; place point xy=9,0,0; choose last\n"
     "choose add material stone" TRANOS_MOVED,
     "len(last) == 2"},
    {"choose add material brick", "E0404"}};
constexpr Example kDropMaterial[] = {
    {"mt=\"stone\"; place point xy=2,0,0; mt=\"lead\"; place point xy=9,0,0; choose all\n"
     "choose drop material stone" TRANOS_MOVED,
     "last.bbox.max.x == 10m"},
    {"choose drop material brick", "E0404"}};
constexpr Example kEvidence[] = {
    {"ev=photo; place point xy=0,0,0; ev=conjecture; place point xy=3,0,0; choose evidence "
     "photo" TRANOS_MOVED,
     "last.bbox.max.x == 1m"},
    {"choose evidence hearsay", "E0208"}};
constexpr Example kAddEvidence[] = {
    {"ev=photo; place point xy=0,0,0; ev=conjecture; place point xy=3,0,0; choose last\n"
     "choose add evidence photo" TRANOS_MOVED,
     "len(last) == 2"},
    {"choose add evidence photo", "E0404"}};
constexpr Example kDropEvidence[] = {
    {"ev=photo; place point xy=0,0,0; ev=conjecture; place point xy=3,0,0; choose all\n"
     "choose drop evidence photo" TRANOS_MOVED,
     "last.bbox.max.x == 4m"},
    {"choose drop evidence photo", "E0404"}};
constexpr Example kFence[] = {
    {"place point xy=1,1,0 xy=9,9,0; choose fence xy=0,0,0 xy=5,5,0" TRANOS_MOVED,
     "last.bbox.max.x == 2m"},
    {"place line xy=1,1,0 xy=9,1,0; choose fence overlap xy=0,0,0 xy=5,0,0 xy=5,5,0" TRANOS_MOVED,
     "last.bbox.max.x == 10m"},
    {"place point xy=9,9,0; choose fence xy=0,0,0 xy=5,5,0 reset", "E0404"}};
constexpr Example kAddFence[] = {
    {"place point xy=1,1,0 xy=9,9,0; choose last; choose add fence xy=0,0,0 xy=5,5,0" TRANOS_MOVED,
     "len(last) == 2"},
    {"choose add fence xy=0,0,0 xy=5,5,0 reset", "E0404"}};
constexpr Example kDropFence[] = {
    {"place point xy=1,1,0 xy=9,9,0; choose all; choose drop fence xy=0,0,0 xy=5,5,0" TRANOS_MOVED,
     "last.bbox.max.x == 10m"},
    {"choose drop fence xy=0,0,0 xy=5,5,0 reset", "E0404"}};
constexpr Example kLast[] = {
    {"place point xy=1,0,0; choose last" TRANOS_MOVED, "last.bbox.max.x == 2m"},
    {"choose last", "E0404"}};
constexpr Example kAddLast[] = {
    {"place point xy=1,0,0; choose all; place point xy=2,0,0; choose add last" TRANOS_MOVED,
     "len(last) == 2"},
    {"choose add last", "E0404"}};
constexpr Example kDropLast[] = {
    {"place point xy=1,0,0 xy=2,0,0; choose all; choose drop last" TRANOS_MOVED,
     "last.bbox.max.x == 2m"},
    {"choose drop last", "E0404"}};
#undef TRANOS_MOVED

constexpr Command PickRow(std::string_view words, std::string_view summary,
                          std::span<const Example> examples,
                          CommandResult (*execute)(const State&, const Answers&)) {
  return {.words = words,
          .family = "choose",
          .summary = summary,
          .manner = Manner::kChooses,
          .prompts = kElementPrompts,
          .examples = examples,
          .execute = execute};
}

constexpr Command FenceRow(std::string_view words, std::string_view summary,
                           std::span<const Example> examples,
                           CommandResult (*execute)(const State&, const Answers&)) {
  return {.words = words,
          .family = "choose",
          .summary = summary,
          .manner = Manner::kGathers,
          .prompts = kFencePrompts,
          .least = 2,
          .options = "inside|overlap",
          .examples = examples,
          .execute = execute};
}

// A row of a criterion: `asks` for a name that may also stand as the key or a string.
constexpr Command By(std::string_view words, std::string_view summary, std::span<const Key> keys,
                     std::span<const Example> examples,
                     CommandResult (*execute)(const State&, const Answers&)) {
  const std::string_view asks = keys.empty() ? std::string_view() : keys[0].name;
  return {.words = words,
          .family = "choose",
          .summary = summary,
          .keys = keys,
          .asks = asks,
          .string_key = asks,
          .examples = examples,
          .execute = execute};
}

constexpr std::span<const Key> kNoKeys;
constexpr auto kReplace = Change::kReplace, kAdd = Change::kAdd, kDrop = Change::kDrop;

constexpr Command kCommands[] = {
    PickRow("choose element",
            "Chooses the element nearest to each data point within the locate tolerance; the first "
            "point replaces what was chosen, the following ones add.",
            kElement, ChooseElement<kReplace>),
    By("choose all", "Chooses everything on levels that are on.", kNoKeys, kAll,
       Carry<All, kReplace>),
    By("choose none", "Leaves nothing chosen.", kNoKeys, kNone, Carry<None, kReplace>),
    By("choose level", "Chooses what is on the levels named.", kLevelKeys, kLevel,
       Carry<OnLevel, kReplace>),
    By("choose name", "Chooses the elements named by `as`.", kNameKeys, kName,
       Carry<Named, kReplace>),
    By("choose type", "Chooses the elements of a type: `line`, `circle`, `dome cruciform`.",
       kTypeKeys, kType, Carry<OfType, kReplace>),
    By("choose material", "Chooses what is of the materials named.", kMaterialKeys, kMaterial,
       Carry<OfMaterial, kReplace>),
    By("choose evidence", "Chooses what stands on this evidence: `photo`, `conjecture`.",
       kEvidenceKeys, kEvidence, Carry<OfEvidence, kReplace>),
    FenceRow(
        "choose fence",
        "Chooses what lies inside a fence as seen along the active plane's normal: a rectangle by "
        "two corners, or an outline by more. `overlap` also takes what crosses it.",
        kFence, Carry<InFence, kReplace>),
    By("choose last", "Chooses what the latest firing made or changed.", kNoKeys, kLast,
       Carry<Last, kReplace>),
    PickRow("choose add element", "Adds the element nearest to each data point to what is chosen.",
            kAddElement, ChooseElement<kAdd>),
    By("choose add all", "Adds everything on levels that are on, what was chosen staying first.",
       kNoKeys, kAddAll, Carry<All, kAdd>),
    By("choose add level", "Adds what is on the levels named.", kLevelKeys, kAddLevel,
       Carry<OnLevel, kAdd>),
    By("choose add name", "Adds the elements named by `as`.", kNameKeys, kAddName,
       Carry<Named, kAdd>),
    By("choose add type", "Adds the elements of a type.", kTypeKeys, kAddType, Carry<OfType, kAdd>),
    By("choose add material", "Adds what is of the materials named.", kMaterialKeys, kAddMaterial,
       Carry<OfMaterial, kAdd>),
    By("choose add evidence", "Adds what stands on this evidence.", kEvidenceKeys, kAddEvidence,
       Carry<OfEvidence, kAdd>),
    FenceRow("choose add fence", "Adds what lies inside a fence.", kAddFence, Carry<InFence, kAdd>),
    By("choose add last", "Adds what the latest firing made or changed.", kNoKeys, kAddLast,
       Carry<Last, kAdd>),
    PickRow("choose drop element",
            "Takes the element nearest to each data point out of what is "
            "chosen.",
            kDropElement, ChooseElement<kDrop>),
    By("choose drop all", "Takes everything on levels that are on out of what is chosen.", kNoKeys,
       kDropAll, Carry<All, kDrop>),
    By("choose drop level", "Takes what is on the levels named out of what is chosen.", kLevelKeys,
       kDropLevel, Carry<OnLevel, kDrop>),
    By("choose drop name", "Takes the elements named by `as` out of what is chosen.", kNameKeys,
       kDropName, Carry<Named, kDrop>),
    By("choose drop type", "Takes the elements of a type out of what is chosen.", kTypeKeys,
       kDropType, Carry<OfType, kDrop>),
    By("choose drop material", "Takes what is of the materials named out of what is chosen.",
       kMaterialKeys, kDropMaterial, Carry<OfMaterial, kDrop>),
    By("choose drop evidence", "Takes what stands on this evidence out of what is chosen.",
       kEvidenceKeys, kDropEvidence, Carry<OfEvidence, kDrop>),
    FenceRow("choose drop fence", "Takes what lies inside a fence out of what is chosen.",
             kDropFence, Carry<InFence, kDrop>),
    By("choose drop last", "Takes what the latest firing made or changed out of what is chosen.",
       kNoKeys, kDropLast, Carry<Last, kDrop>),
};

}  // namespace

std::span<const Command> ChooseCommands() { return kCommands; }

}  // namespace tranos::interp
