// SPDX-License-Identifier: BSD-3-Clause
//
// Reads PLY.
#pragma once

#include <filesystem>

#include "base/mesh_data.hpp"

namespace tegl::io_detail {

Mesh read_ply(const std::filesystem::path& path, ReadProgress& progress);

}  // namespace tegl::io_detail
