// SPDX-License-Identifier: BSD-3-Clause
//
// The rule that places vertices on edges by relaxation.
#pragma once

#include <memory>

#include "ambiguity/face_estimator.hpp"
#include "position/placed_source.hpp"
#include "position/relaxation.hpp"

namespace tegl::detail {

/// Positions of all critical edges of samples in memory.
template <int N>
class RelaxedPositions final : public PositionsOnEdges<N> {
 public:
  RelaxedPositions(const SampleSource<N>& samples, const Grid<N>& grid, const ExtractOptions& options,
                   const RelaxationOptions& relaxation)
      : RelaxedPositions(std::make_unique<SampleSigns<N>>(samples, grid.sizes(), options.work.threads), samples, grid,
                         options, relaxation) {}

  void find(const LayerEdges<N>& edges, double* out) const noexcept override {
    std::size_t last_row = ~std::size_t{0};
    typename CriticalEdges<N>::Number number = 0;
    for (std::size_t i = 0; i < edges.edges.count; ++i) {
      const std::size_t row = edges.row_of_all(i);
      // edges of the same row come in order, except that those of a cell may be in any order
      number = row == last_row && edges.edges.at[i] > edges.edges.at[i - 1]
                   ? edges_.number_after(number, edges.edges.at[i])
                   : edges_.number(edges.axis, row, edges.edges.at[i]);
      last_row = row;
      out[i] = places_[number];
    }
  }

 private:
  /// The signs are not kept: the list of edges takes less memory for most images.
  RelaxedPositions(std::unique_ptr<SampleSigns<N>> signs, const SampleSource<N>& samples, const Grid<N>& grid,
                   const ExtractOptions& options, const RelaxationOptions& relaxation)
      : edges_(*signs, options.work.threads) {
    std::unique_ptr<FaceEstimator<N>> estimator;
    if (is_estimated(options.ambiguity))
      estimator = std::make_unique<FaceEstimator<N>>(samples, grid.sizes(), options, PartOfImage{});
    const auto joins_high = [&](const SampleIndex<N>& base, unsigned axes) {
      if (!estimator) return options.ambiguity == Ambiguity::high;
      std::array<double, 4> values;
      samples.corner_values(base, axes, values.data());
      return estimator->is_square_high(base, axes, values);
    };
    const ContourNet<N> net(*signs, edges_, joins_high, options.work.threads);
    signs.reset();
    if (estimator) estimator->rethrow();
    places_ = relaxed_positions<N>(net, relaxation);
  }

  CriticalEdges<N> edges_;
  Buffer<float> places_;
};

}  // namespace tegl::detail
