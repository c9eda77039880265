// SPDX-License-Identifier: BSD-3-Clause
#include "curved/curved_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <Eigen/LU>

#include "hwy/cache_control.h"

namespace tegl::detail {

/// Whether both are stored by points, and have the same number in memory at each sample. The same numbers along other
/// axes are other coordinates.
static bool are_same_numbers(const CurvedAxis& one, const CurvedAxis& other) {
  return one.values.empty() && other.values.empty() && one.along == other.along &&
         one.points.pitch() == other.points.pitch() &&
         (one.points.floats() != nullptr) == (other.points.floats() != nullptr) &&
         first_address(one) == first_address(other);
}

template <int N>
void require_curved(const Grid<N>& grid, std::span<const CurvedAxis> curved) {
  const auto fail = [](const std::string& text) { throw Error(ErrorCode::InvalidGrid, text); };
  if (grid.has_world_map()) fail("a curved grid with a world map; expected coordinates in space");
  unsigned seen = 0;
  for (const CurvedAxis& one : curved) {
    if (one.axis < 0 || one.axis >= N)
      fail(fmt::format("curved coordinates of axis {}; expected an axis from 0 to {}", one.axis, N - 1));
    if ((seen >> one.axis & 1u) != 0) fail(fmt::format("two curved coordinates of axis {}; expected one", one.axis));
    seen |= 1u << one.axis;
    if ((one.along >> one.axis & 1u) == 0 || one.along >> N != 0)
      fail(fmt::format(
          "curved coordinates of axis {} along the axes of the bits {}; expected this axis and others below "
          "{}",
          one.axis, one.along, N));
    std::size_t samples = 1;
    for (int a = 0; a < N; ++a)
      if ((one.along >> a & 1u) != 0) samples *= grid.axes[a].size();
    if (one.size() != samples)
      fail(fmt::format("{} curved coordinates of axis {}; expected {}, one for each sample", one.size(), one.axis,
                       samples));
    if (!one.values.empty()) continue;
    if (one.column >= one.points.columns())
      fail(fmt::format("column {} of the points for axis {}; expected a number below {}", one.column, one.axis,
                       one.points.columns()));
    for (const CurvedAxis* other = curved.data(); other != &one; ++other)
      if (are_same_numbers(*other, one))
        fail(
            fmt::format("the curved coordinates of axis {} and of axis {} are the same numbers in memory; expected "
                        "coordinates of its own for each axis",
                        other->axis, one.axis));
  }
}

template <int N>
CurvedMap<N>::CurvedMap(const Grid<N>& grid, std::span<const CurvedAxis> curved) : axes_(curved), sizes_(grid.sizes()) {
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    curved_ |= 1u << axes_[k].axis;
    along_ |= axes_[k].along;
    std::size_t stride = 1;
    for (int a = 0; a < N; ++a) {
      if ((axes_[k].along >> a & 1u) == 0) continue;
      strides_[k][a] = stride;
      stride *= sizes_[a];
    }
    add_array(axes_[k], strides_[k]);
  }
  for (CurvedArrays& each : arrays_) each.find_columns(N);
}

template <int N>
void CurvedMap<N>::add_array(const CurvedAxis& one, const SampleIndex& strides) {
  CurvedArrays group{};
  group.pitch = one.values.empty() ? one.points.pitch() : 1;
  group.are_floats = one.values.empty() && one.points.floats() != nullptr;
  for (int a = 0; a < N; ++a) group.strides[a] = strides[a] * group.pitch;
  auto same = std::find_if(arrays_.begin(), arrays_.end(), [&](const CurvedArrays& of) {
    return of.strides == group.strides && of.pitch == group.pitch && of.are_floats == group.are_floats;
  });
  if (same == arrays_.end()) same = arrays_.insert(same, group);
  constexpr std::size_t kLarge = std::size_t{1} << 20;  // bytes
  const std::size_t numbers = one.size() * group.pitch;
  same->is_large = numbers * (group.are_floats ? sizeof(float) : sizeof(double)) > kLarge;
  same->fits_32_bits = numbers <= std::numeric_limits<std::int32_t>::max();
  const auto axis = static_cast<std::size_t>(one.axis);
  if (group.are_floats)
    same->add(one.points.floats() + one.column, axis);
  else
    same->add(one.values.empty() ? one.points.doubles() + one.column : one.values.data(), axis);
}

template <int N>
double CurvedMap<N>::orientation(const SampleIndex& cell, unsigned corner) const noexcept {
  SampleIndex at = cell;
  for (int a = 0; a < N; ++a) at[a] += corner >> a & 1u;
  // The determinant's rows of straight axes are unit vectors.
  Matrix<N> edges = identity<N>();
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const double here = value(k, at);
    for (int a = 0; a < N; ++a) {
      double& edge = edges[axes_[k].axis][a];
      edge = 0.0;
      if ((axes_[k].along >> a & 1u) == 0) continue;
      SampleIndex other = at;
      other[a] = cell[a] + 1 - (corner >> a & 1u);
      edge = (corner >> a & 1u) != 0 ? here - value(k, other) : value(k, other) - here;
    }
  }
  Eigen::Matrix<double, N, N> matrix;
  for (int c = 0; c < N; ++c)
    for (int a = 0; a < N; ++a) matrix(c, a) = edges[c][a];
  const double determinant = matrix.determinant();
  return std::isnan(determinant) ? determinant : static_cast<double>((determinant > 0.0) - (determinant < 0.0));
}

template <int N>
double CurvedMap<N>::main_orientation() const {
  constexpr std::size_t kSamples = 499;  // a prime, so that the cells are not all at the same place along an axis
  std::size_t cells = 1;
  for (int a = 0; a < N; ++a) cells *= (along_ >> a & 1u) != 0 ? std::max<std::size_t>(sizes_[a], 2) - 1 : 1;
  const std::size_t step = std::max<std::size_t>(1, cells / kSamples);
  std::vector<SampleIndex> some;
  for (std::size_t number = 0; number < cells; number += step) {
    SampleIndex cell{};
    std::size_t rest = number;
    bool is_cell = true;
    for (int a = 0; a < N; ++a) {
      if ((along_ >> a & 1u) == 0) continue;
      if (sizes_[a] < 2) is_cell = false;
      const std::size_t size = std::max<std::size_t>(sizes_[a], 2) - 1;
      cell[a] = rest % size;
      rest /= size;
    }
    if (is_cell) some.push_back(cell);
  }
  // Far apart in memory, so they are requested ahead.
  constexpr std::size_t kAhead = 24;
  double sum = 0.0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    // no function of its own: GCC removes calls of functions that only prefetch
    for (std::size_t k = 0; k < axes_.size() && i + kAhead < some.size(); ++k) {
      const CurvedAxis& one = axes_[k];
      std::size_t here = 0;
      for (int a = 0; a < N; ++a) here += some[i + kAhead][a] * strides_[k][a];
      for (int a = -1; a < N; ++a) {
        const std::size_t at = here + (a < 0 ? 0 : strides_[k][a]), number = one.points.pitch() * at + one.column;
        if (!one.values.empty())
          hwy::Prefetch(one.values.data() + at);
        else if (one.points.floats() != nullptr)
          hwy::Prefetch(one.points.floats() + number);
        else
          hwy::Prefetch(one.points.doubles() + number);
      }
    }
    const double sign = orientation(some[i], 0);
    if (!std::isnan(sign)) sum += sign;
  }
  return sum < 0.0 ? -1.0 : 1.0;
}

template <int N>
void CurvedMap<N>::set_edge(std::size_t i, const CellPlace<N>& place, CurvedBlock& block) const noexcept {
  double share = 0.0;
  unsigned axes = 0;
  for (int a = 0; a < N; ++a) {
    if ((along_ >> a & 1u) == 0 || place.share[a] == 0.0) continue;
    share += place.share[a];
    axes |= 1u << a;
  }
  if (std::popcount(axes) > 1 || share == 1.0) block.inside |= std::uint64_t{1} << i;
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    std::size_t first = 0, step = 0;
    for (int a = 0; a < N; ++a) {
      first += place.base[a] * arrays_[k].strides[a];
      if ((axes >> a & 1u) != 0) step += arrays_[k].strides[a];
    }
    block.ends[k].first[i] = static_cast<std::int64_t>(first);
    block.ends[k].second[i] = static_cast<std::int64_t>(first + step);
    block.ends[k].weight[i] = step != 0 ? share : 0.0;
  }
}

template <int N>
void CurvedMap<N>::request(const CurvedBlock& block) const noexcept {
  for (std::size_t k = 0; k < arrays_.size(); ++k) detail::request(arrays_[k], block.ends[k], block.count);
}

template <int N>
double CurvedMap<N>::inside(std::size_t k, const CellPlace<N>& place) const noexcept {
  const CellCorners<N> corners = weighted_corners<N>(place, along_);
  double sum = 0.0;
  for (unsigned i = 0; i < corners.count; ++i) sum += corners.weight[i] * value(k, corners.index[i]);
  return sum;
}

template <int N>
double CurvedMap<N>::difference(std::size_t k, const SampleIndex& index, int a) const noexcept {
  const double here = value(k, index);
  double low = here, high = here, steps = 0.0;
  // one-sided at the border and next to unknown coordinates
  const auto take = [&](std::size_t to, double turn, double& x) {
    SampleIndex at = index;
    at[a] = to;
    const double there = value(k, at) + turn;
    if (std::isnan(there)) return;
    x = there;
    ++steps;
  };
  const bool wraps = (periodic_ >> a & 1u) != 0;
  const double turn = turns_[a][axes_[k].axis];
  if (index[a] > 0)
    take(index[a] - 1, 0.0, low);
  else if (wraps)
    take(sizes_[a] - 2, -turn, low);
  if (index[a] + 1 < sizes_[a])
    take(index[a] + 1, 0.0, high);
  else if (wraps)
    take(1, turn, high);
  return steps > 0.0 ? (high - low) / steps : 0.0;
}

template <int N>
Matrix<N> CurvedMap<N>::derivatives(const CellPlace<N>& place) const noexcept {
  Matrix<N> result{};
  const CellCorners<N> corners = weighted_corners<N>(place, along_);
  for (std::size_t k = 0; k < axes_.size(); ++k)
    for (int a = 0; a < N; ++a) {
      if ((axes_[k].along >> a & 1u) == 0) continue;
      double& sum = result[axes_[k].axis][a];
      for (unsigned i = 0; i < corners.count; ++i) sum += corners.weight[i] * difference(k, corners.index[i], a);
    }
  return result;
}

#define TEGL_INSTANTIATE_CURVED(N)                                              \
  template void require_curved<N>(const Grid<N>&, std::span<const CurvedAxis>); \
  template class CurvedMap<N>;
TEGL_INSTANTIATE_CURVED(2)
TEGL_INSTANTIATE_CURVED(3)
TEGL_INSTANTIATE_CURVED(4)
#undef TEGL_INSTANTIATE_CURVED

}  // namespace tegl::detail
