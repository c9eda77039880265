// SPDX-License-Identifier: BSD-3-Clause
//
// Layers of images of any type and dimension, and of headerless raw files.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/raw_layers.hpp"
#include "process/separate_reading.hpp"
#include "tegl/io/layers.hpp"

namespace tegl::io_detail {

/// Converts to layers of the library's value types and dimensions.
OpenLayersResult to_open_layers(RawLayers&& source, const std::filesystem::path& path);

/// Opens files by `open`, in a child process or in this one. Progress is reported until the files are open and not by
/// the readers of their layers, although these may keep a copy of the callback that `open` takes.
LayersOfFiles open_reporting(const std::filesystem::path& path, const Progress& progress, bool separate,
                             const std::function<LayersOfFiles(const Progress&)>& open);

/// Opens a headerless raw file.
RawLayers open_raw(const std::filesystem::path& path, const RawLayout& layout);

/// One remark on the raw files of `files` that have bytes after the last sample, if there are any: the sizes, the type
/// or the offset may be wrong. It names up to three files.
std::vector<std::string> remarks_on_rest(std::span<const std::filesystem::path> files, const RawLayout& layout);

}  // namespace tegl::io_detail
