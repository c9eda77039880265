// SPDX-License-Identifier: BSD-3-Clause
//
// Reads files of any image format.
#pragma once

#include <filesystem>

#include "base/raw_image.hpp"
#include "base/raw_layers.hpp"

namespace tegl::io_detail {

/// Reads a file of any format; trailing axes of one sample are dropped.
RawImage read_any(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options);
/// Opens a file of any format. UnsupportedData if it cannot be read layer by layer.
RawLayers open_any_layers(const std::filesystem::path& path, const ReadImageOptions& options);

}  // namespace tegl::io_detail
