// SPDX-License-Identifier: BSD-3-Clause
//
// Reads Wavefront OBJ.
#pragma once

#include <filesystem>

#include "base/mesh_data.hpp"

namespace tegl::io_detail {

/// Reads the triangles of a file, with polygons triangulated as fans; if there are none, the segments. Vertices are
/// those of the file in its order, used or not. Normals are read if there is one for each vertex, and every corner of a
/// face refers to the normal of its vertex's number. Errors: MalformedFile (with the line), UnsupportedData (neither
/// triangles nor segments), TooLarge (more vertices than Index can number).
Mesh read_obj(const std::filesystem::path& path, ReadProgress& progress);

}  // namespace tegl::io_detail
