// SPDX-License-Identifier: BSD-3-Clause
//
// Rules for positions on single edges: a second image, and a function of the caller.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "base/workers.hpp"
#include "image/edge_alphas.hpp"
#include "position/placed_source.hpp"
#include "tegl/error.hpp"
#include "tegl/positions.hpp"

namespace tegl::detail {

/// Edges that a rule gets at a time.
inline constexpr std::size_t kMostEdgesAtOnce = 80;  // those of a 5-cube

/// Linear interpolation of a second image, clamped to the sides of the samples.
template <int N>
class FilteredPositions final : public PositionsOnEdges<N> {
 public:
  /// `values`: axis 0 fastest. `epsilon`: as for `edge_alphas`.
  FilteredPositions(const SampleSource<N>& samples, const Grid<N>& grid, std::span<const float> values, double epsilon)
      : samples_(samples),
        values_(values),
        isovalue_(samples.isovalue()),
        below_(std::nextafter(isovalue_, -std::numeric_limits<double>::infinity())),
        epsilon_(epsilon) {
    std::size_t stride = 1;
    for (int a = 0; a < N; ++a) {
      strides_[a] = stride;
      stride *= grid.axes[a].size();
    }
  }

  void find(const GridEdge<N>* edges, std::size_t count, double* out) const noexcept override {
    static constexpr auto kInOrder = [] {
      std::array<std::uint32_t, kMostEdgesAtOnce> result{};
      std::iota(result.begin(), result.end(), 0u);
      return result;
    }();
    static constexpr std::array<std::ptrdiff_t, kMostEdgesAtOnce> kOneRow{};
    std::array<double, kMostEdgesAtOnce> from, to;
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t at = 0;
      for (int a = 0; a < N; ++a) at += edges[i].start[a] * strides_[a];
      const bool high = samples_.is_high(edges[i].start);
      from[i] = clamped(edges[i].start, at, high);
      SampleIndex<N> end = edges[i].start;
      end[edges[i].axis] += 1;
      to[i] = clamped(end, at + strides_[edges[i].axis], !high);
    }
    edge_alphas<double>({from.data(), to.data(), kOneRow.data(), kInOrder.data(), count, 1}, isovalue_, epsilon_, out);
  }

 private:
  [[nodiscard]] double clamped(const SampleIndex<N>& index, std::size_t at, bool high) const noexcept {
    double value = values_[at];
    if (std::isnan(value)) value = samples_.value(index);
    return high ? std::max(value, isovalue_) : std::min(value, below_);
  }

  const SampleSource<N>& samples_;
  std::span<const float> values_;
  double isovalue_;
  double below_;  ///< the largest number below the isovalue
  double epsilon_;
  std::array<std::size_t, N> strides_{};
};

/// A function of the samples at both ends.
template <int N>
class CustomPositions final : public PositionsOnEdges<N> {
 public:
  CustomPositions(const SampleSource<N>& samples, const PositionOptions& options)
      : samples_(samples), position_(options.custom) {}

  void find(const GridEdge<N>* edges, std::size_t count, double* out) const noexcept override {
    for (std::size_t i = 0; i < count; ++i) out[i] = ask(edges[i]);
  }

  /// Throws the first exception of the function, or an error if it returned NaN.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  [[nodiscard]] double ask(const GridEdge<N>& edge) const noexcept {
    if (failed_.load(std::memory_order_relaxed)) return 0.5;
    try {
      SampleIndex<N> end = edge.start;
      end[edge.axis] += 1;
      const double first = samples_.value(edge.start), second = samples_.value(end);
      const double position = call_apart([&] { return position_(first, second, samples_.isovalue()); });
      if (std::isnan(position))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("the function for custom positions returned NaN for samples {} and {} and the isovalue "
                                "{}; expected a number from 0 to 1",
                                first, second, samples_.isovalue()));
      return position;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      failed_ = true;
    }
    return 0.5;
  }

  const SampleSource<N>& samples_;
  const std::function<double(double, double, double)>& position_;
  mutable std::atomic<bool> failed_ = false;
  mutable std::mutex mutex_;
  mutable std::exception_ptr error_;
};

}  // namespace tegl::detail
