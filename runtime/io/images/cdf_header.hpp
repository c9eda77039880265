// SPDX-License-Identifier: BSD-3-Clause
//
// A check of classic netCDF files before the netCDF library opens them, which overruns its callers' buffers with long
// names and reads zeros beyond the end of a truncated file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace tegl::io_detail {

/// True if the bytes start as a classic netCDF file does (CDF-1, CDF-2 or CDF-5).
bool is_classic_netcdf(std::span<const unsigned char> prefix);

/// Throws MalformedFile unless the header of the classic file at `path` is sound and every variable that it lists
/// lies within the file.
void check_classic_netcdf(const std::filesystem::path& path);

/// How many bytes of a classic file its header and variables take; 0 if the header goes on after `bytes`, the first
/// ones of the file. `most`: a size that the file cannot exceed. Errors: those of check_classic_netcdf; `path` is for
/// these.
std::uint64_t bytes_of_classic_netcdf(std::span<const unsigned char> bytes, std::uint64_t most,
                                      const std::filesystem::path& path);

}  // namespace tegl::io_detail
