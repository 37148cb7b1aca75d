// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <functional>

#include "app/console.h"
#include "app/status.h"
#include "app/verbs.h"
#include "app/version.h"

namespace tranos::app {

namespace {

// "steps=1000,memory=500M": k, M and G stand for thousands, millions and thousands of millions.
std::string ReadLimits(const std::string& text, interp::Limits* limits) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, comma - at);
    at = comma + 1;
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    const std::string number = equals == std::string::npos ? "" : part.substr(equals + 1);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    std::uint64_t factor = 1;
    const std::string_view rest(end, static_cast<std::size_t>(number.data() + number.size() - end));
    if (rest == "k")
      factor = 1000;
    else if (rest == "M")
      factor = 1'000'000;
    else if (rest == "G")
      factor = 1'000'000'000;
    else if (!rest.empty())
      return "`" + number + "` is no number";
    if (error != std::errc() || value == 0 || value > UINT64_MAX / 2 / factor)
      return "`" + part + "` needs a number above zero";
    value *= factor;
    if (name == "steps")
      limits->steps = value;
    else if (name == "elements")
      limits->elements = value;
    else if (name == "memory")
      limits->memory = value;
    else if (name == "depth" && value <= 1000)
      limits->depth = static_cast<int>(value);
    else if (name == "depth")
      return "depth is at most 1000";
    else
      return "there is no limit `" + name + "`: steps, elements, memory, depth";
  }
  return "";
}

void AddScriptOptions(CLI::App* verb, ScriptOptions* options, const std::string& name) {
  verb->add_option(name, options->script, "the script")->required()->type_name("SCRIPT");
  verb->add_option_function<std::vector<std::string>>(
          "-D",
          [options](const std::vector<std::string>& given) {
            for (const std::string& text : given) {
              const std::size_t equals = text.find('=');
              if (equals == 0 || equals == std::string::npos)
                throw CLI::ValidationError("-D", "-D takes name=value");
              options->parameters.emplace_back(text.substr(0, equals), text.substr(equals + 1));
            }
          },
          "give a `parameter` of the script its value")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  verb->add_option("--hypothesis", options->hypothesis, "the alternative to run")
      ->type_name("NAME");
  verb->add_option("--allow", options->allow, "a further folder that the script may read")
      ->type_name("DIR")
      ->allow_extra_args(false);
  verb->add_option_function<std::vector<std::string>>(
          "--limit",
          [options](const std::vector<std::string>& given) {
            for (const std::string& text : given) {
              const std::string problem = ReadLimits(text, &options->limits);
              if (!problem.empty()) throw CLI::ValidationError("--limit", problem);
            }
          },
          "raise or lower a limit: steps, elements, memory, depth")
      ->type_name("NAME=N,…")
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace

int RunCommandLine(int argc, char** argv) {
  CLI::App app("Tranos: reconstructing buildings that no longer stand, by command scripts.",
               "tranos");
  app.require_subcommand(1);
  int status = kFine;

  RunVerbOptions run;
  CLI::App* verb = app.add_subcommand("run", "run a script: model, pictures, report");
  AddScriptOptions(verb, &run.script, "script");
  verb->add_option("-o,--output", run.output, "the folder to write to")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_flag("--json", run.json, "report on standard output as JSON");
  verb->add_flag("--no-output", run.no_output, "write nothing");
  verb->add_option("--journal", run.journal, "write what was done, step by step")
      ->type_name("FILE");
  verb->add_option("--threads", run.threads, "threads for pictures; as many as cores if not given")
      ->check(CLI::Range(1, 256));
  verb->callback([&] { status = RunVerb(run); });

  ScriptOptions check;
  bool check_json = false;
  verb = app.add_subcommand("check", "say what is wrong with a script without running it");
  AddScriptOptions(verb, &check, "script");
  verb->add_flag("--json", check_json, "diagnostics as JSON");
  verb->callback([&] { status = CheckVerb(check, check_json); });

  FmtOptions fmt;
  verb = app.add_subcommand("fmt", "put scripts into the one layout");
  verb->add_option("files", fmt.files, "the scripts; standard input if none")->type_name("SCRIPT…");
  verb->add_flag("--check", fmt.check, "tell which would change, and change nothing");
  verb->callback([&] { status = FmtVerb(fmt); });

  std::vector<std::string> help;
  verb = app.add_subcommand("help", "what the tables know of a command, function or setting");
  verb->add_option("words", help, "its words: `tranos help place arc`");
  verb->callback([&] { status = HelpVerb(help); });

  std::string code;
  verb = app.add_subcommand("explain", "tell more of a diagnostic");
  verb->add_option("code", code, "its code, such as E0203")->required();
  verb->callback([&] { status = ExplainVerb(code); });

  ScriptOptions inspect;
  verb = app.add_subcommand("inspect", "run a script and list what it made");
  AddScriptOptions(verb, &inspect, "script");
  verb->callback([&] { status = InspectVerb(inspect); });

  ReplayOptions replay;
  verb = app.add_subcommand("replay", "run a journal again and say where it differs");
  verb->add_option("journal", replay.journal, "the journal")->required()->type_name("JOURNAL");
  verb->callback([&] { status = ReplayVerb(replay); });

  DiffOptions diff;
  verb = app.add_subcommand("diff", "compare two scripts or journals by their effect");
  verb->add_option("a", diff.a, "the one")->required();
  verb->add_option("b", diff.b, "the other")->required();
  verb->add_flag("--json", diff.json, "as JSON");
  verb->callback([&] { status = DiffVerb(diff); });

  DocsOptions docs;
  verb = app.add_subcommand("docs", "write the reference");
  verb->add_option("-o,--output", docs.file, "the file")->type_name("FILE")->capture_default_str();
  verb->add_flag("--check", docs.check, "only say whether it is up to date");
  verb->callback([&] { status = DocsVerb(docs); });

  verb = app.add_subcommand("version", "print the version");
  verb->callback([] { PrintOut("tranos " + std::string(kVersion) + "\n"); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code_of_library = app.exit(error);
    return code_of_library == 0 ? kFine : kCommandLineIsWrong;
  }
  return status;
}

}  // namespace tranos::app
