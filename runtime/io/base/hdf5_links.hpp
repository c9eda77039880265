// SPDX-License-Identifier: BSD-3-Clause
//
// Files that an HDF5 file leads to: by external links, external storage and virtual datasets. The library follows them
// on its own, wherever they lead, so they are checked before anything is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace tegl::io_detail {

/// What reads the file after the check. HDF5 takes names of external storage from the current folder, as netCDF-C
/// leaves it, unless a dataset is opened with the prefix "${ORIGIN}", as `H5File::open` does.
enum class Hdf5Reader {
  netcdf,  ///< netCDF-C: reads all groups when it opens the file, by every link
  h5file,  ///< H5File: what is asked for by name
};

/// Checks all groups and datasets of an HDF5 file, and of the HDF5 files that it names. `content`: the bytes of the
/// file, if they are in memory; these must outlive nothing but the call.
/// Returns the sum of the sizes of the file and of all that it names.
/// Errors: MalformedFile for a file that cannot be opened, or groups nested deeper than 32, or for
/// netCDF-C a group with two links, soft ones included; UnsupportedData for files
/// outside of the folder of `path`, unless `allow_outside_paths`, and for virtual datasets with a pattern of file
/// names, or a relative name of no file, which HDF5 looks for in other folders as well.
std::uint64_t check_hdf5_links(const std::filesystem::path& path, std::span<const unsigned char> content,
                               Hdf5Reader reader, bool allow_outside_paths);

}  // namespace tegl::io_detail
