// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of images on lattices: those of the lattice's cells, instantiated for all value types.
#include "facets/facets_of_stored.hpp"
#include "lattice/stored_lattice.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4>
void extract_facets_several(const Image<T, N>& image, Lattice lattice, std::span<const double> isovalues,
                            const std::type_identity_t<FacetSink<N, Real>>& use, const ExtractOptions& options,
                            const AxisPeriods<N>& periods) {
  const Grid<N>& grid = image.grid();
  for (const double isovalue : isovalues) detail::check_lattice_arguments<N>(grid, lattice, isovalue, options, periods);
  if (isovalues.empty()) return;
  const detail::StoredLattice<T, N> stored(image, lattice, isovalues[0], options, periods);
  detail::pass_facets<Real>(grid, stored, isovalues, options, use);
}

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> FacetHierarchy<N, Real> extract_facets(const Image<T, N>& image, Lattice lattice,
                                                                          double isovalue,
                                                                          const ExtractOptions& options,
                                                                          const AxisPeriods<N>& periods) {
  return detail::facets_of_one<N, Real>([&](const auto& use) {
    extract_facets_several<Real>(image, lattice, std::array{isovalue}, use, options, periods);
  });
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                                   \
  template FacetHierarchy<N, Real> extract_facets<Real, T, N>(const Image<T, N>&, Lattice, double,           \
                                                              const ExtractOptions&, const AxisPeriods<N>&); \
  template void extract_facets_several<Real, T, N>(const Image<T, N>&, Lattice, std::span<const double>,     \
                                                   const FacetSink<N, Real>&, const ExtractOptions&,         \
                                                   const AxisPeriods<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
