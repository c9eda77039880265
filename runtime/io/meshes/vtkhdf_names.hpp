// SPDX-License-Identifier: BSD-3-Clause
//
// Names and constants shared by the reader and the writer of VTKHDF.
#pragma once

#include <array>
#include <cstddef>

namespace tegl::io_detail {

/// VTK's cell types of simplices by dimension: vertex, line, triangle, tetrahedron; poly-vertex for 4-simplices, which
/// VTK does not have.
inline constexpr std::array<unsigned char, 5> kCellTypes = {1, 3, 5, 10, 2};

/// Names of point and field arrays.
/// Point arrays of the coordinates after x, y, z, in 4-space and 5-space.
inline constexpr std::array<const char*, 2> kFurtherCoordinates = {"t", "u"};
/// Number of coordinates after x, y, z.
constexpr std::size_t further_count(int space_dim) {
  return space_dim > 3 ? static_cast<std::size_t>(space_dim - 3) : 0;
}
inline constexpr const char* kIsovalue = "isovalue";  ///< of the field data
inline constexpr const char* kPeriods = "periods";    ///< of the field data
inline constexpr const char* kNormals = "Normals";
inline constexpr std::array<const char*, 2> kFurtherNormals = {"normal_t", "normal_u"};  ///< as kFurtherCoordinates

/// HDF5 attributes of an attribute's array: its index in its group, and its unit and name if they are not empty and the
/// name differs from the array's.
inline constexpr const char* kAttributeOrder = "tegl_order";
inline constexpr const char* kAttributeUnit = "tegl_unit";
inline constexpr const char* kAttributeName = "tegl_name";

/// Number of rows that are converted and passed to HDF5 at a time.
inline constexpr std::size_t kMostRows = std::size_t{1} << 16;

}  // namespace tegl::io_detail
