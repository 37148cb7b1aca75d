// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/functions.h"

#include "interp/value_support.h"

namespace tranos::interp {

std::span<const Builtin> AllBuiltins() {
  static const std::vector<Builtin> all = [] {
    std::vector<Builtin> rows;
    for (const auto family :
         {MathFunctions(), VectorFunctions(), ListFunctions(), GeometryFunctions()}) {
      rows.insert(rows.end(), family.begin(), family.end());
    }
    return rows;
  }();
  return all;
}

int FindBuiltin(std::string_view name) {
  const std::span<const Builtin> all = AllBuiltins();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name() == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace tranos::interp
