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
        below_(std::nextafter(isovalue_, -std::numeric_limits<double>::infinity())),
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
    bool any_nan = false;
    for (std::size_t i = 0; i < count; ++i) {
      from[i] = at[i][0];
      to[i] = at[i][stride];
      any_nan |= std::isnan(from[i] + to[i]);
    }
    if (any_nan) replace_nans(edges, from.data(), to.data());
    // clamp: the first end to the side of the higher or of the lower values, the second end to the other side
    const Word high = starts_high_(edges.k, edges.edges);
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_high = (high >> i & 1u) != 0;
      const double first = from[i], second = to[i];
      from[i] = is_high ? std::max(first, isovalue_) : std::min(first, below_);
      to[i] = is_high ? std::min(second, below_) : std::max(second, isovalue_);
    }
    alphas_between(from.data(), to.data(), count, isovalue_, epsilon_, out);
  }

 private:
  /// Replaces values that are NaN by the image's own.
  void replace_nans(const LayerEdges<N>& edges, double* from, double* to) const noexcept {
    for (std::size_t i = 0; i < edges.edges.count; ++i) {
      SampleIndex<N> index = edges.start(i);
      if (std::isnan(from[i])) from[i] = samples_.value(index);
      index[edges.axis] += 1;
      if (std::isnan(to[i])) to[i] = samples_.value(index);
    }
  }

  const SampleSource<N>& samples_;
  StartsHigh starts_high_;
  std::span<const Second> values_;
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
