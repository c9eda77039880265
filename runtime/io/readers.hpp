// SPDX-License-Identifier: BSD-3-Clause
//
// The readers of the single formats.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "raw_image.hpp"

namespace tegl::io_detail {

RawImage read_nifti(const std::filesystem::path& path, const Progress& progress);
RawImage read_nrrd(const std::filesystem::path& path, const Progress& progress);
RawImage read_metaimage(const std::filesystem::path& path, const Progress& progress);
RawImage read_netcdf(const std::filesystem::path& path, const ReadImageOptions& options);

/// An image whose samples are read later, some layers along its last axis at a time.
struct RawLayers {
  RawGrid grid;
  ImageInfo info;
  std::size_t block = 1;  ///< layers that are best read together
  /// The samples of the layers [first, first + count); always of the same type. Keeps the file open.
  std::function<ValueArray(std::size_t first, std::size_t count)> read;
};
RawLayers open_netcdf_layers(const std::filesystem::path& path, const std::string& variable);

/// The variables of a netCDF file that can be read as images.
std::vector<ImageVariable> list_netcdf(const std::filesystem::path& path);

}  // namespace tegl::io_detail
