// SPDX-License-Identifier: BSD-3-Clause
//
// Reads headers of MetaImage.
#pragma once

#include <filesystem>

#include "images/stored_image.hpp"

namespace tegl::io_detail {

/// `allow_outside_paths`: see ReadImageOptions.
StoredImage open_metaimage(const std::filesystem::path& path, bool allow_outside_paths);

}  // namespace tegl::io_detail
