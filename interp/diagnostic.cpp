// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/diagnostic.h"

#include <utf8proc.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>

namespace tranos::interp {
namespace {

constexpr std::size_t kMostErrors = 100;
constexpr std::size_t kMostWarnings = 100;

constexpr CodeInfo kInfos[] = {
#define TRANOS_DIAGNOSTIC(code, name, severity, title, explanation) \
  {code, #name, Severity::severity, title, explanation},
#include "interp/diagnostics.def"
#undef TRANOS_DIAGNOSTIC
};

char LowerAscii(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::u32string FoldedCodePoints(std::string_view text) {
  std::u32string out;
  for (std::size_t at = 0; at < text.size();) {
    std::int32_t code_point = 0;
    const auto length =
        utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text.data()) + at,
                         static_cast<utf8proc_ssize_t>(text.size() - at), &code_point);
    if (length <= 0) {
      out += static_cast<unsigned char>(text[at++]);
      continue;
    }
    out += static_cast<char32_t>(utf8proc_tolower(code_point));
    at += static_cast<std::size_t>(length);
  }
  return out;
}

// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`.
std::size_t EditDistance(const std::u32string& a, const std::u32string& b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t other = a[i - 1] == b[j - 1] ? 0 : 1;
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, previous[j - 1] + other});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before[j - 2] + 1);
      }
    }
    before.swap(previous);
    previous.swap(current);
  }
  return previous[b.size()];
}

// How many mistakes a word of this length may hold and still be recognised.
std::size_t MostMistakes(std::size_t length) {
  if (length < 2) return 0;
  return length < 6 ? 1 : length < 9 ? 2 : 3;
}

}  // namespace

const CodeInfo& InfoOf(Code code) { return kInfos[static_cast<std::size_t>(code)]; }

std::optional<Code> FindCode(std::string_view code) {
  for (std::size_t i = 0; i < std::size(kInfos); ++i) {
    const std::string_view candidate = kInfos[i].code;
    const auto same = [](char a, char b) { return LowerAscii(a) == LowerAscii(b); };
    if (std::equal(code.begin(), code.end(), candidate.begin(), candidate.end(), same)) {
      return static_cast<Code>(i);
    }
  }
  return std::nullopt;
}

const std::vector<Code>& AllCodes() {
  static const std::vector<Code> codes = [] {
    std::vector<Code> all;
    for (std::size_t i = 0; i < std::size(kInfos); ++i) all.push_back(static_cast<Code>(i));
    return all;
  }();
  return codes;
}

void Diagnostics::Add(Diagnostic diagnostic) {
  const bool is_error = diagnostic.severity() == Severity::kError;
  std::size_t& count = is_error ? error_count_ : warning_count_;
  if (++count <= (is_error ? kMostErrors : kMostWarnings)) list_.push_back(std::move(diagnostic));
}

void Diagnostics::Append(const Diagnostics& other) {
  const std::size_t errors = error_count_ + other.error_count_;
  const std::size_t warnings = warning_count_ + other.warning_count_;
  for (const Diagnostic& diagnostic : other.list_) Add(diagnostic);
  error_count_ = errors;
  warning_count_ = warnings;
}

void Diagnostics::SortByPlace() {
  std::stable_sort(list_.begin(), list_.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.span.file, a.span.begin) < std::tie(b.span.file, b.span.begin);
  });
}

std::optional<std::string> DidYouMean(std::string_view word,
                                      const std::vector<std::string>& candidates) {
  const std::u32string wanted = FoldedCodePoints(word);
  const std::size_t most = MostMistakes(wanted.size());
  std::optional<std::string> best;
  std::size_t best_distance = most + 1;
  for (const std::string& candidate : candidates) {
    if (candidate == word) continue;
    const std::u32string folded = FoldedCodePoints(candidate);
    const std::size_t longer = std::max(folded.size(), wanted.size());
    if (longer - std::min(folded.size(), wanted.size()) > most) continue;
    const std::size_t distance = EditDistance(wanted, folded);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = candidate;
  }
  return best;
}

}  // namespace tranos::interp
