// SPDX-License-Identifier: BSD-3-Clause
//
// Writing of contours without triangulation: segments, polygons and polyhedra. Link with tegl::io; the rules for
// threads in tegl/io.hpp apply.
#pragma once

#include <filesystem>

#include "tegl/facet_hierarchy.hpp"
#include "tegl/io/write_options.hpp"

namespace tegl {

/// Writes a contour's facets without triangulation; the extension selects the format. .vtu (XML, raw appended data)
/// holds the segments of 2D contours (VTK_LINE), the polygons of 3D ones (VTK_POLYGON) and the polyhedra of 4D ones
/// (VTK_POLYHEDRON, with t as a point array). .vtkhdf holds the first two; VTK 9.1 does not read its polyhedra.
/// Vertices, names, units, normals and compression as in write_mesh, lossless. Polygons of a polyhedron are oriented as
/// parts of its boundary. Cell arrays: `sample` and `signature`, as in FacetPlace, and `cap`, 1 for caps. For Real =
/// float, vertices and normals are float and vertex numbers have 32 bits. There is never a partial file. Memory: a few
/// numbers per facet; for compressed .vtu the size of the file. Errors: UnsupportedFormat, WriteFailed, Cancelled.
/// read_mesh does not read polygons and polyhedra.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void write_facets(const FacetHierarchy<N, Real>& facets, const std::filesystem::path& path,
                  const WriteOptions& options = {});

}  // namespace tegl
