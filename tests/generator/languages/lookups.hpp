// SPDX-License-Identifier: BSD-3-Clause
//
// The look-up functions of one emitted table in any language, as function pointers.
#pragma once

#include <cstdint>

#include "tegl/tile/triangulation.hpp"

namespace tegl::test {

/// Functions that a table lacks are null: only 4D has side vertices.
struct Lookups {
  std::uint32_t (*simplex_count)(std::uint32_t signature);
  std::uint32_t (*cone_vertices)(std::uint32_t signature);
  std::uint32_t (*vertex)(std::uint32_t signature, std::uint32_t simplex, std::uint32_t corner);
  std::uint32_t (*edge_corner)(std::uint32_t edge, std::uint32_t end);
  std::uint32_t (*side_vertices)(std::uint32_t signature);
  std::uint32_t (*side_mask)(std::uint32_t signature, std::uint32_t side, std::uint32_t half);
  std::uint32_t corners, edges, first_tile_vertex, max_simplices, max_tile_vertices, words;
};

/// For glsl and wgsl in 4D, `words` is the content of a shader's storage buffer; it is not copied.
Lookups glsl_lookups(int dim, Triangulation triangulation, const std::uint32_t* words);
Lookups wgsl_lookups(int dim, Triangulation triangulation, const std::uint32_t* words);
Lookups cuda_lookups(int dim, Triangulation triangulation);

/// The look-up functions of the complete table of the cube.
struct ResolvedLookups {
  std::uint32_t (*ambiguous_squares)(std::uint32_t signature);
  std::uint32_t (*entry)(std::uint32_t signature, std::uint32_t high_squares);
  std::uint32_t (*triangle_count)(std::uint32_t entry, std::uint32_t centre);
  std::uint32_t (*vertex)(std::uint32_t entry, std::uint32_t centre, std::uint32_t triangle, std::uint32_t corner);
  std::uint32_t (*own_vertices)(std::uint32_t entry, std::uint32_t centre);
  std::uint32_t (*own_mask)(std::uint32_t entry, std::uint32_t centre, std::uint32_t own);
};

ResolvedLookups glsl_resolved_lookups();
ResolvedLookups wgsl_resolved_lookups();
ResolvedLookups cuda_resolved_lookups();

}  // namespace tegl::test

#define TEGL_RESOLVED_LOOKUPS                                                                             \
  ResolvedLookups {                                                                                       \
    tegl_tile3_resolved_ambiguous_squares, tegl_tile3_resolved_entry, tegl_tile3_resolved_triangle_count, \
        tegl_tile3_resolved_vertex, tegl_tile3_resolved_own_vertices, tegl_tile3_resolved_own_mask        \
  }

// A table's Lookups from its prefix; `sides` are its two functions for side vertices, or nullptr, nullptr.
#define TEGL_LOOKUPS(prefix, ...)                                                                       \
  Lookups {                                                                                             \
    prefix##_simplex_count, prefix##_cone_vertices, prefix##_vertex, prefix##_edge_corner, __VA_ARGS__, \
        prefix##_CORNERS, prefix##_EDGES, prefix##_FIRST_TILE_VERTEX, prefix##_MAX_SIMPLICES,           \
        prefix##_MAX_TILE_VERTICES, prefix##_WORDS                                                      \
  }
#define TEGL_LOOKUPS_WITHOUT_SIDES(prefix) TEGL_LOOKUPS(prefix, nullptr, nullptr)
#define TEGL_LOOKUPS_WITH_SIDES(prefix) TEGL_LOOKUPS(prefix, prefix##_side_vertices, prefix##_side_mask)
