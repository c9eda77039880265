// SPDX-License-Identifier: BSD-3-Clause
//
// Complexes of images on staggered lattices.
#include "tegl/lattice.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_grid.hpp"
#include "lattice/lattice_in_time.hpp"

namespace tegl {
namespace {

struct LatticeFacts {
  Lattice lattice;
  const char* name;
  int dim;
  double layer_step;
  std::size_t least_layers;
};
constexpr LatticeFacts kLattices[] = {{Lattice::triangular, "triangular", 2, 0.86602540378443864676, 2},
                                      {Lattice::fcc, "fcc", 3, 0.70710678118654752440, 2},
                                      {Lattice::bcc, "bcc", 3, 0.5, 2},
                                      {Lattice::d4, "d4", 4, 0.5, 3},
                                      {Lattice::fcc_in_time, "fcc_in_time", 4, 0.70710678118654752440, 2}};

const LatticeFacts& facts_of(Lattice lattice) noexcept {
  return *std::find_if(std::begin(kLattices), std::end(kLattices) - 1,
                       [&](const LatticeFacts& facts) { return facts.lattice == lattice; });
}

}  // namespace

std::string_view name_of(Lattice lattice) noexcept { return facts_of(lattice).name; }
std::optional<Lattice> parse_lattice(std::string_view name) noexcept {
  for (const LatticeFacts& facts : kLattices)
    if (facts.name == name) return facts.lattice;
  return std::nullopt;
}
int dimension(Lattice lattice) noexcept { return facts_of(lattice).dim; }
double layer_step(Lattice lattice) noexcept { return facts_of(lattice).layer_step; }
std::size_t least_layers(Lattice lattice) noexcept { return facts_of(lattice).least_layers; }

template <Value T, int N>
requires DimensionBetween<N, 2, 4> Complex<N> lattice_complex(const Image<T, N>& image, Lattice lattice) {
  detail::check_dimension(lattice, N);
  if constexpr (N == 4)
    if (lattice == Lattice::fcc_in_time)
      return detail::fcc_over_times(detail::fcc_at_a_time(image.grid()), image.grid(), detail::values_of(image));
  detail::check_grid(image.grid(), lattice, N - 1);
  const detail::LatticeCells cells = detail::cells_of_lattice(lattice, detail::four_sizes(image.grid()));
  Complex<N> complex(detail::points_of(image.grid(), N - 1), cells.types, cells.corners);
  complex.set_values(detail::values_of(image));
  return complex;
}

#define TEGL_INSTANTIATE(T)                                               \
  template Complex<2> lattice_complex<T, 2>(const Image<T, 2>&, Lattice); \
  template Complex<3> lattice_complex<T, 3>(const Image<T, 3>&, Lattice); \
  template Complex<4> lattice_complex<T, 4>(const Image<T, 4>&, Lattice);
#include "base/instantiate.hpp"

}  // namespace tegl
