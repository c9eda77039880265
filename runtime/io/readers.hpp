// SPDX-License-Identifier: BSD-3-Clause
//
// The readers of the single formats.
#pragma once

#include <filesystem>

#include "raw_image.hpp"

namespace tegl::io_detail {

RawImage read_nifti(const std::filesystem::path& path, const Progress& progress);
RawImage read_nrrd(const std::filesystem::path& path, const Progress& progress);
RawImage read_metaimage(const std::filesystem::path& path, const Progress& progress);
RawImage read_netcdf(const std::filesystem::path& path, const ReadImageOptions& options);

/// The variables of a netCDF file that can be read as images.
std::vector<ImageVariable> list_netcdf(const std::filesystem::path& path);

}  // namespace tegl::io_detail
