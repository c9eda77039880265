// SPDX-License-Identifier: BSD-3-Clause
//
// Source and destination of vertices on critical edges, for the passes that write them.
#pragma once

#include <cstddef>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Output range for vertices, indexed by number. Numbers count modulo 2^32, so a contour may have more vertices than
/// that, but a part of it may not.
template <class Vertex>
struct VertexRun {
  Vertex* data;
  Index first;
  Vertex* normals = nullptr;  ///< null: no normals requested
  Vertex& operator[](Index id) const noexcept { return data[static_cast<Index>(id - first)]; }
  Vertex& normal(Index id) const noexcept { return normals[static_cast<Index>(id - first)]; }
};

/// Source and destination of edges for a chunk of rows: edges in a layer, and edges along the last axis in the slab
/// below it.
template <class Vertex>
struct EdgeTarget {
  struct Run {
    std::size_t layer = 0;  ///< layer in which the edges start
    Vertex* end = nullptr;  ///< limit for stores that are later overwritten
  };
  Run in_layer, in_slab;
  VertexRun<Vertex> vertices;
};

}  // namespace tegl::detail
