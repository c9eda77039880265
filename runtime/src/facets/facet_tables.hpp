// SPDX-License-Identifier: BSD-3-Clause
//
// Symbolic facets of the faces of a grid: by dimension and signature, the facets of a face and the facets of its own
// faces that bound each of them. No positions and no triangulation.
//
// Based on: M. Liversage, thesis, 1994, section 7.6 (facets by recursion over dimension). A facet is a component of the
// union of the facets in the face's own faces. In squares, cubes and tesseracts with every ambiguity resolved the same
// way, each component bounds its own facet. If ambiguities are resolved from the data, the signature does not determine
// the facets: faces have types instead. A cube may then have a tunnel, between several components. Its triangles, from
// the table of the cube (table_contract.hpp), are the facets in that case, and have points and segments inside the
// cube.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/extract.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// A facet in the boundary of another: facet `number` of face 2 a + side. That face is at the lower (side 0) or upper
/// end of axis a and has the other axes in ascending order; face 6 of a cube stands for the segments inside it. `sign`:
/// the incidence number.
struct FacetEntry {
  std::uint8_t face;
  std::uint8_t number;
  std::int8_t sign;
};

/// Faces have up to kMaxDim dimensions; corner v has coordinate v >> a & 1 on axis a.
///
/// Orientation: a facet followed by a normal towards the high side is positive in its face's axes. So the incidence
/// number of a facet in the boundary of another is that of their faces (outward normal first). Points have no
/// orientation: the start of a 1-facet has -1, its end +1.
///
/// Order of the entries: of a segment, its start and its end; of a polygon, head to tail, along its orientation; of a
/// polyhedron, by face and number.
class FacetTables {
 public:
  static constexpr unsigned kMaxDim = 4;
  static constexpr unsigned kInside = 6;      ///< FacetEntry::face
  static constexpr unsigned kCubeEdges = 12;  ///< number of edges of a cube; numbering: table_contract.hpp

  /// Points and segments inside a cube that is resolved from the data.
  struct Inside {
    std::vector<std::uint8_t> points;  ///< numbers of the own vertices of the cube's list
    std::vector<std::array<std::uint8_t, 2>>
        segments;  ///< start and end: an edge of the cube (its point), or kCubeEdges + index in `points`
    /// Choice of the cube's centre if there is a tunnel: all corners of that sign are connected in the cube.
    tile::Choice joins = tile::Choice::separate;
  };

  /// Builds the tables of edges, squares and cubes. Types are signatures; if ambiguities are resolved from the data:
  /// square_type for squares, numbers of ResolvedCubes' lists for cubes.
  explicit FacetTables(Ambiguity ambiguity);
  static constexpr unsigned square_type(unsigned signature, bool high) noexcept {
    return signature | (high && (signature == 6 || signature == 9) ? 16u : 0u);
  }
  /// Builds the tables of the tesseracts with these signatures, the only ones that may be queried. Not thread-safe with
  /// readers. (If ambiguities are resolved from the data, see resolved_facets.hpp.)
  void add_tesseracts(std::span<const std::uint16_t> signatures);

  /// Number of facets of a face of dimension `dim`, 1 to kMaxDim.
  [[nodiscard]] unsigned count(unsigned dim, unsigned type) const noexcept {
    const Lists& lists = lists_[dim];
    return lists.first_facet[type + 1] - lists.first_facet[type];
  }
  /// Boundary of facet `number`.
  [[nodiscard]] std::span<const FacetEntry> entries(unsigned dim, unsigned type, unsigned number) const noexcept {
    const Lists& lists = lists_[dim];
    const std::size_t facet = lists.first_facet[type] + number;
    return {lists.entries.data() + lists.first_entry[facet], lists.first_entry[facet + 1] - lists.first_entry[facet]};
  }
  /// Total number of entries of all facets.
  [[nodiscard]] std::size_t entry_count(unsigned dim, unsigned type) const noexcept {
    const Lists& lists = lists_[dim];
    return lists.first_entry[lists.first_facet[type + 1]] - lists.first_entry[lists.first_facet[type]];
  }
  /// For cubes that are resolved from the data.
  [[nodiscard]] const Inside& inside(unsigned type) const noexcept { return inside_[type]; }
  /// Points of facet `number` of such a cube: bit e is the point on edge e, bit kCubeEdges + j is point j inside.
  [[nodiscard]] std::uint16_t points(unsigned type, unsigned number) const noexcept {
    return points_[lists_[3].first_facet[type] + number];
  }

 private:
  /// Types of the faces of a face, in the order of FacetEntry::face.
  using FaceTypes = std::array<unsigned, std::size_t{2} * kMaxDim>;
  struct Lists {
    std::vector<std::uint32_t> first_facet;  ///< by type, and the end
    std::vector<std::uint32_t> first_entry;  ///< by facet, and the end
    std::vector<FacetEntry> entries;
  };
  /// A facet of one of the face's own faces.
  struct Part {
    FacetEntry entry;
    std::size_t component;
    std::array<unsigned, 2> ends{};  ///< of a segment: names of the edges of its start and end
  };

  using Triangle = std::array<std::uint8_t, 3>;

  void add_signature(unsigned dim, unsigned signature);
  void add_square(unsigned signature, bool high);
  void add_cube(unsigned list);
  void add_loop(const std::vector<Part>& parts, std::size_t first);
  void add_triangle(const Triangle& triangle, const std::vector<Part>& parts, Inside& inside);
  static FaceTypes face_types(unsigned dim, unsigned signature) noexcept;
  [[nodiscard]] std::vector<Part> parts(unsigned dim, const FaceTypes& types) const;
  void join_parts(unsigned dim, const FaceTypes& types, std::vector<Part>& parts) const;
  /// Numbers of the parts of a cycle, head to tail, starting with `first`.
  static std::vector<std::size_t> loop(const std::vector<Part>& parts, std::size_t first);

  Ambiguity ambiguity_;
  std::array<Lists, kMaxDim + 1> lists_;  ///< by dimension; 0: none
  std::vector<Inside> inside_;            ///< by type of cubes
  std::vector<std::uint16_t> points_;     ///< by facet of cubes
};

}  // namespace tegl::detail
