// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of images that are stored as complexes (lattices and divisions), at several isovalues.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "base/progress.hpp"
#include "facets/complex_facets.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl::detail {

/// Options of the i-th of `count` equal parts of a call, for its progress.
inline ExtractOptions options_of_part(const ExtractOptions& options, std::size_t i, std::size_t count) {
  const auto share = [&](std::size_t done) { return static_cast<double>(done) / static_cast<double>(count); };
  ExtractOptions part = options;
  part.work.progress = part_of(options.work.progress, share(i), share(i + 1));
  return part;
}

/// Passes the facets of a stored complex, with the names and units of the image's axes, to use(i, facets).
template <class Real, int N, class Stored, class Use>
void pass_facets(const Grid<N>& grid, const Stored& stored, std::span<const double> isovalues,
                 const ExtractOptions& options, const Use& use) {
  for (std::size_t i = 0; i < isovalues.size(); ++i) {
    auto facets = facets_in<Real, N>(stored.complex(), isovalues[i], options_of_part(options, i, isovalues.size()),
                                     stored.surroundings());
    for (std::size_t a = 0; a < N; ++a) {
      facets.axis_names[a] = grid.axes[a].name;
      facets.axis_units[a] = grid.axes[a].unit;
    }
    use(i, std::move(facets));
  }
}

/// The facets that `pass(use)` passes for one isovalue.
template <int N, class Real, class Pass>
FacetHierarchy<N, Real> facets_of_one(const Pass& pass) {
  FacetHierarchy<N, Real> result;
  pass(FacetSink<N, Real>([&](std::size_t, FacetHierarchy<N, Real> facets) { result = std::move(facets); }));
  return result;
}

}  // namespace tegl::detail
