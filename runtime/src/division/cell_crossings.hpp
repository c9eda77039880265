// SPDX-License-Identifier: BSD-3-Clause
//
// Where the contour may have vertices in a divided cell, and which simplices it has between them.
//
// A vertex is on an edge of the division. If the contour is closed, high points on the image border are vertices, too:
// caps are the contour in the cones over the border's simplices from a low apex outside of the image, with the
// crossings at the border's points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "division/divided_cell.hpp"
#include "division/simplex_contour.hpp"

namespace tegl::detail {

/// A point of the cell; all points are in the lexicographic order of their coordinates, the last axis first. Points of
/// neighbouring cells have the same order.
struct CellPoint {
  FacePoint face;
  std::array<std::uint8_t, 5> doubled{};  ///< coordinates in half cells: 0, 1 or 2
  unsigned upper = 0;                     ///< bit a: at the upper end of axis a
  std::uint64_t sides = 0;                ///< bit a: at the lower end of axis a; bit 8 + a: at the upper end
};

/// The division of a cell, with the edges of its simplices. Crossings are numbered: first the edges, then the points,
/// which are crossings of caps.
template <int N>
class CellCrossings {
 public:
  static constexpr std::size_t kPairs = SimplexContour<N>::kEdges;
  /// A simplex, or the cone over one at the border.
  struct Simplex {
    /// Numbers of the points, ascending. A cone's first vertex is its apex, which has no number.
    std::array<std::uint8_t, N + 1> points;
    bool is_positive;                             ///< its orientation
    std::uint32_t corners = 0;                    ///< those of the cell that it has; of a cone, those of its simplex
    std::array<std::uint16_t, kPairs> crossings;  ///< by edge (edge_number)
    /// Whether it is left out, as some corners are missing.
    [[nodiscard]] bool is_without(std::uint32_t missing) const noexcept { return (corners & missing) != 0; }
  };
  /// The cones over the simplices on one side of the cell.
  struct Side {
    std::uint64_t bit;  ///< of CellPoint::sides
    std::vector<Simplex> cones;
  };

  /// `division`: kuhn or symmetric.
  explicit CellCrossings(Division division);

  [[nodiscard]] const std::vector<CellPoint>& points() const noexcept { return points_; }
  [[nodiscard]] const std::vector<Simplex>& simplices() const noexcept { return simplices_; }
  [[nodiscard]] const std::vector<Side>& sides() const noexcept { return sides_; }
  /// Number of edges.
  [[nodiscard]] std::size_t edges() const noexcept { return edges_.size(); }
  /// Number of edges and points.
  [[nodiscard]] std::size_t count() const noexcept { return edges_.size() + points_.size(); }
  /// The points at the ends of an edge, ascending.
  [[nodiscard]] const std::array<std::uint8_t, 2>& ends(std::size_t edge) const noexcept { return edges_[edge]; }
  /// Bit a: the crossing is at the upper end of axis a. Then the next cell along the axis has it, too.
  [[nodiscard]] unsigned upper(std::size_t crossing) const noexcept { return upper_[crossing]; }
  /// The simplices at an edge.
  [[nodiscard]] const std::vector<std::uint16_t>& simplices_at(std::size_t edge) const noexcept {
    return simplices_at_[edge];
  }
  /// The axes along which all points of the crossing have the same place; the cells around it differ along these.
  [[nodiscard]] unsigned fixed(std::size_t crossing) const noexcept { return fixed_[crossing]; }
  /// The fixed axes along which this cell is behind the crossing.
  [[nodiscard]] unsigned place(std::size_t crossing) const noexcept {
    return fixed_[crossing] & ~unsigned{upper_[crossing]};
  }
  /// The number of a crossing in the cell around it that is behind it along the axes `place`, which are fixed.
  [[nodiscard]] std::size_t at_place(std::size_t crossing, unsigned place) const noexcept {
    return in_next(in_first_[crossing], place);
  }
  /// The number of a crossing in the next cell along the axes `along`, which are in upper(crossing).
  [[nodiscard]] std::size_t in_next(std::size_t crossing, unsigned along) const noexcept {
    return in_next_[(crossing << N) + along];
  }

 private:
  void add_points(const DividedCell<N>& cell);
  void add_simplices(const DividedCell<N>& cell);
  void add_sides();
  void find_next();
  [[nodiscard]] std::size_t point_at(const std::array<std::uint8_t, 5>& doubled) const;
  [[nodiscard]] std::uint16_t edge_between(std::uint8_t first, std::uint8_t second);

  std::vector<CellPoint> points_;
  std::vector<std::array<std::uint8_t, 2>> edges_;
  std::vector<std::uint16_t> edge_of_;  ///< by points: number + 1, or 0
  std::vector<Simplex> simplices_;
  std::vector<Side> sides_;
  std::vector<std::vector<std::uint16_t>> simplices_at_;
  std::vector<std::uint8_t> upper_, fixed_;
  std::vector<std::uint16_t> in_first_;  ///< the number in the cell that is before it along all fixed axes
  std::vector<std::uint16_t> in_next_;
};

}  // namespace tegl::detail
