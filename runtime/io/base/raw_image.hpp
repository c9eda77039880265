// SPDX-License-Identifier: BSD-3-Clause
//
// What a reader hands over: values of any stored type and a grid whose dimension is known at run time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "base/value_array.hpp"
#include "tegl/io.hpp"

namespace tegl::io_detail {

/// An axis of one sample that an image was left without, and where it points to.
struct SingleAxis {
  Axis axis;
  AxisDirection direction = AxisDirection::unknown;
};

/// The coordinate function of n axes: as Grid<N>, of dynamic size.
struct RawGrid {
  std::vector<Axis> axes;  ///< axis 0 runs fastest
  Eigen::MatrixXd linear;  ///< n x n
  Eigen::VectorXd offset;  ///< n
  /// Axes of one sample that were left out: where the image lies along them, the likeliest time first.
  std::vector<SingleAxis> single;
};

struct RawImage {
  RawGrid grid;
  ValueArray values;
  ImageInfo info;
};

/// The grid of samples at affine * index + offset (affine: n x n, column a = step along axis a). An axis that is not
/// coupled to others has its origin and signed step in itself, so that a diagonal affine leaves the world map the
/// identity; the other axes hold the lengths of their columns, and `linear` their directions. Errors: MalformedFile for
/// a column that is zero or not finite, a singular affine, or samples whose coordinates are not finite.
RawGrid affine_grid(const std::vector<std::size_t>& sizes, const Eigen::MatrixXd& affine, const Eigen::VectorXd& offset,
                    const std::filesystem::path& path);

/// Names x, y, z, t by position, for axes that have none.
void name_axes(RawGrid& grid);

/// The axis of at least two coordinates: uniform where they are, bit by bit. InvalidGrid unless strictly monotone.
Axis axis_of(const std::vector<double>& coordinates);

/// The grid with an axis more, which no other is coupled with.
RawGrid with_last_axis(const RawGrid& grid, Axis last);

/// Drops trailing axes of one sample, but keeps two axes; where a dropped axis takes part in the orientation
/// (a slice that lies obliquely in space), what is left is the plane's own coordinates and no world frame.
void drop_trailing_axes(RawGrid& grid, ImageInfo& info);

/// The grid in N dimensions, of which it has as many axes.
template <int N>
Grid<N> fixed_grid(const RawGrid& grid) {
  Grid<N> result;
  for (int a = 0; a < N; ++a) result.axes[a] = grid.axes[a];
  result.linear = grid.linear;
  result.offset = grid.offset;
  return result;
}

/// Throws UnsupportedData for an image of other than 2, 3 or 4 axes.
[[noreturn]] void fail_axes(const RawGrid& grid, const std::filesystem::path& path);

/// The image, in 2, 3 or 4 dimensions; UnsupportedData for any other. uint32, int64 and uint64 become int32 if all
/// values fit, else double.
AnyImage to_any_image(RawImage&& image, const std::filesystem::path& path);

/// "uint8", ... of the alternative that is held.
const char* type_name(const ValueArray& values) noexcept;

/// An empty array of the type of that name.
ValueArray array_of_type(std::string_view name);

/// The values with an axis moved behind the others, which keep their order: before it lie `inner` samples, along it
/// `count`, after it `outer`. One copy.
ValueArray with_axis_last(const ValueArray& values, std::size_t inner, std::size_t count, std::size_t outer);

}  // namespace tegl::io_detail
