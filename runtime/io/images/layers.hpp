// SPDX-License-Identifier: BSD-3-Clause
//
// Layers of images of any type and dimension, and of headerless raw files.
#pragma once

#include <filesystem>

#include "base/raw_layers.hpp"
#include "tegl/io/layers.hpp"

namespace tegl::io_detail {

/// Converts to layers of the library's value types and dimensions.
OpenLayersResult to_open_layers(RawLayers&& source, const std::filesystem::path& path);

/// Opens a headerless raw file.
RawLayers open_raw(const std::filesystem::path& path, const RawLayout& layout);

}  // namespace tegl::io_detail
