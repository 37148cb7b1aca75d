// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes parse without harm; a script without errors means the same when it is formatted, and
// formatting it again changes nothing.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "interp/format.h"
#include "tests/interp/front/tree_text.h"

namespace {

using tranos::interp::CommentsOf;
using tranos::interp::Format;
using tranos::interp::Parsed;
using tranos::interp::ParseText;
using tranos::interp::TreeText;

void Demand(bool holds, const char* what, const std::string& text) {
  if (holds) return;
  std::fprintf(stderr, "%s:\n%s\n", what, text.c_str());
  std::abort();
}

constexpr int kRendered = 3;  // of the diagnostics: rendering all would take most of the time

void RenderSome(const Parsed& parsed) {
  int rendered = 0;
  for (const auto& diagnostic : parsed.diagnostics.list()) {
    const auto& span = diagnostic.span;
    Demand(span.begin <= span.end && span.end <= parsed.sources.files[0].text.size(),
           "a span outside the text", diagnostic.message);
    if (++rendered > kRendered) continue;
    RenderText(diagnostic, parsed.sources, false);
    RenderJson(diagnostic, parsed.sources);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Parsed parsed = ParseText(std::string(reinterpret_cast<const char*>(data), size));
  RenderSome(parsed);
  if (parsed.diagnostics.has_errors()) return 0;
  const std::string once = Format(parsed.sources.files[0], parsed.tree);
  const Parsed again = ParseText(once);
  Demand(!again.diagnostics.has_errors(), "the formatted text has errors", once);
  Demand(TreeText(again) == TreeText(parsed), "the formatted text means something else", once);
  Demand(CommentsOf(again) == CommentsOf(parsed), "comments are lost", once);
  Demand(Format(again.sources.files[0], again.tree) == once, "formatting twice differs", once);
  return 0;
}
