// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>

#include "app/console.h"
#include "app/limits_option.h"
#include "app/status.h"
#include "app/verbs.h"
#include "app/version.h"

namespace tranos::app {

namespace {

constexpr const char* kExamples =
    "For a start:\n"
    "  tranos run scripts/cruciform_dome.trn     writes out/cruciform_dome.glb and a picture\n"
    "  tranos help                               lists the commands of the language\n"
    "  tranos help place arc                     tells of one of them\n"
    "  tranos explain E0203                      tells more of an error\n\n"
    "Exit status: 0 fine, 1 the script is wrong, 2 the command line is wrong, 3 a file cannot be "
    "read or\n"
    "written, 4 an assertion of the script failed, 5 a fault of ours.\n";

// A check that help does not spell out beside the option.
CLI::Validator Quiet(CLI::Validator check) { return check.description(""); }

// An option that may be given several times, each text put where it belongs by `take`, which gives
// what is wrong with it, or nothing.
void AddRepeated(CLI::App* verb, const std::string& name, const std::string& type,
                 const std::string& tells, std::function<std::string(const std::string&)> take) {
  verb->add_option_function<std::vector<std::string>>(
          name,
          [name, take = std::move(take)](const std::vector<std::string>& given) {
            for (const std::string& text : given) {
              const std::string problem = take(text);
              if (!problem.empty()) throw CLI::ValidationError(name, interp::Printable(problem));
            }
          },
          tells)
      ->type_name(type)
      ->allow_extra_args(false)
      ->take_all();
}

void AddScriptOptions(CLI::App* verb, ScriptOptions* options) {
  verb->add_option("script", options->script, "the script")->required()->type_name("SCRIPT");
  AddRepeated(verb, "-D", "NAME=VALUE", "sets a `parameter` of the script",
              [options](const std::string& text) -> std::string {
                const std::size_t equals = text.find('=');
                if (equals == 0 || equals == std::string::npos)
                  return "`" + text + "` is not NAME=VALUE";
                options->parameters.emplace_back(text.substr(0, equals), text.substr(equals + 1));
                return "";
              });
  verb->add_option("--hypothesis", options->hypothesis,
                   "the alternative to run; the first, if not given")
      ->type_name("NAME");
  verb->add_option("--allow", options->allow, "a further folder that the script may read from")
      ->type_name("DIR")
      ->check(Quiet(CLI::ExistingDirectory))
      ->allow_extra_args(false);
  AddRepeated(verb, "--limit", "NAME=N,...",
              "sets limits: steps (50M), elements (1M), memory (2G bytes), depth (200)",
              [options](const std::string& text) { return ReadLimits(text, &options->limits); });
}

// What the command line says, before it is known which verb it calls.
struct Choices {
  RunVerbOptions run;
  ScriptOptions check;
  bool check_json = false;
  FmtOptions fmt;
  TraceOptions trace;
  std::vector<std::string> help;
  std::string family;
  std::string code;
  ScriptOptions inspect;
  ReplayOptions replay;
  DiffOptions diff;
  DocsOptions docs;
  GalleryOptions gallery;
  SoakOptions soak;
};

void AddScriptVerbs(CLI::App* app, Choices* choices, int* status) {
  RunVerbOptions& run = choices->run;
  CLI::App* verb = app->add_subcommand("run", "Runs a script and writes its model and pictures.");
  AddScriptOptions(verb, &run.script);
  verb->add_option("-o,--output", run.output, "the folder to write to")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_flag("--json", run.json, "reports on standard output as JSON");
  verb->add_flag("--no-output", run.no_output, "writes no model and no pictures");
  verb->add_option("--journal", run.journal,
                   "writes what was done, step by step, for `tranos replay`")
      ->type_name("FILE");
  verb->add_option("--threads", run.script.threads,
                   "threads for pictures; as many as cores, if not given")
      ->type_name("N")
      ->check(Quiet(CLI::Range(1, 256)));
  verb->callback([&run, status] { *status = RunVerb(run); });

  verb = app->add_subcommand("check", "Says what is wrong with a script, without running it.");
  AddScriptOptions(verb, &choices->check);
  verb->add_flag("--json", choices->check_json, "diagnostics on standard output as JSON");
  verb->callback([choices, status] { *status = CheckVerb(choices->check, choices->check_json); });

  verb = app->add_subcommand("inspect", "Runs a script and lists what it made, with measures.");
  AddScriptOptions(verb, &choices->inspect);
  verb->callback([choices, status] { *status = InspectVerb(choices->inspect); });

  TraceOptions& trace = choices->trace;
  verb = app->add_subcommand("trace", "Writes a script with the edges found on a photograph.");
  verb->add_option("photo", trace.photo, "the photograph")->required()->type_name("PHOTO");
  verb->add_option("-o,--output", trace.output,
                   "the script, in the photograph's folder or one above it; beside it and named "
                   "after it, if not given")
      ->type_name("SCRIPT");
  verb->callback([&trace, status] { *status = TraceVerb(trace); });

  FmtOptions& fmt = choices->fmt;
  verb = app->add_subcommand("fmt", "Puts scripts into the one layout.");
  verb->add_option("scripts", fmt.files, "the scripts; standard input to standard output, if none")
      ->type_name("SCRIPT");
  verb->add_flag("--check", fmt.check, "only tells which would change, with status 1");
  verb->callback([&fmt, status] { *status = FmtVerb(fmt); });
}

void AddComparingVerbs(CLI::App* app, Choices* choices, int* status) {
  CLI::App* verb = app->add_subcommand("replay", "Runs a journal again and says where it differs.");
  verb->add_option("journal", choices->replay.journal, "a journal of `tranos run --journal`")
      ->required()
      ->type_name("JOURNAL");
  verb->callback([choices, status] { *status = ReplayVerb(choices->replay); });

  DiffOptions& diff = choices->diff;
  verb = app->add_subcommand("diff", "Compares two scripts or journals by their effect.");
  verb->add_option("a", diff.a, "the one")->required()->type_name("SCRIPT");
  verb->add_option("b", diff.b, "the other")->required()->type_name("SCRIPT");
  verb->add_flag("--json", diff.json, "as JSON");
  verb->callback([&diff, status] { *status = DiffVerb(diff); });
}

// For those who write the library.
void AddLibraryVerbs(CLI::App* app, Choices* choices, int* status) {
  GalleryOptions& gallery = choices->gallery;
  CLI::App* verb = app->add_subcommand("gallery", "Shows the library's elements on a page.");
  verb->add_option("names", gallery.names,
                   "whose pictures are made, such as dome_onion; all, if none")
      ->type_name("NAME");
  verb->add_option("-o,--output", gallery.folder, "the folder of gallery.md and gallery/")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_flag("--check", gallery.check, "only says whether it is up to date");
  verb->callback([&gallery, status] { *status = GalleryVerb(gallery); });

  SoakOptions& soak = choices->soak;
  verb = app->add_subcommand("soak", "Builds the library's elements all over their ranges.");
  verb->add_option("names", soak.names,
                   "families or elements, such as domes or dome_onion; all, if none")
      ->type_name("NAME");
  verb->add_option("--settings", soak.settings, "random settings of each element and detail")
      ->type_name("N")
      ->check(Quiet(CLI::Range(0, 1000000)))
      ->capture_default_str();
  verb->add_flag("!--no-corners", soak.corners, "leaves out the ends of the ranges");
  verb->add_flag("--crossings", soak.crossings,
                 "looks for solids that cross themselves, too, at the defaults");
  verb->add_flag("--crossings-everywhere", soak.crossings_everywhere,
                 "and at all other settings, which takes long");
  verb->add_option("--library", soak.folder,
                   "the library's folder, read now; as built, if not given")
      ->type_name("DIR")
      ->check(Quiet(CLI::ExistingDirectory));
  verb->add_option("--seed", soak.seed, "another seed gives other settings")
      ->type_name("N")
      ->capture_default_str();
  verb->callback([&soak, status] { *status = SoakVerb(soak); });
}

void AddTellingVerbs(CLI::App* app, Choices* choices, int* status) {
  CLI::App* verb =
      app->add_subcommand("help", "Tells of a command, function or setting of the language.");
  verb->add_option("words", choices->help,
                   "its words, as in `tranos help place arc`; none lists all")
      ->type_name("WORD");
  verb->callback([choices, status] { *status = HelpVerb(choices->help); });

  verb = app->add_subcommand("lib", "Lists the elements of the library, by family.");
  verb->add_option("family", choices->family, "one family, such as domes")->type_name("FAMILY");
  verb->callback([choices, status] { *status = LibVerb(choices->family); });

  verb = app->add_subcommand("explain", "Tells more of an error or a warning.");
  verb->add_option("code", choices->code, "its code, such as E0203")->required()->type_name("CODE");
  verb->callback([choices, status] { *status = ExplainVerb(choices->code); });

  DocsOptions& docs = choices->docs;
  verb = app->add_subcommand("docs", "Writes the reference of commands, settings and functions.");
  verb->add_option("-o,--output", docs.file, "the file")->type_name("FILE")->capture_default_str();
  verb->add_flag("--check", docs.check, "only says whether it is up to date");
  verb->callback([&docs, status] { *status = DocsVerb(docs); });

  verb = app->add_subcommand("version", "Prints the version.");
  verb->callback([status] {
    PrintOut("tranos " + std::string(kVersion) + "\n");
    *status = kFine;
  });
}

// A first word that is no verb would otherwise only be told as missing.
bool IsUnknownVerb(const CLI::App& app, const std::string& word) {
  if (word.starts_with('-')) return false;
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  if (std::find(verbs.begin(), verbs.end(), word) != verbs.end()) return false;
  const auto meant = interp::DidYouMean(word, verbs);
  PrintFailure("there is no verb `" + interp::Printable(word) + "`: " +
               (word.ends_with(".trn")
                    ? "`tranos run " + interp::Printable(word) + "` runs a script"
                : meant ? "did you mean `" + *meant + "`?"
                        : "`tranos --help` lists them"));
  return true;
}

}  // namespace

int RunCommandLine(int argc, char** argv) {
  CLI::App app(
      "Tranos reconstructs buildings that no longer stand, from scripts of drawing commands.",
      "tranos");
  app.require_subcommand(1);
  app.set_help_flag("-h,--help", "Prints this help");
  app.set_version_flag("--version", "tranos " + std::string(kVersion), "Prints the version");
  app.get_formatter()->column_width(26);
  app.get_formatter()->label("REQUIRED", "");
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return "error: " + std::string(error.what()) +
           "\n`tranos --help` and `tranos VERB --help` tell how.\n";
  });
  Choices choices;
  int status = kFine;
  AddScriptVerbs(&app, &choices, &status);
  AddComparingVerbs(&app, &choices, &status);
  AddTellingVerbs(&app, &choices, &status);
  AddLibraryVerbs(&app, &choices, &status);
  for (CLI::App* verb : app.get_subcommands({}))
    verb->group("Verbs, each with a --help of its own");
  app.footer(kExamples);
  if (argc < 2) {
    PrintError(app.help());
    return kCommandLineIsWrong;
  }
  if (IsUnknownVerb(app, argv[1])) return kCommandLineIsWrong;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code_of_library = app.exit(error);
    return code_of_library == 0 ? kFine : kCommandLineIsWrong;
  }
  return status;
}

}  // namespace tranos::app
