// SPDX-License-Identifier: BSD-3-Clause
//
// Indexes of active tiles in files (.tindex). Link with tegl::io. Thread-safe for different files.
#pragma once

#include <filesystem>
#include <memory>

#include "tegl/active_tiles.hpp"

namespace tegl {

/// The extension of index files.
inline constexpr const char* kIndexExtension = ".tindex";

/// Writes an index to a temporary name beside the target and renames it at the end, so there is never a partial file.
/// Errors: WriteFailed, InvalidArgument (see ActiveTiles::save), Cancelled. One thread.
template <int N>
requires DimensionBetween<N, 2, 5>
void write_active_tiles(const ActiveTiles<N>& active, const std::filesystem::path& path, const WorkOptions& work = {});

/// Reads an index and verifies that it belongs to the image. Errors, naming the file: FileNotFound, and all of
/// load_active_tiles.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::unique_ptr<ActiveTiles<N>> read_active_tiles(const std::filesystem::path& path,
                                                                const Image<T, N>& image, const WorkOptions& work = {});

/// Reads the header of an index file. Errors, naming the file: FileNotFound, MalformedFile, UnsupportedFormat.
[[nodiscard]] ActiveTilesHead read_active_tiles_head(const std::filesystem::path& path);

/// Reads the whole file, verifies that it is undamaged, and returns its header. Errors: as read_active_tiles_head.
ActiveTilesHead check_active_tiles(const std::filesystem::path& path);

}  // namespace tegl
