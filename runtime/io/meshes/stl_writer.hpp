// SPDX-License-Identifier: BSD-3-Clause
//
// Writes binary STL.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/pending_path.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::io_detail {

/// Writes a mesh to a pending file. Errors: those of write_mesh.
void write_stl(const MeshView& mesh, const PendingPath& file, const Progress& progress);

/// Converts the count to the 32-bit field of the file; TooLarge beyond 2^32 - 1.
std::uint32_t stl_triangle_count(std::uint64_t triangles, const std::filesystem::path& path);

}  // namespace tegl::io_detail
