// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of the program, a function each: options in, exit status out.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "interp/run.h"

namespace tranos::app {

// What a script is run with, whatever verb runs it.
struct ScriptOptions {
  std::string script;
  std::vector<std::pair<std::string, std::string>> parameters;  // -D
  std::string hypothesis;
  interp::Limits limits;
  std::vector<std::string> allow;  // further folders that may be read
  int threads = 0;                 // of pictures; 0: as many as there are cores
};

struct RunVerbOptions {
  ScriptOptions script;
  std::string output = "out";
  bool json = false;
  bool no_output = false;
  std::string journal;
};
int RunVerb(const RunVerbOptions& options);

int CheckVerb(const ScriptOptions& options, bool json);

struct FmtOptions {
  std::vector<std::string> files;  // none: standard input to standard output
  bool check = false;              // tell which would change, and change nothing
};
int FmtVerb(const FmtOptions& options);

struct TraceOptions {
  std::string photo;
  std::string output;  // the script; "": named after the photograph, beside it
};
int TraceVerb(const TraceOptions& options);

int HelpVerb(const std::vector<std::string>& words);
int LibVerb(const std::string& family);  // "" for all
int ExplainVerb(const std::string& code);
int InspectVerb(const ScriptOptions& options);

struct ReplayOptions {
  std::string journal;
};
int ReplayVerb(const ReplayOptions& options);

struct DiffOptions {
  std::string a, b;  // scripts or journals
  bool json = false;
};
int DiffVerb(const DiffOptions& options);

struct DocsOptions {
  std::string file = "docs/reference.md";
  bool check = false;  // only say whether the file is up to date
};
int DocsVerb(const DocsOptions& options);

struct GalleryOptions {
  std::string folder = "docs";
  std::vector<std::string> names;  // of the elements whose pictures are made; none: all
  bool check = false;              // only say whether all is up to date
};
int GalleryVerb(const GalleryOptions& options);

struct SoakOptions {
  std::vector<std::string> names;  // families or elements; none: all
  std::string folder;      // of the library's files; "": those that the program was built of
  int settings = 200;      // random ones of each element and detail, besides the defaults
  bool corners = true;     // and the ends of the ranges
  bool crossings = false;  // whether solids at the defaults cross themselves, which takes its time
  bool crossings_everywhere = false;  // and those at all other settings
  std::uint64_t seed = 1;
};
int SoakVerb(const SoakOptions& options);

}  // namespace tranos::app
