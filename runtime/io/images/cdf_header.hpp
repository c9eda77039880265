// SPDX-License-Identifier: BSD-3-Clause
//
// Checks classic netCDF files before the netCDF library opens them: for long names it overruns its callers' buffers,
// and it reads zeros beyond the end of a truncated file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace tegl::io_detail {

/// Whether the bytes start like a classic netCDF file (CDF-1, CDF-2 or CDF-5).
bool is_classic_netcdf(std::span<const unsigned char> prefix);

/// Throws MalformedFile unless the header of the classic file at `path` is valid and all its variables lie within the
/// file. Returns the first byte of each variable, in the order of their ids; nullopt for variables whose records lie
/// apart, with records of other variables between them.
std::vector<std::optional<std::uint64_t>> check_classic_netcdf(const std::filesystem::path& path);

/// Size in bytes of a classic file's header and variables; 0 if the header is longer than `bytes`, the start of the
/// file. `most`: an upper bound of the file size. Errors: those of check_classic_netcdf, naming `path`.
std::uint64_t bytes_of_classic_netcdf(std::span<const unsigned char> bytes, std::uint64_t most,
                                      const std::filesystem::path& path);

}  // namespace tegl::io_detail
