// SPDX-License-Identifier: BSD-3-Clause
//
// The cells of a complex by type, with corners in the order of the generated tables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "polytope/polytopes.hpp"
#include "tegl/cell_contract.hpp"
#include "tegl/complex.hpp"

namespace tegl::detail {

/// A type of cells and its shape in the tables.
struct CellKind {
  CellType type;
  const char* name;
  tables::CellShape shape;
  bool is_ring;  ///< corners 2 and 3 (and 6 and 7) of the base are exchanged in the order around a border
};

/// The kind of a type, or null for another number.
[[nodiscard]] const CellKind* find_kind(CellType type) noexcept;
/// The table of a shape. All shapes have the same corners and edges in both triangulations.
[[nodiscard]] const tables::CellTable& table_of(tables::CellShape shape) noexcept;
/// The position in the table's order of corner i of a cell.
[[nodiscard]] std::size_t table_corner(const CellKind& kind, std::size_t i) noexcept;
/// The shape of a cell x an interval.
[[nodiscard]] tables::CellShape prism_of(tables::CellShape shape) noexcept;

/// All cells of one shape, in the order of the input.
struct CellGroup {
  tables::CellShape shape;
  std::size_t corner_count;    ///< of a cell
  std::vector<Index> corners;  ///< #cells x corner_count
  /// Prisms over cells at several times: both cells at an end, which lies in a layer, have its corners in one order.
  bool is_swept = false;

  [[nodiscard]] std::size_t size() const noexcept { return corners.size() / corner_count; }
  [[nodiscard]] const Index* cell(std::size_t i) const noexcept { return corners.data() + i * corner_count; }
};

/// The cells of a complex. Groups are ordered by shape and not empty. Polygons, polyhedra and polytopes are numbered
/// after the cells of all groups; those with a shape of the tables are in the groups.
struct CellGroups {
  std::vector<CellGroup> groups;
  std::size_t cell_count = 0;
  Polytopes polytopes = {};
};

/// Consecutive cells of a group.
struct CellRange {
  std::size_t group, from, to;
};
/// All cells in ranges of a fixed size, the units of parallel work: they do not depend on the number of threads.
[[nodiscard]] std::vector<CellRange> ranges_of(const CellGroups& cells);

/// Whether each cell is oriented against the reference corners: the sign of the best affine map between the two. Cells
/// that are flat up to rounding have the sign that all others of their shape have; if those differ, or for lack of
/// others, they are not inverted. By group, then of the polytopes: bit c % 64 of word c / 64.
template <int N>
[[nodiscard]] CellSigns find_cell_signs(const CellGroups& cells, const std::vector<std::array<double, N>>& points);

/// Checks and groups cells. Errors: as the constructors of Complex.
[[nodiscard]] CellGroups group_cells(int dim, std::size_t points, std::span<const CellType> types,
                                     std::span<const Index> corners);
/// The same for cells of one type.
[[nodiscard]] CellGroups group_cells(int dim, std::size_t points, CellType type, std::span<const Index> corners);
/// The same with polygons, polyhedra and 4D polytopes.
[[nodiscard]] CellGroups group_cells(int dim, std::size_t points, const CellLists& cells);

/// Access to the private data of complexes.
struct ComplexAccess {
  template <int N>
  static const CellGroups& cells(const Complex<N>& complex) noexcept {
    return *complex.cells_;
  }
  template <int N>
  static const ComplexEdges* edges(const Complex<N>& complex) noexcept {
    return complex.edges_.get();
  }
  /// The facets on the border, or null before find_border.
  template <int N>
  static const std::vector<BorderFacet>* border(const Complex<N>& complex) noexcept {
    return complex.border_.get();
  }
  template <int N>
  static const CellSigns& signs(const Complex<N>& complex) noexcept {
    return *complex.signs_;
  }
  template <int N>
  static bool is_layered(const Complex<N>& complex) noexcept {
    return complex.is_layered_;
  }
  /// The largest absolute value of a coordinate.
  template <int N>
  static double largest_coordinate(const Complex<N>& complex) noexcept {
    return complex.largest_coordinate_;
  }
  /// A complex of cells of one type whose corners have the same orientation, also in cells without volume.
  template <int N>
  static Complex<N> oriented(std::vector<std::array<double, N>> points, CellType type, std::span<const Index> corners);
  /// The complex with other points, which may be any numbers, and the same orientations of the cells.
  template <int N>
  static Complex<N> at_places(const Complex<N>& complex, std::vector<std::array<double, N>> places);
  /// The complex with other points and values, `number` of the old points among the new ones, and the same orientations
  /// of the cells, whose corners may then be a period apart.
  template <int N>
  static Complex<N> identified(const Complex<N>& complex, std::vector<std::array<double, N>> points,
                               std::vector<double> values, std::span<const Index> number);
  /// A complex of cells that need no check.
  template <int N>
  static Complex<N> layered(std::vector<std::array<double, N>> points, CellGroups cells);
};

}  // namespace tegl::detail
