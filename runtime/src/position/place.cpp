// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction with positions by a rule (see tegl/positions.hpp).
#include "position/place.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <variant>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "kernel/extract_in_memory.hpp"
#include "position/edge_rules.hpp"
#include "position/gravitation.hpp"
#include "position/listed_positions.hpp"
#include "position/relaxed_positions.hpp"

namespace tegl::detail {

void check_positions(const PositionOptions& positions, std::size_t samples, int dimensions) {
  const std::size_t values = std::visit([](const auto& second) { return second.size(); }, positions.filtered);
  if (positions.rule == Positions::filtered && values != samples)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("filtered positions with {} values; expected one for each of the image's {} samples",
                            values, samples));
  if (positions.rule == Positions::custom && !positions.custom && !positions.custom_of_many)
    throw Error(ErrorCode::InvalidArgument,
                "custom positions without a function; expected one in PositionOptions::custom or custom_of_many");
  if (positions.rule == Positions::custom && positions.custom && positions.custom_of_many)
    throw Error(ErrorCode::InvalidArgument,
                "custom positions with two functions, custom and custom_of_many; expected one of the two");
  if (positions.rule == Positions::gravitation && dimensions > 4)
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("gravitation of a {}D image; expected 2 to 4 dimensions", dimensions));
  if (!(positions.margin > 0 && positions.margin < 0.5))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("a margin of {}; expected more than 0 and less than 0.5", positions.margin));
  if (!(positions.last_axis_weight >= 0 && positions.last_axis_weight <= 1e6))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("a weight of the last axis of {}; expected 0 to 1000000", positions.last_axis_weight));
}

namespace {

template <int N, class Real, class Source = PlacedSource<N>, class Rule>
Extraction<N, Real> extract_on_edges(SampleSource<N>& samples, const Grid<N>& grid, const Rule& rule,
                                     const ExtractOptions& options, const ExtractPlan& plan) {
  const LayerRows<N> rows(grid, samples.strides());
  Source placed(samples, rows, grid.axes[N - 1], rule, options.epsilon);
  return extract_in_memory<N, Real>(placed, grid, options, plan);
}

/// Passes on how far the extraction is after a first share for the positions.
ExtractOptions after_share(const ExtractOptions& options, double share) {
  ExtractOptions rest = options;
  rest.work.progress = part_of(options.work.progress, share, 1.0);
  return rest;
}

template <int N, class Real>
Extraction<N, Real> extract_custom(SampleSource<N>& samples, const Grid<N>& grid, const PositionOptions& positions,
                                   const ExtractOptions& options, const ExtractPlan& plan) {
  if (positions.custom_of_many) {
    constexpr double kShare = 0.5;  // of the function in the time
    const BlockPositions<N> rule(samples, grid, positions,
                                 {options.work.threads, part_of(options.work.progress, 0.0, kShare)});
    return extract_on_edges<N, Real>(samples, grid, rule, after_share(options, kShare), plan);
  }
  const CustomPositions<N> rule(samples, positions);
  Extraction<N, Real> result = extract_on_edges<N, Real>(samples, grid, rule, options, plan);
  rule.rethrow();
  return result;
}

template <int N, class Real>
Extraction<N, Real> extract_relaxed(SampleSource<N>& samples, const Grid<N>& grid, const PositionOptions& positions,
                                    const ExtractOptions& options, const ExtractPlan& plan) {
  constexpr double kShare = 0.8;  // of the relaxation in the time
  RelaxationOptions relaxation;
  relaxation.margin = std::max(positions.margin, options.epsilon);
  relaxation.last_axis_weight = positions.last_axis_weight;
  relaxation.work = {options.work.threads, part_of(options.work.progress, 0.0, kShare)};
  const RelaxedPositions<N> relaxed(samples, grid, options, relaxation);
  return extract_on_edges<N, Real>(samples, grid, relaxed, after_share(options, kShare), plan);
}

}  // namespace

template <int N, class Real>
Extraction<N, Real> extract_placed_from(SampleSource<N>& samples, StartsHigh starts_high, const Grid<N>& grid,
                                        const PositionOptions& positions, const ExtractOptions& options,
                                        const ExtractPlan& plan) {
  switch (positions.rule) {
    case Positions::filtered:
      return std::visit(
          [&]<class Second>(std::span<const Second> values) {
            const FilteredPositions<N, Second> rule(samples, starts_high, grid, values, options.epsilon);
            return extract_on_edges<N, Real>(samples, grid, rule, options, plan);
          },
          positions.filtered);
    case Positions::custom:
      return extract_custom<N, Real>(samples, grid, positions, options, plan);
    case Positions::gravitation:
      return extract_on_edges<N, Real, GravitationSource<N>>(
          samples, grid, Gravitation<N>(samples, grid, options.work.threads), options, plan);
    case Positions::relaxed:
      return extract_relaxed<N, Real>(samples, grid, positions, options, plan);
    case Positions::linear:
      break;
  }
  return extract_in_memory<N, Real>(samples, grid, options, plan);
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real)                                                            \
  template Extraction<N, Real> extract_placed_from<N, Real>(SampleSource<N>&, StartsHigh, const Grid<N>&,  \
                                                            const PositionOptions&, const ExtractOptions&, \
                                                            const ExtractPlan&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
