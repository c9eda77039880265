// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of images whose cells are divided into simplices, instantiated for all value types.
#include "division/stored_division.hpp"
#include "facets/facets_of_stored.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4>
void extract_facets_several(const Image<T, N>& image, Division division, std::span<const double> isovalues,
                            const std::type_identity_t<FacetSink<N, Real>>& use, const ExtractOptions& options,
                            const AxisPeriods<N>& periods) {
  for (const double isovalue : isovalues)
    detail::check_division_arguments<N>(image.grid(), division, isovalue, options, periods);
  const auto part = [&](std::span<const double> of, std::size_t first, const ExtractOptions& of_part) {
    const detail::StoredDivision<T, N> stored(image, division, of[0], of_part, periods);
    detail::pass_facets<Real>(image.grid(), stored, of, stored.options(of_part),
                              [&](std::size_t i, auto facets) { use(first + i, std::move(facets)); });
  };
  if (division != Division::hybrid && !isovalues.empty()) return part(isovalues, 0, options);
  // other cells for each isovalue
  for (std::size_t i = 0; i < isovalues.size(); ++i)
    part(isovalues.subspan(i, 1), i, detail::options_of_part(options, i, isovalues.size()));
}

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> FacetHierarchy<N, Real> extract_facets(const Image<T, N>& image, Division division,
                                                                          double isovalue,
                                                                          const ExtractOptions& options,
                                                                          const AxisPeriods<N>& periods) {
  return detail::facets_of_one<N, Real>([&](const auto& use) {
    extract_facets_several<Real>(image, division, std::array{isovalue}, use, options, periods);
  });
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                                   \
  template FacetHierarchy<N, Real> extract_facets<Real, T, N>(const Image<T, N>&, Division, double,          \
                                                              const ExtractOptions&, const AxisPeriods<N>&); \
  template void extract_facets_several<Real, T, N>(const Image<T, N>&, Division, std::span<const double>,    \
                                                   const FacetSink<N, Real>&, const ExtractOptions&,         \
                                                   const AxisPeriods<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
