// SPDX-License-Identifier: BSD-3-Clause
//
// The edges and cells of a staggered lattice by sample, with the streams of bits in which the numbers of a cell's
// vertices are found.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "complex/cell_contour.hpp"
#include "lattice/lattice_cells.hpp"
#include "tegl/extract.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// An edge of a sample: to the sample with these differences of indices.
struct EdgeKind {
  /// A cell that has the edge: which one of the patterns, of the sample at the edge's minus `at`.
  struct Use {
    std::size_t parity, cell;
    LatticePlace at;
  };
  LatticePlace to;
  std::vector<Use> uses = {};
};

/// A cell of the lattice, with what its contour needs.
struct LatticeCell {
  /// An edge of the cell: of which sample, relative to the cell's, and which of its kinds.
  struct Edge {
    LatticePlace at;
    std::size_t kind;
  };
  /// A vertex inside of the cell: the mean of vertices on edges and of corners, or a part of the way from there to the
  /// mean of all corners.
  struct OwnVertex {
    static constexpr std::size_t kMostEdges = 30;
    /// Ascending by the numbers of the samples at their ends, so that the sum does not depend on the cell.
    std::array<std::uint8_t, kMostEdges> edges{};
    std::uint8_t edge_count = 0;
    bool is_between = false;    ///< of prisms: whether it is off both times
    std::uint32_t corners = 0;  ///< as bits
    double part = 0.0;          ///< of the way
  };
  /// The contour of a signature.
  struct Contour {
    std::uint32_t first = 0;  ///< in `lists`
    std::uint16_t simplices = 0, own = 0;
  };
  static constexpr std::size_t kMargin = 16;  ///< entries that can be read behind a list
  bool at_ends;
  tables::CellShape shape;
  bool is_swept = false;                   ///< as CellGroup::is_swept
  bool is_reversed = false;                ///< whether simplices have the orientation opposite to the table's
  LatticePlace least{}, most{};            ///< differences of corners
  std::vector<LatticePlace> corners = {};  ///< in the order of the table
  std::vector<std::uint8_t> shifts = {};   ///< by corner: its bit in the word of the cell's, modulo 64
  std::vector<Edge> edges = {};            ///< in the order of the table
  std::vector<std::array<LatticePlace, 2>> ends = {};  ///< by edge
  std::vector<std::uint32_t> crossed = {};             ///< by signature: edges, as bits
  std::vector<Contour> contours = {};                  ///< by signature; empty before the contour is added
  std::vector<std::uint8_t> lists = {};                ///< vertices of simplices: edges, then own vertices
  std::vector<std::uint32_t> first_own = {};           ///< by signature: in `own`
  std::vector<OwnVertex> own = {};                     ///< of all signatures
};

/// Everything of samples in layers of one parity.
struct LayerPattern {
  std::vector<EdgeKind> edges;
  std::vector<LatticeCell> cells;
};
using LatticePatterns = std::array<LayerPattern, 2>;

/// The signatures that occur, by pattern and cell. Threads may add them at the same time.
class OccurringSignatures {
 public:
  explicit OccurringSignatures(const LatticePatterns& patterns);
  [[nodiscard]] std::atomic<bool>* of(std::size_t parity, std::size_t cell) noexcept {
    return of_[parity][cell].data();
  }
  [[nodiscard]] const std::atomic<bool>* of(std::size_t parity, std::size_t cell) const noexcept {
    return of_[parity][cell].data();
  }

 private:
  std::array<std::vector<std::vector<std::atomic<bool>>>, 2> of_;
};

/// The patterns of even and odd layers of a lattice. `grid`: for the orientation of the cells. `options`: all that
/// decide which simplices there are. In 4D without contours (add_contours).
template <int N>
[[nodiscard]] LatticePatterns make_patterns(Lattice lattice, const Grid<N>& grid, const ExtractOptions& options);

/// Adds the contours of 4D cells, which are compact, with these signatures: there are so many that only those that
/// occur are built. Errors: Cancelled.
void add_contours(LatticePatterns& patterns, const OccurringSignatures& signatures, Ambiguity ambiguity,
                  const WorkOptions& work);

}  // namespace tegl::detail
