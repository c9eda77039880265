// SPDX-License-Identifier: BSD-3-Clause
//
// Writing of meshes to a pending file: for the program, which puts several files in place together.
#pragma once

#include "tegl/io/meshes.hpp"

namespace tegl {

class PendingPath;

/// As write_mesh of tegl/io/meshes.hpp; the caller commits the file.
void write_mesh(const MeshView& mesh, const PendingPath& file, const WriteOptions& options);

}  // namespace tegl
