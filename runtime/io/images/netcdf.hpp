// SPDX-License-Identifier: BSD-3-Clause
//
// Reads variables of netCDF files as images.
#pragma once

#include <filesystem>
#include <vector>

#include "base/raw_image.hpp"
#include "base/raw_layers.hpp"

namespace tegl::io_detail {

RawImage read_netcdf(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options);
RawLayers open_netcdf_layers(const std::filesystem::path& path, const ReadImageOptions& options);

/// Lists the variables of a netCDF file that are readable as images.
std::vector<ImageVariable> list_netcdf(const std::filesystem::path& path, bool allow_outside_paths);

}  // namespace tegl::io_detail
