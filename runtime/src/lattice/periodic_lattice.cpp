// SPDX-License-Identifier: BSD-3-Clause
//
// A longer image, with a margin of the samples at the other end of each periodic axis, has all cells in one piece, and
// so their orientations. Then the samples of the margin become those that they repeat. No cell has two of them: cells
// extend over one step of the shifted axes and two layers, and prisms over one interval of time.
#include "lattice/periodic_lattice.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "complex/cell_groups.hpp"
#include "complex/image_points.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_grid.hpp"
#include "lattice/lattice_in_time.hpp"
#include "periodic/periodic_layers.hpp"
#include "periodic/periods.hpp"

namespace tegl::detail {

namespace {

[[noreturn]] void refuse(Lattice lattice, const std::string& text) {
  throw Error(ErrorCode::InvalidArgument, fmt::format("lattice {}: {}", name_of(lattice), text));
}

}  // namespace

template <int N>
void check_lattice_periods(const Grid<N>& grid, Lattice lattice, const AxisPeriods<N>& periods) {
  for (int a = 0; a < N; ++a) {
    if (periods[a] == 0.0) continue;
    const Axis& axis = grid.axes[a];
    const std::size_t size = axis.size();
    if (a == layer_axis(lattice) && (size % 2 != 0 || size < 6))
      refuse(lattice, fmt::format("{} is periodic and has {} layers; expected an even number, at least 6, as odd "
                                  "layers are shifted",
                                  label_of_axis(axis, a), size));
    if (size < 3)
      refuse(lattice,
             fmt::format("{} is periodic and has {} samples; expected at least 3", label_of_axis(axis, a), size));
    const double expected = static_cast<double>(size) * std::abs(axis.step());
    if (axis.is_uniform() && !(std::abs(periods[a] - expected) <= 1e-6 * expected))
      refuse(lattice, fmt::format("the period of {} is {}; expected {}, the number of samples x the step",
                                  label_of_axis(axis, a), periods[a], expected));
    // Half a period apart or more, points of one cell would have no nearest places. Across the layers, all cells but
    // triangles extend over two steps.
    const int steps = a == layer_axis(lattice) && lattice != Lattice::triangular ? 2 : 1;
    const bool is_longer = std::isfinite(periods[a]) && periods[a] > std::abs(axis[size - 1] - axis[0]);
    if (const std::string reason = is_longer ? too_long_steps(axis, a, periods[a], steps) : ""; !reason.empty())
      refuse(lattice, reason);
  }
}

template <Value T, int N>
Complex<N> periodic_lattice_complex(const Image<T, N>& image, Lattice lattice, const AxisPeriods<N>& periods) {
  Grid<N> longer = image.grid();
  const auto sizes = image.grid().sizes();
  std::array<std::size_t, 4> margin{};
  for (int a = 0; a < N; ++a) {
    if (periods[a] == 0.0) continue;
    margin[a] = kLatticeMargin;
    longer.axes[a] = wrapped_axis(image.grid().axes[a], periods[a], kLatticeMargin, kLatticeMargin);
  }
  if (lattice == Lattice::fcc_in_time && periods[N - 1] != 0.0) {  // as many intervals as times
    margin[N - 1] = 0;
    longer.axes[N - 1] = wrapped_axis(image.grid().axes[N - 1], periods[N - 1], 0, 1);
  }
  const std::size_t count = count_samples(longer, "a lattice with its margins");  // before anything is allocated
  std::vector<Index> number;
  for_each_sample<N>(longer.sizes(), [&](std::array<std::size_t, N> index) {
    std::size_t at = 0;
    for (int a = N - 1; a >= 0; --a) at = at * sizes[a] + (index[a] + sizes[a] - margin[a]) % sizes[a];
    number.push_back(static_cast<Index>(at));
  });
  const auto identified = [&](const Complex<N>& cells) {
    return ComplexAccess::identified<N>(cells, points_of(image.grid(), layer_axis(lattice)), values_of(image), number);
  };
  if constexpr (N == 4)
    if (lattice == Lattice::fcc_in_time)
      return identified(fcc_over_times(fcc_at_a_time(longer, margin), longer, std::vector<double>(count)));
  const LatticeCells cells = cells_of_lattice(lattice, four_sizes(longer), margin);
  return identified(Complex<N>(points_of(longer, N - 1), cells.types, cells.corners));
}

#define TEGL_INSTANTIATE_DIM(T, N) \
  template Complex<N> periodic_lattice_complex<T, N>(const Image<T, N>&, Lattice, const AxisPeriods<N>&);
#define TEGL_INSTANTIATE(T)  \
  TEGL_INSTANTIATE_DIM(T, 2) \
  TEGL_INSTANTIATE_DIM(T, 3) \
  TEGL_INSTANTIATE_DIM(T, 4)
#include "base/instantiate.hpp"
#undef TEGL_INSTANTIATE_DIM

template void check_lattice_periods<2>(const Grid<2>&, Lattice, const AxisPeriods<2>&);
template void check_lattice_periods<3>(const Grid<3>&, Lattice, const AxisPeriods<3>&);
template void check_lattice_periods<4>(const Grid<4>&, Lattice, const AxisPeriods<4>&);

}  // namespace tegl::detail
