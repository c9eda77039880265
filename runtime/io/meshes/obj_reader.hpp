// SPDX-License-Identifier: BSD-3-Clause
//
// The reader of Wavefront OBJ.
#pragma once

#include <filesystem>

#include "base/mesh_formats.hpp"

namespace tegl::io_detail {

/// The triangles of the file, polygons cut into fans; the segments where there are no triangles. Vertices are those of
/// the file in its order, used or not. Normals are taken where there is one for each vertex and every corner of a face
/// names the one of its vertex's number. Errors: MalformedFile (with the line), UnsupportedData (neither triangles nor
/// segments), TooLarge (more vertices than Index counts).
Mesh read_obj(const std::filesystem::path& path, ReadProgress& progress);

}  // namespace tegl::io_detail
