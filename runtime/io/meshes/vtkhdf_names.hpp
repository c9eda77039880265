// SPDX-License-Identifier: BSD-3-Clause
//
// The names and numbers in a VTKHDF file that its reader and its writer share.
#pragma once

#include <array>
#include <cstddef>

namespace tegl::io_detail {

/// VTK's numbers of the simplices by dimension: vertex, line, triangle, tetrahedron.
inline constexpr std::array<unsigned char, 4> kCellTypes = {1, 3, 5, 10};

/// Point arrays.
inline constexpr const char* kTimes = "t";            ///< in 4-space
inline constexpr const char* kIsovalue = "isovalue";  ///< of the field data
inline constexpr const char* kNormals = "Normals";
inline constexpr const char* kNormalTimes = "normal_t";  ///< in 4-space

/// Attributes of an attribute's array: its place among those of its group, and its unit and name where they are not
/// empty and not the array's.
inline constexpr const char* kAttributeOrder = "tegl_order";
inline constexpr const char* kAttributeUnit = "tegl_unit";
inline constexpr const char* kAttributeName = "tegl_name";

/// Rows that are converted and handed to HDF5 at a time.
inline constexpr std::size_t kMostRows = std::size_t{1} << 16;

}  // namespace tegl::io_detail
