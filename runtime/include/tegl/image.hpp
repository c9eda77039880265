// SPDX-License-Identifier: BSD-3-Clause
//
// Images: a view of values on a grid, and an image that owns its values.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "tegl/grid.hpp"
#include "tegl/values.hpp"

namespace tegl {

/// The sample types that the library is compiled for.
template <class T>
concept Value = std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::int8_t> || std::is_same_v<T, std::uint16_t> ||
    std::is_same_v<T, std::int16_t> || std::is_same_v<T, std::int32_t> || std::is_same_v<T, float> ||
    std::is_same_v<T, double>;

/// A view of an N-dimensional image; owns only its grid. The value of index i is data[sum_a i_a * strides[a]]. Strides
/// count elements and may be negative or zero. NaN is a missing value: tiles with a missing corner have no contour.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
class Image {
 public:
  using value_type = T;                           ///< the type of a sample
  using Strides = std::array<std::ptrdiff_t, N>;  ///< by axis, counted in elements

  /// A dense view, axis 0 fastest. Throws InvalidGrid for a null pointer, an axis without samples, or a world map that
  /// is singular or not finite.
  Image(const T* data, Grid<N> grid);
  /// A view with any strides; throws InvalidGrid as well.
  Image(const T* data, Grid<N> grid, const Strides& strides);

  [[nodiscard]] const T* data() const noexcept { return data_; }               ///< the sample of index 0, ..., 0
  [[nodiscard]] const Grid<N>& grid() const& noexcept { return grid_; }        ///< the samples' coordinates
  [[nodiscard]] Grid<N> grid() const&& { return grid_; }                       ///< a copy, for temporaries
  [[nodiscard]] const Strides& strides() const& noexcept { return strides_; }  ///< by axis, in elements
  [[nodiscard]] Strides strides() const&& noexcept { return strides_; }        ///< a copy, for temporaries
  /// Number of samples along an axis.
  [[nodiscard]] std::size_t size(int axis) const noexcept { return grid_.axes[axis].size(); }

  /// The sample at an index. Precondition: the index is inside the image.
  [[nodiscard]] T operator()(const std::array<std::size_t, N>& index) const noexcept {
    std::ptrdiff_t at = 0;
    for (int a = 0; a < N; ++a) at += static_cast<std::ptrdiff_t>(index[a]) * strides_[a];
    return data_[at];
  }

  /// A view of the layers [first, first + count) along `axis`, with unchanged coordinates. O(1) plus a copy of the
  /// axis. Throws InvalidArgument for an axis or layers that the image does not have.
  [[nodiscard]] Image part(int axis, std::size_t first, std::size_t count) const;

 private:
  const T* data_;
  Grid<N> grid_;
  Strides strides_;
};

/// An image that owns its values, axis 0 fastest.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
struct OwnedImage {
  Grid<N> grid = {};      ///< the samples' coordinates
  Values<T> values = {};  ///< axis 0 fastest

  /// A view of the image; valid while this object lives and `values` is unchanged.
  [[nodiscard]] Image<T, N> view() const& { return Image<T, N>(values.data(), grid); }
  /// Deleted: a view of a temporary would dangle.
  Image<T, N> view() const&& = delete;
};

}  // namespace tegl
