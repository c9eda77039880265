// SPDX-License-Identifier: BSD-3-Clause
//
// Least squares on the neighbours of a sample (see lattice_gradients.hpp).
#include "lattice/lattice_gradients.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "base/periods.hpp"

namespace tegl::detail {

namespace {

template <int N>
using Column = Eigen::Matrix<double, N, 1>;
template <int N>
using Square = Eigen::Matrix<double, N, N>;

}  // namespace

template <int N>
LatticeGradients<N>::LatticeGradients(const CornerValues<N>& values, const Grid<N>& grid, Lattice lattice,
                                      GradientDirection direction, unsigned periodic,
                                      std::span<const Period<N>> periods)
    : values_(values),
      grid_(grid),
      sizes_(grid.sizes()),
      layers_(layer_axis(lattice)),
      sign_(direction == GradientDirection::descent ? -1.0 : 1.0),
      periodic_(periodic),
      periods_(periods),
      neighbours_(neighbours_of_lattice(lattice == Lattice::fcc_in_time ? Lattice::fcc : lattice)) {
  if (lattice == Lattice::fcc_in_time)
    for (auto& of : neighbours_) of.insert(of.end(), {{0, 0, 0, -1}, {0, 0, 0, 1}});
  find_weights();
}

template <int N>
std::array<double, N> LatticeGradients<N>::at(const Sample& index) const {
  const std::size_t parity = index[layers_] % 2;
  const double here = values_.value(index);
  if (!is_inside(index)) return by_least_squares(index, here);
  Gradient sum{};
  for (std::size_t n = 0; n < neighbours_[parity].size(); ++n) {
    const double change = values_.value(moved(index, neighbours_[parity][n])) - here;
    if (!std::isfinite(change)) return by_least_squares(index, here);
    for (int i = 0; i < N; ++i) sum[i] += change * weights_[parity][n][i];
  }
  return sum;
}

template <int N>
bool LatticeGradients<N>::is_inside(const Sample& index) const {
  if (weights_[0].empty()) return false;
  for (int a = 0; a < N; ++a)
    if ((periodic_ >> a & 1u) == 0 && (index[a] < 2 || index[a] + 2 >= sizes_[a])) return false;
  return true;
}

/// The weights of the neighbours in the inside of an even grid.
template <int N>
void LatticeGradients<N>::find_weights() {
  Sample middle;
  for (int a = 0; a < N; ++a) {
    if (!grid_.axes[a].is_uniform() || sizes_[a] < 6) return;
    middle[a] = 2;
  }
  for (std::size_t parity = 0; parity < 2; ++parity) {
    middle[layers_] = 2 + parity;
    Square<N> sum = Square<N>::Zero();
    std::vector<Column<N>> steps;
    for (const LatticePlace& step : neighbours_[parity]) {
      steps.push_back(Column<N>(difference(middle, moved(middle, step)).data()));
      sum += steps.back() * steps.back().transpose();
    }
    const Square<N> inverse = sum.inverse();
    for (const Column<N>& step : steps) {
      Gradient weight;
      Eigen::Map<Column<N>>(weight.data()) = inverse * step;
      weights_[parity].push_back(weight);
    }
  }
}

template <int N>
std::array<double, N> LatticeGradients<N>::difference(const Sample& from, const Sample& to) const {
  const Gradient a = lattice_place<N>(grid_, from, layers_);
  Gradient b = lattice_place<N>(grid_, to, layers_);
  move_near<N>(periods_, a, b);
  for (int i = 0; i < N; ++i) b[i] -= a[i];
  return b;
}

template <int N>
std::array<double, N> LatticeGradients<N>::by_least_squares(const Sample& index, double here) const {
  Square<N> sum = Square<N>::Zero();
  Column<N> right = Column<N>::Zero();
  for (const LatticePlace& step : neighbours_[index[layers_] % 2]) {
    const Sample there = moved(index, step);
    if (!exists(there)) continue;
    const double change = values_.value(there) - here;
    if (!std::isfinite(change)) continue;
    const Column<N> d(difference(index, there).data());
    sum += d * d.transpose();
    right += change * d;
  }
  // Neighbours that do not span the space: the part of the gradient that they determine.
  const double scale = sum.trace();
  if (!(scale > 0.0)) return {};
  sum += 1e-13 * scale * Square<N>::Identity();
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
