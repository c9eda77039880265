// SPDX-License-Identifier: BSD-3-Clause
//
// Images on lattices for tests.
#pragma once

#include <array>
#include <cstddef>
#include <random>
#include <utility>

#include "tegl/image.hpp"
#include "tegl/lattice.hpp"
#include "tegl/periodic.hpp"

namespace tegl::test {

/// Samples of f(x, index, sizes) on a lattice.
template <int N, class F>
OwnedImage<double, N> sampled_on_lattice(Lattice lattice, Grid<N> grid, F f) {
  const int layers = lattice == Lattice::fcc_in_time ? 2 : N - 1;
  OwnedImage<double, N> image;
  image.grid = std::move(grid);
  const std::array<std::size_t, N> sizes = image.grid.sizes();
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  std::array<std::size_t, N> index{};
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, N> x;
    for (int a = 0; a < N; ++a) {
      const Axis& axis = image.grid.axes[a];
      x[a] = axis[index[a]] + (a < layers && index[layers] % 2 == 1 ? 0.5 * axis.step() : 0.0);
    }
    image.values.push_back(f(x, index, sizes));
    for (int a = 0; a < N && ++index[a] == sizes[a]; ++a) index[a] = 0;
  }
  return image;
}

/// An image on a lattice with its isotropic steps, around the origin, within about [-1, 1]^N.
template <int N, class F>
OwnedImage<double, N> lattice_image(Lattice lattice, std::size_t samples, F f) {
  const double step = 2.2 / static_cast<double>(samples - 1);
  const int layers = lattice == Lattice::fcc_in_time ? 2 : N - 1;
  Grid<N> grid;
  for (int a = 0; a < N; ++a) {
    const bool is_layered = a == layers;
    const double here = is_layered ? step * layer_step(lattice) : step;
    const std::size_t size = is_layered ? static_cast<std::size_t>(2.2 / here) + 1 : samples;
    grid.axes[a] = Axis::uniform(size, -0.5 * here * static_cast<double>(size - 1), here);
  }
  return sampled_on_lattice<N>(lattice, std::move(grid), std::move(f));
}

/// Noise up to the border of the array.
template <int N>
auto noise_everywhere(unsigned seed) {
  return [random = std::mt19937(seed)](const auto&, const auto&, const auto&) mutable {
    return std::uniform_real_distribution<double>()(random);
  };
}

/// A grid from 0 whose periods are 1 along all axes.
template <int N>
Grid<N> grid_of_torus(const std::array<std::size_t, N>& sizes) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(sizes[a], 0.0, 1.0 / static_cast<double>(sizes[a]));
  return grid;
}

/// Periods of 1 along the axes with bits in `axes`.
template <int N>
AxisPeriods<N> periods_along(unsigned axes) {
  AxisPeriods<N> periods{};
  for (int a = 0; a < N; ++a) periods[a] = (axes >> a & 1u) != 0 ? 1.0 : 0.0;
  return periods;
}

}  // namespace tegl::test
