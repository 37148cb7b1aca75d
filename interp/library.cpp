// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/library.h"

#include <utility>

#include "stdlib/texts.h"

namespace tranos::interp {

namespace {

constexpr std::string_view kDefine = "define ";

// The words of each line that begins with `define`. A string or comment that looks so costs a
// family parsed in vain: what counts is what its binding finds.
template <class F>
void ForEachDefinition(std::string_view text, F&& tell) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (!line.starts_with(kDefine)) continue;
    line.remove_prefix(kDefine.size());
    // A parameter on the same line has its name before the colon.
    const std::size_t stop = line.find_first_of("{\":#");
    std::size_t last = line.find_last_not_of(" \r", stop == line.npos ? stop : stop - 1);
    if (stop != line.npos && line[stop] == ':')
      last = line.find_last_not_of(' ', line.find_last_of(' ', last));
    tell(line.substr(0, last + 1));
  }
}

}  // namespace

Library::Library(std::vector<LibraryFamily> families) : families_(std::move(families)) {
  for (const LibraryFamily& family : families_) {
    ForEachDefinition(family.text, [&](std::string_view words) {
      by_words_.emplace(std::string(words), &family);
    });
  }
}

const LibraryFamily* Library::Named(std::string_view name) const {
  for (const LibraryFamily& family : families_) {
    if (family.name == name) return &family;
  }
  return nullptr;
}

const LibraryFamily* Library::Defining(std::string_view words) const {
  const auto found = by_words_.find(words);
  return found == by_words_.end() ? nullptr : found->second;
}

std::vector<std::string> Library::Words() const {
  std::vector<std::string> words;
  for (const auto& [each, family] : by_words_) words.push_back(each);
  return words;
}

const Library& StandardLibrary() {
  static const Library kLibrary = [] {
    std::vector<LibraryFamily> families;
    for (const stdlib::Text& text : stdlib::Families())
      families.push_back({std::string(text.name), text.text});
    return Library(std::move(families));
  }();
  return kLibrary;
}

}  // namespace tranos::interp
