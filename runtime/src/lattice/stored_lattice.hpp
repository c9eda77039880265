// SPDX-License-Identifier: BSD-3-Clause
//
// Images on lattices as complexes, with the gradients at their samples and their periods.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "complex/contour_numbers.hpp"
#include "complex/image_points.hpp"
#include "complex/point_gradients.hpp"
#include "image/row_source.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_gradients.hpp"
#include "lattice/lattice_grid.hpp"
#include "lattice/periodic_lattice.hpp"
#include "periodic/periods.hpp"
#include "tegl/error.hpp"
#include "tegl/lattice.hpp"
#include "tegl/normals.hpp"

namespace tegl::detail {

/// Checks the arguments of a contour on a lattice, except for the steps of its grid. Errors: those of
/// `extract_lattice`.
template <int N>
void check_lattice_arguments(const Grid<N>& grid, Lattice lattice, double isovalue, ExtractOptions options,
                             const AxisPeriods<N>& periods) {
  if (options.normals != Normals::none && options.normals != Normals::differences)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} normals on a lattice; expected gradient (differences), geometric or flat",
                            name_of(options.normals)));
  const ExtractOptions with_normals = options;
  options.normals = Normals::none;
  check_complex_options(isovalue, options);
  check_dimension(lattice, N);
  if (periodic_axes<N>(periods) == 0) return;
  check_lattice_periods<N>(grid, lattice, periods);
  check_periods<N>(grid, periods, with_normals);
}

/// The complex of an image on a lattice, and what is known beside it.
template <Value T, int N>
class StoredLattice {
 public:
  /// The image must outlive this object; the arguments are checked (check_lattice_arguments). Errors: those of
  /// `lattice_complex`.
  StoredLattice(const Image<T, N>& image, Lattice lattice, double isovalue, const ExtractOptions& options,
                const AxisPeriods<N>& periods)
      : periodic_(periodic_axes<N>(periods)),
        complex_(complex_of(image, lattice, periods)),
        source_(image, isovalue, options.epsilon) {
    if (periodic_ != 0) around_.periods = world_periods<N>(image.grid(), periods);
    if (options.normals == Normals::none) return;
    gradients_.emplace(source_, image.grid(), lattice, options.direction, periods);
    around_.gradient = [this, sizes = image.grid().sizes()](Index p) { return gradients_->at(index_of<N>(p, sizes)); };
  }
  // around_ and gradients_ refer to other members
  StoredLattice(const StoredLattice&) = delete;
  StoredLattice& operator=(const StoredLattice&) = delete;

  [[nodiscard]] const Complex<N>& complex() const noexcept { return complex_; }
  [[nodiscard]] const Surroundings<N>& surroundings() const noexcept { return around_; }

 private:
  static Complex<N> complex_of(const Image<T, N>& image, Lattice lattice, const AxisPeriods<N>& periods) {
    if (periodic_axes<N>(periods) == 0) return lattice_complex(image, lattice);
    check_grid(image.grid(), lattice, layer_axis(lattice));
    return periodic_lattice_complex(image, lattice, periods);
  }

  unsigned periodic_;
  Complex<N> complex_;
  ImageSource<T, N> source_;
  Surroundings<N> around_;
  std::optional<LatticeGradients<N>> gradients_;
};

}  // namespace tegl::detail
