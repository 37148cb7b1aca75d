// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "model/element.h"

namespace tranos::output {

// Why an output could not be made, as a sentence without its full stop, and the element at fault
// (kNoElement: none in particular).
struct Error {
  std::string message;
  model::ElementId element = model::kNoElement;
};
template <class T>
using Result = tl::expected<T, Error>;

}  // namespace tranos::output
