// SPDX-License-Identifier: BSD-3-Clause
//
// Builds and searches the interval tree of a complex, and extracts contours with it (see tegl/cell_index.hpp).
#include "tegl/cell_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "complex/cell_groups.hpp"
#include "complex/contour_numbers.hpp"
#include "complex/point_gradients.hpp"
#include "tegl/error.hpp"

namespace tegl {

namespace {

/// The largest float that is not above a value, and the smallest that is not below it.
float rounded_down(double value) noexcept {
  if (value > double{std::numeric_limits<float>::max()}) return std::numeric_limits<float>::max();
  const auto near = static_cast<float>(std::max(value, -std::numeric_limits<double>::infinity()));
  return double{near} <= value ? near : std::nextafter(near, -std::numeric_limits<float>::infinity());
}
float rounded_up(double value) noexcept { return -rounded_down(-value); }

}  // namespace

template <int N>
CellIndex::CellIndex(const Complex<N>& complex, const WorkOptions& work)
    : all_cells_(complex.cell_count()), points_(complex.points().size()) {
  std::vector<Range> ranges;
  Index cell = 0;
  const std::vector<double>& values = complex.values();
  const auto add = [&](std::span<const Index> corners, Index number) {
    double low = values[corners[0]], high = low;
    bool is_missing = std::isnan(low);
    for (const Index corner : corners.subspan(1)) {
      const double value = values[corner];
      is_missing = is_missing || std::isnan(value);
      low = std::min(low, value);
      high = std::max(high, value);
    }
    has_missing_ = has_missing_ || is_missing;
    if (!is_missing && low < high) ranges.push_back({rounded_down(low), rounded_up(high), number});
  };
  for (const detail::CellGroup& group : detail::ComplexAccess::cells(complex).groups)
    for (std::size_t i = 0; i < group.size(); ++i, ++cell) {
      if (i % 65536 == 0)
        detail::tell(work.progress, 0.3 * static_cast<double>(cell) / static_cast<double>(all_cells_));
      add({group.cell(i), group.corner_count}, cell);
    }
  const detail::Polytopes& polytopes = detail::ComplexAccess::cells(complex).polytopes;
  for (std::size_t i = 0; i < polytopes.size(); ++i, ++cell) add(polytopes.points_of(i), cell);
  cells_ = ranges.size();
  lows_.reserve(cells_);
  highs_.reserve(cells_);
  if (!ranges.empty()) (void)add_node(ranges.data(), ranges.data() + ranges.size());
  detail::tell(work.progress, 1.0);
}

namespace {
/// The middle of a range whose ends may be infinite.
double middle_of(float low, float high) noexcept {
  constexpr float kMost = std::numeric_limits<float>::max();
  return 0.5 * static_cast<double>(std::max(low, -kMost)) + 0.5 * static_cast<double>(std::min(high, kMost));
}
}  // namespace

std::uint32_t CellIndex::add_node(Range* first, Range* end) {
  // A value in the range of the cell in the middle, so that each side has at most half of the cells.
  Range* const middle = first + (end - first) / 2;
  std::nth_element(first, middle, end, [](const Range& a, const Range& b) {
    const double of_a = middle_of(a.low, a.high), of_b = middle_of(b.low, b.high);
    return of_a < of_b || (of_a == of_b && a.cell < b.cell);
  });
  const auto centre = static_cast<float>(middle_of(middle->low, middle->high));
  const float value = middle->low < centre && centre <= middle->high ? centre : middle->high;
  Range* const inside = std::partition(first, end, [&](const Range& range) { return range.high < value; });
  Range* const above = std::partition(inside, end, [&](const Range& range) { return range.low < value; });
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({value, 0, 0, lows_.size(), lows_.size() + static_cast<std::size_t>(above - inside)});
  const auto begin = static_cast<std::ptrdiff_t>(lows_.size());
  for (const Range* range = inside; range != above; ++range) {
    lows_.push_back({range->low, range->cell});
    highs_.push_back({range->high, range->cell});
  }
  std::sort(lows_.begin() + begin, lows_.end(), [](const End& a, const End& b) { return a.value < b.value; });
  std::sort(highs_.begin() + begin, highs_.end(), [](const End& a, const End& b) { return a.value > b.value; });
  if (first != inside) {
    const std::uint32_t child = add_node(first, inside);
    nodes_[node].below = child;
  }
  if (above != end) {
    const std::uint32_t child = add_node(above, end);
    nodes_[node].above = child;
  }
  return node;
}

std::vector<Index> CellIndex::find(double isovalue) const {
  std::vector<Index> cells;
  if (nodes_.empty()) return cells;
  // active: minimum < isovalue <= maximum
  for (std::uint32_t at = 0;;) {
    const Node& node = nodes_[at];
    const bool is_below = isovalue <= double{node.value};
    const std::vector<End>& ends = is_below ? lows_ : highs_;
    for (std::size_t i = node.first; i < node.end; ++i) {
      const double value = double{ends[i].value};
      if (is_below ? value >= isovalue : value < isovalue) break;
      cells.push_back(ends[i].cell);
    }
    at = is_below ? node.below : node.above;
    if (at == 0) break;
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

template <Coordinate Real, int N>
requires DimensionBetween<N, 2, 4> Extraction<N, Real> extract_with_stats(const Complex<N>& complex,
                                                                          const CellIndex& index, double isovalue,
                                                                          const ExtractOptions& options) {
  if (index.cell_count() != complex.cell_count() || index.point_count() != complex.points().size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("an index of {} cells and {} points; the complex has {} and {}", index.cell_count(),
                            index.point_count(), complex.cell_count(), complex.points().size()));
  if (index.has_missing()) return extract_with_stats<Real>(complex, isovalue, options);
  detail::check_complex_options(isovalue, options);
  detail::Stopwatch watch;
  const std::vector<Index> active = index.find(isovalue);
  double seconds = 0;
  watch.add_to(seconds);
  detail::Surroundings<N> around;
  around.active = &active;
  Extraction<N, Real> result = detail::extract_in<Real>(complex, isovalue, options, around);
  result.stats.find_seconds += seconds;
  return result;
}

#define TEGL_INSTANTIATE_WITH_INDEX(N)                                                                      \
  template Extraction<N, float> extract_with_stats<float, N>(const Complex<N>&, const CellIndex&, double,   \
                                                             const ExtractOptions&);                        \
  template Extraction<N, double> extract_with_stats<double, N>(const Complex<N>&, const CellIndex&, double, \
                                                               const ExtractOptions&);
TEGL_INSTANTIATE_WITH_INDEX(2)
TEGL_INSTANTIATE_WITH_INDEX(3)
TEGL_INSTANTIATE_WITH_INDEX(4)
#undef TEGL_INSTANTIATE_WITH_INDEX

template CellIndex::CellIndex(const Complex<2>&, const WorkOptions&);
template CellIndex::CellIndex(const Complex<3>&, const WorkOptions&);
template CellIndex::CellIndex(const Complex<4>&, const WorkOptions&);

}  // namespace tegl
