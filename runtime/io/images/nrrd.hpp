// SPDX-License-Identifier: BSD-3-Clause
//
// Reads headers of NRRD.
#pragma once

#include <filesystem>

#include "images/stored_image.hpp"

namespace tegl::io_detail {

/// `allow_outside_paths`: see ReadImageOptions.
StoredImage open_nrrd(const std::filesystem::path& path, bool allow_outside_paths);

}  // namespace tegl::io_detail
