// SPDX-License-Identifier: BSD-3-Clause
//
// Samples of an image as points of a complex, axis 0 fastest, and other numbers at points.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/image.hpp"

namespace tegl::detail {

/// Number of samples. Throws TooLarge if numbers of points cannot count them. `what`: for the message.
template <int N>
std::size_t count_samples(const Grid<N>& grid, const std::string& what) {
  std::size_t count = 1;
  for (const Axis& axis : grid.axes) {
    if (axis.size() == 0 || count > std::numeric_limits<Index>::max() / axis.size())
      throw Error(ErrorCode::TooLarge, fmt::format("2^32 samples of {} or more; expected fewer", what));
    count *= axis.size();
  }
  return count;
}

/// Calls work(index) for all samples.
template <int N, class Work>
void for_each_sample(const std::array<std::size_t, N>& sizes, const Work& work) {
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  std::array<std::size_t, N> index{};
  for (std::size_t i = 0; i < count; ++i) {
    work(index);
    for (int a = 0; a < N && ++index[a] == sizes[a]; ++a) index[a] = 0;
  }
}

/// The number of a sample.
template <int N>
std::size_t number_of(const Grid<N>& grid, const std::array<std::size_t, N>& index) {
  std::size_t at = 0;
  for (int a = N - 1; a >= 0; --a) at = at * grid.axes[a].size() + index[a];
  return at;
}

/// The index of number `number`, axis 0 fastest.
template <int N>
std::array<std::size_t, N> index_of(std::size_t number, const std::array<std::size_t, N>& sizes) noexcept {
  std::array<std::size_t, N> index;
  for (int a = 0; a < N; ++a) {
    index[a] = number % sizes[a];
    number /= sizes[a];
  }
  return index;
}

/// The place in the world of axis coordinates.
template <int N>
std::array<double, N> place_in_world(const Grid<N>& grid, const std::array<double, N>& x) {
  std::array<double, N> place = grid.offset;
  for (int row = 0; row < N; ++row)
    for (int a = 0; a < N; ++a) place[row] += grid.linear[row][a] * x[a];
  return place;
}

template <Value T, int N>
std::vector<double> values_of(const Image<T, N>& image) {
  std::vector<double> values;
  for_each_sample<N>(image.grid().sizes(),
                     [&](const auto& index) { values.push_back(static_cast<double>(image(index))); });
  return values;
}

/// Interpolates numbers at points to the vertices of a contour. Coordinates of vertices are linear in those of the
/// points, with weights that depend on the values only. So the numbers take the place of the coordinates, N at a time:
/// `contour_of` makes the contour of points at these places.
template <int N, class ContourOf>
Attribute interpolate_as_places(std::size_t points, std::span<const double> numbers, Attribute attribute,
                                const ContourOf& contour_of) {
  const std::size_t width = points == 0 ? 1 : numbers.size() / points;
  if (width == 0 || numbers.size() != width * points)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} numbers; expected one or several for each of the {} points", numbers.size(), points));
  attribute.width = static_cast<int>(width);
  for (std::size_t first = 0; first < width; first += N) {
    const std::size_t count = std::min<std::size_t>(N, width - first);
    std::vector<std::array<double, N>> places(points);
    for (std::size_t p = 0; p < points; ++p) std::copy_n(numbers.data() + p * width + first, count, places[p].data());
    const Contour<N, double> contour = contour_of(std::move(places));
    attribute.values.resize(contour.vertices.size() * width);
    for (std::size_t v = 0; v < contour.vertices.size(); ++v)
      std::copy_n(contour.vertices[v].data(), count, attribute.values.data() + v * width + first);
  }
  return attribute;
}

}  // namespace tegl::detail
