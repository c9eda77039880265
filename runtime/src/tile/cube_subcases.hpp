// SPDX-License-Identifier: BSD-3-Clause
//
// The lists of the table of cubes with every ambiguity resolved freely, as parts of Sigma in each of the eight cubes of
// a 4D tile. Computed once per triangulation.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/generated/tables.hpp"
#include "tegl/tile/facets.hpp"
#include "tile/cube_key.hpp"

namespace tegl::detail {

/// A list of the table and its cube.
struct CubeList {
  const tables::ResolvedList* list;  ///< in the compact triangulation
  std::uint8_t signature;
  std::uint8_t high_squares;  ///< among the ambiguous squares
};

/// All lists in all cubes of a 4D tile, in the form that ResolvedTesseract reads.
class ResolvedCubes {
 public:
  static constexpr unsigned kCubes = 8;
  static constexpr unsigned kEdges = 32;     ///< of the tile
  static constexpr unsigned kMostOwn = 3;    ///< maximum per list
  static constexpr unsigned kMostParts = 4;  ///< maximum per list, and undefined entries after the parts of each list
  static constexpr unsigned kVertices = kEdges + kCubes * kMostOwn;
  static constexpr std::uint16_t kNone = 0xffff;  ///< cube without a contour

  /// A connected component of a list in one of the cubes.
  struct Part {
    std::uint32_t
        apexes;  ///< edges of the tile that may be a cone apex: those not in the part, and those that pass may_be_apex
    std::uint32_t first_triangle;
    std::uint8_t triangle_count;
    std::uint8_t cube;
  };

  /// Properties of a list that are the same in every cube.
  struct Summary {
    std::uint32_t first_part;  ///< relative to the cube's first part
    std::uint8_t part_count, triangle_count;
    std::uint8_t is_not_low;  ///< whether it differs from the low-connected contour
    std::uint8_t own_vertices;
    std::uint8_t barycentres;  ///< number of own vertices that are barycentres of polygons; they come first
  };

  using Lists = std::array<std::uint16_t, kCubes>;  ///< by cube of a tile

  /// List numbers are the same in both triangulations.
  static const ResolvedCubes& instance(Triangulation triangulation = Triangulation::compact);

  /// Byte f: signature of cube f.
  [[nodiscard]] std::uint64_t signatures(std::uint16_t tile) const noexcept {
    return signatures_[0][tile & 255u] | signatures_[1][tile >> 8];
  }
  /// Byte f, bit q: whether square q of cube f is high. `tile`: bits numbered as kTesseractSquares.
  [[nodiscard]] std::uint64_t squares(std::uint32_t tile) const noexcept {
    std::uint64_t result = 0;
    for (unsigned pair = 0; pair < 6; ++pair) result |= squares_[pair][tile >> (4 * pair) & 15u];
    return result;
  }
  /// Entry of tables::kTile3Resolved. Bits of `high_squares` for unambiguous squares are ignored.
  [[nodiscard]] unsigned entry(unsigned signature, unsigned high_squares) const noexcept {
    const Signature of = of_signatures_[signature];
    return unsigned{of.first_entry} + kPackedSquares[of.ambiguous][high_squares];
  }
  /// Number of a list, less than lists().size(), or kNone for a cube of one sign.
  [[nodiscard]] std::uint16_t list(unsigned signature, unsigned high_squares, tile::Choice choice) const noexcept {
    return list_of_entry(entry(signature, high_squares), choice);
  }
  /// Number of a list by entry of tables::kTile3Resolved.
  [[nodiscard]] std::uint16_t list_of_entry(unsigned entry, tile::Choice choice) const noexcept {
    return list_of_[3 * entry + static_cast<unsigned>(choice)];
  }
  /// Whether the choice matters for an entry.
  [[nodiscard]] bool has_choice(unsigned entry) const noexcept { return has_choice_[entry] != 0; }
  /// Number of own vertices of a list; 0 for kNone.
  [[nodiscard]] unsigned own_vertices(unsigned list) const noexcept { return summary(list).own_vertices; }
  /// A key whose filling is the list.
  [[nodiscard]] CubeKey key(unsigned list) const noexcept { return key_of_[list]; }
  [[nodiscard]] const std::vector<CubeList>& lists() const noexcept { return lists_; }
  /// Triangles of a list in the cube, three local vertices each.
  [[nodiscard]] std::span<const std::uint8_t> triangles_of(unsigned list) const noexcept {
    return {of_cube_.data() + first_of_cube_[list], of_cube_.data() + first_of_cube_[list + 1]};
  }
  /// Corners (bit v) and edges (bit 8 + e) between which own vertex `own` of a list lies.
  [[nodiscard]] std::uint32_t mask(unsigned list, unsigned own) const noexcept { return masks_[list][own]; }
  [[nodiscard]] const Summary& summary(unsigned list) const noexcept {
    return summaries_.data()[std::min<std::size_t>(list, summaries_.size() - 1)];
  }
  /// For a list in a cube: edges that may be a cone's apex, if all parts of the list are connected through other cubes.
  [[nodiscard]] std::uint32_t apexes(unsigned cube, unsigned list) const noexcept {
    return apexes_.data()[cube * summaries_.size() + std::min<std::size_t>(list, summaries_.size() - 1)];
  }
  /// Number of a cube's first part.
  [[nodiscard]] std::uint32_t first_part(unsigned cube) const noexcept { return cube * parts_of_cube_; }
  [[nodiscard]] const Part& part(std::uint32_t number) const noexcept { return parts_.data()[number]; }
  /// Vertex sets of parts, by number.
  [[nodiscard]] const std::uint64_t* part_vertices() const noexcept { return part_vertices_.data(); }
  /// Triangles as words: a zero byte and three vertices, so that the cone from `apex` is word | apex_word(apex).
  /// kWordsBehind undefined words follow the last.
  static constexpr unsigned kWordsBehind = 8;
  [[nodiscard]] const std::uint32_t* triangles(const Part& part) const noexcept {
    return triangles_.data() + part.first_triangle;
  }
  static std::uint32_t apex_word(unsigned apex) noexcept {
    return std::bit_cast<std::uint32_t>(std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(apex), 0, 0, 0});
  }
  /// All vertices that share a cube with the vertex on an edge, including itself.
  [[nodiscard]] std::uint64_t beside(unsigned edge) const noexcept { return beside_[edge]; }
  /// Edges of the tile that belong to a cube.
  [[nodiscard]] std::uint32_t edges_of(unsigned cube) const noexcept { return edges_of_[cube]; }
  /// Local vertex of the tile for a local vertex of a cube's list.
  [[nodiscard]] unsigned lifted(unsigned cube, unsigned vertex) const noexcept { return lifted_[cube][vertex]; }
  /// Whether (apex, triangle) faces the low side if the triangle, in the cube, faces the high side.
  [[nodiscard]] bool is_reversed(unsigned cube) const noexcept { return reversed_[cube]; }

 private:
  explicit ResolvedCubes(Triangulation triangulation);
  void number_lists(Triangulation triangulation);
  void take_compact(const tables::ResolvedList& list);
  void take_barycentric();
  void make_frames();
  void make_parts(unsigned cube, unsigned list);

  std::array<std::array<std::uint64_t, 256>, 2> signatures_{};
  std::array<std::array<std::uint64_t, 16>, 6> squares_{};
  struct Signature {
    std::uint16_t first_entry;
    std::uint16_t ambiguous;  ///< ambiguous squares
  };
  std::array<Signature, 256> of_signatures_{};
  std::vector<CubeList> lists_;
  std::vector<std::uint16_t> list_of_;
  std::vector<CubeKey> key_of_;        ///< by list
  std::vector<std::uint8_t> of_cube_;  ///< triangles of the lists
  std::vector<std::uint32_t> first_of_cube_{0};
  std::vector<std::array<std::uint32_t, kMostOwn>> masks_;  ///< by list
  std::vector<Summary> summaries_;                          ///< by list, then for kNone
  std::vector<std::uint8_t> has_choice_;                    ///< by entry
  std::vector<std::uint32_t> apexes_;                       ///< by cube, then by list and kNone
  std::uint32_t parts_of_cube_ = 0;
  std::vector<Part> parts_;
  std::vector<std::uint64_t> part_vertices_;
  std::vector<std::uint32_t> triangles_;
  std::array<std::uint64_t, kEdges> beside_{};
  std::array<std::uint32_t, kCubes> edges_of_{};
  std::array<std::array<std::uint8_t, 12 + kMostOwn>, kCubes> lifted_{};
  std::array<bool, kCubes> reversed_{};
};

/// Number of the list (ResolvedCubes) for a cube's key; kNone for a cube without a contour.
unsigned list_of_key(CubeKey key) noexcept;

}  // namespace tegl::detail
