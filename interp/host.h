// SPDX-License-Identifier: GPL-3.0-or-later
// The only way outward. The app fills it in; tests give one in memory.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace tranos::camera {
struct Photo;
}
namespace tranos::model {
struct PhotoRequest;
}

namespace tranos::interp {

struct HostError {
  enum Kind { kMissing, kOutside, kProtected, kFailed } kind;
  std::string detail;  // "no such file", "a symbolic link", …
};

struct Host {
  // The bytes of a regular file below the script's folder or one allowed; never through a link.
  std::function<tl::expected<std::string, HostError>(std::string_view path)> read = nullptr;
  // Shows a line of `print` as it happens.
  std::function<void(std::string_view line)> print = nullptr;
  // A photograph of the model as a camera would take it, or why there is none. Null in a replay,
  // which needs no pixels.
  std::function<tl::expected<std::shared_ptr<const camera::Photo>, std::string>(
      const model::PhotoRequest& request)>
      render_photo = nullptr;
};

}  // namespace tranos::interp
