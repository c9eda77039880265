// SPDX-License-Identifier: BSD-3-Clause
//
// An index of the cells of a complex by their ranges of values: finds the active cells of any isovalue without reading
// the others.
//
// Based on: P. Cignoni, P. Marino, C. Montani, E. Puppo, R. Scopigno, Speeding up isosurface extraction using interval
// trees, 1997; on the face-centred cubic lattice: T. Takahashi, I. Ide, Y. Mekada, H. Murase, T. Yonekura, A speedup
// method for isosurfacing volumetric data sampled with a face-centered cubic lattice, 2005.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegl/complex.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// An interval tree of cells. It does not refer to the complex, and keeps 16 bytes for each cell whose values differ.
class CellIndex {
 public:
  /// Of the cells and values of `complex`. O(C log C) time. Errors: Cancelled.
  template <int N>
  explicit CellIndex(const Complex<N>& complex, const WorkOptions& work = {});

  /// Cells in the index: without missing corners, and with different values.
  [[nodiscard]] std::size_t size() const noexcept { return cells_; }
  /// Whether the complex has missing values. `extract` then reads all cells.
  [[nodiscard]] bool has_missing() const noexcept { return has_missing_; }
  /// Number of cells of the complex.
  [[nodiscard]] std::size_t cell_count() const noexcept { return all_cells_; }
  /// Number of points of the complex.
  [[nodiscard]] std::size_t point_count() const noexcept { return points_; }
  /// Memory that the index takes.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return nodes_.size() * sizeof(Node) + (lows_.size() + highs_.size()) * sizeof(End);
  }

  /// The cells that may be active at an isovalue: all active ones, and few others, whose range ends within the
  /// precision of a float from it. Ascending; cells are numbered by shape, within a shape in the order of the complex.
  /// O(log C + k) for k cells, and sorting.
  [[nodiscard]] std::vector<Index> find(double isovalue) const;

 private:
  /// An end of a cell's range: the minimum rounded down, or the maximum rounded up.
  struct End {
    float value;
    Index cell;
  };
  /// The cells whose range contains `value`: ends first ... end - 1 of both lists. Other cells are below or above.
  struct Node {
    float value;
    std::uint32_t below = 0, above = 0;  ///< numbers of nodes; 0: none
    std::size_t first = 0, end = 0;
  };
  struct Range {
    float low, high;
    Index cell;
  };
  std::uint32_t add_node(Range* first, Range* end);

  std::vector<Node> nodes_;
  std::vector<End> lows_, highs_;  ///< by node, minima ascending and maxima descending
  std::size_t cells_ = 0, all_cells_ = 0, points_ = 0;
  bool has_missing_ = false;
};

/// As `extract_with_stats` of the complex, with the active cells from an index of it: the same contour. Errors: those
/// of `extract`; InvalidArgument for an index of another number of cells or points. If values have changed since the
/// index was made, parts of the contour may be missing. The time no longer depends on the number of cells, except for
/// 8 bytes of memory per point that are cleared (with Complex::find_edges, 1 byte per 4 edges).
template <Coordinate Real = float, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Extraction<N, Real> extract_with_stats(const Complex<N>& complex, const CellIndex& index, double isovalue,
                                                     const ExtractOptions& options = {});

/// The contour.
template <Coordinate Real = float, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> extract(const Complex<N>& complex, const CellIndex& index, double isovalue,
                                       const ExtractOptions& options = {}) {
  return extract_with_stats<Real>(complex, index, isovalue, options).contour;
}

}  // namespace tegl
