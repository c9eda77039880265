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
#include <span>

#include "base/workers.hpp"
#include "image/edge_alphas.hpp"
#include "position/placed_source.hpp"
#include "tegl/error.hpp"
#include "tegl/positions.hpp"

namespace tegl::detail {

/// Linear interpolation of a second image of floats or doubles, clamped to the sides of the samples.
template <int N, class Second>
class FilteredPositions final : public PositionsOnEdges<N> {
 public:
  /// `values`: axis 0 fastest. `epsilon`: as for `edge_alphas`.
  FilteredPositions(const SampleSource<N>& samples, StartsHigh starts_high, const Grid<N>& grid,
                    std::span<const Second> values, double epsilon)
      : samples_(samples),
        starts_high_(starts_high),
        values_(values),
        isovalue_(samples.isovalue()),
        sides_{{{-kInfinity, std::nextafter(isovalue_, -kInfinity)}, {isovalue_, kInfinity}}},
        epsilon_(epsilon) {
    std::size_t stride = 1;
    for (int a = 0; a < N; ++a) {
      strides_[a] = stride;
      stride *= grid.axes[a].size();
    }
  }

  void find(const LayerEdges<N>& edges, double* out) const noexcept override {
    constexpr std::size_t kMost = LayerEdges<N>::kMost;
    const std::size_t count = edges.edges.count, stride = strides_[edges.axis];
    // read both ends, which are seldom in the cache
    const Second* const layer = values_.data() + edges.k * edges.rows.size() * edges.rows.row_size();
    std::array<const Second*, kMost> at;
    for (std::size_t i = 0; i < count; ++i) {
      at[i] = layer + static_cast<std::size_t>(edges.row[i]) * edges.rows.row_size() + edges.edges.at[i];
      __builtin_prefetch(at[i]);
      if (edges.axis != 0) __builtin_prefetch(at[i] + stride);
    }
    std::array<double, kMost> from, to;
    const Word high = starts_high_(edges.k, edges.edges);
    bool any_nan = false;
    for (std::size_t i = 0; i < count; ++i) {
      const double first = at[i][0], second = at[i][stride];
      any_nan |= std::isnan(first + second);
      const Word is_high = high >> i & 1u;
      from[i] = sides_[is_high].clamped(first);
      to[i] = sides_[is_high ^ 1u].clamped(second);
    }
    if (any_nan) replace_nans(edges, at.data(), high, from.data(), to.data());
    alphas_between(from.data(), to.data(), count, isovalue_, epsilon_, out);
  }
  [[nodiscard]] LayerInMemory layer_in_memory(std::size_t k) const noexcept override {
    constexpr std::ptrdiff_t kBytes = sizeof(Second);
    return {reinterpret_cast<const std::byte*>(values_.data() + k * strides_[N - 1]),
            static_cast<std::ptrdiff_t>(strides_[1]) * kBytes, kBytes};
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  /// The values of the low or of the high side. Without branches, as sides are hard to predict.
  struct Side {
    double least, most;
    [[nodiscard]] double clamped(double value) const noexcept { return std::min(std::max(value, least), most); }
  };

  /// Replaces the ends of edges whose values are NaN by the image's own.
  void replace_nans(const LayerEdges<N>& edges, const Second* const* at, Word high, double* from,
                    double* to) const noexcept {
    for (std::size_t i = 0; i < edges.edges.count; ++i) {
      SampleIndex<N> index = edges.start(i);
      const Word is_high = high >> i & 1u;
      if (std::isnan(at[i][0])) from[i] = sides_[is_high].clamped(samples_.value(index));
      index[edges.axis] += 1;
      if (std::isnan(at[i][strides_[edges.axis]])) to[i] = sides_[is_high ^ 1u].clamped(samples_.value(index));
    }
  }

  const SampleSource<N>& samples_;
  StartsHigh starts_high_;
  std::span<const Second> values_;
  double isovalue_;
  std::array<Side, 2> sides_;  ///< low, high
  double epsilon_;
  std::array<std::size_t, N> strides_{};
};

/// A function of the samples at both ends.
template <int N>
class CustomPositions final : public PositionsOnEdges<N> {
 public:
  CustomPositions(const SampleSource<N>& samples, const PositionOptions& options)
      : samples_(samples), position_(options.custom) {}

  void find(const LayerEdges<N>& edges, double* out) const noexcept override {
    std::array<double, LayerEdges<N>::kMost> from, to;
    for (std::size_t i = 0; i < edges.edges.count; ++i) {
      SampleIndex<N> index = edges.start(i);
      from[i] = samples_.value(index);
      index[edges.axis] += 1;
      to[i] = samples_.value(index);
    }
    for (std::size_t i = 0; i < edges.edges.count; ++i) out[i] = ask(from[i], to[i]);
  }

  /// Throws the first exception of the function, or an error if it returned NaN.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  [[nodiscard]] double ask(double first, double second) const noexcept {
    if (failed_.load(std::memory_order_relaxed)) return 0.5;
    try {
      const double position = call_apart([&] { return position_(first, second, samples_.isovalue()); });
      if (std::isnan(position))
        throw Error(ErrorCode::InvalidArgument, nan_position(first, second, samples_.isovalue()));
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
