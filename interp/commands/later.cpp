// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that belong to the language and are not carried out yet. They are known by their words,
// so that a script that uses one is told so.
#include "interp/commands/families.h"

namespace tranos::interp {

namespace {

// A row's only example is its words, which give E0001.
struct Later {
  std::string_view words, family, summary;
  Example example;
};

constexpr Later Row(std::string_view words, std::string_view family, std::string_view summary) {
  return {words, family, summary, {words, "E0001"}};
}

constexpr Later kLater[] = {
    Row("place dimension", "place", "A measure between two points, with its number."),
    Row("construct section", "construct", "A drawing of the model cut by a plane."),
    Row("attach drawing", "photograph",
        "Brings in a drawing as a reference: DXF, or an image with a scale."),
    Row("plot", "output", "Draws a sheet at a scale."),
    Row("highlight", "output", "Shows elements in a colour that stands out, for debugging."),
};

std::vector<Command> Rows() {
  std::vector<Command> rows;
  for (const Later& later : kLater) {
    rows.push_back({.words = later.words,
                    .family = later.family,
                    .summary = later.summary,
                    .examples = std::span(&later.example, 1)});
  }
  return rows;
}

}  // namespace

std::span<const Command> LaterCommands() {
  static const std::vector<Command> rows = Rows();
  return rows;
}

}  // namespace tranos::interp
