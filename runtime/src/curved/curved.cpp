// SPDX-License-Identifier: BSD-3-Clause
//
// Contours on curved grids; see tegl/curved.hpp.
#include "tegl/curved.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/LU>

#include "base/atomic_minimum.hpp"
#include "base/periods.hpp"
#include "base/workers.hpp"
#include "curved/curved_map.hpp"
#include "curved/curved_seams.hpp"
#include "periodic/periodic_layers.hpp"

namespace tegl {
namespace {

template <int N, class Real>
std::array<double, N> widened(const Real* point) noexcept {
  std::array<double, N> result;
  std::copy_n(point, N, result.begin());
  return result;
}

/// Moves vertices and normals.
template <int N>
class Mover {
 public:
  /// `indices`: grid of the points.
  Mover(const Grid<N>& grid, std::span<const CurvedAxis> curved, Grid<N> indices, std::span<const CurvedSeam<N>> seams)
      : map_(grid, curved), indices_(std::move(indices)), locator_(indices_) {
    map_.set_seams(seams);
    is_straight_and_needed_ = (map_.along() & ~map_.curved()) != 0;
    for (int a = 0; a < N; ++a) steps_[a] = map_.is_curved(a) ? indices_.axes[a].step() : 0.0;
  }

  /// The place of a point of the index grid.
  [[nodiscard]] detail::CellPlace<N> place_of(const std::array<double, N>& point) const noexcept {
    detail::CellPlace<N> place{};
    if (is_straight_and_needed_) {
      locator_.find_nearest(point, place);
      return place;
    }
    for (int a = 0; a < N; ++a) {
      const double index = std::max(point[a] * steps_[a], 0.0);
      const auto base = static_cast<std::int64_t>(index);  // to unsigned numbers the conversion has branches
      place.base[a] = static_cast<std::size_t>(base);
      place.share[a] = index - static_cast<double>(base);
    }
    return place;
  }

  /// The axes, as bits, whose coordinates are moved.
  [[nodiscard]] unsigned moved() const noexcept { return map_.curved(); }
  /// Finds the edges of the first block.count of kMost points.
  template <class Real>
  void find_edges(const Real* points, detail::CurvedBlock& block) const noexcept {
    if (!is_straight_and_needed_) {
      map_.find_edges(points, steps_, block);
      return;
    }
    block.inside = 0;
    for (std::size_t i = 0; i < block.count; ++i) map_.set_edge(i, place_of(widened<N>(points + i * N)), block);
  }
  /// Starts to load coordinates at the edges of a block.
  void request(const detail::CurvedBlock& block) const noexcept { map_.request(block); }
  /// Sets the curved coordinates of the points of a block in `moved`, NaN where they are unknown. Meanwhile starts to
  /// load the coordinates of `next`. Returns whether all are known; false is possible although they are.
  template <class Real, class Moved>
  bool move(const Real* points, const detail::CurvedBlock& block, const detail::CurvedBlock& next,
            Moved* moved) const noexcept {
    bool known = map_.set_on_edges(block, next, moved);
    for (std::uint64_t rest = block.inside; rest != 0; rest &= rest - 1) {
      const std::size_t i = N * static_cast<std::size_t>(std::countr_zero(rest));
      known = map_.set_inside(place_of(widened<N>(points + i)), moved + i) && known;
    }
    return known;
  }

  /// The normal in space of one on the index grid: the gradient g becomes the solution x of J^T x = g.
  [[nodiscard]] std::array<double, N> turned(const std::array<double, N>& point,
                                             const std::array<double, N>& normal) const noexcept {
    const detail::CellPlace<N> place = place_of(point);
    const Matrix<N> by_index = map_.derivatives(place);
    Eigen::Matrix<double, N, N> transposed;
    Eigen::Matrix<double, N, 1> gradient;
    for (int a = 0; a < N; ++a) {
      gradient(a) = normal[a];
      for (int c = 0; c < N; ++c)
        transposed(a, c) = (map_.curved() >> c & 1u) == 0 ? (a == c ? 1.0 : 0.0) : by_index[c][a] / step_at(a, place);
    }
    const Eigen::Matrix<double, N, 1> solution = transposed.partialPivLu().solve(gradient);
    std::array<double, N> result{};
    const double length = solution.norm();
    if (std::isfinite(length) && length > 0.0)
      for (int a = 0; a < N; ++a) result[a] = solution(a) / length;
    return result;
  }

 private:
  /// The step of the index grid along an axis.
  [[nodiscard]] double step_at(int a, const detail::CellPlace<N>& place) const noexcept {
    const Axis& axis = indices_.axes[a];
    if (axis.is_uniform() || axis.size() < 2) return axis.step();
    const std::size_t base = std::min(place.base[a], axis.size() - 2);
    return axis[base + 1] - axis[base];
  }

  detail::CurvedMap<N> map_;
  detail::IndexSteps steps_{};  ///< of the indices, 1 or -1; 0 along straight axes
  Grid<N> indices_;
  detail::GridLocator<N> locator_;
  bool is_straight_and_needed_ = false;  ///< whether curved coordinates differ along an axis with its own coordinates
};

/// The first point of a block whose coordinates in space are not known; block.count if there is none.
template <class Real, int N>
std::size_t first_unknown(const Mover<N>& mover, const Real* points, const detail::CurvedBlock& block) noexcept {
  detail::CurvedBlock::Points<double> moved{};  // not rounded to Real, which may be infinite
  mover.move(points, block, {}, moved.data());
  for (std::size_t i = 0; i < block.count; ++i)
    for (int a = 0; a < N; ++a)
      if ((mover.moved() >> a & 1u) != 0 && !std::isfinite(moved[N * i + static_cast<std::size_t>(a)])) return i;
  return block.count;
}

template <int N>
[[noreturn]] void throw_unknown(const Mover<N>& mover, const std::array<double, N>& point) {
  const detail::CellPlace<N> place = mover.place_of(point);
  std::vector<std::size_t> index(place.base.begin(), place.base.end());
  throw Error(ErrorCode::UnsupportedData,
              fmt::format("the contour crosses the cell at the sample ({}), which has unknown coordinates; expected "
                          "missing values there",
                          fmt::join(index, ", ")));
}

/// Moves a contour by a mover.
template <class Real, int N>
void move_contour(const Mover<N>& mover, std::span<const CurvedAxis> curved, const WorkOptions& work,
                  Contour<N, Real>& contour) {
  const std::size_t vertices = contour.vertices.size();
  // The first vertex without a place keeps its indices, for the message.
  std::atomic<std::size_t> unknown{vertices};
  detail::for_each_part(vertices, work.threads, work.progress, [&](std::size_t from, std::size_t to) {
    // While one block is moved, the coordinates of a later one are requested, as memory is slow.
    constexpr std::size_t kMost = detail::CurvedBlock::kMost, kAhead = 2;
    std::array<detail::CurvedBlock, kAhead + 1> blocks;
    detail::CurvedBlock::Points<Real> unmoved{}, rest{};
    const auto find_edges = [&](std::size_t first) -> detail::CurvedBlock& {
      detail::CurvedBlock& block = blocks[(first - from) / kMost % blocks.size()];
      block.count = first < to ? std::min(to - first, kMost) : 0;
      if (block.count == 0) return block;
      const Real* points = contour.vertices[first].data();
      if (block.count < kMost) points = (std::copy_n(points, N * block.count, rest.begin()), rest.data());
      mover.find_edges(points, block);
      return block;
    };
    for (std::size_t k = 0; k < kAhead; ++k) mover.request(find_edges(from + k * kMost));
    for (std::size_t first = from; first < to; first += kMost) {
      const detail::CurvedBlock& block = blocks[(first - from) / kMost % blocks.size()];
      Real* const points = contour.vertices[first].data();
      std::copy_n(points, N * block.count, unmoved.begin());
      if (!mover.move(unmoved.data(), block, find_edges(first + kAhead * kMost), points))
        if (const std::size_t i = first_unknown(mover, unmoved.data(), block); i < block.count) {
          std::copy_n(unmoved.begin(), N * block.count, points);
          detail::lower_to(unknown, first + i);
          continue;
        }
      for (std::size_t i = 0; i < block.count && !contour.normals.empty(); ++i) {
        auto& normal = contour.normals[first + i];
        const auto turned = mover.turned(widened<N>(unmoved.data() + N * i), detail::widened_point<N>(normal));
        for (int a = 0; a < N; ++a) normal[a] = static_cast<Real>(turned[a]);
      }
    }
  });
  if (unknown < vertices) throw_unknown<N>(mover, detail::widened_point<N>(contour.vertices[unknown]));
  for (const CurvedAxis& one : curved) {
    if (!one.name.empty()) contour.axis_names[one.axis] = one.name;
    if (!one.unit.empty()) contour.axis_units[one.axis] = one.unit;
  }
}

/// As index_grid; `step`: of the first curved axis.
template <int N>
Grid<N> with_indices(const Grid<N>& grid, std::span<const CurvedAxis> curved, double step) {
  Grid<N> result = grid;
  for (const CurvedAxis& one : curved) {
    const Axis& own = grid.axes[one.axis];
    Axis axis = Axis::uniform(own.size(), 0.0, std::exchange(step, 1.0));
    axis.name = own.name;
    axis.unit = own.unit;
    result.axes[one.axis] = std::move(axis);
  }
  return result;
}

/// The grid of a contour's indices. The sign of the first curved axis's step is the sign of its vertices' coordinates:
/// finding it by the grid's orientation would read memory. Coordinates near 0 may have another sign if the contour was
/// smoothed or simplified, so they count only if all are near 0.
template <int N, class Real>
Grid<N> index_grid_of(const Contour<N, Real>& contour, const Grid<N>& grid, std::span<const CurvedAxis> curved) {
  detail::require_curved<N>(grid, curved);
  if (curved.empty()) return grid;
  const auto axis = static_cast<std::size_t>(curved.front().axis);
  const auto beyond = [&](double least) {
    const auto is_beyond = [&](const auto& vertex) { return std::abs(vertex[axis]) > least; };
    return std::find_if(contour.vertices.begin(), contour.vertices.end(), is_beyond);
  };
  for (const double least : {0.5, 0x1p-10, 0.0})
    if (const auto found = beyond(least); found != contour.vertices.end())
      return with_indices(grid, curved, (*found)[axis] < 0 ? -1.0 : 1.0);
  return with_indices(grid, curved, detail::CurvedMap<N>(grid, curved).main_orientation());
}

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 4> Grid<N> index_grid(const Grid<N>& grid, std::span<const CurvedAxis> curved) {
  detail::require_curved<N>(grid, curved);
  if (curved.empty()) return grid;
  return with_indices(grid, curved, detail::CurvedMap<N>(grid, curved).main_orientation());
}

template <Coordinate Real, int N>
requires DimensionBetween<N, 2, 4> Contour<N, Real> on_curved_grid(Contour<N, Real> contour, const Grid<N>& grid,
                                                                   std::span<const CurvedAxis> curved,
                                                                   const WorkOptions& work,
                                                                   const CurvedSeams<N>& seams) {
  Grid<N> indices = index_grid_of(contour, grid, curved);
  if (seams.empty()) {
    detail::require_unwrapped(contour, "on_curved_grid");
    move_contour<Real, N>(Mover<N>(grid, curved, std::move(indices), {}), curved, work, contour);
    return contour;
  }
  if (contour.periods.size() != seams.size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("on_curved_grid: a contour with {} periods and {} seams; expected as many",
                            contour.periods.size(), seams.size()));
  const detail::LongerCurved<N> longer = detail::longer_curved<N>(grid, curved, seams);
  indices = detail::longer_grid<N>(indices, index_periods<N>(grid, curved, seams));
  contour.periods.clear();
  move_contour<Real, N>(Mover<N>(longer.grid, longer.curved, std::move(indices), seams), curved, work, contour);
  contour.periods = detail::periods_of_seams<N>(grid, curved, seams);
  if (contour.periods.empty()) return contour;
  for (auto& vertex : contour.vertices) {
    std::array<double, N> place = detail::widened_point<N>(vertex);
    detail::move_inside<N, Real>(contour.periods, place);
    for (int a = 0; a < N; ++a) vertex[a] = static_cast<Real>(place[a]);
  }
  return contour;
}

#define TEGL_INSTANTIATE_CURVED(N)                                                                                    \
  template Grid<N> index_grid<N>(const Grid<N>&, std::span<const CurvedAxis>);                                        \
  template Contour<N, float> on_curved_grid<float, N>(Contour<N, float>, const Grid<N>&, std::span<const CurvedAxis>, \
                                                      const WorkOptions&, const CurvedSeams<N>&);                     \
  template Contour<N, double> on_curved_grid<double, N>(                                                              \
      Contour<N, double>, const Grid<N>&, std::span<const CurvedAxis>, const WorkOptions&, const CurvedSeams<N>&);
TEGL_INSTANTIATE_CURVED(2)
TEGL_INSTANTIATE_CURVED(3)
TEGL_INSTANTIATE_CURVED(4)
#undef TEGL_INSTANTIATE_CURVED

}  // namespace tegl
