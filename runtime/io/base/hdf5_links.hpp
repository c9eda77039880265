// SPDX-License-Identifier: BSD-3-Clause
//
// Checks files that an HDF5 file refers to, by external links, external storage and virtual datasets. The library
// follows them automatically to any place, so they are checked before reading.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace tegl::io_detail {

/// The library that reads the file after the check. HDF5 resolves names of external storage relative to the current
/// folder, as in netCDF-C, unless a dataset is opened with the prefix "${ORIGIN}", as in `H5File::open`.
enum class Hdf5Reader {
  netcdf,  ///< netCDF-C: reads all groups at opening, through every link
  h5file,  ///< H5File: reads only requested names
};

/// Checks all groups and datasets of an HDF5 file, and of the HDF5 files that it names. `content`: the bytes of the
/// file if they are in memory; needed only during the call. Returns the total size of the file and all files that it
/// names. Errors: MalformedFile for a file that cannot be opened, for groups nested deeper than 32, and for netCDF-C
/// also for a group with two links, soft ones included; UnsupportedData for files outside of the folder of `path`,
/// unless `allow_outside_paths`, and for virtual datasets with a pattern of file names, or with a relative name of a
/// missing file, which HDF5 searches in other folders too.
std::uint64_t check_hdf5_links(const std::filesystem::path& path, std::span<const unsigned char> content,
                               Hdf5Reader reader, bool allow_outside_paths);

}  // namespace tegl::io_detail
