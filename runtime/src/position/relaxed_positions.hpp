// SPDX-License-Identifier: BSD-3-Clause
//
// The rule that places vertices on edges by relaxation.
#pragma once

#include <memory>

#include "ambiguity/face_estimator.hpp"
#include "position/listed_positions.hpp"
#include "position/relaxation.hpp"

namespace tegl::detail {

/// Positions of all critical edges of samples in memory.
template <int N>
class RelaxedPositions final : public ListedPositions<N, float> {
 public:
  RelaxedPositions(const SampleSource<N>& samples, const Grid<N>& grid, const ExtractOptions& options,
                   const RelaxationOptions& relaxation)
      : RelaxedPositions(std::make_unique<SampleSigns<N>>(samples, grid.sizes(), options.work.threads), samples, grid,
                         options, relaxation) {}

 private:
  /// The signs are not kept: the list of edges takes less memory for most images.
  RelaxedPositions(std::unique_ptr<SampleSigns<N>> signs, const SampleSource<N>& samples, const Grid<N>& grid,
                   const ExtractOptions& options, const RelaxationOptions& relaxation)
      : ListedPositions<N, float>(*signs, options.work.threads) {
    std::unique_ptr<FaceEstimator<N>> estimator;
    if (is_estimated(options.ambiguity))
      estimator = std::make_unique<FaceEstimator<N>>(samples, grid.sizes(), options, PartOfImage{});
    const auto joins_high = [&](const SampleIndex<N>& base, unsigned axes) {
      if (!estimator) return options.ambiguity == Ambiguity::high;
      std::array<double, 4> values;
      samples.corner_values(base, axes, values.data());
      return estimator->is_square_high(base, axes, values);
    };
    const ContourNet<N> net(*signs, this->edges_, joins_high, options.work.threads);
    signs.reset();
    if (estimator) estimator->rethrow();
    this->places_ = relaxed_positions<N>(net, relaxation);
  }
};

}  // namespace tegl::detail
