// SPDX-License-Identifier: BSD-3-Clause
//
// Filters of the samples in a box: keeps layers of rows that are extended beyond both ends, and gives each row with its
// neighbours to an operation.
#include <algorithm>
#include <limits>
#include <utility>

#include "filter/layer_filter.hpp"
#include "filter/window_operation.hpp"

namespace tegl::detail {

namespace {

template <class Real>
class WindowFilter final : public LayerFilter<Real> {
 public:
  using Base = LayerFilter<Real>;
  using Load = typename Base::Load;
  using Scratch = typename Base::Scratch;

  WindowFilter(FilterShape given, std::unique_ptr<WindowOperation<Real>> operation)
      : Base(std::move(given)),
        operation_(std::move(operation)),
        width_(shape().sizes[0]),
        pitch_(width_ + 2 * shape().radii[0]),
        rows_(shape().layer_size() / width_),
        ring_(Base::ring_size()),
        outside_(pitch_, std::numeric_limits<Real>::quiet_NaN()) {
    // the numbers of rows in a layer of a 2D image are 1
    for (std::size_t a = 1; a < shape().axes(); ++a) box_rows_ *= 2 * shape().radii[a] + 1;
  }

 private:
  struct RingLayer {
    std::vector<Real> values;
    bool misses = false;  ///< whether some sample is missing
  };

  void take(std::ptrdiff_t from, std::ptrdiff_t to, Load load, bool parallel) override;
  void put(std::size_t first, std::size_t count, Real* out) override;
  bool extend_row(Real* row) const;
  void gather_rows(std::size_t layer, std::size_t row, std::vector<const Real*>& rows) const;

  using Base::for_items;
  using Base::in_ring;
  using Base::place;
  using Base::shape;

  std::unique_ptr<WindowOperation<Real>> operation_;
  std::size_t width_, pitch_, rows_;
  std::size_t box_rows_ = 1;
  std::vector<RingLayer> ring_;
  std::vector<Real> outside_;  ///< a row of missing samples
};

/// Fills the ends of a row. Returns whether one of its samples is missing.
template <class Real>
bool WindowFilter<Real>::extend_row(Real* row) const {
  const auto radius = static_cast<std::ptrdiff_t>(shape().radii[0]);
  Real* const samples = row + radius;
  const auto outside = [&](std::ptrdiff_t at) {
    const std::ptrdiff_t index = source_index(at, width_, shape().borders[0]);
    return index < 0 ? outside_[0] : samples[index];
  };
  for (std::ptrdiff_t i = 1; i <= radius; ++i) {
    samples[-i] = outside(-i);
    samples[static_cast<std::ptrdiff_t>(width_) - 1 + i] = outside(static_cast<std::ptrdiff_t>(width_) - 1 + i);
  }
  bool misses = false;
  for (std::size_t i = 0; i < width_; ++i) misses |= samples[i] != samples[i];
  return misses;
}

template <class Real>
void WindowFilter<Real>::take(std::ptrdiff_t from, std::ptrdiff_t to, Load load, bool parallel) {
  // Layers are loaded to the end of their place, and rows moved forward from there.
  for (std::ptrdiff_t layer = from; layer < to; ++layer) ring_[place(layer)].values.resize(rows_ * pitch_);
  const std::size_t size = rows_ * width_;
  Base::load_all(from, to, load, parallel,
                 [&](std::ptrdiff_t layer) { return ring_[place(layer)].values.data() + (rows_ * pitch_ - size); });
  for_items(static_cast<std::size_t>(to - from), 1, [&](std::size_t i, Scratch&) {
    RingLayer& layer = ring_[place(from + static_cast<std::ptrdiff_t>(i))];
    Real* const loaded = layer.values.data() + (rows_ * pitch_ - size);
    layer.misses = false;
    for (std::size_t row = 0; row < rows_; ++row) {
      Real* const target = layer.values.data() + row * pitch_;
      std::copy(loaded + row * width_, loaded + (row + 1) * width_, target + shape().radii[0]);
      layer.misses |= extend_row(target);
    }
  });
}

/// The rows of the box around a row of an output layer.
template <class Real>
void WindowFilter<Real>::gather_rows(std::size_t layer, std::size_t row, std::vector<const Real*>& rows) const {
  constexpr std::size_t kMostAxes = 5;
  const std::size_t axes = shape().axes();
  std::array<std::ptrdiff_t, kMostAxes> index{};
  for (std::size_t a = 1, rest = row; a + 1 < axes; rest /= shape().sizes[a], ++a)
    index[a] = static_cast<std::ptrdiff_t>(rest % shape().sizes[a]);
  std::array<std::ptrdiff_t, kMostAxes> offset{};
  for (std::size_t a = 1; a < axes; ++a) offset[a] = -static_cast<std::ptrdiff_t>(shape().radii[a]);
  rows.resize(box_rows_);
  for (const Real*& to : rows) {
    std::ptrdiff_t at = 0;
    bool outside = false;
    std::ptrdiff_t stride = 1;
    for (std::size_t a = 1; a + 1 < axes; ++a) {
      const std::ptrdiff_t i = source_index(index[a] + offset[a], shape().sizes[a], shape().borders[a]);
      outside = outside || i < 0;
      at += i * stride;
      stride *= static_cast<std::ptrdiff_t>(shape().sizes[a]);
    }
    std::size_t slot = 0;
    outside = outside || !in_ring(static_cast<std::ptrdiff_t>(layer) + offset[axes - 1], slot);
    to = outside ? outside_.data() : ring_[slot].values.data() + at * static_cast<std::ptrdiff_t>(pitch_);
    for (std::size_t a = 1; a < axes; ++a) {
      if (++offset[a] <= static_cast<std::ptrdiff_t>(shape().radii[a])) break;
      offset[a] = -static_cast<std::ptrdiff_t>(shape().radii[a]);
    }
  }
}

template <class Real>
void WindowFilter<Real>::put(std::size_t first, std::size_t count, Real* out) {
  const auto radius = static_cast<std::ptrdiff_t>(shape().radii.back());
  std::vector<std::uint8_t> misses;  // by output layer
  for (std::size_t k = first; k < first + count; ++k) {
    bool any = shape().misses_border();
    for (std::ptrdiff_t j = -radius; j <= radius && !any; ++j) {
      std::size_t slot = 0;
      any = in_ring(static_cast<std::ptrdiff_t>(k) + j, slot) && ring_[slot].misses;
    }
    misses.push_back(any ? 1 : 0);
  }
  for_items(count * rows_, 4, [&](std::size_t item, Scratch& scratch) {
    const std::size_t k = item / rows_;
    gather_rows(first + k, item % rows_, scratch.more_lines);
    Real* const to = out + item * width_;
    operation_->apply({scratch.more_lines.data(), width_, misses[k] != 0, &scratch}, to);
    if (shape().fill_missing || misses[k] == 0) return;
    const Real* const middle = scratch.more_lines[box_rows_ / 2] + shape().radii[0];
    for (std::size_t x = 0; x < width_; ++x)
      if (middle[x] != middle[x]) to[x] = outside_[0];
  });
}

}  // namespace

template <class Real>
std::unique_ptr<LayerFilter<Real>> make_window_filter(FilterShape shape, const Filter& filter) {
  std::unique_ptr<WindowOperation<Real>> operation = std::visit(
      [&]<class Kind>(const Kind& one) -> std::unique_ptr<WindowOperation<Real>> {
        if constexpr (std::is_same_v<Kind, SeparableConvolution>)
          return nullptr;
        else
          return make_operation<Real>(shape, one);
      },
      filter);
  return std::make_unique<WindowFilter<Real>>(std::move(shape), std::move(operation));
}
template std::unique_ptr<LayerFilter<float>> make_window_filter<float>(FilterShape, const Filter&);
template std::unique_ptr<LayerFilter<double>> make_window_filter<double>(FilterShape, const Filter&);

}  // namespace tegl::detail
