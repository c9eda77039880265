// SPDX-License-Identifier: BSD-3-Clause
//
// What the measuring programs share: options by thread count, and sizes of results.
#pragma once

#include <cstdint>
#include <string>

#include "tegl/error.hpp"
#include "tegl/extract.hpp"

namespace tegl::bench {

/// Whether the library has an option for the number of threads.
template <class Options>
concept Threaded = requires(Options options) {
  options.threads = 1;
};
inline constexpr bool kHasThreads = Threaded<ExtractOptions>;

/// The options with a number of threads. Throws InvalidArgument for more than one where the library has no threads.
template <class Options = ExtractOptions>
Options with_threads(Options options, int threads) {
  if constexpr (Threaded<Options>)
    options.threads = threads;
  else if (threads != 1)
    throw Error(ErrorCode::InvalidArgument, std::to_string(threads) + " threads; the library has one");
  return options;
}

/// Bytes of a contour's vertices and simplices.
template <int N, class Real>
std::uint64_t contour_bytes(const Contour<N, Real>& contour) {
  return contour.vertices.size() * sizeof(typename Contour<N, Real>::Vertex) +
         contour.simplices.size() * sizeof(typename Contour<N, Real>::Simplex);
}

}  // namespace tegl::bench
