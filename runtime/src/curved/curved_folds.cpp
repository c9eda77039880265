// SPDX-License-Identifier: BSD-3-Clause
//
// Cells of curved grids that are turned inside out; see find_folds in tegl/curved.hpp. Highway's foreach_target
// compiles this file once per instruction set: vectors of cells find those with the expected orientation, which nearly
// all have; the others are tested one by one.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/atomic_minimum.hpp"
#include "base/workers.hpp"
#include "curved/curved_map.hpp"
#include "curved/curved_seams.hpp"
#include "tegl/curved.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "curved/curved_folds.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

#ifndef TEGL_SRC_CURVED_FOLDS
#define TEGL_SRC_CURVED_FOLDS
namespace tegl::detail {

/// The coordinates at the corners of a row of cells along an axis of the grid.
struct CellRow {
  static constexpr std::size_t kMostAxes = 4, kMostCorners = 1u << kMostAxes;
  /// By coordinate and corner of a cell: the coordinates at this corner of the cells; null for coordinates that are not
  /// curved.
  std::array<std::array<const double*, kMostCorners>, kMostAxes> at{};
  std::array<unsigned, kMostAxes> along{};  ///< bit a: the coordinate differs along axis a
  unsigned all_along = 0;                   ///< bit a: a coordinate differs along axis a
  std::size_t cells = 0;
  double expected = 1.0;  ///< orientation
};

}  // namespace tegl::detail
#endif  // TEGL_SRC_CURVED_FOLDS

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FoldTag = hn::CappedTag<double, 8>;
using FoldVector = hn::Vec<FoldTag>;

/// a * d - b * c
HWY_INLINE FoldVector determinant_2(FoldVector a, FoldVector b, FoldVector c, FoldVector d) {
  return hn::Sub(hn::Mul(a, d), hn::Mul(b, c));
}

/// Not fused, so that signs are those of CurvedMap::orientation.
HWY_INLINE FoldVector determinant(const FoldVector (&m)[2][2]) {
  return determinant_2(m[0][0], m[0][1], m[1][0], m[1][1]);
}
HWY_INLINE FoldVector determinant(const FoldVector (&m)[3][3]) {
  const auto part = [&](std::size_t a, std::size_t b, std::size_t c)
                        HWY_ATTR { return hn::Mul(m[0][a], determinant_2(m[1][b], m[1][c], m[2][b], m[2][c])); };
  return hn::Add(hn::Sub(part(0, 1, 2), part(1, 0, 2)), part(2, 0, 1));
}
HWY_INLINE FoldVector determinant(const FoldVector (&m)[4][4]) {
  const auto two = [&](std::size_t i, std::size_t j)
                       HWY_ATTR { return determinant_2(m[i][0], m[j][0], m[i][1], m[j][1]); };
  const auto three =
      [&](std::size_t i, FoldVector at_i, std::size_t j, FoldVector at_j, std::size_t k, FoldVector at_k)
          HWY_ATTR { return hn::Add(hn::Mul(m[i][2], at_i), hn::Sub(hn::Mul(m[k][2], at_k), hn::Mul(m[j][2], at_j))); };
  const auto of_01 = two(0, 1), of_02 = two(0, 2), of_03 = two(0, 3), of_12 = two(1, 2), of_13 = two(1, 3),
             of_23 = two(2, 3);
  const auto without_0 = three(1, of_23, 2, of_13, 3, of_12), without_1 = three(0, of_23, 2, of_03, 3, of_02);
  const auto without_2 = three(0, of_13, 1, of_03, 3, of_01), without_3 = three(0, of_12, 1, of_02, 2, of_01);
  return hn::Add(hn::Sub(hn::Mul(m[1][3], without_1), hn::Mul(m[0][3], without_0)),
                 hn::Sub(hn::Mul(m[3][3], without_3), hn::Mul(m[2][3], without_2)));
}

/// Whether the cells from cell i on have the expected orientation at all corners.
template <std::size_t N>
HWY_INLINE hn::Mask<FoldTag> have_orientation(const CellRow& row, std::size_t i) {
  const FoldTag d;
  auto result = hn::Eq(hn::Zero(d), hn::Zero(d));
  for (unsigned corner = 0; corner < 1u << N; ++corner) {
    if ((corner & ~row.all_along) != 0) continue;
    FoldVector edges[N][N];
    for (std::size_t c = 0; c < N; ++c)
      for (std::size_t a = 0; a < N; ++a) {
        if (row.at[c][0] == nullptr)
          edges[c][a] = hn::Set(d, a == c ? 1.0 : 0.0);
        else if ((row.along[c] >> a & 1u) == 0)
          edges[c][a] = hn::Zero(d);
        else
          edges[c][a] =
              hn::Sub(hn::LoadU(d, row.at[c][corner | 1u << a] + i), hn::LoadU(d, row.at[c][corner & ~(1u << a)] + i));
      }
    result = hn::And(result, hn::Gt(hn::Mul(determinant(edges), hn::Set(d, row.expected)), hn::Zero(d)));
  }
  return result;
}

/// Sets is_other[i] to 0 for cells with the expected orientation at all corners, to another number for other cells.
template <std::size_t N>
void find_others(const CellRow& row, std::uint8_t* is_other) {
  const FoldTag d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < row.cells; i += lanes) {
    if (i + lanes > row.cells) {  // the rest, with cells before it again, or one by one
      i = row.cells >= lanes ? row.cells - lanes : i;
      if (row.cells < lanes) {
        for (; i < row.cells; ++i) is_other[i] = 1;
        return;
      }
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, have_orientation<N>(row, i), bits);
    for (std::size_t k = 0; k < lanes; ++k) is_other[i + k] = (bits[0] >> k & 1u) == 0 ? 1 : 0;
  }
}

void find_others_2(const CellRow& row, std::uint8_t* is_other) { find_others<2>(row, is_other); }
void find_others_3(const CellRow& row, std::uint8_t* is_other) { find_others<3>(row, is_other); }
void find_others_4(const CellRow& row, std::uint8_t* is_other) { find_others<4>(row, is_other); }

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl {
namespace detail {

HWY_EXPORT(find_others_2);
HWY_EXPORT(find_others_3);
HWY_EXPORT(find_others_4);

namespace {

/// Rows of a coordinate as arrays of double: in place, or copies, of which some are kept, as a row of cells needs most
/// rows of the one before it.
class DoubleRows {
 public:
  explicit DoubleRows(std::size_t count) : copies_(CellRow::kMostCorners * count), count_(count) {}
  /// Starts a row of cells, which may ask for fewer rows of coordinates than kMostCorners.
  void start() noexcept { ++current_; }
  /// The coordinates one[first], one[first + step], ... The pointer is valid until the next row of cells starts.
  const double* row(const CurvedAxis& one, std::size_t first, std::size_t step) {
    if (step == 1 && !one.values.empty()) return one.values.data() + first;
    const auto found = std::find(first_.begin(), first_.end(), first);
    if (found != first_.end()) {
      const auto slot = static_cast<std::size_t>(found - first_.begin());
      used_[slot] = current_;
      return copies_.data() + count_ * slot;
    }
    while (used_[next_] == current_) next_ = (next_ + 1) % first_.size();  // the oldest one may be needed again
    double* const to = copies_.data() + count_ * next_;
    first_[next_] = first;
    used_[next_] = current_;
    next_ = (next_ + 1) % first_.size();
    const auto copy = [&](const auto* from, std::size_t pitch) {
      for (std::size_t i = 0; i < count_; ++i, from += step * pitch) to[i] = static_cast<double>(*from);
    };
    const std::size_t at = one.points.pitch() * first + one.column;
    if (!one.values.empty())
      copy(one.values.data() + first, 1);
    else if (one.points.floats() != nullptr)
      copy(one.points.floats() + at, one.points.pitch());
    else
      copy(one.points.doubles() + at, one.points.pitch());
    return to;
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> first_ = std::vector<std::size_t>(CellRow::kMostCorners, kNone);  ///< of the copies
  std::vector<std::size_t> used_ = std::vector<std::size_t>(CellRow::kMostCorners, 0);  ///< by which row of cells, last
  std::vector<double> copies_;
  std::size_t current_ = 0;  ///< number of the row of cells, from 1
  std::size_t count_;        ///< of coordinates in a row
  std::size_t next_ = 0;
};

/// Finds folded cells, row by row along the first axis along which coordinates differ.
template <int N>
class FoldFinder {
 public:
  using SampleIndex = std::array<std::size_t, N>;

  FoldFinder(const Grid<N>& grid, std::span<const CurvedAxis> curved) : map_(grid, curved), curved_(curved) {
    axis_ = std::countr_zero(map_.along());
    for (int a = 0; a < N; ++a) {
      const bool differs = (map_.along() >> a & 1u) != 0;
      const std::size_t size = grid.axes[a].size() - 1;
      cells_[a] = differs ? size : 1;
      rows_ *= a == axis_ ? 1 : cells_[a];
      alike_ *= differs ? 1 : size;
    }
    for (std::size_t k = 0; k < curved.size(); ++k)
      for (std::size_t a = 0, stride = 1; a < N; ++a) {
        if ((curved[k].along >> a & 1u) == 0) continue;
        strides_[k][a] = stride;
        stride *= grid.axes[a].size();
      }
    expected_ = map_.main_orientation();
  }

  [[nodiscard]] GridFolds<N> find(const WorkOptions& work) const {
    GridFolds<N> folds;
    if (cells_[axis_] == 0) return folds;
    std::atomic<std::uint64_t> found{0};
    std::atomic<std::size_t> first{std::numeric_limits<std::size_t>::max()};
    const auto find_in = [&](std::size_t /*block*/, std::size_t from, std::size_t to, Scratch& own) {
      for (std::size_t row = from; row < to; ++row) {
        find_others(row, own);
        for (std::size_t i = 0; i < cells_[axis_]; ++i) {
          if (own.is_other[i] == 0 || !is_folded(row, i)) continue;
          found.fetch_add(1, std::memory_order_relaxed);
          lower_to(first, row * cells_[axis_] + i);
        }
      }
    };
    constexpr std::size_t kCells = 1u << 15;  // of a block
    const std::size_t block = std::max<std::size_t>(1, kCells / cells_[axis_]);
    for_each_block(
        rows_, block, work.threads, work.progress, [&] { return make_scratch(); }, find_in);
    folds.cells = found * alike_;
    if (folds.cells > 0) folds.first = cell_of(first / cells_[axis_], first % cells_[axis_]);
    return folds;
  }

 private:
  /// Cell i of a row. All axes before `axis_` have one cell.
  [[nodiscard]] SampleIndex cell_of(std::size_t row, std::size_t i) const noexcept {
    SampleIndex cell{};
    for (int a = 0; a < N; ++a) {
      cell[a] = a == axis_ ? i : row % cells_[a];
      row /= a == axis_ ? 1 : cells_[a];
    }
    return cell;
  }

  /// Whether the cell has another orientation than expected at a corner, and all its coordinates are known.
  [[nodiscard]] bool is_folded(std::size_t row, std::size_t i) const noexcept {
    const SampleIndex cell = cell_of(row, i);
    bool result = false;
    for (unsigned corner = 0; corner < 1u << N; ++corner) {
      if ((corner & ~map_.along()) != 0) continue;
      const double orientation = map_.orientation(cell, corner);
      if (std::isnan(orientation)) return false;
      result = result || orientation != expected_;
    }
    return result;
  }

  /// Memory of one thread.
  struct Scratch {
    std::vector<DoubleRows> rows;        ///< by coordinate
    std::vector<std::uint8_t> is_other;  ///< by cell of a row: not 0 if it may be folded
  };
  [[nodiscard]] Scratch make_scratch() const {
    return {std::vector<DoubleRows>(curved_.size(), DoubleRows(cells_[axis_] + 1)),
            std::vector<std::uint8_t>(cells_[axis_])};
  }

  /// Marks cells of a row whose orientation is not the expected one, or not known.
  void find_others(std::size_t number, Scratch& own) const {
    const SampleIndex cell = cell_of(number, 0);
    CellRow row;
    row.all_along = map_.along();
    row.cells = cells_[axis_];
    row.expected = expected_;
    for (std::size_t k = 0; k < curved_.size(); ++k) {
      const CurvedAxis& one = curved_[k];
      row.along[static_cast<std::size_t>(one.axis)] = one.along;
      own.rows[k].start();
      for (unsigned corner = 0; corner < 1u << N; ++corner) {
        if ((corner >> axis_ & 1u) != 0) continue;
        std::size_t first = 0;
        for (int a = 0; a < N; ++a) first += (cell[a] + (corner >> a & 1u)) * strides_[k][a];
        const double* const at = own.rows[k].row(one, first, strides_[k][axis_]);
        row.at[static_cast<std::size_t>(one.axis)][corner] = at;
        row.at[static_cast<std::size_t>(one.axis)][corner | 1u << axis_] = at + 1;
      }
    }
    if constexpr (N == 2) HWY_DYNAMIC_DISPATCH(find_others_2)(row, own.is_other.data());
    if constexpr (N == 3) HWY_DYNAMIC_DISPATCH(find_others_3)(row, own.is_other.data());
    if constexpr (N == 4) HWY_DYNAMIC_DISPATCH(find_others_4)(row, own.is_other.data());
  }

  CurvedMap<N> map_;
  std::span<const CurvedAxis> curved_;
  int axis_ = 0;         ///< of the rows
  SampleIndex cells_{};  ///< along the axes; 1 along axes along which cells are alike
  std::size_t rows_ = 1, alike_ = 1;
  std::array<SampleIndex, N> strides_{};  ///< by coordinate
  double expected_ = 1.0;
};

}  // namespace
}  // namespace detail

template <int N>
requires DimensionBetween<N, 2, 4> GridFolds<N> find_folds(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                                           const WorkOptions& work, const CurvedSeams<N>& seams) {
  detail::require_curved<N>(grid, curved);
  if (!seams.empty()) {
    const detail::LongerCurved<N> longer = detail::longer_curved<N>(grid, curved, seams);
    return find_folds<N>(longer.grid, longer.curved, work);
  }
  if (curved.empty()) return {};
  return detail::FoldFinder<N>(grid, curved).find(work);
}

#define TEGL_INSTANTIATE_FOLDS(N)                                                                      \
  template GridFolds<N> find_folds<N>(const Grid<N>&, std::span<const CurvedAxis>, const WorkOptions&, \
                                      const CurvedSeams<N>&);
TEGL_INSTANTIATE_FOLDS(2)
TEGL_INSTANTIATE_FOLDS(3)
TEGL_INSTANTIATE_FOLDS(4)
#undef TEGL_INSTANTIATE_FOLDS

}  // namespace tegl

#endif  // HWY_ONCE
