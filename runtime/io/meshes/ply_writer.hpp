// SPDX-License-Identifier: BSD-3-Clause
//
// Writes PLY.
#pragma once

#include "base/pending_path.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::io_detail {

/// Writes a mesh to a pending file. Errors: those of write_mesh.
void write_ply(const MeshView& mesh, const PendingPath& file, const Progress& progress);

}  // namespace tegl::io_detail
