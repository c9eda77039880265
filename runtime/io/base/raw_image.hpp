// SPDX-License-Identifier: BSD-3-Clause
//
// The result of an image reader: values of any stored type, and a grid whose dimension is known at run time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "base/value_array.hpp"
#include "tegl/eigen.hpp"
#include "tegl/io/images.hpp"

namespace tegl::io_detail {

/// An axis of one sample that was removed from an image, with its direction.
struct SingleAxis {
  Axis axis;
  AxisDirection direction = AxisDirection::unknown;
};

/// The coordinates of n axes: as Grid<N>, with dynamic size.
struct RawGrid {
  std::vector<Axis> axes;  ///< axis 0 is the fastest
  Eigen::MatrixXd linear;  ///< n x n
  Eigen::VectorXd offset;  ///< n
  /// Removed axes of one sample, most likely time first; they give the position of the image along them.
  std::vector<SingleAxis> single;
};

/// How much of a file to read: everything, or grid and metadata with an empty array of the values' type.
enum class Extent { whole, header };

struct RawImage {
  RawGrid grid;
  ValueArray values;
  ImageInfo info;
};

/// The grid with samples at affine * index + offset (affine: n x n, column a = step along axis a). An axis that is not
/// coupled to others gets its origin and signed step, so a diagonal affine gives an identity world map. Other axes get
/// the lengths of their columns, and `linear` their directions. Errors: MalformedFile for a column that is zero or not
/// finite, a singular affine, or samples with coordinates that are not finite.
RawGrid affine_grid(const std::vector<std::size_t>& sizes, const Eigen::MatrixXd& affine, const Eigen::VectorXd& offset,
                    const std::filesystem::path& path);

/// Names unnamed axes x, y, z, t, u by position.
void name_axes(RawGrid& grid);

/// The axis with at least two coordinates; uniform if they are so, bit by bit. InvalidGrid unless strictly monotone.
Axis axis_of(const std::vector<double>& coordinates);

/// The grid with an additional last axis, not coupled with the others.
RawGrid with_last_axis(const RawGrid& grid, Axis last);

/// Drops trailing axes of one sample, but keeps at least two axes. If a dropped axis is coupled with others (an oblique
/// slice in space), the remaining axes have the plane's own coordinates and no world frame.
void drop_trailing_axes(RawGrid& grid, ImageInfo& info);

/// The key (NRRD), attribute (netCDF) or array (.npz) with the name of the samples' lattice.
inline constexpr const char* kLatticeKey = "sample_lattice";
/// The lattice of this name; none for "cubic" and for an empty text. Throws MalformedFile for another name.
[[nodiscard]] std::optional<Lattice> lattice_of_text(std::string_view name, const std::filesystem::path& path);
/// Fits the lattice of a file to the axes that are read: one time of fcc_in_time is fcc. Throws UnsupportedData for a
/// lattice of another dimension.
void settle_lattice(const RawGrid& grid, ImageInfo& info, const std::filesystem::path& path);

/// The grid with static dimension N, which must be its number of axes.
template <int N>
Grid<N> fixed_grid(const RawGrid& grid) {
  Grid<N> result;
  for (int a = 0; a < N; ++a) result.axes[a] = grid.axes[a];
  as_eigen(result.linear) = grid.linear;
  as_eigen(result.offset) = grid.offset;
  return result;
}

/// Throws UnsupportedData about an image that does not have 2, 3 or 4 axes.
[[noreturn]] void fail_axes(const RawGrid& grid, const ImageInfo& info, const std::filesystem::path& path);

/// Converts to 2, 3 or 4 dimensions; UnsupportedData for any other. uint32, int64 and uint64 become int32 if all values
/// fit, else double.
AnyImage to_any_image(RawImage&& image, const std::filesystem::path& path);

/// Converts an image of 5 axes: values of at most 16 bits, and float, to float; others to double.
AnyImage5d to_image_5d(RawImage&& image);

/// The name of the value type: "uint8", ...
const char* type_name(const ValueArray& values) noexcept;

/// An empty array of the type with this name.
ValueArray array_of_type(std::string_view name);

/// Moves one axis of the values to the end; the others keep their order. `inner`: samples of the axes before it,
/// `count`: of the axis, `outer`: of the axes after it. One copy.
ValueArray with_axis_last(const ValueArray& values, std::size_t inner, std::size_t count, std::size_t outer);

/// Reverses the order of the axes, whose sizes in `values` are given fastest first: the last becomes the fastest. One
/// copy, in square blocks of the first and the last axis.
ValueArray with_axes_reversed(const ValueArray& values, const std::vector<std::size_t>& sizes);

}  // namespace tegl::io_detail
