// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at the samples of a lattice: the best linear function, by least squares, on a sample and its neighbours. In
// the inside of the face-centred cubic lattice of step w this is the sum of f(x + d) d / (4 w^2) over the twelve
// neighbours d. At the border and beside missing values it uses the neighbours that are there, and is exact for linear
// functions as long as these span the space.
//
// Differences are added up in half steps of the axes, opposite neighbours first: for samples that are symmetric about a
// sample, and for integers of any order, the sums are exact. So a gradient of zero is exactly 0, and as places of
// samples do not matter, the gradients of a part of an image are those of the image.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "complex/point_gradients.hpp"
#include "image/sample_source.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_grid.hpp"
#include "tegl/extract.hpp"
#include "tegl/periodic.hpp"

namespace tegl::detail {

template <int N>
class LatticeGradients {
 public:
  using Sample = std::array<std::size_t, N>;
  using Gradient = std::array<double, N>;

  /// `values` and `grid` must outlive this object. Axes with a period are periodic.
  LatticeGradients(const CornerValues<N>& values, const Grid<N>& grid, Lattice lattice, GradientDirection direction,
                   const AxisPeriods<N>& periods = {});

  /// The unit normal at `alpha` between two samples with these gradients, on the side of the direction; 0 if the
  /// gradient is zero.
  template <class Real>
  [[nodiscard]] std::array<Real, N> normal_between(const Gradient& a, const Gradient& b, double alpha) const {
    Gradient sum;
    for (int i = 0; i < N; ++i) sum[i] = sign_ * ((1.0 - alpha) * a[i] + alpha * b[i]);
    return unit<Real>(sum);
  }
  /// The unit normal at a sample.
  template <class Real>
  [[nodiscard]] std::array<Real, N> normal_at(const Sample& index) const {
    Gradient gradient = at(index);
    for (double& x : gradient) x *= sign_;
    return unit<Real>(gradient);
  }
  template <class Real>
  static std::array<Real, N> unit(const Gradient& vector) {
    return unit_of<Real>(vector);
  }

  /// The gradient at a sample, in the world.
  [[nodiscard]] Gradient at(const Sample& index) const;

 private:
  /// Two neighbours on opposite sides of a sample.
  struct Pair {
    std::array<LatticePlace, 2> steps;
    Gradient offset;  ///< to the first one, in half steps
  };

  [[nodiscard]] Sample moved(Sample index, const LatticePlace& step) const {
    for (int a = 0; a < N; ++a) {
      index[a] += static_cast<std::size_t>(step[a]);  // modulo 2^64
      if (periods_[a] == 0.0 || index[a] < sizes_[a]) continue;
      index[a] += step[a] < 0 ? sizes_[a] : std::size_t{0} - sizes_[a];
    }
    return index;
  }
  [[nodiscard]] bool exists(const Sample& index) const {
    for (int a = 0; a < N; ++a)
      if (index[a] >= sizes_[a]) return false;
    return true;
  }
  /// Whether all neighbours exist, at the distances of the weights.
  [[nodiscard]] bool is_inside(const Sample& index) const;
  void find_pairs(Lattice lattice);
  void find_weights();
  [[nodiscard]] Gradient by_least_squares(const Sample& index, double here) const;
  /// From a sample to a neighbour: along uniform axes in half steps, along others as coordinates.
  [[nodiscard]] Gradient offset(const Sample& from, const LatticePlace& step) const;
  /// An offset in the world.
  [[nodiscard]] Gradient in_world(const Gradient& offset) const;

  const CornerValues<N>& values_;
  const Grid<N>& grid_;
  Sample sizes_;
  int layers_;
  double sign_;
  AxisPeriods<N> periods_;
  std::array<double, N> units_;             ///< of offsets along the axes
  std::array<std::vector<Pair>, 2> pairs_;  ///< by the parity of the layer
  bool is_even_ = true;                     ///< whether all axes are uniform
  Matrix<N> of_sums_{};                     ///< of an even grid: maps sums of differences x offsets to gradients
};

}  // namespace tegl::detail
