// SPDX-License-Identifier: BSD-3-Clause
#include "division/divided_contour.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "base/workers.hpp"
#include "complex/crossings.hpp"
#include "complex/edge_alpha.hpp"
#include "division/cell_crossings.hpp"
#include "kernel/contour_output.hpp"
#include "kernel/placement.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {
namespace {

constexpr std::size_t kPointWords = 3;      ///< 163 points of a symmetric cell in 5D
constexpr std::size_t kCrossingWords = 28;  ///< its 1 602 edges and the points

/// Calls work(bit) for the set bits of words, ascending.
template <class Work>
void for_each_bit(std::span<const std::uint64_t> words, const Work& work) {
  for (std::size_t w = 0; w < words.size(); ++w)
    for (std::uint64_t rest = words[w]; rest != 0; rest &= rest - 1)
      work(64 * w + static_cast<std::size_t>(std::countr_zero(rest)));
}

inline bool has(std::span<const std::uint64_t> words, std::size_t bit) noexcept {
  return (words[bit / 64] >> (bit % 64) & 1u) != 0;
}

/// A cell that has vertices or simplices.
struct CellWithContour {
  std::uint64_t number;                         ///< among all cells, axis 0 fastest
  std::array<std::uint64_t, kPointWords> high;  ///< its high points
  std::uint32_t first_vertex;                   ///< relative to the block's
};

/// The active cells of some rows of cells.
struct Block {
  std::vector<CellWithContour> cells;
  std::vector<std::uint64_t> own;  ///< by cell: the crossings that are vertices of this cell, as bits
  std::uint64_t vertices = 0, simplices = 0, active = 0;
  std::uint64_t first_vertex = 0, first_simplex = 0;
};

template <int N, class Real>
class DividedExtraction {
 public:
  using Sample = std::array<std::size_t, N>;

  DividedExtraction(const Grid<N>& grid, ReadSamples<N> read, Division division, double isovalue,
                    const ExtractOptions& options)
      : grid_(grid),
        read_(read),
        isovalue_(isovalue),
        options_(options),
        crossings_(division),
        contours_(SimplexContour<N>::instance()),
        words_(block_count(crossings_.count(), 64)),
        flip_(against_tables(grid, options)) {
    for (const CellPoint& point : crossings_.points()) corners_of_.push_back(corner_masks(point.face));
    for (int a = 0; a < N; ++a) cells_[a] = grid.axes[a].size() - 1;
    for (int a = 1; a < N; ++a) rows_ *= cells_[a];
    rows_per_block_ = std::max<std::size_t>(1, 2048 / std::max<std::size_t>(1, cells_[0]));
  }

  ExtractedSize run(Contour<N, Real>* contour) {
    ExtractedSize result;
    if (rows_ == 0 || cells_[0] == 0) return result;
    Stopwatch watch;
    classify();
    watch.add_to(result.stats.classify_seconds);
    for (Block& block : blocks_) {
      block.first_vertex = result.size.vertices;
      block.first_simplex = result.size.simplices;
      result.size.vertices += block.vertices;
      result.size.simplices += block.simplices;
      result.stats.active_tiles += block.active;
    }
    result.stats.tiles = rows_ * cells_[0] * crossings_.simplices().size();
    watch.add_to(result.stats.find_seconds);
    if (contour != nullptr) write(result.size, *contour);
    watch.add_to(result.stats.generate_seconds);
    tell(options_.work.progress, 1.0);
    return result;
  }

 private:
  /// Values of the corners of a row of cells: by the corner's mask without axis 0, the samples along the row.
  struct Row {
    std::array<std::vector<double>, (1u << (N - 1))> values;
    std::vector<std::uint32_t> high;  ///< by sample along the row: bit by mask without axis 0
  };
  struct Scratch {
    Row row;
    std::vector<Index> numbers;  ///< by crossing of a cell
    std::array<double, (1u << N)> corners;
    std::vector<double> values;  ///< by point of a cell
    std::array<std::array<std::uint32_t, kCrossingWords>, (1u << N)> ranks;
  };

  /// Index of the first cell of a row.
  [[nodiscard]] Sample row_at(std::size_t row) const noexcept {
    Sample at{};
    for (int a = 1; a < N; ++a) {
      at[a] = row % cells_[a];
      row /= cells_[a];
    }
    return at;
  }
  [[nodiscard]] Sample cell_at(std::uint64_t number) const noexcept {
    Sample at = row_at(number / cells_[0]);
    at[0] = number % cells_[0];
    return at;
  }
  /// The sides of the image at which a cell is; as CellPoint::sides.
  [[nodiscard]] std::uint64_t sides_of(const Sample& at) const noexcept {
    std::uint64_t sides = 0;
    for (int a = 0; a < N; ++a) {
      sides |= std::uint64_t{at[a] == 0} << a;
      sides |= std::uint64_t{at[a] + 1 == cells_[a]} << (8 + a);
    }
    return sides;
  }
  [[nodiscard]] static Sample corner_at(Sample at, unsigned mask) noexcept {
    for (int a = 0; a < N; ++a) at[a] += mask >> a & 1u;
    return at;
  }

  void classify() {
    blocks_.resize(block_count(rows_, rows_per_block_));
    std::atomic<std::size_t> missing_at = kNothing;
    for_each_block(
        rows_, rows_per_block_, options_.work.threads, part_of(options_.work.progress, 0.0, 0.5),
        [] { return Scratch(); },
        [&](std::size_t b, std::size_t from, std::size_t to, Scratch& scratch) {
          for (std::size_t row = from; row < to; ++row) classify_row(row, blocks_[b], scratch, missing_at);
        });
    if (missing_at != kNothing)
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("a divided {}D image with missing values (or infinite ones of both signs in a symmetric "
                              "cell), the first beside layer {} of its last axis; expected none, which are supported "
                              "up to 4D",
                              N, missing_at.load()));
  }

  void classify_row(std::size_t row, Block& block, Scratch& scratch, std::atomic<std::size_t>& missing_at) const {
    const Sample at = row_at(row);
    bool is_missing = false;
    Row& samples = scratch.row;
    samples.high.assign(cells_[0] + 1, 0);
    for (unsigned rest = 0; rest < samples.values.size(); ++rest) {
      std::vector<double>& values = samples.values[rest];
      values.resize(cells_[0] + 1);
      read_(corner_at(at, rest << 1), values.size(), values.data());
      for (std::size_t i = 0; i < values.size(); ++i) {
        samples.high[i] |= std::uint32_t{values[i] >= isovalue_} << rest;
        is_missing = is_missing || std::isnan(values[i]);
      }
    }
    if (!is_missing) is_missing = !find_active(row, at, block, scratch);
    if (!is_missing) return;
    std::size_t known = missing_at;
    while (at[N - 1] < known && !missing_at.compare_exchange_weak(known, at[N - 1])) {
    }
  }

  /// Returns false if a point between infinite values has none.
  [[nodiscard]] bool find_active(std::size_t row, Sample at, Block& block, Scratch& scratch) const {
    constexpr std::uint32_t kAll = (std::uint64_t{1} << (1u << (N - 1))) - 1;
    const Row& samples = scratch.row;
    for (std::size_t i = 0; i < cells_[0]; ++i) {
      const std::uint32_t any = samples.high[i] | samples.high[i + 1];
      if (any == 0) continue;
      at[0] = i;
      const bool is_mixed = (samples.high[i] & samples.high[i + 1]) != kAll;
      const std::uint64_t sides = options_.close ? sides_of(at) : 0;
      if (!is_mixed && sides == 0) continue;
      for (unsigned v = 0; v < 1u << N; ++v) scratch.corners[v] = samples.values[v >> 1][i + (v & 1u)];
      find_values(scratch);
      CellWithContour cell{row * cells_[0] + i, {}, static_cast<std::uint32_t>(block.vertices)};
      for (std::size_t p = 0; p < scratch.values.size(); ++p) {
        if (std::isnan(scratch.values[p])) return false;
        cell.high[p / 64] |= std::uint64_t{scratch.values[p] >= isovalue_} << (p % 64);
      }
      add(cell, at, sides, block);
    }
    return true;
  }

  /// The values at the points of a cell with these corners.
  void find_values(Scratch& scratch) const {
    scratch.values.clear();
    std::array<double, (1u << N)> of_face;
    for (const std::vector<unsigned>& masks : corners_of_) {
      for (std::size_t i = 0; i < masks.size(); ++i) of_face[i] = scratch.corners[masks[i]];
      scratch.values.push_back(masks.size() == 1 ? of_face[0]
                                                 : mean_of_corners(std::span(of_face).first(masks.size())));
    }
  }

  /// Calls work(crossing) for the crossings of a cell, ascending.
  template <class Work>
  void for_each_crossing(const CellWithContour& cell, std::uint64_t sides, const Work& work) const {
    for (std::size_t e = 0; e < crossings_.edges(); ++e) {
      const auto [p, q] = crossings_.ends(e);
      if (has(cell.high, p) != has(cell.high, q)) work(e);
    }
    if (sides == 0) return;
    for_each_bit(cell.high, [&](std::size_t p) {
      if ((crossings_.points()[p].sides & sides) != 0) work(crossings_.edges() + p);
    });
  }
  /// Calls work(simplex, signature) for the active simplices and cones of a cell.
  template <class Work>
  void for_each_simplex(const CellWithContour& cell, std::uint64_t sides, const Work& work) const {
    const auto signature_of = [&](const auto& simplex, int first) {
      unsigned signature = 0;
      for (int j = first; j <= N; ++j) signature |= unsigned{has(cell.high, simplex.points[j])} << j;
      return signature;
    };
    constexpr unsigned kAll = (2u << N) - 1;
    for (const auto& simplex : crossings_.simplices())
      if (const unsigned signature = signature_of(simplex, 0); signature != 0 && signature != kAll)
        work(simplex, signature);
    for (const auto& side : crossings_.sides()) {
      if ((side.bit & sides) == 0) continue;
      for (const auto& cone : side.cones)
        if (const unsigned signature = signature_of(cone, 1); signature != 0) work(cone, signature);
    }
  }

  void add(const CellWithContour& cell, const Sample& at, std::uint64_t sides, Block& block) const {
    const unsigned last = last_along(at);
    block.cells.push_back(cell);
    block.own.resize(block.own.size() + words_);
    std::uint64_t* const own = block.own.data() + block.own.size() - words_;
    for_each_crossing(cell, sides, [&](std::size_t crossing) {
      if ((crossings_.upper(crossing) & ~last) != 0) return;
      own[crossing / 64] |= std::uint64_t{1} << (crossing % 64);
      ++block.vertices;
    });
    for_each_simplex(cell, sides, [&](const auto& /*simplex*/, unsigned signature) {
      block.simplices += contours_.count(signature);
      ++block.active;
    });
  }
  /// The axes along which there is no next cell.
  [[nodiscard]] unsigned last_along(const Sample& at) const noexcept {
    unsigned last = 0;
    for (int a = 0; a < N; ++a) last |= unsigned{at[a] + 1 == cells_[a]} << a;
    return last;
  }

  void write(const ContourSize& size, Contour<N, Real>& contour) {
    require_numbers(size.vertices);
    contour.vertices.resize(size.vertices);
    contour.simplices.resize(size.simplices);
    const Placement<N, Real> placement(grid_);
    for_each_block(
        blocks_.size(), 1, options_.work.threads, part_of(options_.work.progress, 0.5, 1.0), [] { return Scratch(); },
        [&](std::size_t b, std::size_t, std::size_t, Scratch& scratch) {
          const Block& block = blocks_[b];
          auto* vertex = contour.vertices.data() + block.first_vertex;
          auto* simplex = contour.simplices.data() + block.first_simplex;
          for (std::size_t c = 0; c < block.cells.size(); ++c) {
            const Sample at = cell_at(block.cells[c].number);
            vertex = write_vertices(block, c, at, placement, scratch, vertex);
            simplex = write_simplices(block.cells[c], at, scratch, simplex);
          }
        });
  }

  using Vertex = typename Contour<N, Real>::Vertex;
  Vertex* write_vertices(const Block& block, std::size_t c, const Sample& at, const Placement<N, Real>& placement,
                         Scratch& scratch, Vertex* out) const {
    const std::span<const std::uint64_t> own = std::span(block.own).subspan(c * words_, words_);
    if (std::all_of(own.begin(), own.end(), [](std::uint64_t word) { return word == 0; })) return out;
    for (unsigned v = 0; v < 1u << N; v += 2) read_(corner_at(at, v), 2, scratch.corners.data() + v);
    find_values(scratch);
    const typename Placement<N, Real>::Cell place(placement, at);
    for_each_bit(own, [&](std::size_t crossing) {
      const bool is_edge = crossing < crossings_.edges();
      const std::size_t p = is_edge ? crossings_.ends(crossing)[0] : crossing - crossings_.edges();
      const std::size_t q = is_edge ? crossings_.ends(crossing)[1] : p;
      const double alpha = is_edge ? alpha_of(scratch.values[p], scratch.values[q], isovalue_, options_.epsilon) : 0.0;
      *out++ = vertex_between(crossings_.points()[p], crossings_.points()[q], alpha, at, place, placement);
    });
    return out;
  }
  /// The vertex at `alpha` between two points of the cell at `at`.
  static Vertex vertex_between(const CellPoint& first, const CellPoint& second, double alpha, const Sample& at,
                               const typename Placement<N, Real>::Cell& place, const Placement<N, Real>& placement) {
    std::array<double, N> x, y;
    for (int a = 0; a < N; ++a) {
      x[a] = 0.5 * first.doubled[a];
      y[a] = 0.5 * second.doubled[a];
    }
    Vertex vertex = placement.world(place.on_axes(point_on_edge<double, N>(x, y, alpha)));
    // Points in a layer stay there.
    for (int a = std::max(0, N - 2); a < N; ++a)
      if (first.doubled[a] != second.doubled[a] || first.doubled[a] == 1)
        vertex = placement.inside_slab(vertex, at[a], a);
    return vertex;
  }

  using SimplexRow = typename Contour<N, Real>::Simplex;
  SimplexRow* write_simplices(const CellWithContour& cell, const Sample& at, Scratch& scratch, SimplexRow* out) const {
    const std::uint64_t sides = options_.close ? sides_of(at) : 0;
    find_numbers(cell, at, sides, scratch);
    for_each_simplex(cell, sides, [&](const auto& simplex, unsigned signature) {
      for (const auto& edges : contours_.of(signature)) {
        for (int j = 0; j < N; ++j) (*out)[j] = scratch.numbers[simplex.crossings[edges[j]]];
        if (simplex.is_positive == flip_) std::swap((*out)[N - 2], (*out)[N - 1]);
        ++out;
      }
    });
    return out;
  }
  /// The numbers of the vertices at the crossings of a cell.
  void find_numbers(const CellWithContour& cell, const Sample& at, std::uint64_t sides, Scratch& scratch) const {
    const unsigned last = last_along(at);
    scratch.numbers.resize(crossings_.count());
    unsigned known = 0;  // bit by axes: the cell there has been found
    std::array<const std::uint64_t*, (1u << N)> own;
    for_each_crossing(cell, sides, [&](std::size_t crossing) {
      const unsigned along = crossings_.upper(crossing) & ~last;
      auto& ranks = scratch.ranks[along];
      if ((known >> along & 1u) == 0) {
        own[along] = find_ranks(at, along, ranks);
        known |= 1u << along;
      }
      const std::size_t there = crossings_.in_next(crossing, along);
      const std::uint64_t below = own[along][there / 64] & ((std::uint64_t{1} << (there % 64)) - 1);
      scratch.numbers[crossing] = ranks[there / 64] + static_cast<Index>(std::popcount(below));
    });
  }
  /// The crossings that the next cell along some axes owns; sets the number of the first one in each word.
  const std::uint64_t* find_ranks(Sample at, unsigned along, std::array<std::uint32_t, kCrossingWords>& ranks) const {
    at = corner_at(at, along);
    std::uint64_t number = 0;
    for (int a = N - 1; a >= 0; --a) number = number * cells_[a] + at[a];
    const Block& block = blocks_[number / cells_[0] / rows_per_block_];
    const auto found = std::lower_bound(block.cells.begin(), block.cells.end(), number,
                                        [](const CellWithContour& cell, std::uint64_t n) { return cell.number < n; });
    const std::uint64_t* const own = block.own.data() + static_cast<std::size_t>(found - block.cells.begin()) * words_;
    auto next = static_cast<Index>(block.first_vertex + found->first_vertex);
    for (std::size_t w = 0; w < words_; ++w) {
      ranks[w] = next;
      next += static_cast<Index>(std::popcount(own[w]));
    }
    return own;
  }

  static constexpr std::size_t kNothing = std::numeric_limits<std::size_t>::max();

  const Grid<N>& grid_;
  ReadSamples<N> read_;
  double isovalue_;
  const ExtractOptions& options_;
  CellCrossings<N> crossings_;
  const SimplexContour<N>& contours_;
  std::size_t words_;  ///< for the crossings of a cell
  bool flip_;
  std::vector<std::vector<unsigned>> corners_of_;  ///< by point: its face's corners
  Sample cells_;                                   ///< by axis
  std::size_t rows_ = 1;
  std::size_t rows_per_block_;
  std::vector<Block> blocks_;
};

}  // namespace

template <int N, class Real>
ExtractedSize extract_divided_cells(const Grid<N>& grid, ReadSamples<N> read, Division division, double isovalue,
                                    const ExtractOptions& options, Contour<N, Real>* contour) {
  return DividedExtraction<N, Real>(grid, read, division, isovalue, options).run(contour);
}

#define TEGL_INSTANTIATE(N, Real)                                                                         \
  template ExtractedSize extract_divided_cells<N, Real>(const Grid<N>&, ReadSamples<N>, Division, double, \
                                                        const ExtractOptions&, Contour<N, Real>*);
TEGL_INSTANTIATE(2, double)
TEGL_INSTANTIATE(3, double)
TEGL_INSTANTIATE(4, double)
TEGL_INSTANTIATE(5, float)
TEGL_INSTANTIATE(5, double)
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
