// SPDX-License-Identifier: BSD-3-Clause
//
// Reads headers of NIfTI-1.
#pragma once

#include <filesystem>

#include "images/stored_image.hpp"

namespace tegl::io_detail {

StoredImage open_nifti(const std::filesystem::path& path);

}  // namespace tegl::io_detail
