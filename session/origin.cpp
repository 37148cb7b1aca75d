// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/origin.h"

namespace tranos::session {

Origin& OriginRecorder::OriginOf(model::ElementId id) {
  if (id >= record_->origins.size()) record_->origins.resize(id + 1);
  return record_->origins[id];
}

void OriginRecorder::Add(const interp::Step& step) {
  if (!step.edit || !step.edit->ChangesModel()) return;
  const model::Edit& edit = *step.edit;
  if (step.command.empty() && edit.added.empty()) return;  // `as`: a name is no change of origin
  const auto firing = static_cast<std::uint32_t>(record_->firings.size());
  const bool by_ending = step.key_in.empty();
  record_->firings.push_back(
      {by_ending ? step.statement : step.span, step.command, step.turn_values, step.answers});
  for (std::size_t i = 0; i < step.ids.size(); ++i) {
    Origin& origin = OriginOf(step.ids[i]);
    if (i < edit.added.size()) {
      origin = {firing, static_cast<std::uint32_t>(i)};
    } else {
      origin.changes.push_back(firing);
    }
  }
}

}  // namespace tranos::session
