// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/journal.h"

#include <algorithm>

namespace tranos::session {

namespace {

void Ids(std::string_view key, const std::vector<model::ElementId>& ids, JsonText* out) {
  if (ids.empty()) return;
  out->Key(key).Open('[');
  for (const model::ElementId id : ids) out->Integer(id);
  out->Close(']');
}

void WriteLimits(const interp::Limits& limits, JsonText* out) {
  out->Key("limits").Open('{').Key("steps").Integer(limits.steps);
  out->Key("elements").Integer(limits.elements).Key("memory").Integer(limits.memory);
  out->Key("depth").Integer(limits.depth).Close('}');
}

// Of the files that a script uses, whatever their order.
model::Hash128 LibraryHash(const interp::Sources& sources) {
  model::Hash128 sum;
  for (std::size_t i = 1; i < sources.files.size(); ++i) {
    model::Hasher hasher;
    sum = sum + hasher.Text(sources.files[i].path).Text(sources.files[i].text).Finish();
  }
  return sum;
}

}  // namespace

model::Hash128 HashOfText(std::string_view text) { return model::Hasher().Text(text).Finish(); }

JournalWriter::JournalWriter(RunSettings settings, std::string program, Sink sink,
                             std::size_t chunk)
    : settings_(std::move(settings)),
      program_(std::move(program)),
      sink_(std::move(sink)),
      chunk_(chunk) {}

void JournalWriter::Begin(const interp::Sources& sources) {
  begun_ = true;
  out_.Open('{').Key("tranos_journal").Integer(kJournalVersion).Key("program").String(program_);
  out_.Key("parameters").Open('[');
  for (const auto& [name, text] : settings_.parameters) {
    out_.Open('[').String(name).String(text).Close(']');
  }
  out_.Close(']').Key("hypothesis").String(settings_.hypothesis);
  WriteLimits(settings_.limits, &out_);
  WriteSources(sources);
  out_.Key("library").String(model::Hex(LibraryHash(sources))).Close('}').text() += '\n';
}

void JournalWriter::WriteSources(const interp::Sources& sources) {
  out_.Key("sources").Open('[');
  for (const interp::SourceText& file : sources.files) {
    out_.Open('{').Key("path").String(file.path).Key("hash").String(
        model::Hex(HashOfText(file.text)));
    out_.Key("text").String(file.text);
    if (file.of_library) out_.Key("stdlib").Boolean(true);
    out_.Close('}');
  }
  out_.Close(']');
}

void JournalWriter::Add(const interp::Step& step) {
  if (!begun_) Begin(*step.sources);
  out_.Open('{').Key("n").Integer(++steps_).Key("key_in").String(step.key_in);
  WritePlace(step);
  if (step.edit && step.edit->ChangesModel()) WriteEdit(step);
  if (step.edit && step.edit->detection) {
    const model::Detection& detection = *step.edit->detection;
    out_.Key("detection").Open('{').Key("content").String(model::Hex(detection.content));
    out_.Key("least_px").Ratio(detection.min_length_px).Close('}');
  }
  Ids("ids", step.ids, &out_);
  out_.Key("model").String(model::Hex(step.state->model.hash));
  out_.Key("state").String(model::Hex(model::HashOf(*step.state))).Close('}').text() += '\n';
  if (out_.text().size() >= chunk_) Flush();
}

void JournalWriter::WritePlace(const interp::Step& step) {
  const interp::Span& span = step.span;
  const interp::SourceText& file = step.sources->files[span.file];
  const auto next_line = [&] {
    return line_column_.line < file.line_starts.size() ? file.line_starts[line_column_.line]
                                                       : file.text.size() + 1;
  };
  const bool goes_on =
      span.file == place_.file && span.begin >= place_.begin && span.begin < next_line();
  if (goes_on) {
    for (std::uint32_t at = place_.begin; at < span.begin; ++at) {
      if ((static_cast<unsigned char>(file.text[at]) & 0xC0) != 0x80) ++line_column_.column;
    }
  } else {
    line_column_ = file.PlaceOf(span.begin);
  }
  place_ = span;
  out_.Key("file").Integer(span.file).Key("begin").Integer(span.begin).Key("end").Integer(span.end);
  out_.Key("line").Integer(line_column_.line).Key("column").Integer(line_column_.column);
}

// Elements are those of the state after the step, which have their ids.
void JournalWriter::WriteEdit(const interp::Step& step) {
  const model::Edit& edit = *step.edit;
  const std::size_t counts[] = {edit.added.size(), edit.replaced.size(), edit.released.size()};
  static constexpr std::string_view kKeys[] = {"added", "replaced", "released"};
  out_.Key("edit").Open('{');
  std::size_t next = 0;
  for (std::size_t kind = 0; kind < 3; ++kind) {
    if (counts[kind] == 0) continue;
    out_.Key(kKeys[kind]).Open('[');
    const std::size_t end = std::min(next + counts[kind], step.ids.size());
    for (; next < end; ++next) {
      if (const auto element = step.state->model.Current(step.ids[next])) {
        WriteElement(*element, &prototypes_, &out_);
      }
    }
    out_.Close(']');
  }
  Ids("consumed", edit.consumed, &out_);
  Ids("deleted", edit.deleted, &out_);
  Ids("grouped", edit.grouped, &out_);
  out_.Close('}');
}

void JournalWriter::Finish(const interp::ScriptResult& result) {
  if (!begun_) Begin(*result.sources);
  out_.Open('{').Key("end").String(result.diagnostics.has_errors() ? "failed" : "ran");
  out_.Key("steps").Integer(steps_).Key("elements").Integer(result.outcome.state.model.live);
  out_.Key("asserts").Open('[');
  for (const interp::AssertResult& assertion : result.outcome.asserts)
    out_.Boolean(assertion.passed);
  out_.Close(']').Key("model").String(model::Hex(result.outcome.state.model.hash));
  out_.Key("state").String(model::Hex(model::HashOf(result.outcome.state))).Close('}').text() +=
      '\n';
  Flush();
}

void JournalWriter::Flush() {
  sink_(out_.text());
  out_.text().clear();
}

}  // namespace tranos::session
