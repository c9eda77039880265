// SPDX-License-Identifier: BSD-3-Clause
//
// Reads headers of NIfTI-1.
#pragma once

#include <filesystem>

#include "images/stored_image.hpp"

namespace tegl::io_detail {

/// `keep_stored`: see ReadImageOptions.
StoredImage open_nifti(const std::filesystem::path& path, bool keep_stored);

}  // namespace tegl::io_detail
