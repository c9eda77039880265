// SPDX-License-Identifier: BSD-3-Clause
//
// Names and constants shared by the reader and the writer of VTKHDF.
#pragma once

#include <array>
#include <cstddef>

namespace tegl::io_detail {

/// VTK's cell types of simplices by dimension: vertex, line, triangle, tetrahedron.
inline constexpr std::array<unsigned char, 4> kCellTypes = {1, 3, 5, 10};

/// Names of point and field arrays.
inline constexpr const char* kTimes = "t";            ///< in 4-space
inline constexpr const char* kIsovalue = "isovalue";  ///< of the field data
inline constexpr const char* kPeriods = "periods";    ///< of the field data
inline constexpr const char* kNormals = "Normals";
inline constexpr const char* kNormalTimes = "normal_t";  ///< in 4-space

/// HDF5 attributes of an attribute's array: its index in its group, and its unit and name if they are not empty and the
/// name differs from the array's.
inline constexpr const char* kAttributeOrder = "tegl_order";
inline constexpr const char* kAttributeUnit = "tegl_unit";
inline constexpr const char* kAttributeName = "tegl_name";

/// Number of rows that are converted and passed to HDF5 at a time.
inline constexpr std::size_t kMostRows = std::size_t{1} << 16;

}  // namespace tegl::io_detail
