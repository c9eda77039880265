// SPDX-License-Identifier: BSD-3-Clause
//
// Samples of an image as points of a complex, axis 0 fastest.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

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

}  // namespace tegl::detail
