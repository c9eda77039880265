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
      : edges_(samples, grid.sizes(), options.work.threads) {
    std::unique_ptr<FaceEstimator<N>> estimator;
    if (is_estimated(options.ambiguity))
      estimator = std::make_unique<FaceEstimator<N>>(samples, grid.sizes(), options, PartOfImage{});
    const auto joins_high = [&](const SampleIndex<N>& base, unsigned axes) {
      if (!estimator) return options.ambiguity == Ambiguity::high;
      std::array<double, 4> values;
      samples.corner_values(base, axes, values.data());
      return estimator->is_square_high(base, axes, values);
    };
    const ContourNet<N> net(edges_, joins_high, options.work.threads);
    if (estimator) estimator->rethrow();
    places_ = relaxed_positions<N>(net, relaxation);
  }

  void find(const GridEdge<N>* edges, std::size_t count, double* out) const noexcept override {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = places_[edges_.number(edges[i].axis, edges_.row_of(edges[i].start), edges[i].start[0])];
  }

 private:
  CriticalEdges<N> edges_;
  Buffer<float> places_;
};

}  // namespace tegl::detail
