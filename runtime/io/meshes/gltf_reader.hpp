// SPDX-License-Identifier: BSD-3-Clause
//
// Reads glTF 2.0: .gltf and .glb.
#pragma once

#include <filesystem>

#include "base/mesh_data.hpp"

namespace tegl::io_detail {

/// `allow_outside_paths`: see ReadMeshOptions.
Mesh read_gltf(const std::filesystem::path& path, ReadProgress& progress, bool allow_outside_paths);

}  // namespace tegl::io_detail
