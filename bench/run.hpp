// SPDX-License-Identifier: BSD-3-Clause
//
// Helpers of the benchmark programs: options by thread count, and sizes of results.
#pragma once

#include <cstdint>
#include <string>

#include "tegl/error.hpp"
#include "tegl/extract.hpp"

namespace tegl::bench {

/// The library has an option for the number of threads.
template <class Options>
concept Threaded = requires(Options options) {
  options.work.threads = 1;
};
inline constexpr bool kHasThreads = Threaded<ExtractOptions>;

/// The library has an option for normals at vertices.
template <class Options>
concept WithNormals = requires(Options options) {
  options.normals = tegl::Normals::differences;
};
inline constexpr bool kHasNormals = WithNormals<ExtractOptions>;

/// The options with or without normals. Throws InvalidArgument if the library has none.
template <class Options = ExtractOptions>
Options with_normals(Options options, bool normals) {
  if constexpr (WithNormals<Options>)
    options.normals = normals ? tegl::Normals::differences : tegl::Normals::none;
  else if (normals)
    throw Error(ErrorCode::InvalidArgument, "the library has no normals");
  return options;
}

/// The options with a number of threads. Throws InvalidArgument for more than one if the library has no threads.
template <class Options = ExtractOptions>
Options with_threads(Options options, int threads) {
  if constexpr (Threaded<Options>)
    options.work.threads = static_cast<decltype(options.work.threads)>(threads);
  else if (threads != 1)
    throw Error(ErrorCode::InvalidArgument, std::to_string(threads) + " threads; the library has one");
  return options;
}

/// Total bytes of a contour's vertices, normals and simplices.
template <int N, class Real>
std::uint64_t contour_bytes(const Contour<N, Real>& contour) {
  std::uint64_t normals = 0;
  if constexpr (requires { contour.normals.size(); })
    normals = contour.normals.size() * sizeof(typename Contour<N, Real>::Vertex);
  return normals + contour.vertices.size() * sizeof(typename Contour<N, Real>::Vertex) +
         contour.simplices.size() * sizeof(typename Contour<N, Real>::Simplex);
}

}  // namespace tegl::bench
