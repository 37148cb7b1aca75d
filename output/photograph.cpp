// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/photograph.h"

#include "output/print.h"

namespace tranos::output {

Result<camera::Photo> TakePhotograph(const model::PhotoRequest& request, int threads) {
  Result<Tones> plate = Expose(request, threads);
  if (!plate) return tl::unexpected(plate.error());
  return PrintOf(*std::move(plate), request, threads);
}

}  // namespace tranos::output
