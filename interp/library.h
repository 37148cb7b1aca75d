// SPDX-License-Identifier: GPL-3.0-or-later
// The definitions that every script reaches by their words, without a `use`.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tranos::interp {

// A file of definitions; `text` outlives the library.
struct LibraryFamily {
  std::string name;  // "domes"
  std::string_view text;
  std::string path() const { return "stdlib/" + name + ".trn"; }
};

// Which family defines what, found by looking at the lines that begin with `define`: a family is
// parsed and bound only when a script reaches it.
class Library {
 public:
  explicit Library(std::vector<LibraryFamily> families);
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  const std::vector<LibraryFamily>& families() const { return families_; }
  // The family of this name, or the one that defines these words ("place dome onion", lower case);
  // null if there is none.
  const LibraryFamily* Named(std::string_view name) const;
  const LibraryFamily* Defining(std::string_view words) const;
  // Of every element, in alphabetical order.
  std::vector<std::string> Words() const;

 private:
  std::vector<LibraryFamily> families_;
  std::map<std::string, const LibraryFamily*, std::less<>> by_words_;
};

// The library that is part of this program.
const Library& StandardLibrary();

}  // namespace tranos::interp
