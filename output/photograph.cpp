// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/photograph.h"

#include "output/print.h"

namespace tranos::output {

Result<camera::Photo> TakePhotograph(const model::PhotoRequest& request, int threads) {
  Result<Exposure> exposure = Expose(request, threads);
  if (!exposure) return tl::unexpected(exposure.error());
  return PrintOf(*std::move(exposure), request, threads);
}

}  // namespace tranos::output
