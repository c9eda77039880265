// SPDX-License-Identifier: BSD-3-Clause
//
// The contour between high and low cells from an image with two samples per cell along each axis, at the cell's two
// faces. The contour passes between samples of different cells only, which lie at the same place; so it consists of the
// faces between cells, and of simplices of zero size at their edges. It is a manifold, as every contour of an image.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cells/cubic_contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"

namespace tegl::detail {

/// `sides`: 1 for high and 0 for low cells, with a layer of low ones around them.
template <class Real, int N>
Contour<N, Real> contour_of_doubled_cells(const OwnedImage<std::uint8_t, N>& sides, const CellPlaces<N>& places,
                                          const ExtractOptions& options) {
  std::array<std::size_t, N> sizes = sides.grid.sizes();
  std::size_t count = 1;
  for (std::size_t& size : sizes) count *= size *= 2;
  OwnedImage<std::uint8_t, N> doubled{Grid<N>::unit(sizes), {}};
  doubled.values.resize(count);
  const Image<std::uint8_t, N> view = sides.view();
  std::array<std::size_t, N> index{};
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::size_t, N> cell;
    for (int a = 0; a < N; ++a) cell[a] = index[a] / 2;
    doubled.values[i] = view(cell);
    for (int a = 0; a < N && ++index[a] == sizes[a]; ++a) index[a] = 0;
  }
  Contour<N, double> contour = extract<double>(doubled.view(), 0.5, options);
  Contour<N, Real> result;
  result.simplices = std::move(contour.simplices);
  result.vertices.resize(contour.vertices.size());
  for (std::size_t v = 0; v < result.vertices.size(); ++v) {
    std::array<double, N> along;
    for (int a = 0; a < N; ++a) {
      // samples 2 i and 2 i + 1 are at the faces of cell i - 1, counted without the layer around
      const std::vector<double>& faces = places.faces[a];
      const double x = contour.vertices[v][a];
      const auto below = static_cast<std::ptrdiff_t>(std::floor(x));
      const auto face = [&](std::ptrdiff_t sample) {
        const std::ptrdiff_t f = (sample + 1) / 2 - 1;
        return faces[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(f, 0, std::ssize(faces) - 1))];
      };
      along[a] = std::lerp(face(below), face(below + 1), x - static_cast<double>(below));
    }
    result.vertices[v] = places.template world<Real>(along);
  }
  if (places.is_mirrored())
    for (auto& simplex : result.simplices) std::swap(simplex[0], simplex[1]);
  return result;
}

}  // namespace tegl::detail
