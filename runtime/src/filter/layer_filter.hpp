// SPDX-License-Identifier: BSD-3-Clause
//
// Base of all filters: computes output layers along the last axis from the input layers around them, which it keeps in
// a ring. Images in memory and images read by layers take the same path, so they give the same bits.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "base/function_ref.hpp"
#include "base/workers.hpp"
#include "tegl/filter.hpp"

namespace tegl::detail {

/// Sizes, borders and radii of a filter by axis.
struct FilterShape {
  std::vector<std::size_t> sizes;
  std::vector<FilterBorder> borders;
  std::vector<std::size_t> radii;
  bool fill_missing = false;
  unsigned threads = 0;

  [[nodiscard]] std::size_t axes() const noexcept { return sizes.size(); }
  [[nodiscard]] std::size_t last() const noexcept { return sizes.size() - 1; }
  [[nodiscard]] std::size_t layers() const noexcept { return sizes.back(); }
  /// Number of samples of a layer.
  [[nodiscard]] std::size_t layer_size() const noexcept;
  /// Whether samples beyond the border of some axis count as missing.
  [[nodiscard]] bool misses_border() const noexcept;
};

/// The sample of an axis that stands for index i, which may be outside; -1 for a missing one.
inline std::ptrdiff_t source_index(std::ptrdiff_t i, std::size_t size, FilterBorder border) noexcept {
  const auto count = static_cast<std::ptrdiff_t>(size);
  if (i >= 0 && i < count) return i;
  if (border == FilterBorder::extended) return i < 0 ? 0 : count - 1;
  if (border == FilterBorder::missing) return -1;
  const std::ptrdiff_t rest = i % count;
  return rest < 0 ? rest + count : rest;
}

/// Working storage of a thread.
template <class Real>
struct FilterScratch {
  std::vector<Real> first, second;
  std::vector<const Real*> lines, more_lines;
};

template <class Real>
class LayerFilter {
 public:
  using Load = FunctionRef<void(std::size_t layer, Real* to)>;

  LayerFilter(const LayerFilter&) = delete;
  LayerFilter& operator=(const LayerFilter&) = delete;
  virtual ~LayerFilter() = default;

  /// Number of layers that are best computed together.
  [[nodiscard]] std::size_t batch() const noexcept { return batch_; }
  [[nodiscard]] const FilterShape& shape() const noexcept { return shape_; }
  /// Computes the output layers [first, first + count), at most batch() of them. `load` is called for each input layer
  /// that is not yet in the ring: from several threads if `parallel`.
  void compute(std::size_t first, std::size_t count, Load load, bool parallel, Real* out);

 protected:
  explicit LayerFilter(FilterShape shape);

  using Scratch = FilterScratch<Real>;
  /// Places in the ring for the input layers [from, to), where a layer outside of the image is one of a cyclic border.
  virtual void take(std::ptrdiff_t from, std::ptrdiff_t to, Load load, bool parallel) = 0;
  /// Computes output layers from the layers in the ring.
  virtual void put(std::size_t first, std::size_t count, Real* out) = 0;

  /// Number of layers in the ring.
  [[nodiscard]] std::size_t ring_size() const noexcept { return ring_; }
  /// Place of a layer in the ring.
  [[nodiscard]] std::size_t place(std::ptrdiff_t layer) const noexcept {
    const auto ring = static_cast<std::ptrdiff_t>(ring_);
    return static_cast<std::size_t>(((layer % ring) + ring) % ring);
  }
  /// The layer of the ring that stands for a layer of the window; false if it is missing.
  [[nodiscard]] bool in_ring(std::ptrdiff_t layer, std::size_t& at) const noexcept;
  /// Number of the input layer.
  [[nodiscard]] std::size_t input(std::ptrdiff_t layer) const noexcept {
    return static_cast<std::size_t>(source_index(layer, shape_.layers(), FilterBorder::cyclic));
  }
  /// Calls load for the layers [from, to), as load(input layer, to(layer)).
  void load_all(std::ptrdiff_t from, std::ptrdiff_t to, Load load, bool parallel,
                FunctionRef<Real*(std::ptrdiff_t layer)> target);
  /// Calls work(item, scratch) for 0 ... count - 1 in parallel.
  template <class Work>
  void for_items(std::size_t count, std::size_t grain, const Work& work) {
    workers_.for_range(count, grain, [&](std::size_t from, std::size_t to, Scratch& scratch) {
      for (std::size_t i = from; i < to; ++i) work(i, scratch);
    });
  }

 private:
  FilterShape shape_;
  std::size_t batch_;
  std::size_t ring_;
  std::ptrdiff_t begin_ = 0;  ///< layers [begin_, end_) are in the ring
  std::ptrdiff_t end_ = 0;
  Workers<Scratch> workers_;
};

/// The filter for an image of these sizes. Errors: InvalidArgument.
template <class Real>
std::unique_ptr<LayerFilter<Real>> make_layer_filter(const std::vector<std::size_t>& sizes, const Filter& filter,
                                                     const FilterOptions& options);

template <class Real>
std::unique_ptr<LayerFilter<Real>> make_separable_filter(FilterShape shape, const SeparableConvolution& filter);
template <class Real>
std::unique_ptr<LayerFilter<Real>> make_window_filter(FilterShape shape, const Filter& filter);

}  // namespace tegl::detail
