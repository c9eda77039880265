// SPDX-License-Identifier: BSD-3-Clause
#include "tegl/curved_points.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "base/workers.hpp"
#include "tegl/contour.hpp"
#include "tegl/curved.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace {

/// Aligned, so that no sample is in two cache lines.
template <class T>
struct alignas(CurvedPoints::kMostColumns * sizeof(T)) Cell {
  std::array<T, CurvedPoints::kMostColumns> numbers;
};

template <class T>
bool is_exact(double x) noexcept {
  return std::is_same_v<T, double> || std::isnan(x) || static_cast<double>(static_cast<float>(x)) == x;
}

/// Copies numbers to a column, as far as T represents them exactly. Returns whether it does.
template <class T, class From>
bool copy_column(const From* from, std::ptrdiff_t step, std::size_t count, T* to, std::size_t pitch) noexcept {
  bool exact = true;
  for (std::size_t i = 0; i < count; ++i) {
    const From x = from[static_cast<std::ptrdiff_t>(i) * step];
    if constexpr (sizeof(From) > sizeof(T)) exact = exact & is_exact<T>(x);
    to[pitch * i] = static_cast<T>(x);
  }
  return exact;
}

/// Copies all arrays in parallel, as far as T represents them exactly. Returns whether it does.
template <class T>
bool copy_columns(std::span<const CoordinateArray> arrays, std::size_t samples, unsigned threads, T* to,
                  std::size_t pitch) {
  constexpr std::size_t kAtOnce = 1024;  // so that all columns are written while the lines are in the nearest cache
  std::atomic<bool> exact{true};
  detail::for_each_part(samples, threads, {}, [&](std::size_t from, std::size_t end) {
    for (std::size_t first = from; first < end && exact.load(std::memory_order_relaxed); first += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, end - first);
      T* const out = to + pitch * first;
      std::fill_n(out, pitch * count, T{});
      for (std::size_t c = 0; c < arrays.size(); ++c) {
        const auto copy = [&](const auto* numbers) {
          const std::ptrdiff_t step = arrays[c].step;
          return copy_column(numbers + static_cast<std::ptrdiff_t>(first) * step, step, count, out + c, pitch);
        };
        if (!std::visit(copy, arrays[c].first)) exact.store(false, std::memory_order_relaxed);
      }
    }
  });
  return exact;
}

}  // namespace

template <class T>
T* CurvedPoints::allocate() {
  const auto cells = std::make_shared<Buffer<Cell<T>>>((size_ * pitch_ + kMostColumns - 1) / kMostColumns);
  T* const numbers = cells->empty() ? nullptr : cells->data()->numbers.data();
  if constexpr (std::is_same_v<T, float>)
    floats_ = numbers;
  else
    doubles_ = numbers;
  memory_ = cells;
  return numbers;
}

CurvedPoints::CurvedPoints(std::size_t samples, std::span<const CoordinateArray> arrays, unsigned threads)
    : size_(samples), columns_(arrays.size()), pitch_(std::bit_ceil(arrays.size())) {
  if (arrays.empty() || arrays.size() > kMostColumns)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} arrays of coordinates; expected 1 to {}", arrays.size(), kMostColumns));
  if (copy_columns(arrays, samples, threads, allocate<float>(), pitch_)) return;
  floats_ = nullptr;
  memory_.reset();  // before twice as much is requested
  copy_columns(arrays, samples, threads, allocate<double>(), pitch_);
}

CurvedPoints CurvedPoints::in_place(std::variant<const float*, const double*> first, std::size_t samples,
                                    std::size_t columns, std::size_t pitch, std::shared_ptr<const void> owner) {
  if (columns == 0 || columns > kMostColumns || pitch < columns)
    throw Error(ErrorCode::InvalidArgument, fmt::format("points of {} coordinates, {} numbers apart; expected 1 to {} "
                                                        "coordinates, and no more than these numbers",
                                                        columns, pitch, kMostColumns));
  CurvedPoints points;
  points.memory_ = std::move(owner);
  if (const auto* const floats = std::get_if<const float*>(&first))
    points.floats_ = *floats;
  else
    points.doubles_ = std::get<const double*>(first);
  points.size_ = samples;
  points.columns_ = columns;
  points.pitch_ = pitch;
  return points;
}

template <class T>
void CurvedPoints::continue_blocks(const CurvedPoints& from, std::size_t row, std::size_t block, const double* added) {
  T* to = allocate<T>();
  std::fill_n(to, pitch_ * size_, T{});
  const auto copy = [&](std::size_t first, std::size_t count, bool moves) {
    for (std::size_t i = first; i < first + count; ++i, to += pitch_)
      for (std::size_t c = 0; c < columns_; ++c)
        to[c] = static_cast<T>(moves ? from(i, c) + added[c] : from(i, c));  // -0 stays
  };
  for (std::size_t first = 0; first < from.size_; first += block) {
    copy(first, block, false);
    copy(first, row, true);
  }
}

CurvedPoints CurvedPoints::continued(std::size_t row, std::size_t block, std::span<const double> added) const {
  const std::size_t count = block == 0 ? 0 : size_ / block;
  CurvedPoints longer;
  longer.size_ = count * (block + row);
  longer.columns_ = columns_;
  longer.pitch_ = std::bit_ceil(columns_);
  bool exact = floats_ != nullptr;
  for (std::size_t c = 0; c < columns_ && exact; ++c)
    for (std::size_t b = 0; b < count && exact && added[c] != 0.0; ++b)
      for (std::size_t i = 0; i < row; ++i) exact = exact && is_exact<float>((*this)(b * block + i, c) + added[c]);
  if (exact)
    longer.continue_blocks<float>(*this, row, block, added.data());
  else
    longer.continue_blocks<double>(*this, row, block, added.data());
  return longer;
}

bool CurvedAxis::operator==(const CurvedAxis& other) const {
  if (axis != other.axis || along != other.along || name != other.name || unit != other.unit || size() != other.size())
    return false;
  for (std::size_t i = 0; i < size(); ++i) {
    const double x = (*this)[i], y = other[i];
    if (x != y && !(std::isnan(x) && std::isnan(y))) return false;
  }
  return true;
}

std::vector<CurvedAxis> by_points(std::vector<CurvedAxis> curved, std::span<const CoordinateArray> arrays,
                                  std::span<const std::size_t> sizes, unsigned threads) {
  if (arrays.size() != curved.size() || sizes.size() != curved.size())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} arrays of coordinates and {} sizes; expected {}, one for "
                                                        "each curved axis",
                                                        arrays.size(), sizes.size(), curved.size()));
  std::vector<std::size_t> left(curved.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::stable_sort(left.begin(), left.end(), [&](auto a, auto b) { return curved[a].axis < curved[b].axis; });
  while (!left.empty()) {
    const std::size_t first = left.front();
    std::vector<std::size_t> group, others;
    for (const std::size_t k : left) {
      const bool fits = curved[k].along == curved[first].along && sizes[k] == sizes[first];
      (fits && group.size() < CurvedPoints::kMostColumns ? group : others).push_back(k);
    }
    std::vector<CoordinateArray> of_group;
    for (const std::size_t k : group) of_group.push_back(arrays[k]);
    const CurvedPoints points(sizes[first], of_group, threads);
    for (std::size_t column = 0; column < group.size(); ++column) {
      curved[group[column]].points = points;
      curved[group[column]].column = static_cast<unsigned>(column);
    }
    left = std::move(others);
  }
  for (CurvedAxis& one : curved) one.values = {};
  return curved;
}

std::vector<CurvedAxis> by_points(std::vector<CurvedAxis> curved, unsigned threads) {
  std::vector<CoordinateArray> arrays;
  std::vector<std::size_t> sizes;
  std::vector<CurvedPoints> before;  // keeps the memory of coordinates that are already stored
  for (const CurvedAxis& one : curved) {
    const auto pitch = static_cast<std::ptrdiff_t>(one.points.pitch());
    if (!one.values.empty())
      arrays.push_back({one.values.data()});
    else if (one.points.floats() != nullptr)
      arrays.push_back({one.points.floats() + one.column, pitch});
    else
      arrays.push_back({one.points.doubles() + one.column, pitch});
    sizes.push_back(one.size());
    before.push_back(one.points);
  }
  return by_points(std::move(curved), arrays, sizes, threads);  // moving the axes does not move their values
}

}  // namespace tegl
