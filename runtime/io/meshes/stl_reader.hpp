// SPDX-License-Identifier: BSD-3-Clause
//
// Reads STL.
#pragma once

#include <filesystem>

#include "base/mesh_data.hpp"

namespace tegl::io_detail {

/// Merges vertices with equal (float) coordinates.
Mesh read_stl(const std::filesystem::path& path, ReadProgress& progress);

}  // namespace tegl::io_detail
