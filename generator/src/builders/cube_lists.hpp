// SPDX-License-Identifier: BSD-3-Clause
//
// The lists of the cube with every ambiguity resolved freely, as parts of Sigma in each of the eight cubes of a
// tesseract: data of the tesseract's builder.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cubes/resolved_cube.hpp"
#include "tables/variant_tables.hpp"
#include "tegl/tile/triangulation.hpp"

namespace tegl::gen {

/// All lists in all cubes of a tesseract. Local vertices of the tesseract: [0, 32) are on its edges; 32 + 4 f + j is
/// own vertex j of cube f's list.
struct CubeLists {
  static constexpr unsigned kCubes = 8;
  static constexpr unsigned kEdges = 32;
  static constexpr unsigned kCubeEdges = 12;
  static constexpr unsigned kMostOwn = 4;    ///< own vertices of a list, at most
  static constexpr unsigned kMostParts = 4;  ///< parts of a list, at most
  static constexpr std::uint16_t kNone = 0xffff;

  /// A distinct list: the first entry and choice of the resolved cube that has it.
  struct List {
    std::uint16_t entry;
    std::uint8_t choice, signature, high_squares;
    std::uint8_t own_vertices = 0, barycentres = 0, triangle_count = 0;
    std::uint16_t key = 0;                        ///< of the list in tables::VariantTable
    std::uint32_t first_triangle = 0;             ///< in `triangles`
    std::array<std::uint32_t, kMostOwn> masks{};  ///< corners (bit v) and edges (bit 8 + e) of own vertices
    std::uint32_t first_part = 0;                 ///< relative to the cube's first part
    std::uint8_t part_count = 0;
    std::uint16_t not_apexes = 0;  ///< edges of the cube that may not be a cone's apex, if cubes connect all parts
  };
  /// A connected component of a list in one of the cubes.
  struct Part {
    std::uint16_t not_apexes;      ///< edges of the cube that may not be a cone apex
    std::uint32_t first_triangle;  ///< in `words`
    std::uint8_t triangle_count, cube;
    std::uint64_t vertices;
  };

  Triangulation triangulation = Triangulation::compact;
  std::vector<List> lists;
  std::vector<std::uint16_t> list_of;              ///< by 3 * entry + choice
  std::vector<std::uint8_t> triangles;             ///< of the lists, in the cube: 3 local vertices each
  std::uint32_t parts_of_cube = 0;                 ///< number of parts of a cube
  std::vector<Part> parts;                         ///< by cube, then by list
  std::vector<std::array<std::uint8_t, 4>> words;  ///< triangles by part, in the cube: 128 and three local vertices

  /// Triangles of a list in the cube.
  [[nodiscard]] std::span<const std::uint8_t> triangles_of(std::size_t list) const {
    return {triangles.data() + 3 * std::size_t{lists[list].first_triangle},
            3 * std::size_t{lists[list].triangle_count}};
  }
};

/// Local vertex of the tesseract for a local vertex of a list in cube f.
[[nodiscard]] unsigned lifted_vertex(unsigned f, unsigned vertex);

/// Compact lists are those of the resolved cube; barycentric ones those of `variants`, which 3D images use.
[[nodiscard]] CubeLists make_cube_lists(const ResolvedCube& cube, const VariantTables& variants);

}  // namespace tegl::gen
