// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tranos::app {

// The text broken into lines that begin at a column; the first goes on from `head`.
std::string Wrap(std::string head, std::size_t indent, std::string_view text);

}  // namespace tranos::app
