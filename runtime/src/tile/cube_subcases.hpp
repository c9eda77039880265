// SPDX-License-Identifier: BSD-3-Clause
//
// The lists of the table of the cube with every ambiguity resolved freely, as parts of Sigma in each of the eight cubes
// of a tile of four dimensions. Made once for each triangulation.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/facets/facets.hpp"
#include "tegl/generated/tables.hpp"
#include "tile/cube_key.hpp"

namespace tegl::detail {

/// Triangulations by the numbers of the generated tables (tables::tile_table).
inline constexpr int kBarycentric = 0, kCompact = 1;

/// A list of the table, and what is known of the cube.
struct CubeList {
  const tables::ResolvedList* list;  ///< in the compact triangulation
  std::uint8_t signature;
  std::uint8_t high_squares;  ///< of those that are ambiguous
};

/// Places of vertices in a cube, by local vertex of its lists; own vertices by their mask.
std::array<double, 3> cube_vertex_place(const tables::ResolvedList& list, unsigned vertex);

class ResolvedCubes {
 public:
  static constexpr unsigned kCubes = 8;
  static constexpr unsigned kEdges = 32;     ///< of the tile
  static constexpr unsigned kMostOwn = 3;    ///< of a list
  static constexpr unsigned kMostParts = 4;  ///< likewise; so many stand behind the parts of each, whatever they are
  static constexpr unsigned kVertices = kEdges + kCubes * kMostOwn;
  static constexpr std::uint16_t kNone = 0xffff;  ///< a cube without a contour

  /// A connected part of a list in one of the cubes.
  struct Part {
    std::uint32_t
        apexes;  ///< edges of the tile: those not in the part, and those joined with each of its other vertices
    std::uint32_t first_triangle;
    std::uint8_t triangle_count;
    std::uint8_t cube;
  };

  /// What is looked at of a list, in any cube.
  struct Summary {
    std::uint32_t first_part;  ///< from the cube's first one on
    std::uint8_t part_count, triangle_count;
    std::uint8_t is_not_low;  ///< whether it is not that of the low-connected contour
    std::uint8_t own_vertices;
    std::uint8_t barycentres;  ///< so many of the own vertices, the first ones, are barycentres of polygons
  };

  using Lists = std::array<std::uint16_t, kCubes>;  ///< of each cube of a tile

  /// The numbers of lists are the same in both triangulations.
  static const ResolvedCubes& instance(int triangulation = kCompact);

  /// Byte f: the signature of cube f.
  [[nodiscard]] std::uint64_t signatures(std::uint16_t tile) const noexcept {
    return signatures_[0][tile & 255u] | signatures_[1][tile >> 8];
  }
  /// Byte f: bit q, square q of cube f is high; by the numbers of kTesseractSquares.
  [[nodiscard]] std::uint64_t squares(std::uint32_t tile) const noexcept {
    std::uint64_t result = 0;
    for (unsigned pair = 0; pair < 6; ++pair) result |= squares_[pair][tile >> (4 * pair) & 15u];
    return result;
  }
  /// The entry of tables::kTile3Resolved. `high_squares`: those not ambiguous are ignored.
  [[nodiscard]] unsigned entry(unsigned signature, unsigned high_squares) const noexcept {
    const Signature of = of_signatures_[signature];
    return unsigned{of.first_entry} + compressed_[of.ambiguous << 6 | high_squares];
  }
  /// The number of a list, less than lists().size(), or kNone for a cube of one sign.
  [[nodiscard]] std::uint16_t list(unsigned signature, unsigned high_squares, facets::Choice choice) const noexcept {
    return list_of_entry(entry(signature, high_squares), choice);
  }
  /// The same by entry of tables::kTile3Resolved.
  [[nodiscard]] std::uint16_t list_of_entry(unsigned entry, facets::Choice choice) const noexcept {
    return list_of_[3 * entry + static_cast<unsigned>(choice)];
  }
  /// Whether an entry's choice matters.
  [[nodiscard]] bool has_choice(unsigned entry) const noexcept { return has_choice_[entry] != 0; }
  /// How many vertices of its own a list has; of kNone none.
  [[nodiscard]] unsigned own_vertices(unsigned list) const noexcept { return summary(list).own_vertices; }
  /// A key (tile_variants.hpp) that the list is that of.
  [[nodiscard]] std::uint16_t key(unsigned list) const noexcept { return key_of_[list]; }
  [[nodiscard]] const std::vector<CubeList>& lists() const noexcept { return lists_; }
  /// The triangles of a list in the cube, three local vertices each.
  [[nodiscard]] std::span<const std::uint8_t> triangles_of(unsigned list) const noexcept {
    return {of_cube_.data() + first_of_cube_[list], of_cube_.data() + first_of_cube_[list + 1]};
  }
  /// The corners (bit v) and edges (bit 8 + e) that own vertex `own` of a list lies between.
  [[nodiscard]] std::uint32_t mask(unsigned list, unsigned own) const noexcept { return masks_[list][own]; }
  [[nodiscard]] const Summary& summary(unsigned list) const noexcept {
    return summaries_.data()[std::min<std::size_t>(list, summaries_.size() - 1)];
  }
  /// Of a list in a cube: what is left of edges that may be apexes, where all of its parts hang together elsewhere.
  [[nodiscard]] std::uint32_t apexes(unsigned cube, unsigned list) const noexcept {
    return apexes_.data()[cube * summaries_.size() + std::min<std::size_t>(list, summaries_.size() - 1)];
  }
  /// The number of a cube's first part.
  [[nodiscard]] std::uint32_t first_part(unsigned cube) const noexcept { return cube * parts_of_cube_; }
  [[nodiscard]] const Part& part(std::uint32_t number) const noexcept { return parts_.data()[number]; }
  /// The vertices of parts, by number.
  [[nodiscard]] const std::uint64_t* part_vertices() const noexcept { return part_vertices_.data(); }
  /// Triangles as words: a zero byte, and their vertices, so that the cone from `apex` is word | apex_word(apex).
  /// Behind them stand kWordsBehind words, whatever they are.
  static constexpr unsigned kWordsBehind = 8;
  [[nodiscard]] const std::uint32_t* triangles(const Part& part) const noexcept {
    return triangles_.data() + part.first_triangle;
  }
  static std::uint32_t apex_word(unsigned apex) noexcept {
    return std::bit_cast<std::uint32_t>(std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(apex), 0, 0, 0});
  }
  /// All vertices that share a cube with the point of an edge, itself among them.
  [[nodiscard]] std::uint64_t beside(unsigned edge) const noexcept { return beside_[edge]; }
  /// The edges of the tile that a cube has.
  [[nodiscard]] std::uint32_t edges_of(unsigned cube) const noexcept { return edges_of_[cube]; }
  /// A local vertex of a cube's list as one of the tile.
  [[nodiscard]] unsigned lifted(unsigned cube, unsigned vertex) const noexcept { return lifted_[cube][vertex]; }
  /// Whether (apex, triangle) points to the low side where the triangle, in the cube, points to the high one.
  [[nodiscard]] bool is_reversed(unsigned cube) const noexcept { return reversed_[cube]; }

 private:
  explicit ResolvedCubes(int triangulation);
  void number_lists(int triangulation);
  void take_compact(const tables::ResolvedList& list);
  void take_barycentric();
  void make_frames();
  void make_parts(unsigned cube, unsigned list);

  std::array<std::array<std::uint64_t, 256>, 2> signatures_{};
  std::array<std::array<std::uint64_t, 16>, 6> squares_{};
  struct Signature {
    std::uint16_t first_entry;
    std::uint16_t ambiguous;  ///< squares
  };
  std::array<Signature, 256> of_signatures_{};
  std::array<std::uint8_t, 64 * 64> compressed_{};
  std::vector<CubeList> lists_;
  std::vector<std::uint16_t> list_of_;
  std::vector<std::uint16_t> key_of_;  ///< by list
  std::vector<std::uint8_t> of_cube_;  ///< triangles of the lists
  std::vector<std::uint32_t> first_of_cube_{0};
  std::vector<std::array<std::uint32_t, kMostOwn>> masks_;  ///< by list
  std::vector<Summary> summaries_;                          ///< likewise; behind them that of kNone
  std::vector<std::uint8_t> has_choice_;                    ///< by entry
  std::vector<std::uint32_t> apexes_;                       ///< by cube, then as summaries
  std::uint32_t parts_of_cube_ = 0;
  std::vector<Part> parts_;
  std::vector<std::uint64_t> part_vertices_;
  std::vector<std::uint32_t> triangles_;
  std::array<std::uint64_t, kEdges> beside_{};
  std::array<std::uint32_t, kCubes> edges_of_{};
  std::array<std::array<std::uint8_t, 12 + kMostOwn>, kCubes> lifted_{};
  std::array<bool, kCubes> reversed_{};
};

/// Corner of cube f of the tile with this corner of the cube.
constexpr unsigned lifted_corner(unsigned cube, unsigned corner) noexcept {
  const unsigned axis = cube / 2, below = corner & ((1u << axis) - 1);
  return below | (corner >> axis) << (axis + 1) | (cube % 2) << axis;
}

/// The number of the list (ResolvedCubes) that a cube's key stands for; kNone for a cube without a contour.
unsigned list_of_key(unsigned key) noexcept;

}  // namespace tegl::detail
