// SPDX-License-Identifier: BSD-3-Clause
//
// Reads and writes whole meshes as VTKHDF.
#pragma once

#include <filesystem>

#include "base/mesh_data.hpp"
#include "base/pending_path.hpp"

namespace tegl::io_detail {

/// Writes a mesh to a pending file. Errors: those of write_mesh.
void write_vtkhdf(const MeshView& mesh, const PendingPath& file, const Progress& progress, Compression compression);
/// `allow_outside_paths`: see ReadMeshOptions.
Mesh read_vtkhdf(const std::filesystem::path& path, ReadProgress& progress, bool allow_outside_paths);

}  // namespace tegl::io_detail
