// SPDX-License-Identifier: GPL-3.0-or-later
// The standard library's files, as they were when the program was built.
#pragma once

#include <span>
#include <string_view>

namespace tranos::stdlib {

struct Text {
  std::string_view name;  // of the file, without its folder and `.trn`
  std::string_view text;
};

// The families, by name: definitions in the language.
std::span<const Text> Families();
// What is true of each element whatever its parameters: a script named after its words.
std::span<const Text> Facts();

}  // namespace tranos::stdlib
