// SPDX-License-Identifier: GPL-3.0-or-later
// The standard library, told on a terminal.
#pragma once

#include <string>

namespace tranos::app {

// Every element of a family with its sentence, a line each that could be keyed in; of all families,
// each under its name, where `family` is "". "" if there is no such family.
std::string ElementList(const std::string& family);
// All that is known of an element; "" if the library has none of these words.
std::string HelpOfElement(const std::string& words);
// The elements whose words begin so, and those that speak of a word; "" if there are none.
std::string ElementsFrom(const std::string& beginning);
std::string ElementsAbout(const std::string& word);

}  // namespace tranos::app
