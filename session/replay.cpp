// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/replay.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "session/replay_difference.h"

namespace tranos::session {

namespace {

using interp::Code;

std::string_view TakeLine(std::string_view* text) {
  const std::size_t end = text->find('\n');
  const std::string_view line = text->substr(0, end);
  text->remove_prefix(end == std::string_view::npos ? text->size() : end + 1);
  return line;
}

std::string Number(double value) { return nlohmann::json(value).dump(); }

// Holds the lines of a replay against those recorded, as they come.
class Comparer {
 public:
  Comparer(std::string_view recorded, ReplayReport* report)
      : recorded_(recorded), report_(report) {}

  // Whole lines.
  void Take(std::string_view found) {
    while (!found.empty() && !stopped_) {
      // What is equal as bytes, which is nearly always all of it, is not even cut into lines.
      if (recorded_.starts_with(found)) {
        line_ += static_cast<std::uint64_t>(std::count(found.begin(), found.end(), '\n'));
        recorded_.remove_prefix(found.size());
        return;
      }
      TakeOne(TakeLine(&found));
    }
  }
  void Finish() {
    if (stopped_) return;
    if (!recorded_.empty())
      Stop(ReplayReport::kDiffers, Code::kReplayDiffers,
           "the replay ends here, and the journal goes on", {});
    if (!stopped_) report_->steps = line_ - 3;  // all lines but the first and the last
  }

 private:
  void TakeOne(std::string_view found) {
    const std::string_view recorded = TakeLine(&recorded_);
    if (recorded == found) {
      ++line_;
      return;
    }
    LineDifference difference = CompareLines(recorded, found);
    if (difference.malformed) {
      return Stop(ReplayReport::kBroken, Code::kBrokenJournal, "the line is not a step", {});
    }
    if (!difference.differing.empty()) return StopDiffering(found, std::move(difference.differing));
    const bool explained =
        difference.close > 0 || report_->verdict == ReplayReport::kWithinTolerance;
    if (!explained) {
      std::vector<std::string> details;
      for (const std::string& hash : difference.hashes)
        details.push_back(hash + ": the hash differs, and nothing that is recorded explains it");
      return StopDiffering(found, std::move(details));
    }
    if (report_->verdict == ReplayReport::kEqual) NoteClose(difference);
    ++line_;
  }
  void NoteClose(const LineDifference& difference) {
    report_->verdict = ReplayReport::kWithinTolerance;
    report_->findings.push_back({Code::kWithinTolerance, line_,
                                 "equal within tolerance from here on: numbers differ by at most " +
                                     Number(difference.largest_close) + " in this step"});
  }
  void StopDiffering(std::string_view found, std::vector<std::string> details) {
    const auto step = nlohmann::json::parse(found.begin(), found.end(), nullptr, false);
    std::string where = "the end of the run differs";
    if (step.is_object() && step.contains("n")) {
      const std::string key_in = step.value("key_in", "");
      where = "step " + step["n"].dump() + " differs" + (key_in.empty() ? "" : ": " + key_in);
      details.push_back("it stands at line " + step["line"].dump() + ", column " +
                        step["column"].dump() + " of source " + step["file"].dump());
    }
    Stop(ReplayReport::kDiffers, Code::kReplayDiffers, std::move(where), std::move(details));
  }
  void Stop(ReplayReport::Verdict verdict, Code code, std::string message,
            std::vector<std::string> details) {
    stopped_ = true;
    report_->verdict = verdict;
    report_->steps = line_ - 2;
    report_->findings.push_back({code, line_, std::move(message), std::move(details)});
  }

  std::string_view recorded_;
  ReplayReport* report_;
  std::uint64_t line_ = 2;
  bool stopped_ = false;
};

}  // namespace

ReplayReport Replay(const Journal& journal) {
  ReplayReport report;
  Comparer comparer(journal.steps, &report);
  bool in_header = true;
  JournalWriter writer(journal.settings, journal.program, [&](std::string_view found) {
    if (in_header) TakeLine(&found);  // what the replay was started from
    in_header = false;
    comparer.Take(found);
  });
  const interp::ScriptResult result =
      RunJournal(journal, [&](const interp::Step& step) { writer.Add(step); }, {});
  writer.Finish(result);
  comparer.Finish();
  return report;
}

}  // namespace tranos::session
