// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/language/golden.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "interp/format.h"

namespace tranos::language {

namespace {

std::string ReadBytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// "-D height=14m --hypothesis late --limit steps=100"
void ReadOptions(const std::string& options, Golden* golden) {
  std::istringstream in(options);
  for (std::string option, value; in >> option >> value;) {
    const std::size_t equals = value.find('=');
    const std::string name = value.substr(0, equals);
    if (option == "--hypothesis") {
      golden->bind.hypothesis = value;
    } else if (option == "-D" && equals != std::string::npos) {
      golden->bind.parameters.emplace_back(name, value.substr(equals + 1));
    } else if (option == "--limit" && equals != std::string::npos) {
      const std::uint64_t number = std::stoull(value.substr(equals + 1));
      if (name == "steps") golden->limits.steps = number;
      if (name == "elements") golden->limits.elements = number;
      if (name == "memory") golden->limits.memory = number;
      if (name == "depth") golden->limits.depth = static_cast<int>(number);
      golden->bind.depth = golden->limits.depth;
    } else {
      golden->mistakes.push_back("an unknown option: " + option + " " + value);
    }
  }
}

// What one comment expects; `about` is the line that it speaks of.
void ReadExpectation(const std::string& comment, std::uint32_t about, Golden* golden) {
  static const std::regex kDiagnostic(
      R"((?:error|warning) ([EW][0-9]{4})(?: in (line|\S.*?)[: ]([0-9]+))?(?:: (.*))?)");
  std::smatch match;
  if (comment.rfind("expect: ", 0) == 0) {
    golden->prints.push_back(comment.substr(8));
  } else if (comment == "expect failed") {
    golden->failed.push_back(about);
  } else if (comment.rfind("expect undeclared ", 0) == 0) {
    golden->undeclared.push_back(comment.substr(18));
  } else if (comment.rfind("run: ", 0) == 0) {
    ReadOptions(comment.substr(5), golden);
  } else if (comment.rfind("expect ", 0) == 0) {
    const std::string rest = comment.substr(7);
    if (!std::regex_match(rest, match, kDiagnostic)) {
      golden->mistakes.push_back("an expectation that says nothing: " + comment);
      return;
    }
    const bool elsewhere = match[2].matched;
    golden->diagnostics.push_back(
        {match[1], match[4], elsewhere && match[2] != "line" ? match[2].str() : "",
         elsewhere ? static_cast<std::uint32_t>(std::stoul(match[3])) : about});
  }
}

void ReadExpectations(Golden* golden) {
  static const std::regex kComment(R"(# ((?:expect|run:).*?)(?=$| # expect))");
  const std::vector<std::string> lines = Lines(golden->text);
  // A comment in a line of its own speaks of the next line that holds something else.
  std::vector<std::string> waiting;
  const auto speak = [&](std::uint32_t about) {
    for (const std::string& comment : waiting) ReadExpectation(comment, about, golden);
    waiting.clear();
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const auto number = static_cast<std::uint32_t>(i + 1);
    const std::size_t first = line.find_first_not_of(' ');
    const bool alone = first != std::string::npos && line[first] == '#';
    if (!alone && !waiting.empty()) speak(number);
    for (std::sregex_iterator at(line.begin(), line.end(), kComment), end; at != end; ++at) {
      if (alone) {
        waiting.push_back((*at)[1]);
      } else {
        ReadExpectation((*at)[1], number, golden);
      }
    }
  }
  speak(static_cast<std::uint32_t>(lines.size()));
}

std::string FolderOf(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

interp::Host HostFor(const Golden& golden, std::vector<std::string>* told) {
  const std::string folder = FolderOf(golden.path);
  interp::Host host;
  host.read = [folder](std::string_view asked) -> tl::expected<std::string, interp::HostError> {
    const std::string path(asked);
    if (path.empty() || path[0] == '/' || path.find("..") != std::string::npos) {
      return tl::make_unexpected(
          interp::HostError{interp::HostError::kOutside, "outside the script's folder"});
    }
    if (!std::filesystem::is_regular_file(folder + path)) {
      return tl::make_unexpected(interp::HostError{interp::HostError::kMissing, "no such file"});
    }
    return ReadBytes(folder + path);
  };
  host.print = [told](std::string_view line) { told->push_back("print: " + std::string(line)); };
  return host;
}

std::string Told(const std::string& file, std::uint32_t line, const std::string& what) {
  return (file.empty() ? "" : file + " ") + "line " + std::to_string(line) + ": " + what;
}

// The place of a span: in the golden itself the file is not named.
std::string Place(const interp::Sources& sources, const interp::Span& span,
                  const std::string& what) {
  const interp::SourceText& source = sources.files[span.file];
  return Told(span.file == 0 ? "" : source.path, source.PlaceOf(span.begin).line, what);
}

std::string Kind(const std::string& code) {
  return std::string(code[0] == 'E' ? "error " : "warning ") + code;
}

// The expected fragment that a diagnostic's text holds, for the told line; "" if none does.
std::string FragmentOf(const Golden& golden, const interp::Diagnostic& diagnostic,
                       const std::string& place) {
  for (const Expected& expected : golden.diagnostics) {
    if (expected.fragment.empty()) continue;
    if (Told(expected.file, expected.line, Kind(expected.code)) != place) continue;
    for (const std::string* text : {&diagnostic.message, &diagnostic.label, &diagnostic.help}) {
      if (text->find(expected.fragment) != std::string::npos) return ": " + expected.fragment;
    }
  }
  return "";
}

std::vector<std::string> Wanted(const Golden& golden) {
  std::vector<std::string> wanted;
  for (const Expected& expected : golden.diagnostics) {
    std::string line = Told(expected.file, expected.line, Kind(expected.code));
    if (!expected.fragment.empty()) line += ": " + expected.fragment;
    wanted.push_back(std::move(line));
  }
  for (const std::uint32_t line : golden.failed) wanted.push_back(Told("", line, "failed"));
  for (const std::string& name : golden.undeclared) wanted.push_back("undeclared " + name);
  for (const std::string& line : golden.prints) wanted.push_back("print: " + line);
  return wanted;
}

// Prints keep their order; everything else is compared as a set with repetition.
std::string Compare(std::vector<std::string> wanted, std::vector<std::string> told) {
  const auto is_print = [](const std::string& line) { return line.rfind("print: ", 0) == 0; };
  for (auto* list : {&wanted, &told}) {
    std::stable_sort(list->begin(), list->end(), [&](const auto& a, const auto& b) {
      if (is_print(a) != is_print(b)) return is_print(b);
      return !is_print(a) && a < b;
    });
  }
  if (wanted == told) return "";
  std::string out = "expected:\n";
  for (const std::string& line : wanted) out += "  " + line + "\n";
  out += "but it told:\n";
  for (const std::string& line : told) out += "  " + line + "\n";
  return out;
}

}  // namespace

bool Golden::expects_error() const {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Expected& expected) { return expected.code[0] == 'E'; }) ||
         !undeclared.empty();
}

std::vector<std::string> GoldensIn(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    // Folders named "beside" hold the files that goldens use.
    const std::string path = entry.path().lexically_normal().string();
    if (entry.path().extension() != ".trn" || path.find("beside/") != std::string::npos) continue;
    paths.push_back(path);
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

Golden ReadGolden(const std::string& path) {
  Golden golden;
  golden.path = path;
  golden.text = ReadBytes(path);
  ReadExpectations(&golden);
  const std::string stem = std::filesystem::path(path).stem().string();
  if (golden.expects_error() != (stem.rfind("fail_", 0) == 0)) {
    golden.mistakes.push_back("a name begins with fail_ if and only if an error is expected");
  }
  return golden;
}

Result RunText(const Golden& golden, const std::string& text) {
  Result result;
  const interp::ScriptResult run =
      interp::RunScript(std::filesystem::path(golden.path).filename().string(), text, golden.bind,
                        {golden.limits, {}}, HostFor(golden, &result.told));
  for (const interp::Diagnostic& diagnostic : run.diagnostics.list()) {
    const std::string code(interp::InfoOf(diagnostic.code).code);
    const std::string place = Place(*run.sources, diagnostic.span, Kind(code));
    result.told.push_back(place + FragmentOf(golden, diagnostic, place));
    result.rendered += interp::RenderText(diagnostic, *run.sources, false);
  }
  for (const interp::AssertResult& assertion : run.outcome.asserts) {
    if (assertion.passed) continue;
    const std::string place = Place(*run.sources, assertion.span, "failed");
    result.told.push_back(place);
    result.rendered += place + ": " + assertion.text + " is " + assertion.value + ", expected " +
                       assertion.expected + "\n";
  }
  for (const std::string& name : run.undeclared) result.told.push_back("undeclared " + name);
  result.has_errors = run.diagnostics.has_errors() || !run.undeclared.empty();
  result.hash = model::HashOf(run.outcome.state);
  return result;
}

std::string Difference(const Golden& golden) {
  std::string out;
  for (const std::string& mistake : golden.mistakes) out += mistake + "\n";
  const Result result = RunText(golden, golden.text);
  const std::string difference = Compare(Wanted(golden), result.told);
  if (!difference.empty()) out += difference + result.rendered;
  return out;
}

namespace {

std::string FormatText(const std::string& text, std::string* problem) {
  interp::Sources sources;
  sources.files.push_back(interp::MakeSource("formatted.trn", text));
  interp::Diagnostics diagnostics;
  const interp::SyntaxTree tree = interp::Parse(sources, 0, {}, &diagnostics);
  if (diagnostics.has_errors()) {
    *problem =
        "it does not parse:\n" + interp::RenderText(diagnostics.list()[0], sources, false) + text;
    return text;
  }
  return interp::Format(sources.files[0], tree);
}

}  // namespace

std::string FormattedDifference(const Golden& golden) {
  const Result before = RunText(golden, golden.text);
  if (before.has_errors) return "it has errors";
  std::string problem;
  const std::string formatted = FormatText(golden.text, &problem);
  const std::string again = problem.empty() ? FormatText(formatted, &problem) : formatted;
  if (!problem.empty()) return problem;
  if (again != formatted) return "formatted once:\n" + formatted + "twice:\n" + again;
  const Result after = RunText(golden, formatted);
  const auto prints = [](const Result& result) {
    std::vector<std::string> out;
    for (const std::string& line : result.told) {
      if (line.rfind("print: ", 0) == 0) out.push_back(line);
    }
    return out;
  };
  if (after.has_errors) return "formatted, it has errors:\n" + after.rendered + formatted;
  if (after.hash != before.hash) return "formatted, it makes another model:\n" + formatted;
  if (prints(after) != prints(before)) return "formatted, it prints something else:\n" + formatted;
  return "";
}

}  // namespace tranos::language
