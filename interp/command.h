// SPDX-License-Identifier: GPL-3.0-or-later
// A command is a record: its words, keys, prompts, examples, and a pure function from the state and
// the answers to an edit. Everything that is known of a command is in its row; help, the reference,
// binding and the engine read it there.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera/framed_camera.h"
#include "interp/diagnostic.h"
#include "interp/host.h"
#include "interp/type.h"
#include "model/edit.h"
#include "model/state.h"
#include "model/value.h"

namespace tranos::interp {

// A key that a command takes besides the data points.
struct Key {
  std::string_view name;
  Type type;
  std::string_view summary;        // a phrase, with the unit where it is not the type's
  std::string_view words = {};     // of kWord: "rectangular|polar"
  std::string_view standard = {};  // its value when not given, as text for help; "" if none
  int prompt = -1;                 // the question it may answer in place of a data point
  bool required = false;
  bool list = false;  // a list of the type
};

// A question, answered by a data point.
struct Prompt {
  std::string_view name;  // "start", "next point"
};

// How a command runs (docs/language.md, "How a command runs").
enum class Manner : std::uint8_t {
  kImmediate,  // asks for no data point; fires at the separator that ends its statement
  kPlaces,   // fires at the data point that answers its last question, then asks again from `again`
  kGathers,  // gathers data points and makes one element when it ends
  kTransforms,  // as kPlaces, on `of=` or the selection
  kPicks,       // create, construct: `of=`, or the selection plus picks; asks to accept
  kEdits,       // delete, drop, modify: as kPicks, but a selection needs no accepting
  kChooses,     // choose element: fires at each data point
};

struct Example {
  std::string_view script;
  // What must hold after it: an expression of the language that is true ("last.length == 10m"),
  // or the code of the error that it must give ("E0501").
  std::string_view expect;
};

// Where in the key-ins an error of a command lies.
struct Where {
  enum Kind : std::uint8_t { kCommand, kKey, kPoint, kChosen } kind = kCommand;
  int index = 0;         // of the point or the chosen element
  std::string_view key;  // of kKey
};
struct CommandError {
  Code code;
  std::string message;
  std::string label = {};
  std::string help = {};
  Where where = {};
};
// A geom error as a command's: `what` was to be made; parts are chosen elements.
CommandError FromGeom(const geom::Error& error, std::string_view what, Where where = {});

// What was answered, converted to the types that the row states.
struct Answers {
  std::vector<geom::Vec3> points;  // in the world, in the order of the prompts
  std::vector<bool> answered;      // which prompts a data point answered (a key may stand for one)
  std::vector<model::ElementPtr> chosen;  // of=, or selection and picks; current versions
  std::vector<std::string> words;         // option words and names, as written
  std::vector<std::pair<std::string_view, model::Value>> keys;  // those given
  bool first = true;  // the first firing since the command started

  const model::Value* Find(std::string_view key) const;
  bool Has(std::string_view key) const { return Find(key) != nullptr; }
  // The key's value; lengths in metres, angles in radians. The `otherwise` where it is not given.
  double Number(std::string_view key, double otherwise = 0) const;
  bool Flag(std::string_view key, bool otherwise = false) const;
  std::string Text(std::string_view key, std::string_view otherwise = {}) const;
  std::optional<geom::Vec3> Point(std::string_view key) const;
  std::vector<geom::Vec3> Points(std::string_view key) const;
  bool HasWord(std::string_view word) const;  // case ignored
};

struct Fired {
  model::Edit edit;
  std::vector<CommandError> warnings = {};
  std::vector<std::string> messages = {};  // what `print` says
};
using CommandResult = tl::expected<Fired, CommandError>;

// What a few commands need beside the state.
struct Source;
struct PhotographFile {
  model::Hash128 content = {};
  Eigen::Vector2i size_px{0, 0};  // zero if no photograph was read from it
  std::shared_ptr<const camera::PhotoFile> picture = nullptr;  // null where no pixels are at hand
  std::optional<camera::FramedCamera> camera = {};             // if one was read from it
};
// An edge that was found on a photograph: its ends, and as how many pixels it counts.
struct FoundEdge {
  std::array<geom::Vec2, 2> ends_px;
  double samples;
};
// What has been read of photographs, or was known beforehand.
struct PhotographFiles {
  std::map<std::string, PhotographFile> by_path;
  std::map<model::Hash128, PhotographFile> taken;       // by `render photo`, by content
  std::map<std::string, std::vector<FoundEdge>> edges;  // by EdgesKey
};
// Of the edges that are found on a photograph where dots deviate by this (0: not stated).
std::string EdgesKey(const model::Detection& detection, double noise_px);
struct Surroundings {
  const Host& host;                    // to read a photograph
  const std::vector<Source>& sources;  // of deviations
  PhotographFiles& photographs;
  const std::function<void(std::uint64_t steps)>& charge;  // against the limit of steps
};

// undo, redo and mark work on the run's history, not on one state.
enum class HistoryStep : std::uint8_t { kNone, kUndo, kRedo, kMark };

struct Command {
  std::string_view words;    // "place line"
  std::string_view family;   // "place": the heading in the reference
  std::string_view summary;  // one sentence
  Manner manner = Manner::kImmediate;
  std::span<const Prompt> prompts = {};
  int again = 0;         // the question asked again after a firing
  bool carries = false;  // the last answer becomes the first question's answer when asking again
  int least = 1;         // gathered points, picked or chosen elements needed to fire
  int most = 1'000'000;  // a picking command fires by itself at this many; gathering: a limit
  std::span<const Key> keys = {};
  std::string_view options = {};     // "wireframe|hidden|phong|antialias": its option words
  std::string_view asks = {};        // a name it asks for in bare words: "level"
  std::string_view string_key = {};  // the key that a bare string stands for: "file"
  std::span<const Example> examples = {};
  CommandResult (*execute)(const model::State&, const Answers&) = nullptr;
  HistoryStep history = HistoryStep::kNone;
  // In place of `execute`, where a command needs more than the state.
  CommandResult (*execute_with)(const model::State&, const Answers&, const Surroundings&) = nullptr;
  bool dots = false;        // its data points are dots of the photograph
  bool calibrates = false;  // solves for the unknowns before it; stands once, at the top
  bool informs = false;     // says what `calibrate` goes by: after it, it is warned of

  // Whether this version carries it out; else it gives E0001.
  bool exists() const {
    return execute || execute_with || calibrates || history != HistoryStep::kNone;
  }
};

// Every command there is, those of later versions included, grouped by family.
std::span<const Command> AllCommands();
// The row with exactly these words, in lower case; null if there is none.
const Command* FindCommand(std::string_view words);
bool HasWord(std::string_view list, std::string_view word);  // in "a|b|c", case ignored
std::vector<std::string> SplitWords(std::string_view list);

// Helpers that the families share.
// The new element with the settings now in force.
model::ElementPtr NewElement(const model::State& state, model::Geometry geometry);
model::Geometry CurveGeometry(geom::Curve curve);
model::Geometry SurfaceGeometry(geom::Surface surface);

}  // namespace tranos::interp
