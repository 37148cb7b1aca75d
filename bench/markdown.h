// SPDX-License-Identifier: GPL-3.0-or-later
// Markdown tables, and documents of which a program rewrites only the parts that are its own.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tranos::bench {

using TableRow = std::vector<std::string>;
// The first row is the head; columns padded to one width.
std::string Table(const std::vector<TableRow>&);

// `text` with what is between the lines `<!-- generated: NAME -->` and `<!-- end: NAME -->`
// replaced, for each name. None if a pair of marks is missing.
std::optional<std::string> WithBlocks(std::string text,
                                      const std::map<std::string, std::string>& blocks);

}  // namespace tranos::bench
