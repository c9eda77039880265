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
#include "tegl/error.hpp"

namespace tegl {
namespace {

struct LatticeFacts {
  Lattice lattice;
  const char* name;
  int dim;
  double layer_step;
};
constexpr LatticeFacts kLattices[] = {{Lattice::triangular, "triangular", 2, 0.86602540378443864676},
                                      {Lattice::fcc, "fcc", 3, 0.70710678118654752440},
                                      {Lattice::bcc, "bcc", 3, 0.5},
                                      {Lattice::d4, "d4", 4, 0.5},
                                      {Lattice::fcc_in_time, "fcc_in_time", 4, 0.70710678118654752440}};

const LatticeFacts& facts_of(Lattice lattice) noexcept {
  return *std::find_if(std::begin(kLattices), std::end(kLattices) - 1,
                       [&](const LatticeFacts& facts) { return facts.lattice == lattice; });
}

/// The prisms of the cells of one layer in time.
template <Value T>
Complex<4> in_time_of(const Image<T, 4>& image) {
  const Grid<4>& grid = image.grid();
  if (!grid.is_separate(3))
    throw Error(ErrorCode::InvalidArgument,
                "lattice fcc_in_time: the world map mixes time and space; expected one that does not");
  Grid<3> space;
  std::copy_n(grid.axes.begin(), 3, space.axes.begin());
  for (int row = 0; row < 3; ++row) {
    std::copy_n(grid.linear[row].begin(), 3, space.linear[row].begin());
    space.offset[row] = grid.offset[row];
  }
  detail::check_grid(space, Lattice::fcc_in_time, 2);
  const detail::LatticeCells cells = detail::cells_of_lattice(Lattice::fcc, detail::four_sizes(space));
  const Complex<3> layer(detail::points_of(space, 2), cells.types, cells.corners);
  std::vector<double> times;
  for (std::size_t k = 0; k < grid.axes[3].size(); ++k)
    times.push_back(grid.linear[3][3] * grid.axes[3][k] + grid.offset[3]);
  return in_time<3>(layer, times, detail::values_of(image));
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

template <Value T, int N>
requires DimensionBetween<N, 2, 4> Complex<N> lattice_complex(const Image<T, N>& image, Lattice lattice) {
  detail::check_dimension(lattice, N);
  if constexpr (N == 4)
    if (lattice == Lattice::fcc_in_time) return in_time_of(image);
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
