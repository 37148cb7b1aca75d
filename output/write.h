// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "model/edit.h"
#include "output/result.h"

namespace tranos::output {

// The bytes of an export, in the format that the file name's extension stands for; an error that
// lists the extensions there are for any other.
Result<std::string> ExportOf(const model::ExportRequest& request, int threads);

// The bytes of a picture, likewise; a request without a file name gives a PNG.
Result<std::string> PictureFileOf(const model::RenderRequest& request, int threads);

}  // namespace tranos::output
