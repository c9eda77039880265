// SPDX-License-Identifier: BSD-3-Clause
//
// Rows of samples on a staggered lattice as bits: which samples are high, which edges the contour crosses, which cells
// are active, and the numbers of the contour's vertices and simplices.
//
// A row is a line of samples along axis 0; the samples of odd layers are half a step further. A neighbour in another
// layer is therefore the same bit of another row, or the bit before or after. So 64 cells are classified at a time, as
// cubes are, and vertices are numbered by counting bits.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/workers.hpp"
#include "image/sample_source.hpp"
#include "lattice/lattice_pattern.hpp"
#include "lattice/lattice_simplices.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Whether rows of bits give the contour. Of fcc, they resolve the pyramids at both ends by fixed rules only; other 2D
/// and 3D lattices have no ambiguous cells. In 4D by fixed rules, and compact ones only: barycentric contours have
/// vertices between two cells, which are not numbered by rows.
[[nodiscard]] inline bool has_rows(Lattice lattice, const ExtractOptions& options) noexcept {
  const bool is_fixed = options.ambiguity == Ambiguity::low || options.ambiguity == Ambiguity::high;
  if (dimension(lattice) == 4) return is_fixed && options.triangulation == Triangulation::compact;
  return lattice != Lattice::fcc || is_fixed;
}

/// Population count; faster than std::popcount where the processor has no instruction for it.
[[nodiscard]] inline std::uint32_t count_bits(Word word) noexcept {
  word -= word >> 1 & 0x5555555555555555u;
  word = (word & 0x3333333333333333u) + (word >> 2 & 0x3333333333333333u);
  word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  return static_cast<std::uint32_t>(word * 0x0101010101010101u >> 56);
}

class LatticeRows {
 public:
  /// The indices of a row's samples along the axes; 0 along the row.
  using At = std::array<std::size_t, 4>;

  /// `sizes`: samples along the axes, 1 along those that the lattice does not have. `patterns` must outlive this
  /// object.
  LatticeRows(Lattice lattice, const std::array<std::size_t, 4>& sizes, const LatticePatterns& patterns);

  /// Compares the samples of all rows with the isovalue. Returns whether a sample is missing.
  template <int N>
  bool classify(const SampleClassifier<N>& samples, const WorkOptions& work);
  /// Adds the signatures of active cells. Errors: Cancelled.
  void find_signatures(OccurringSignatures& signatures, const WorkOptions& work);
  /// Finds crossed edges and active cells, and numbers vertices and simplices. Errors: TooLarge, Cancelled.
  void count(const WorkOptions& work);

  [[nodiscard]] std::size_t row_count() const noexcept { return size_[1] * size_[2] * size_[3]; }
  [[nodiscard]] std::uint64_t vertices() const noexcept { return vertices_; }
  [[nodiscard]] std::uint64_t simplices() const noexcept { return simplices_; }
  [[nodiscard]] std::uint64_t cells() const noexcept { return cells_; }
  [[nodiscard]] std::uint64_t active_cells() const noexcept { return active_cells_; }
  [[nodiscard]] At at(std::size_t r) const noexcept {
    return {0, r % size_[1], r / size_[1] % size_[2], r / size_[1] / size_[2]};
  }
  [[nodiscard]] const LayerPattern& pattern(const At& at) const noexcept { return patterns_[parity(at)]; }

  /// Numbers of a row: its vertices on edges come first, then the own vertices of its cells.
  struct Row {
    std::uint32_t own = 0, simplices = 0, active = 0;  ///< how many
    std::uint32_t kinds = 0;                           ///< of active cells, as bits by cell of the pattern
    Index first = 0, first_own = 0;
    std::uint64_t first_simplex = 0;
  };
  [[nodiscard]] const Row& row(std::size_t r) const noexcept { return rows_[r]; }
  /// Number of cells of the samples of row `r`.
  [[nodiscard]] std::uint64_t cells(std::size_t r) const noexcept;

  /// The crossed edges of one kind of a row's samples.
  struct Crossed {
    const Word* bits;
    const std::uint32_t* before;  ///< by word: number of the first vertex, relative to the row's
    /// The number of the vertex on the edge of sample i, relative to the row's.
    [[nodiscard]] Index operator[](std::size_t i) const noexcept {
      const Word below = (Word{1} << (i % kWordBits)) - 1;
      return before[i / kWordBits] + count_bits(bits[i / kWordBits] & below);
    }
  };
  /// For a row with vertices on edges, or with active cells that have the edge.
  [[nodiscard]] Crossed crossed(std::size_t r, std::size_t kind) const noexcept {
    const std::size_t at = (r * kinds_ + kind) * words_;
    return {crossed_.data() + at, before_.data() + at};
  }
  [[nodiscard]] std::size_t words() const noexcept { return words_; }

  /// Whether the row at these differences exists.
  [[nodiscard]] bool has_row(const At& at, const LatticePlace& to) const noexcept {
    bool exists = true;
    for (std::size_t a = 1; a < 4; ++a)  // modulo 2^64
      exists = exists && at[a] + static_cast<std::size_t>(to[a]) < size_[a];
    return exists;
  }
  /// The number of the row at these differences from another one, minus the number of that one, modulo 2^64.
  [[nodiscard]] std::size_t steps(const LatticePlace& to) const noexcept {
    return (static_cast<std::size_t>(to[3]) * size_[2] + static_cast<std::size_t>(to[2])) * size_[1] +
           static_cast<std::size_t>(to[1]);
  }

  /// The cells of row `r`, which has them. `cell`: of the row's pattern.
  [[nodiscard]] LatticeCellRow cells_of_row(std::size_t r, const At& at, std::size_t cell) const noexcept;
  /// The vertices on the edges of active cells of row `r`, to `out`, by edge.
  void streams_of_row(std::size_t r, const At& at, std::size_t cell, EdgeStream* out) const noexcept;

 private:
  /// The bits of word w for the samples `first` ... `end` - 1.
  [[nodiscard]] static Word range(std::size_t w, std::ptrdiff_t first, std::ptrdiff_t end) noexcept {
    const auto from = static_cast<std::ptrdiff_t>(w * kWordBits);
    const auto low = std::clamp<std::ptrdiff_t>(first - from, 0, kWordBits);
    const auto high = std::clamp<std::ptrdiff_t>(end - from, 0, kWordBits);
    const auto below = [](std::ptrdiff_t bits) {
      return bits == kWordBits ? ~Word{0} : (Word{1} << static_cast<unsigned>(bits)) - 1;
    };
    return below(high) & ~below(low);
  }
  /// One past the last sample of a row that may have this cell.
  [[nodiscard]] std::ptrdiff_t last(const LatticeCell& cell) const noexcept {
    return static_cast<std::ptrdiff_t>(size_[0]) - cell.most[0];
  }
  /// The bits of word w of a row, of the samples `along` further.
  [[nodiscard]] Word shifted(const Word* row, std::size_t w, std::ptrdiff_t along) const noexcept {
    if (along == 0) return row[w];
    if (along > 0) return row[w] >> 1 | row[w + 1] << (kWordBits - 1);
    return row[w] << 1 | (w == 0 ? 0 : row[w - 1] >> (kWordBits - 1));
  }
  [[nodiscard]] const Word* high(std::size_t r) const noexcept { return high_.data() + 1 + r * (words_ + 1); }
  [[nodiscard]] std::size_t parity(const At& at) const noexcept { return at[layer_axis_] % 2; }
  /// Whether a row has cells like this one.
  [[nodiscard]] bool applies(const At& at, const LatticeCell& cell) const noexcept;

  /// What a cell needs of other rows, relative to its own one.
  struct CellSteps {
    std::vector<std::ptrdiff_t> corners;  ///< LatticeCellRow::corners
    std::vector<std::size_t> rows;        ///< by edge: its row
    std::vector<std::size_t> words;       ///< by edge: its words in `crossed_`
  };
  [[nodiscard]] CellSteps steps_of(const LatticeCell& cell) const;

  /// The first and one past the last sample of a range.
  using Range = std::array<std::ptrdiff_t, 2>;
  /// By kind of edge: the samples whose edge belongs to a cell, by each use that applies to the row.
  using Ranges = std::vector<std::vector<Range>>;
  /// Rows at the same distance from the border have the same ranges: how far they are, up to kNear along each axis.
  static constexpr std::size_t kNear = 2, kDistances = 2 * kNear + 1;
  static constexpr std::size_t kBorders = 2 * kDistances * kDistances * kDistances;
  [[nodiscard]] std::size_t border_of(const At& at) const noexcept;
  [[nodiscard]] Ranges find_ranges(const At& at) const;

  /// The rows along axis 1 that are classified or counted together.
  struct Block {
    std::size_t first, count;  ///< numbers
    At at;                     ///< of the first one
  };
  static constexpr std::size_t kRows = kWordBits;
  [[nodiscard]] std::size_t block_count() const noexcept {
    return detail::block_count(size_[1], kRows) * size_[2] * size_[3];
  }
  [[nodiscard]] Block block(std::size_t b) const noexcept;

  /// The block's rows are all low or all high, and so are all that can have corners or edges of the same cells.
  [[nodiscard]] bool is_quiet(const Block& rows) const noexcept { return lines_[rows.first / size_[1]] != kMixed; }
  /// Whether samples are low or high.
  [[nodiscard]] std::uint8_t state_of(const Block& rows) const noexcept;
  void find_quiet_lines();
  [[nodiscard]] std::uint64_t count_all_cells() const noexcept;

  /// Working memory of a thread: ranges that were found, by border.
  struct Scratch {
    std::vector<std::optional<Ranges>> ranges;
  };
  void find_crossed(std::size_t r, const At& at, Scratch& scratch);
  void count_row(std::size_t r, const At& at);

  std::array<std::size_t, 4> size_;
  std::size_t layer_axis_;
  const LatticePatterns& patterns_;
  std::size_t words_, kinds_;
  bool knows_active_ = false;  ///< whether the rows have their active cells
  std::vector<Word> high_;     ///< 0, then rows x (words + 1), the last one of which is 0
  /// Lines are the rows along axis 1. Whether samples are low or high: of the line, then of all lines near it.
  static constexpr std::uint8_t kLow = 1, kHigh = 2, kMixed = kLow | kHigh;
  std::vector<std::uint8_t> lines_;
  std::array<std::vector<CellSteps>, 2> steps_;  ///< by parity and cell
  Buffer<Word> crossed_;                         ///< of rows that are not quiet
  Buffer<std::uint32_t> before_;
  std::vector<Row> rows_;
  std::uint64_t vertices_ = 0, simplices_ = 0, cells_ = 0, active_cells_ = 0;
};

}  // namespace tegl::detail
