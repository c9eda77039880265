// SPDX-License-Identifier: BSD-3-Clause
//
// Indexes of active tiles in files (.tindex). Link with tegl::io. Thread-safe on different files.
#pragma once

#include <filesystem>
#include <memory>

#include "tegl/active_tiles.hpp"

namespace tegl {

/// The extension of index files.
inline constexpr const char* kIndexExtension = ".tindex";

/// Writes an index. Written under another name beside the target and renamed at the end: never half a file. Errors:
/// WriteFailed, InvalidArgument (see ActiveTiles::save).
template <int N>
void write_active_tiles(const ActiveTiles<N>& active, const std::filesystem::path& path);

/// Reads an index and makes sure that it belongs to the image. Errors, naming the file: FileNotFound, and those of
/// load_active_tiles.
template <Value T, int N>
std::unique_ptr<ActiveTiles<N>> read_active_tiles(const std::filesystem::path& path, const Image<T, N>& image,
                                                  const ActiveTilesOptions& options = {});

/// What the beginning of an index file says. Errors, naming the file: FileNotFound, MalformedFile, UnsupportedFormat.
ActiveTilesHead read_active_tiles_head(const std::filesystem::path& path);

/// The same, once all of the file has been read and found undamaged.
ActiveTilesHead check_active_tiles(const std::filesystem::path& path);

}  // namespace tegl
