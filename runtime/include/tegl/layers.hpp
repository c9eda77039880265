// SPDX-License-Identifier: BSD-3-Clause
//
// Images that are read layer by layer along their last axis, for images larger than memory.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "tegl/image.hpp"

namespace tegl {

/// A source of the layers of an image along its last axis.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
class LayerReader {
 public:
  using value_type = T;  ///< the type of a sample
  LayerReader() = default;
  LayerReader(const LayerReader&) = delete;
  LayerReader& operator=(const LayerReader&) = delete;
  virtual ~LayerReader() = default;

  /// The grid of the whole image.
  [[nodiscard]] virtual const Grid<N>& grid() const noexcept = 0;

  /// Writes layer `k` to `to`: dense, axis 0 fastest, the product of the other axes' sizes in values. NaN is a missing
  /// value. The extraction requests each layer once, in ascending order, from the thread that called it; with normals
  /// along a periodic last axis, the last layer comes first. Exceptions end the extraction and reach its caller.
  virtual void read(std::size_t k, T* to) = 0;
};

/// Layers computed by a function.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
class FunctionLayers final : public LayerReader<T, N> {
 public:
  using Function = std::function<void(std::size_t k, T* to)>;  ///< writes layer `k` to `to`, as LayerReader::read
  /// Layers of an image on `grid`, written by `function`.
  FunctionLayers(Grid<N> grid, Function function) : grid_(std::move(grid)), function_(std::move(function)) {}
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return grid_; }  ///< the grid of the whole image
  void read(std::size_t k, T* to) override { function_(k, to); }                 ///< calls the function

 private:
  Grid<N> grid_;
  Function function_;
};

}  // namespace tegl
