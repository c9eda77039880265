// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of images on lattices: those of the lattice's cells, instantiated for all value types.
#include <cstddef>

#include "facets/complex_facets.hpp"
#include "lattice/stored_lattice.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> FacetHierarchy<N, Real> extract_facets(const Image<T, N>& image, Lattice lattice,
                                                                          double isovalue,
                                                                          const ExtractOptions& options,
                                                                          const AxisPeriods<N>& periods) {
  const Grid<N>& grid = image.grid();
  detail::check_lattice_arguments<N>(grid, lattice, isovalue, options, periods);
  const detail::StoredLattice<T, N> stored(image, lattice, isovalue, options, periods);
  auto facets = detail::facets_in<Real, N>(stored.complex(), isovalue, options, stored.surroundings());
  for (std::size_t a = 0; a < N; ++a) {
    facets.axis_names[a] = grid.axes[a].name;
    facets.axis_units[a] = grid.axes[a].unit;
  }
  return facets;
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                         \
  template FacetHierarchy<N, Real> extract_facets<Real, T, N>(const Image<T, N>&, Lattice, double, \
                                                              const ExtractOptions&, const AxisPeriods<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
