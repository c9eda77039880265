// SPDX-License-Identifier: BSD-3-Clause
//
// The polygons, polyhedra and 4D polytopes of a complex, by the faces around them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "polytope/polytope_shape.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

struct RecognisedPolytope;
struct SolidFacet;

/// The polygons (of a 2D complex), polyhedra (3D), or 4D polytopes of a complex, in the order of the input. The latter
/// are either all prisms over polyhedra, made by in_time, or none is known to be one.
class Polytopes {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return shape_of_.size(); }
  /// The dimension of the cells; 3 if there are none.
  [[nodiscard]] int dim() const noexcept { return shapes_.empty() ? 3 : shapes_[0].dim(); }
  [[nodiscard]] const PolytopeShape& shape(std::size_t cell) const noexcept { return shapes_[shape_of_[cell]]; }
  /// The points at the corners of a cell.
  [[nodiscard]] const Index* cell(std::size_t i) const noexcept { return corners_.data() + first_[i]; }
  [[nodiscard]] std::span<const Index> points_of(std::size_t i) const noexcept {
    return {cell(i), shape(i).corner_count()};
  }
  /// Number of different shapes.
  [[nodiscard]] std::size_t shape_count() const noexcept { return shapes_.size(); }

  /// Appends a polygon with its corners around it.
  void add_polygon(std::span<const Index> corners);
  /// Appends a polyhedron with the rings of its faces, checked, in the numbers of its corners.
  void add_polyhedron(std::span<const Index> corners, std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends);
  /// Appends a 4D polytope. After the last one, `find_entangled_facets` is to be called.
  void add_polytope(RecognisedPolytope polytope);
  /// Finds the 4D polytopes that are entangled, and names their facets.
  void find_entangled_facets();
  /// The prisms over the polygons or polyhedra in the intervals between layers of `points` points each.
  [[nodiscard]] Polytopes in_time(std::size_t points, std::size_t intervals) const;
  /// Of prisms over polyhedra: number of polyhedra. Prism c + k * base_count() is over polyhedron c in interval k. Of
  /// other 4D polytopes: their number.
  [[nodiscard]] std::size_t base_count() const noexcept { return is_entangled_.size(); }
  /// The polyhedra under prisms or, of other 4D polytopes, the cells, ascending, that have corners in common with
  /// another one which are not all in one face, or facet: both cells may have the same diagonals between edges.
  [[nodiscard]] const std::vector<Index>& entangled() const noexcept { return entangled_; }
  [[nodiscard]] bool is_entangled(std::size_t cell) const noexcept {
    return base_count() > 0 && is_entangled_[cell % base_count()];
  }
  /// The name of a facet without a table if it is an end of a prism over an entangled polyhedron, which is that, or a
  /// facet of another entangled polytope. Cells with the facet agree.
  [[nodiscard]] std::optional<Index> entangled_facet(std::size_t cell, const SolidFacet& facet) const;
  /// Replaces each point p by number[p].
  void renumber(std::span<const Index> number);

  /// Number of parts of all cells, the units of parallel work.
  [[nodiscard]] std::size_t part_count() const noexcept { return (size() + kCellsOfPart - 1) / kCellsOfPart; }
  /// Calls visit(p, q) for the edges of the cells in a part.
  template <class Visit>
  void for_each_edge(std::size_t part, const Visit& visit) const {
    for (std::size_t c = kCellsOfPart * part; c < std::min(size(), kCellsOfPart * (part + 1)); ++c)
      for (const auto& [a, b] : shape(c).edges()) visit(cell(c)[a], cell(c)[b]);
  }

 private:
  static constexpr std::size_t kCellsOfPart = 4096;
  using Lattice = std::pair<std::vector<std::uint8_t>, std::vector<std::uint16_t>>;
  void add(std::span<const Index> corners, Lattice lattice);
  void add(std::span<const Index> corners, std::uint32_t shape);
  [[nodiscard]] PolytopeShape shape_of_facets(const RecognisedPolytope& polytope);
  [[nodiscard]] Polytopes solids_in_time(std::size_t points, std::size_t intervals) const;
  [[nodiscard]] std::vector<Index> find_entangled() const;

  std::vector<PolytopeShape> shapes_;
  std::map<Lattice, std::uint32_t> numbers_;  ///< of the shapes; of 4D polytopes, by the facets' descriptions
  std::map<Lattice, PolytopeShape> solids_;   ///< the facets of 4D polytopes that have no table
  std::vector<std::uint32_t> shape_of_;       ///< by cell
  std::vector<std::uint64_t> first_;          ///< by cell: its first corner in corners_
  std::vector<Index> corners_;
  std::vector<Index> entangled_;  ///< of 4D polytopes
  std::vector<bool> is_entangled_;
  std::map<std::vector<Index>, Index> entangled_facets_;  ///< of polytopes that are no prisms: by ascending points
};

/// Whether each polytope is oriented against its rings: by the sign of its volume or area. Flat ones are as the others
/// if these all have one sign, otherwise not inverted. Bit c % 64 of word c / 64.
template <int N>
[[nodiscard]] std::vector<std::uint64_t> find_polytope_signs(const Polytopes& polytopes,
                                                             const std::vector<std::array<double, N>>& points);

}  // namespace tegl::detail
