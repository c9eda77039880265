// SPDX-License-Identifier: BSD-3-Clause
//
// The edges and cells of a staggered lattice by sample, with the streams of bits in which the numbers of a cell's
// vertices are found.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "complex/cell_contour.hpp"
#include "lattice/lattice_cells.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// An edge of a sample: to the sample with these differences of indices (along the row, row, layer).
struct EdgeKind {
  /// A cell that has the edge: which one of the patterns, of the sample at the edge's minus `at`.
  struct Use {
    std::size_t parity, cell;
    std::array<std::ptrdiff_t, 3> at;
  };
  std::array<std::ptrdiff_t, 3> to;
  std::vector<Use> uses = {};
};

/// A cell of the lattice, with what its contour needs.
struct LatticeCell {
  /// An edge of the cell: of which sample, relative to the cell's, and which of its kinds.
  struct Edge {
    std::array<std::ptrdiff_t, 3> at;
    std::size_t kind;
  };
  /// The contour of a signature: vertices of its simplices, as they are to be written (edges, then own vertices).
  struct Contour {
    std::uint32_t crossed = 0;  ///< bit e: edge e
    std::uint32_t simplices = 0, own = 0;
    std::vector<std::uint8_t> vertices = {};
    std::vector<std::uint32_t> centres = {};  ///< by own vertex: the edges whose points it is the mean of
  };
  static constexpr std::size_t kList = 32;  ///< entries of a list
  bool at_ends;
  std::array<std::ptrdiff_t, 3> least{}, most{};            ///< differences of corners
  std::vector<std::array<std::ptrdiff_t, 3>> corners = {};  ///< in the order of the table
  std::vector<Edge> edges = {};                             ///< in the order of the table
  std::vector<Contour> contours = {};                       ///< by signature
  // The contours in brief, unless a signature has own vertices or more entries than a list.
  bool has_lists = false;
  std::vector<std::uint8_t> sizes = {};  ///< by signature: number of simplices
  std::vector<std::uint8_t> lists = {};  ///< by signature: kList entries, the vertices of all simplices, then 0
};

/// Everything of samples in layers of one parity.
struct LayerPattern {
  std::vector<EdgeKind> edges;
  std::vector<LatticeCell> cells;
};

/// The patterns of even and odd layers of a 2D or 3D lattice. `grid`: for the orientation of the cells. `options`: all
/// that decide which simplices there are.
template <int N>
[[nodiscard]] std::array<LayerPattern, 2> make_patterns(Lattice lattice, const Grid<N>& grid,
                                                        const ExtractOptions& options);

}  // namespace tegl::detail
