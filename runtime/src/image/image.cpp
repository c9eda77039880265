// SPDX-License-Identifier: BSD-3-Clause
//
// Image views: validation, dense strides, parts.
#include "tegl/image.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include "tegl/eigen.hpp"

namespace tegl {
namespace {

template <int N>
std::array<std::ptrdiff_t, N> dense_strides(const Grid<N>& grid) {
  std::array<std::ptrdiff_t, N> strides;
  std::ptrdiff_t step = 1;
  for (int a = 0; a < N; ++a) {
    strides[a] = step;
    step *= static_cast<std::ptrdiff_t>(grid.axes[a].size());
  }
  return strides;
}

/// The map to the world must be finite and invertible, so that the two sides of a contour remain distinct.
template <int N>
void check_grid(const Grid<N>& grid) {
  for (int a = 0; a < N; ++a)
    if (grid.axes[a].size() == 0)
      throw Error(ErrorCode::InvalidGrid, fmt::format("axis {} has 0 samples; expected at least 1", a));
  const Eigen::Matrix<double, N, N> linear = as_eigen(grid.linear);
  if (!linear.allFinite() || !as_eigen(grid.offset).allFinite())
    throw Error(ErrorCode::InvalidGrid, "the affine map to the world has a NaN or infinity; expected finite values");
  if (linear.determinant() == 0.0)
    throw Error(ErrorCode::InvalidGrid, "the affine map to the world has determinant 0; expected an invertible map");
}

}  // namespace

template <Value T, int N>
requires DimensionBetween<N, 2, 5> Image<T, N>::Image(const T* data, Grid<N> grid, const Strides& strides)
    : data_(data), grid_(std::move(grid)), strides_(strides) {
  check_grid(grid_);
  if (data_ == nullptr) throw Error(ErrorCode::InvalidGrid, "image with a null data pointer; expected its samples");
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> Image<T, N>::Image(const T* data, Grid<N> grid)
    : Image(data, grid, dense_strides(grid)) {}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> Image<T, N> Image<T, N>::part(int axis, std::size_t first, std::size_t count)
const {
  if (axis < 0 || axis >= N)
    throw Error(ErrorCode::InvalidArgument, fmt::format("axis {} of an image; expected 0 to {}", axis, N - 1));
  Grid<N> grid = grid_;
  grid.axes[axis] = grid_.axes[axis].part(first, count);
  return Image(data_ + static_cast<std::ptrdiff_t>(first) * strides_[axis], std::move(grid), strides_);
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N) template class Image<T, N>;
#include "base/instantiate.hpp"

}  // namespace tegl
