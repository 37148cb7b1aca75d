// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes, run as a script within small limits: no crash, no leak, no endless work; and a script
// that runs has the same effect when it is formatted and run again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "interp/format.h"
#include "interp/run.h"

namespace {

using namespace tranos::interp;

ScriptResult RunBounded(std::string text) {
  Limits limits;
  limits.steps = 3000;
  limits.elements = 200;
  limits.memory = 1'000'000;
  limits.depth = 40;
  // One file can be used: an empty one, whatever it is called.
  const Host host{
      [](std::string_view) -> tl::expected<std::string, HostError> { return std::string(); }, {}};
  // And one photograph is known, so that what is traced on it can be calibrated.
  const PhotographFiles photographs{{{"facade.png", {{}, {1600, 1067}}}}, {}, {}};
  return RunScript("fuzz.trn", std::move(text), {{}, {}, limits.depth},
                   {limits, {}, {}, photographs}, host);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 4096) return 0;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const ScriptResult first = RunBounded(text);
  if (!first.ran || first.diagnostics.has_errors()) return 0;
  Diagnostics diagnostics;
  const SyntaxTree tree = Parse(*first.sources, 0, {40}, &diagnostics);
  const ScriptResult second = RunBounded(Format(first.sources->files[0], tree));
  if (second.diagnostics.has_errors() ||
      second.outcome.state.model.hash != first.outcome.state.model.hash)
    std::abort();
  return 0;
}
