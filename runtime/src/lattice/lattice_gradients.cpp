// SPDX-License-Identifier: BSD-3-Clause
//
// Least squares on the neighbours of a sample (see lattice_gradients.hpp).
#include "lattice/lattice_gradients.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tegl::detail {

namespace {

template <int N>
using Column = Eigen::Matrix<double, N, 1>;
template <int N>
using Square = Eigen::Matrix<double, N, N>;

}  // namespace

template <int N>
LatticeGradients<N>::LatticeGradients(const CornerValues<N>& values, const Grid<N>& grid, Lattice lattice,
                                      GradientDirection direction, const AxisPeriods<N>& periods)
    : values_(values),
      grid_(grid),
      sizes_(grid.sizes()),
      layers_(layer_axis(lattice)),
      sign_(direction == GradientDirection::descent ? -1.0 : 1.0),
      periods_(periods) {
  for (int a = 0; a < N; ++a) {
    units_[a] = grid.axes[a].is_uniform() ? 0.5 * grid.axes[a].step() : 1.0;
    is_even_ = is_even_ && grid.axes[a].is_uniform();
  }
  find_pairs(lattice);
  if (is_even_) find_weights();
}

template <int N>
void LatticeGradients<N>::find_pairs(Lattice lattice) {
  const auto neighbours = neighbours_of_lattice(lattice == Lattice::fcc_in_time ? Lattice::fcc : lattice);
  for (std::size_t parity = 0; parity < 2; ++parity) {
    const auto in_half_steps = [&](const LatticePlace& step) {
      LatticePlace place = step;
      const bool is_shifted = step[layers_] % 2 != 0;
      for (int a = 0; a < N; ++a) place[a] = 2 * step[a] + (a < layers_ && is_shifted ? (parity == 0 ? 1 : -1) : 0);
      return place;
    };
    for (const LatticePlace& step : neighbours[parity]) {
      const LatticePlace place = in_half_steps(step);
      LatticePlace opposite{};
      for (int a = 0; a < N; ++a) opposite[a] = -place[a];
      if (opposite < place) continue;  // has its pair
      const auto other = std::ranges::find(neighbours[parity], opposite, in_half_steps);
      Pair pair{{step, *other}, {}};
      for (int a = 0; a < N; ++a) pair.offset[a] = static_cast<double>(place[a]);
      pairs_[parity].push_back(pair);
    }
    if (lattice != Lattice::fcc_in_time) continue;
    Pair in_time{{{{0, 0, 0, -1}, {0, 0, 0, 1}}}, {}};
    in_time.offset[N - 1] = -2.0;
    pairs_[parity].push_back(in_time);
  }
}

template <int N>
std::array<double, N> LatticeGradients<N>::at(const Sample& index) const {
  const double here = values_.value(index);
  if (!is_inside(index) || !std::isfinite(here)) return by_least_squares(index, here);
  Gradient sums{};
  for (const Pair& pair : pairs_[index[layers_] % 2]) {
    const double change = values_.value(moved(index, pair.steps[0])) - values_.value(moved(index, pair.steps[1]));
    if (!std::isfinite(change)) return by_least_squares(index, here);
    for (int i = 0; i < N; ++i) sums[i] += change * pair.offset[i];
  }
  Gradient gradient{};
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < N; ++a) gradient[i] += of_sums_[i][a] * sums[a];
  return gradient;
}

template <int N>
bool LatticeGradients<N>::is_inside(const Sample& index) const {
  if (!is_even_) return false;
  for (int a = 0; a < N; ++a)
    if (periods_[a] == 0.0 && (index[a] < 2 || index[a] + 2 >= sizes_[a])) return false;
  return true;
}

/// The map from sums to gradients in the inside of an even grid.
template <int N>
void LatticeGradients<N>::find_weights() {
  Square<N> sum = Square<N>::Zero(), units;
  for (const Pair& pair : pairs_[0]) {
    const Column<N> d(in_world(pair.offset).data());
    sum += 2.0 * (d * d.transpose());
  }
  for (int a = 0; a < N; ++a) {
    Gradient unit{};
    unit[a] = 1.0;
    units.col(a) = Column<N>(in_world(unit).data());
  }
  const Square<N> of_sums = sum.inverse() * units;
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < N; ++a) of_sums_[i][a] = of_sums(i, a);
}

template <int N>
std::array<double, N> LatticeGradients<N>::offset(const Sample& from, const LatticePlace& step) const {
  const bool is_shifted = step[layers_] % 2 != 0;
  const double shift = from[layers_] % 2 == 0 ? 1.0 : -1.0;
  const Sample to = moved(from, step);
  Gradient result;
  for (int a = 0; a < N; ++a) {
    const Axis& axis = grid_.axes[a];
    const double shifted = a < layers_ && is_shifted ? shift : 0.0;
    if (axis.is_uniform()) {
      result[a] = 2.0 * static_cast<double>(step[a]) + shifted;
      continue;
    }
    result[a] = axis[to[a]] - axis[from[a]] + 0.5 * axis.step() * shifted;
    if (from[a] + static_cast<std::size_t>(step[a]) != to[a])  // across the seam
      result[a] += (step[a] < 0) == axis.is_descending() ? periods_[a] : -periods_[a];
  }
  return result;
}

template <int N>
std::array<double, N> LatticeGradients<N>::in_world(const Gradient& offset) const {
  Gradient x;
  for (int a = 0; a < N; ++a) x[a] = units_[a] * offset[a];
  Gradient result{};
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < N; ++a) result[i] += grid_.linear[i][a] * x[a];
  return result;
}

template <int N>
std::array<double, N> LatticeGradients<N>::by_least_squares(const Sample& index, double here) const {
  Square<N> sum = Square<N>::Zero();
  Gradient sums{};
  const auto add = [&](const LatticePlace& step, double change) {
    const Gradient to = offset(index, step);
    for (int a = 0; a < N; ++a) sums[a] += change * to[a];
  };
  for (const Pair& pair : pairs_[index[layers_] % 2]) {
    std::array<double, 2> values;
    std::array<bool, 2> is_known;
    for (std::size_t i = 0; i < 2; ++i) {
      const Sample there = moved(index, pair.steps[i]);
      values[i] = exists(there) ? values_.value(there) : std::numeric_limits<double>::quiet_NaN();
      is_known[i] = std::isfinite(values[i] - here);
      if (!is_known[i]) continue;
      const Column<N> d(in_world(offset(index, pair.steps[i])).data());
      sum += d * d.transpose();
    }
    if (is_even_ && is_known[0] && is_known[1] && std::isfinite(values[0] - values[1])) {
      add(pair.steps[0], values[0] - values[1]);
      continue;
    }
    for (std::size_t i = 0; i < 2; ++i)
      if (is_known[i]) add(pair.steps[i], values[i] - here);
  }
  // Neighbours that do not span the space: the part of the gradient that they determine.
  const double scale = sum.trace();
  if (!(scale > 0.0)) return {};
  sum += 1e-13 * scale * Square<N>::Identity();
  const Column<N> right(in_world(sums).data());
  Gradient result;
  Eigen::Map<Column<N>>(result.data()) = sum.ldlt().solve(right);
  for (double& x : result)
    if (!std::isfinite(x)) x = 0.0;
  return result;
}

template class LatticeGradients<2>;
template class LatticeGradients<3>;
template class LatticeGradients<4>;

}  // namespace tegl::detail
