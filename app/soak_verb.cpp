// SPDX-License-Identifier: GPL-3.0-or-later
// Builds every element of the library at settings all over its ranges.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <thread>

#include "app/console.h"
#include "app/element_settings.h"
#include "app/element_text.h"
#include "app/files.h"
#include "app/status.h"
#include "app/verbs.h"

namespace tranos::app {

namespace {

using interp::Definition;
using model::ElementPtr;

constexpr double kPlanHeight_m = 1e-9;  // a plan symbol stays this near to z = 0

// One element at one level of detail.
struct Job {
  const Definition* element;
  std::string detail;
  std::size_t settings = 0;
  std::vector<std::string> failures = {};  // a text of lines each
};

// The facts' script, its placement at the settings of this line; without facts the line alone. ""
// where facts do not place the element.
std::string ScriptFor(const ElementLibrary& elements, const Definition& element,
                      const std::string& line) {
  const std::string_view facts = FactsTextOf(elements, element.words);
  std::string script;
  bool placed = false;
  for (std::size_t at = 0; at < facts.size();) {
    const std::size_t end = std::min(facts.find('\n', at), facts.size());
    const std::string_view own = facts.substr(at, end - at);
    at = end + 1;
    const bool places = !placed && own.starts_with(element.words + " ") && own.ends_with(" as it");
    placed |= places;
    script += (places ? line : std::string(own)) + "\n";
  }
  if (facts.empty()) return line + "\n";
  return placed ? script : "";
}

// What a plan symbol may not be, as a sentence; "" for one that keeps to the drafting convention.
std::string PlanProblem(const model::Model& model) {
  std::string problem;
  model.ForEach([&](const ElementPtr& element) {
    const geom::Box box = model::BoundingBox(*element);
    if (!box.empty() && (box.min.z() < -kPlanHeight_m || box.max.z() > kPlanHeight_m))
      problem = "the plan symbol leaves the plane z = 0";
    model::ForEachLeaf(
        *element, [&](const model::Element& leaf, const geom::Affine&, const model::Attributes&) {
          const bool is_line = std::holds_alternative<model::CurvePtr>(leaf.geometry) ||
                               std::holds_alternative<model::TextPtr>(leaf.geometry) ||
                               std::holds_alternative<model::Point>(leaf.geometry);
          if (!is_line)
            problem = "the plan symbol has a " + model::TypeOf(leaf) + ", not lines alone";
        });
  });
  return problem;
}

// What is wrong with the facets of the model's solids, as a sentence; "" if nothing is. Whether
// they cross one another is found exactly and takes its time, so that it is looked for where it is
// asked for.
std::string FacetProblem(const model::Model& model, bool crossings_too) {
  std::string problem;
  const auto look = [&](const geom::Solid& solid) -> std::string {
    const auto facets = solid.Facets();
    if (!facets) return "a solid cannot be evaluated: " + facets.error().detail;
    if (!geom::IsClosed(**facets)) return "the surface of a solid is open";
    if (crossings_too && geom::HasSelfIntersection(**facets)) return "a solid intersects itself";
    return "";
  };
  model.ForEach([&](const ElementPtr& element) {
    model::ForEachLeaf(
        *element, [&](const model::Element& leaf, const geom::Affine&, const model::Attributes&) {
          const auto* solid = std::get_if<model::SolidPtr>(&leaf.geometry);
          if (solid && problem.empty()) problem = look(**solid);
        });
  });
  return problem;
}

// What is wrong with the element placed by this line; "" if nothing is.
std::string ProblemOf(const ElementLibrary& elements, const Job& job, const std::string& line,
                      bool crossings_too) {
  interp::BindOptions bind;
  bind.library = elements.library;
  const std::string script = ScriptFor(elements, *job.element, line);
  if (script.empty()) return "no line of its facts places it and ends with `as it`\n";
  const interp::ScriptResult result = interp::RunScript("facts", script, bind, {}, {});
  for (const interp::Diagnostic& diagnostic : result.diagnostics.list())
    return interp::RenderText(diagnostic, *result.sources, false);
  for (const interp::AssertResult& assertion : result.outcome.asserts) {
    if (assertion.passed) continue;
    return "not so: " + (assertion.message.empty() ? assertion.text : assertion.message) +
           "; it is " + assertion.value + ", expected " + assertion.expected + "\n";
  }
  const model::Model& model = result.outcome.state.model;
  const std::string problem =
      job.detail == "plan" ? PlanProblem(model) : FacetProblem(model, crossings_too);
  return problem.empty() ? "" : problem + "\n";
}

// The same element and seed give the same settings, whatever else is tried.
std::uint64_t SeedOf(const Definition& element, std::uint64_t seed) {
  return seed ^ model::Hasher().Text(element.words).Finish().low;
}

void Do(const ElementLibrary& elements, Job* job, const SoakOptions& options) {
  const std::size_t parameters = job->element->parameters.size();
  std::vector<std::vector<Pick>> settings = {std::vector<Pick>(parameters, Pick::kStandard)};
  if (options.corners) settings = CornersOf(*job->element);
  settings.insert(settings.end(), static_cast<std::size_t>(options.settings),
                  std::vector<Pick>(parameters, Pick::kRandom));
  Draws draws(SeedOf(*job->element, options.seed));
  for (const std::vector<Pick>& picks : settings) {
    ++job->settings;
    const auto line = PlacementOf(*job->element, picks, job->detail, &draws);
    const bool crossings_too =
        options.crossings_everywhere ||
        (options.crossings && std::all_of(picks.begin(), picks.end(),
                                          [](Pick pick) { return pick == Pick::kStandard; }));
    const std::string problem =
        line ? ProblemOf(elements, *job, *line, crossings_too) : line.error() + "\n";
    if (!problem.empty()) job->failures.push_back((line ? *line + "\n" : "") + problem);
  }
}

bool IsAsked(const SoakOptions& options, const std::string& family, std::string_view words) {
  return options.names.empty() ||
         std::any_of(options.names.begin(), options.names.end(), [&](const std::string& name) {
           return name == family || name == FileNameOf(words);
         });
}

void DoAll(const ElementLibrary& elements, std::vector<Job>* jobs, const SoakOptions& options) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs->size(); i = next++) Do(elements, &(*jobs)[i], options);
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
    threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
}

// Tells of the failures, and how many there are.
std::size_t Tell(const std::vector<Job>& jobs) {
  constexpr std::size_t kTold = 5;  // of a job
  std::size_t failed = 0;
  for (const Job& job : jobs) {
    failed += job.failures.size();
    for (std::size_t i = 0; i < std::min(job.failures.size(), kTold); ++i)
      PrintError(job.failures[i] + "\n");
    if (job.failures.size() > kTold) {
      PrintError(fmt::format("… and {} more of `{}` at detail={}\n\n", job.failures.size() - kTold,
                             job.element->words, job.detail));
    }
  }
  return failed;
}

// What the family's declarations lack; false if they do not bind.
bool TellOfDeclarations(const BoundFamily& family, std::size_t* failed) {
  for (const Definition* element : family.elements) {
    for (const std::string& name : RangesMissing(*element)) {
      ++*failed;
      PrintFailure("`" + element->words + "` declares no range for `" + name + "`");
    }
  }
  PrintDiagnostics(family.diagnostics, *family.program->sources);
  return !family.diagnostics.has_errors();
}

int Soak(const ElementLibrary& elements, const SoakOptions& options) {
  std::vector<BoundFamily> families;
  std::vector<Job> jobs;
  std::size_t failed = 0;
  const std::vector<std::string> words = elements.library->Words();
  for (const interp::LibraryFamily& family : elements.library->families()) {
    if (std::none_of(words.begin(), words.end(), [&](const std::string& each) {
          return elements.library->Defining(each) == &family && IsAsked(options, family.name, each);
        })) {
      continue;
    }
    families.push_back(BindLibraryFamily(elements, family));
    if (!TellOfDeclarations(families.back(), &failed)) return kScriptIsWrong;
    for (const Definition* element : families.back().elements) {
      if (!IsAsked(options, family.name, element->words)) continue;
      for (const std::string& detail : DetailsOf(*element)) jobs.push_back({element, detail});
    }
  }
  if (jobs.empty()) {
    PrintFailure("the library has nothing of these names: `tranos lib` lists its families");
    return kCommandLineIsWrong;
  }
  if (failed > 0) return kScriptIsWrong;
  DoAll(elements, &jobs, options);
  failed = Tell(jobs);
  std::size_t settings = 0;
  for (const Job& job : jobs) settings += job.settings;
  PrintOut(fmt::format("{} settings of {} elements and details: {} failed\n", settings, jobs.size(),
                       failed));
  return failed == 0 ? kFine : kScriptIsWrong;
}

// The texts of a folder's scripts, by name.
std::map<std::string, std::string, std::less<>> TextsBelow(const std::string& folder) {
  std::map<std::string, std::string, std::less<>> texts;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    if (entry.path().extension() != ".trn") continue;
    if (auto text = ReadNamedFile(entry.path().string()))
      texts.emplace(entry.path().stem().string(), *std::move(text));
  }
  return texts;
}

}  // namespace

int SoakVerb(const SoakOptions& options) {
  if (options.folder.empty()) return Soak(StandardElements(), options);
  const auto texts = TextsBelow(options.folder);
  std::vector<interp::LibraryFamily> families;
  for (const auto& [name, text] : texts) families.push_back({name, text});
  const interp::Library library(std::move(families));
  return Soak({&library, TextsBelow(options.folder + "/facts")}, options);
}

}  // namespace tranos::app
