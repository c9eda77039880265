// SPDX-License-Identifier: BSD-3-Clause
//
// The facets of the faces of a grid as symbols: for each dimension and signature, which facets a face has, and which
// facets of its own faces each of them is bounded by. No positions and no triangulation.
//
// Based on: M. Liversage, thesis, 1994, section 7.6 (facets by recursion over dimension). A facet is a component of
// what the facets in the face's own faces make up. In squares, cubes and tesseracts with every ambiguity resolved the
// same way, each component bounds a facet of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/extract.hpp"

namespace tegl::detail {

/// One facet of those that bound another: facet `number` of face 2 a + side, which is at the lower (side 0) or upper
/// end of axis a and has the other axes in ascending order. `sign`: its incidence number.
struct FacetEntry {
  std::uint8_t face;
  std::uint8_t number;
  std::int8_t sign;
};

/// Faces have up to kMaxDim dimensions; corner v has coordinate v >> a & 1 on axis a.
///
/// Orientation: a facet followed by a normal towards the high side is positive in its face's axes. Then the incidence
/// number of a facet in the boundary of another is that of their faces (outward normal first). Points have none: the
/// start of a 1-facet has -1, its end +1.
///
/// Order of the entries: of a segment, its start and its end; of a polygon, head to tail, along its orientation; of a
/// polyhedron, by face and number.
class FacetTables {
 public:
  static constexpr unsigned kMaxDim = 4;

  /// Makes those of edges, squares and cubes.
  explicit FacetTables(Ambiguity ambiguity);
  /// Makes those of the tesseracts with these signatures, which are asked for alone. Not while others read.
  void add_tesseracts(std::span<const std::uint16_t> signatures);

  /// How many facets a face of dimension `dim` has, 1 to kMaxDim.
  [[nodiscard]] unsigned count(unsigned dim, unsigned signature) const noexcept {
    const Lists& lists = lists_[dim];
    return lists.first_facet[signature + 1] - lists.first_facet[signature];
  }
  /// What bounds facet `number`.
  [[nodiscard]] std::span<const FacetEntry> entries(unsigned dim, unsigned signature, unsigned number) const noexcept {
    const Lists& lists = lists_[dim];
    const std::size_t facet = lists.first_facet[signature] + number;
    return {lists.entries.data() + lists.first_entry[facet], lists.first_entry[facet + 1] - lists.first_entry[facet]};
  }
  /// What bounds all of them together.
  [[nodiscard]] std::size_t entry_count(unsigned dim, unsigned signature) const noexcept {
    const Lists& lists = lists_[dim];
    return lists.first_entry[lists.first_facet[signature + 1]] - lists.first_entry[lists.first_facet[signature]];
  }

 private:
  struct Lists {
    std::vector<std::uint32_t> first_facet;  ///< by signature, and the end
    std::vector<std::uint32_t> first_entry;  ///< by facet, and the end
    std::vector<FacetEntry> entries;
  };
  /// A facet of one of the face's own faces.
  struct Part {
    FacetEntry entry;
    std::size_t component;
    std::array<unsigned, 2> ends{};  ///< of a segment: the numbers of the edges that it runs from and to
  };

  void add_signature(unsigned dim, unsigned signature);
  void add_square(unsigned signature);
  [[nodiscard]] std::vector<Part> parts(unsigned dim, unsigned signature) const;
  void join_parts(unsigned dim, unsigned signature, std::vector<Part>& parts) const;

  Ambiguity ambiguity_;
  std::array<Lists, kMaxDim + 1> lists_;  ///< by dimension; 0: none
};

/// The signature of the face of a `dim`-cube at the lower (side 0) or upper end of an axis.
constexpr unsigned face_signature(unsigned dim, unsigned signature, unsigned axis, unsigned side) noexcept {
  unsigned result = 0;
  for (unsigned v = 0, to = 0; v < 1u << dim; ++v)
    if ((v >> axis & 1u) == side) result |= (signature >> v & 1u) << to++;
  return result;
}

/// The incidence number of that face in the cube: outward normal first, axes ascending.
constexpr int face_sign(unsigned axis, unsigned side) noexcept { return (axis % 2 == 0) == (side == 1) ? 1 : -1; }

}  // namespace tegl::detail
