// SPDX-License-Identifier: GPL-3.0-or-later
// The one list of all commands, and words in lists.
#include <algorithm>

#include "interp/command.h"
#include "interp/commands/families.h"

namespace tranos::interp {

namespace {

// The order of the families in the reference.
constexpr std::string_view kFamilies =
    "place|choose|create|manipulate|construct|set|view|output|photograph|history";

std::size_t RankOf(std::string_view family) { return kFamilies.find(family); }

std::vector<Command> Collect() {
  std::vector<Command> all;
  for (const auto family : {PlaceCommands(),        PlaceCurveCommands(),
                            PlaceSolidCommands(),   PlaceWallCommands(),
                            ChooseCommands(),       CreateCommands(),
                            TransformCommands(),    ArrayCommands(),
                            EditCommands(),         OffsetCommands(),
                            CutCommands(),          CornerCommands(),
                            ConstructCommands(),    ConstructSolidCommands(),
                            SolidBooleanCommands(), SymmetryCommands(),
                            PlaneCommands(),        ViewCommands(),
                            OutputCommands(),       PhotographCommands(),
                            RenderPhotoCommands(),  OrthophotoCommands(),
                            FacadeCommands(),       PriorCommands(),
                            TraceCommands(),        DetectCommands(),
                            CalibrateCommands(),    HistoryCommands(),
                            LaterCommands()}) {
    all.insert(all.end(), family.begin(), family.end());
  }
  std::stable_sort(all.begin(), all.end(), [](const Command& a, const Command& b) {
    return RankOf(a.family) < RankOf(b.family);
  });
  return all;
}

std::vector<const Command*> SortByWords() {
  std::vector<const Command*> sorted;
  for (const Command& command : AllCommands()) sorted.push_back(&command);
  std::sort(sorted.begin(), sorted.end(),
            [](const Command* a, const Command* b) { return a->words < b->words; });
  return sorted;
}

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool SameWord(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return Lower(x) == Lower(y); });
}

// Calls f(word) for each word of "a|b|c" until it returns true; whether one did.
template <class F>
bool AnyWord(std::string_view list, F&& f) {
  while (!list.empty()) {
    const std::size_t bar = std::min(list.find('|'), list.size());
    if (f(list.substr(0, bar))) return true;
    list.remove_prefix(std::min(bar + 1, list.size()));
  }
  return false;
}

}  // namespace

std::span<const Command> AllCommands() {
  static const std::vector<Command> all = Collect();
  return all;
}

const Command* FindCommand(std::string_view words) {
  static const std::vector<const Command*> sorted = SortByWords();
  const auto found = std::lower_bound(
      sorted.begin(), sorted.end(), words,
      [](const Command* command, std::string_view w) { return command->words < w; });
  return found != sorted.end() && (*found)->words == words ? *found : nullptr;
}

bool HasWord(std::string_view list, std::string_view word) {
  return AnyWord(list, [&](std::string_view each) { return SameWord(each, word); });
}

std::vector<std::string> SplitWords(std::string_view list) {
  std::vector<std::string> words;
  AnyWord(list, [&](std::string_view each) {
    words.emplace_back(each);
    return false;
  });
  return words;
}

}  // namespace tranos::interp
