// SPDX-License-Identifier: BSD-3-Clause
//
// Coordinates of netCDF variables as axes of images.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/raw_image.hpp"
#include "base/value_array.hpp"
#include "images/netcdf_file.hpp"
#include "tegl/io/images.hpp"

namespace tegl::io_detail {

/// The grid of a variable, and the dimension that becomes the image's last axis: time, else the slowest one.
struct VariableGrid {
  RawGrid grid;
  std::vector<AxisDirection> directions;  ///< of the grid's axes
  std::size_t last_dimension = 0;
  std::size_t time_axis = 0;            ///< index of the last axis in the file, from the fastest
  bool has_time = false;                ///< whether the last axis is time
  std::vector<std::size_t> dimensions;  ///< of the variable, by axis
};

/// The axes of a slab of a variable, from its coordinate variables; indices along dimensions without one. Errors:
/// MalformedFile (coordinates that make no axis).
VariableGrid read_grid(const NcFile& file, const NcVariable& variable, const NcSlab& slab);

/// The curved axes of the image; the grid then has indices there. Longitude and latitude are used if their axes have no
/// coordinate variables of their own. Adds remarks on coordinates that are not used.
std::vector<CurvedAxis> find_curved(const NcFile& file, const NcVariable& variable, const NcSlab& slab,
                                    VariableGrid& grid, std::vector<std::string>& remarks);

/// Makes samples with unknown coordinates missing, if the values have a missing value.
void hide_unknown(const std::vector<CurvedAxis>& curved, const std::vector<Axis>& axes, ValueArray& values);

}  // namespace tegl::io_detail
