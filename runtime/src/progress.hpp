// SPDX-License-Identifier: BSD-3-Clause
//
// Progress of operations that have several passes after each other.
#pragma once

#include "tegl/error.hpp"

namespace tegl::detail {

/// Tells `progress`; throws Cancelled, with this message, where it says stop.
inline void tell(const Progress& progress, double fraction,
                 const char* message = "cancelled by the progress callback") {
  if (progress && !progress(fraction)) throw Error(ErrorCode::Cancelled, message);
}

/// The progress of a pass that takes the whole from `first` to `last`. The whole's must outlive it.
inline Progress part_of(const Progress& progress, double first, double last) {
  if (!progress) return {};
  return [&progress, first, last](double fraction) { return progress(first + (last - first) * fraction); };
}

}  // namespace tegl::detail
