// SPDX-License-Identifier: BSD-3-Clause
//
// Images that come in layer after layer along their last axis: those larger than memory.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "tegl/image.hpp"

namespace tegl {

/// The layers of an image along its last axis, from wherever they come.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
class LayerReader {
 public:
  using value_type = T;  ///< the type of a sample
  LayerReader() = default;
  LayerReader(const LayerReader&) = delete;
  LayerReader& operator=(const LayerReader&) = delete;
  virtual ~LayerReader() = default;

  /// Coordinates of the whole image.
  [[nodiscard]] virtual const Grid<N>& grid() const noexcept = 0;

  /// Writes layer `k` to `to`, dense, axis 0 fastest: as many values as the other axes have samples. NaN is a missing
  /// value. Layers are asked for in ascending order, each one once, always by the thread that called for the
  /// extraction. What it throws ends the extraction and reaches its caller.
  virtual void read(std::size_t k, T* to) = 0;
};

/// Layers that a function fills in.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
class FunctionLayers final : public LayerReader<T, N> {
 public:
  using Function = std::function<void(std::size_t k, T* to)>;  ///< writes layer `k` to `to`, as LayerReader::read
  /// Layers of an image on `grid`, as `function` writes them.
  FunctionLayers(Grid<N> grid, Function function) : grid_(std::move(grid)), function_(std::move(function)) {}
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return grid_; }  ///< coordinates of the whole image
  void read(std::size_t k, T* to) override { function_(k, to); }                 ///< asks the function

 private:
  Grid<N> grid_;
  Function function_;
};

}  // namespace tegl
