// SPDX-License-Identifier: BSD-3-Clause
//
// A check of classic netCDF files before the netCDF library opens them: it reads what lies beyond the end of a
// truncated file as zeros.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace tegl::io_detail {

/// True if the bytes start as a classic netCDF file does (CDF-1, CDF-2 or CDF-5).
bool is_classic_netcdf(std::span<const unsigned char> prefix);

/// Throws MalformedFile unless the header of the classic file at `path` is sound and every variable that it lists
/// lies within the file. `content`: the file's bytes where they are in memory (a compressed file), else empty.
void check_classic_netcdf(const std::filesystem::path& path, std::span<const unsigned char> content);

}  // namespace tegl::io_detail
