// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the ring of layers.
#include "filter/layer_filter.hpp"

#include <algorithm>
#include <thread>

namespace tegl::detail {

namespace {

/// Samples of a batch per thread: large enough that starting a parallel loop costs little, small enough for a cache.
constexpr std::size_t kBatchSamples = std::size_t{1} << 17;

std::size_t batch_of(const FilterShape& shape) {
  const unsigned threads = shape.threads != 0 ? shape.threads : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted = kBatchSamples * std::min(threads, 64U) / shape.layer_size();
  return std::clamp<std::size_t>(wanted, 1, shape.layers());
}

}  // namespace

std::size_t FilterShape::layer_size() const noexcept {
  std::size_t size = 1;
  for (std::size_t a = 0; a + 1 < sizes.size(); ++a) size *= sizes[a];
  return size;
}

bool FilterShape::misses_border() const noexcept {
  for (std::size_t a = 0; a < axes(); ++a)
    if (borders[a] == FilterBorder::missing && radii[a] > 0) return true;
  return false;
}

template <class Real>
LayerFilter<Real>::LayerFilter(FilterShape shape)
    : shape_(std::move(shape)),
      batch_(batch_of(shape_)),
      ring_(batch_ + 2 * shape_.radii.back()),
      workers_(shape_.threads, [] { return Scratch(); }) {
  if (shape_.borders.back() != FilterBorder::cyclic) ring_ = std::min(ring_, shape_.layers());
}

template <class Real>
bool LayerFilter<Real>::in_ring(std::ptrdiff_t layer, std::size_t& at) const noexcept {
  if (shape_.borders.back() != FilterBorder::cyclic)
    layer = source_index(layer, shape_.layers(), shape_.borders.back());
  else
    return at = place(layer), true;
  if (layer < 0) return false;
  at = place(layer);
  return true;
}

template <class Real>
void LayerFilter<Real>::load_all(std::ptrdiff_t from, std::ptrdiff_t to, Load load, bool parallel,
                                 FunctionRef<Real*(std::ptrdiff_t layer)> target) {
  const auto one = [&](std::size_t i) {
    const std::ptrdiff_t layer = from + static_cast<std::ptrdiff_t>(i);
    load(input(layer), target(layer));
  };
  const auto count = static_cast<std::size_t>(to - from);
  if (parallel)
    for_items(count, 1, [&](std::size_t i, Scratch&) { one(i); });
  else
    for (std::size_t i = 0; i < count; ++i) one(i);
}

template <class Real>
void LayerFilter<Real>::compute(std::size_t first, std::size_t count, Load load, bool parallel, Real* out) {
  const auto radius = static_cast<std::ptrdiff_t>(shape_.radii.back());
  std::ptrdiff_t from = static_cast<std::ptrdiff_t>(first) - radius;
  std::ptrdiff_t to = static_cast<std::ptrdiff_t>(first + count) + radius;
  if (shape_.borders.back() != FilterBorder::cyclic) {
    from = std::max<std::ptrdiff_t>(from, 0);
    to = std::min(to, static_cast<std::ptrdiff_t>(shape_.layers()));
  }
  if (from < begin_ || from > end_) begin_ = end_ = from;
  if (to > end_) {
    const std::ptrdiff_t old = end_;
    end_ = begin_;  // nothing is in the ring if a layer cannot be read
    take(old, to, load, parallel);
    end_ = to;
    begin_ = std::max(begin_, end_ - static_cast<std::ptrdiff_t>(ring_));
  }
  put(first, count, out);
}

template class LayerFilter<float>;
template class LayerFilter<double>;

}  // namespace tegl::detail
