// SPDX-License-Identifier: BSD-3-Clause
//
// Complexes of the face-centred cubic lattice over time.
#include "lattice/lattice_in_time.hpp"

#include <algorithm>
#include <utility>

#include "complex/cell_groups.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_grid.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

Complex<3> fcc_at_a_time(const Grid<4>& grid, const std::array<std::size_t, 4>& margin) {
  if (!grid.is_separate(3))
    throw Error(ErrorCode::InvalidArgument,
                "lattice fcc_in_time: the world map mixes time and space; expected one that does not");
  Grid<3> space;
  std::copy_n(grid.axes.begin(), 3, space.axes.begin());
  for (int row = 0; row < 3; ++row) {
    std::copy_n(grid.linear[row].begin(), 3, space.linear[row].begin());
    space.offset[row] = grid.offset[row];
  }
  check_grid(space, Lattice::fcc_in_time, 2);
  const LatticeCells cells =
      cells_of_lattice(Lattice::fcc, four_sizes(space), {margin[0], margin[1], margin[2], std::size_t{0}});
  return Complex<3>(points_of(space, 2), cells.types, cells.corners);
}

Complex<4> fcc_over_times(const Complex<3>& at_a_time, const Grid<4>& grid, std::span<const double> values) {
  std::vector<double> times;
  for (std::size_t k = 0; k < grid.axes[3].size(); ++k)
    times.push_back(grid.linear[3][3] * grid.axes[3][k] + grid.offset[3]);
  const bool descends = times.size() > 1 && times.front() > times.back();
  if (!descends) return in_time<3>(at_a_time, times, values);
  // `in_time` has ascending times: the mirror image, whose cells are then oriented anew
  for (double& time : times) time = -time;
  const Complex<4> mirrored = in_time<3>(at_a_time, times, values);
  std::vector<std::array<double, 4>> points = mirrored.points();
  for (auto& point : points) point[3] = -point[3];
  Complex<4> complex = ComplexAccess::layered<4>(std::move(points), ComplexAccess::cells(mirrored));
  complex.set_values(std::vector<double>(values.begin(), values.end()));
  return complex;
}

}  // namespace tegl::detail
