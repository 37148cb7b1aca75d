// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/journal_reader.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "camera/json_text.h"

namespace tranos::session {

namespace {

using interp::Code;
using Json = nlohmann::json;

// As on the command line: deeper nesting might not fit the machine's stack.
constexpr std::uint64_t kDeepest = 1000;

tl::unexpected<JournalFinding> Broken(std::uint64_t line, std::string message) {
  return tl::make_unexpected(JournalFinding{Code::kBrokenJournal, line, std::move(message)});
}

const Json* Member(const Json& object, const char* key, Json::value_t type) {
  const auto found = object.find(key);
  return found != object.end() && found->type() == type ? &*found : nullptr;
}
const std::string* Text(const Json& object, const char* key) {
  const Json* member = Member(object, key, Json::value_t::string);
  return member ? member->get_ptr<const Json::string_t*>() : nullptr;
}

bool ReadLimits(const Json& header, interp::Limits* limits) {
  const Json* object = Member(header, "limits", Json::value_t::object);
  if (!object) return false;
  for (const auto& [key, target] : {std::pair{"steps", &limits->steps},
                                    {"elements", &limits->elements},
                                    {"memory", &limits->memory}}) {
    const Json* number = Member(*object, key, Json::value_t::number_unsigned);
    if (!number) return false;
    *target = number->get<std::uint64_t>();
  }
  const Json* depth = Member(*object, "depth", Json::value_t::number_unsigned);
  if (!depth || depth->get<std::uint64_t>() > kDeepest) return false;
  limits->depth = depth->get<int>();
  return true;
}

bool ReadParameters(const Json& header, RunSettings* settings) {
  const Json* list = Member(header, "parameters", Json::value_t::array);
  if (!list) return false;
  for (const Json& pair : *list) {
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_string() || !pair[1].is_string())
      return false;
    settings->parameters.emplace_back(pair[0].get<std::string>(), pair[1].get<std::string>());
  }
  return true;
}

tl::expected<void, JournalFinding> ReadSources(const Json& header, Journal* journal) {
  const Json* list = Member(header, "sources", Json::value_t::array);
  if (!list || list->empty()) return Broken(1, "the header holds no sources");
  for (const Json& source : *list) {
    const std::string* path = source.is_object() ? Text(source, "path") : nullptr;
    const std::string* text = path ? Text(source, "text") : nullptr;
    const std::string* hash = text ? Text(source, "hash") : nullptr;
    if (!hash) return Broken(1, "a source needs `path`, `hash` and `text`");
    if (*hash != model::Hex(HashOfText(*text))) {
      return Broken(1, "the text of `" + interp::Printable(*path) +
                           "` does not have the hash that stands beside it");
    }
    const Json* library = Member(source, "stdlib", Json::value_t::boolean);
    journal->sources.push_back({*path, *text, {}, library && library->get<bool>()});
  }
  return {};
}

// The last line, which says that the run ended.
tl::expected<void, JournalFinding> CheckEnd(std::string_view steps) {
  const auto lines = static_cast<std::uint64_t>(std::count(steps.begin(), steps.end(), '\n')) + 1;
  if (steps.empty() || steps.back() != '\n')
    return Broken(lines + (steps.empty() ? 0 : 1), "the journal is cut short");
  const std::size_t before =
      steps.size() < 2 ? std::string_view::npos : steps.rfind('\n', steps.size() - 2);
  const std::string_view last = steps.substr(before == std::string_view::npos ? 0 : before + 1);
  const Json end = Json::parse(last.begin(), last.end(), nullptr, false);
  if (!end.is_object() || !Text(end, "end")) {
    return Broken(lines, "the journal is cut short: its last line has no `end`");
  }
  const Json* count = Member(end, "steps", Json::value_t::number_unsigned);
  if (!count || count->get<std::uint64_t>() != lines - 2) {
    return Broken(lines, "the journal holds " + std::to_string(lines - 2) +
                             " steps, which is not what its last line says");
  }
  return {};
}

}  // namespace

std::string RenderText(const JournalFinding& finding, std::string_view path) {
  const interp::CodeInfo& info = interp::InfoOf(finding.code);
  std::string out = info.severity == interp::Severity::kError ? "error[" : "warning[";
  out += std::string(info.code) + "]: " + interp::Printable(finding.message) + "\n";
  out += "  --> " + interp::Printable(path) + ":" + std::to_string(finding.line) + "\n";
  for (const std::string& detail : finding.details)
    out += "   = " + interp::Printable(detail) + "\n";
  return out;
}

bool IsJournal(std::string_view text) { return text.starts_with("{\"tranos_journal\":"); }

tl::expected<Journal, JournalFinding> ReadJournal(std::string_view text) {
  const std::size_t line_end = text.find('\n');
  const std::string_view first = text.substr(0, line_end);
  const Json header = Json::parse(first.begin(), first.end(), nullptr, false);
  if (!header.is_object() || !header.contains("tranos_journal")) {
    const bool is_cut = IsJournal(text);
    return tl::make_unexpected(
        JournalFinding{is_cut ? Code::kBrokenJournal : Code::kNotAJournal, 1,
                       is_cut ? "the header is cut short or malformed" : "the file is no journal"});
  }
  const Json* version = Member(header, "tranos_journal", Json::value_t::number_unsigned);
  if (!version) return Broken(1, "`tranos_journal` is to be the number of the format's version");
  if (*version != kJournalVersion) {
    return tl::make_unexpected(JournalFinding{Code::kJournalVersion, 1,
                                              "the journal's version is " + version->dump() +
                                                  "; this program reads version " +
                                                  std::to_string(kJournalVersion)});
  }
  Journal journal;
  const std::string* program = Text(header, "program");
  const std::string* hypothesis = Text(header, "hypothesis");
  if (!program || !hypothesis || !ReadParameters(header, &journal.settings) ||
      !ReadLimits(header, &journal.settings.limits)) {
    return Broken(1, "the header needs `program`, `hypothesis`, `parameters` and `limits`");
  }
  journal.program = *program;
  journal.settings.hypothesis = *hypothesis;
  if (auto sources = ReadSources(header, &journal); !sources)
    return tl::make_unexpected(sources.error());
  journal.steps =
      line_end == std::string_view::npos ? std::string_view() : text.substr(line_end + 1);
  if (auto end = CheckEnd(journal.steps); !end) return tl::make_unexpected(end.error());
  return journal;
}

namespace {

constexpr std::string_view kPhotographType = "\"type\":\"photograph\"";
constexpr std::string_view kDetection = "\"detection\":";

// The camera that a photograph got from a file.
std::optional<camera::FramedCamera> CameraIn(const Json& geometry, const Eigen::Vector2i& size_px) {
  const auto size_mm = camera::NumbersIn(camera::MemberOf(geometry, "size_mm"), 2);
  const auto numbers = camera::NumbersIn(camera::MemberOf(geometry, "camera"), camera::kParameters);
  if (!size_mm || !numbers) return std::nullopt;
  camera::FramedCamera framed{{{(*size_mm)[0], (*size_mm)[1]}, size_px}, {}};
  framed.camera.parameters = Eigen::Map<const camera::ParameterVector>(numbers->data());
  return framed;
}

// Calls f(step) for every step whose line holds this text.
template <class F>
void ForEachStepWith(std::string_view text, std::string_view steps, F&& f) {
  for (std::size_t at = steps.find(text); at != std::string_view::npos; at = steps.find(text, at)) {
    const std::size_t begin = steps.rfind('\n', at) + 1;  // npos + 1 is the text's beginning
    const std::size_t end = std::min(steps.find('\n', at), steps.size());
    at = end;
    const Json step = Json::parse(steps.substr(begin, end - begin), nullptr, false);
    if (step.is_object() && step.contains("edit") && step["edit"].is_object()) f(step);
  }
}
// The geometry of each element that it added.
std::vector<Json> AddedBy(const Json& step) {
  std::vector<Json> added;
  for (const Json& element : step["edit"].value("added", Json::array())) {
    added.push_back(element.is_object() ? element.value("geometry", Json()) : Json());
  }
  return added;
}

void AddPhotograph(const Json& geometry, interp::PhotographFiles* photographs) {
  const std::string *file = Text(geometry, "file"), *content = Text(geometry, "content");
  const Json* size = Member(geometry, "size_px", Json::value_t::array);
  if (!file || !content || !size || size->size() != 2) return;
  const auto hash = model::HashFromHex(*content);
  if (!hash || !(*size)[0].is_number() || !(*size)[1].is_number()) return;
  const Eigen::Vector2i size_px((*size)[0].get<int>(), (*size)[1].get<int>());
  interp::PhotographFile& known = photographs->by_path[*file];
  if (known.size_px.x() == 0) known = {*hash, size_px, nullptr, known.camera};
  if (const std::string* camera_file = Text(geometry, "camera_file")) {
    // On the file's own format, unless the script always stated another.
    auto& of_file = photographs->by_path[*camera_file].camera;
    const bool is_own = camera::MemberOf(geometry, "format_is_stated") == false;
    if (!of_file || is_own) of_file = CameraIn(geometry, size_px);
  }
}

// The edges that a step found on a photograph.
void AddEdges(const Json& step, interp::PhotographFiles* photographs) {
  const Json& found_by = step["detection"];
  const std::string* content = Text(found_by, "content");
  const auto hash = content ? model::HashFromHex(*content) : std::nullopt;
  const auto least_px = camera::NumberIn(camera::MemberOf(found_by, "least_px"));
  if (!hash || !least_px) return;
  std::vector<interp::FoundEdge> edges;
  double noise_px = 0;
  for (const Json& trace : AddedBy(step)) {
    const Json& dots = camera::MemberOf(trace, "dots");
    const auto noise = camera::NumberIn(camera::MemberOf(trace, "noise_px"));
    if (!dots.is_array() || dots.size() != 2 || !noise) return;
    const auto a = camera::NumbersIn(dots[0], 2), b = camera::NumbersIn(dots[1], 2);
    if (!a || !b) return;
    const auto samples = camera::NumberIn(camera::MemberOf(trace, "samples"));
    edges.push_back(
        {{geom::Vec2((*a)[0], (*a)[1]), geom::Vec2((*b)[0], (*b)[1])}, samples.value_or(0)});
    noise_px = *noise;
  }
  photographs->edges[interp::EdgesKey({*hash, *least_px}, noise_px)] = std::move(edges);
}

// What is known of the photographs that the recorded run attached; their pixels are not needed to
// run it again. Lines that do not say it are passed over: the replay then finds them different.
interp::PhotographFiles PhotographsIn(std::string_view steps) {
  interp::PhotographFiles photographs;
  ForEachStepWith(kPhotographType, steps, [&](const Json& step) {
    for (const Json& geometry : AddedBy(step)) AddPhotograph(geometry, &photographs);
  });
  ForEachStepWith(kDetection, steps, [&](const Json& step) {
    if (step.contains("detection")) AddEdges(step, &photographs);
  });
  return photographs;
}

// The families of the library that the recorded run reached, as they were then.
std::vector<interp::LibraryFamily> FamiliesIn(const Journal& journal) {
  std::vector<interp::LibraryFamily> families;
  for (const interp::SourceText& source : journal.sources) {
    if (!source.of_library) continue;
    const std::size_t name = source.path.rfind('/') + 1;  // npos + 1 is the path's beginning
    families.push_back({source.path.substr(name, source.path.rfind('.') - name), source.text});
  }
  return families;
}

}  // namespace

interp::ScriptResult RunJournal(const Journal& journal,
                                std::function<void(const interp::Step&)> on_step,
                                std::function<void(std::string_view)> print) {
  interp::Host host;
  host.read = [&](std::string_view path) -> tl::expected<std::string, interp::HostError> {
    for (std::size_t i = 1; i < journal.sources.size(); ++i) {
      const interp::SourceText& source = journal.sources[i];
      if (!source.of_library && source.path == path) return source.text;
    }
    return tl::make_unexpected(
        interp::HostError{interp::HostError::kMissing, "not in the journal"});
  };
  host.print = std::move(print);
  const RunSettings& settings = journal.settings;
  const interp::Library library(FamiliesIn(journal));
  return interp::RunScript(
      journal.sources[0].path, journal.sources[0].text,
      {settings.hypothesis, settings.parameters, settings.limits.depth, &library},
      {settings.limits, std::move(on_step), {}, PhotographsIn(journal.steps)}, host);
}

}  // namespace tranos::session
