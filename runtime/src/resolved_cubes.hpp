// SPDX-License-Identifier: BSD-3-Clause
//
// The lists of the table of the cube with every ambiguity resolved freely, as parts of Sigma in each of the eight cubes
// of a tile of four dimensions. Made once.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/facets/facets.hpp"
#include "tegl/generated/tables.hpp"

namespace tegl::detail {

/// A list of the table, and what is known of the cube.
struct CubeList {
  const tables::ResolvedList* list;
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
    std::uint64_t vertices;
    std::uint32_t
        apexes;  ///< edges of the tile: those not in the part, and those joined with each of its other vertices
    std::uint32_t first_triangle;
    std::uint8_t triangle_count;
    std::uint8_t cube;
  };

  using Lists = std::array<std::uint16_t, kCubes>;  ///< of each cube of a tile

  static const ResolvedCubes& instance();

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
  /// The number of a list, less than lists().size(), or kNone for a cube of one sign. `high_squares`: those not
  /// ambiguous are ignored.
  [[nodiscard]] std::uint16_t list(unsigned signature, unsigned high_squares, facets::Choice choice) const noexcept {
    const Signature of = of_signatures_[signature];
    const unsigned entry = of.first_entry + compressed_[of.ambiguous << 6 | high_squares];
    return list_of_[3 * entry + static_cast<unsigned>(choice)];
  }
  /// The same by entry of tables::kTile3Resolved.
  [[nodiscard]] std::uint16_t list_of_entry(unsigned entry, facets::Choice choice) const noexcept {
    return list_of_[3 * entry + static_cast<unsigned>(choice)];
  }
  /// Whether an entry's choice matters.
  [[nodiscard]] bool has_choice(unsigned entry) const noexcept { return has_choice_[entry] != 0; }
  /// How many vertices of its own a list has; of kNone none.
  [[nodiscard]] unsigned own_vertices(unsigned list) const noexcept { return list == kNone ? 0 : own_vertices_[list]; }
  [[nodiscard]] const std::vector<CubeList>& lists() const noexcept { return lists_; }
  /// Whether a list is that of the low-connected contour.
  [[nodiscard]] bool is_low(unsigned list) const noexcept { return is_low_[list] != 0; }
  [[nodiscard]] std::span<const Part> parts(unsigned cube, unsigned list) const noexcept {
    const auto* const first = &first_part_[cube * (lists_.size() + 1) + list];
    return {parts_.data() + first[0], parts_.data() + first[1]};
  }
  /// Triangles as words: a zero byte, and their vertices, so that the cone from `apex` is word | apex_word(apex).
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
  ResolvedCubes();
  void number_lists();
  void make_frames();
  void make_parts(unsigned cube, const CubeList& list);

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
  std::vector<std::uint8_t> is_low_;
  std::vector<std::uint8_t> own_vertices_;
  std::vector<std::uint8_t> has_choice_;  ///< by entry
  std::vector<std::uint32_t> first_part_;
  std::vector<Part> parts_;
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

}  // namespace tegl::detail
