// SPDX-License-Identifier: BSD-3-Clause
//
// Helpers of the benchmark programs: options by thread count, and sizes of results.
#pragma once

#include <cstdint>
#include <string>

#include "tegl/error.hpp"
#include "tegl/extract.hpp"

namespace tegl::bench {

/// The options with or without normals.
inline ExtractOptions with_normals(ExtractOptions options, bool normals) {
  options.normals = normals ? Normals::differences : Normals::none;
  return options;
}

/// The options with a number of threads.
inline ExtractOptions with_threads(ExtractOptions options, int threads) {
  options.work.threads = static_cast<unsigned>(threads);
  return options;
}

/// Total bytes of a contour's vertices, normals and simplices.
template <int N, class Real>
std::uint64_t contour_bytes(const Contour<N, Real>& contour) {
  return contour.normals.size() * sizeof(typename Contour<N, Real>::Vertex) +
         contour.vertices.size() * sizeof(typename Contour<N, Real>::Vertex) +
         contour.simplices.size() * sizeof(typename Contour<N, Real>::Simplex);
}

}  // namespace tegl::bench
