// SPDX-License-Identifier: BSD-3-Clause
//
// Measures of the cuts of a contour by values of its last coordinate: by sums over simplices (cut_sums.cpp), or of the
// cuts of wrapped contours, which are made, as many at a time as there are threads.
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "cut/each_cut.hpp"
#include "mesh/cut_sums.hpp"
#include "mesh/validate.hpp"
#include "tegl/error.hpp"
#include "tegl/measure.hpp"

namespace tegl {
namespace {

/// The cuts of a wrapped contour are wrapped, too: whether one encloses a content depends on where it winds round.
template <int N, class Real>
std::vector<CutMeasures> measure_wrapped_cuts(const Contour<N, Real>& contour, std::span<const double> at,
                                              const WorkOptions& work) {
  std::vector<CutMeasures> result(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) result[i].at = at[i];
  detail::for_each_cut<N, Real>(
      contour, at, work, [&](std::span<const std::size_t> places, const Contour<N - 1, Real>& cut, unsigned threads) {
        const Measures<N - 1> measures = measure(cut, {threads, {}});
        for (const std::size_t i : places) {
          result[i].size = measures.size;
          result[i].content = measures.content;
        }
      });
  return result;
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5> std::vector<CutMeasures> measure_cuts(const Contour<N, Real>& contour,
                                                                         std::span<const double> at,
                                                                         const WorkOptions& work) {
  detail::require_vertices(contour);
  detail::require_finite(contour);
  for (const double t : at)
    if (!std::isfinite(t))
      throw Error(ErrorCode::InvalidArgument, fmt::format("a slice at {}; expected finite values", t));
  if (!contour.periods.empty()) return measure_wrapped_cuts(contour, at, work);
  return detail::measure_cuts_of_view(detail::SimplexView<N>(contour), contour.direction, at, work);
}

template std::vector<CutMeasures> measure_cuts(const Contour<3, float>&, std::span<const double>, const WorkOptions&);
template std::vector<CutMeasures> measure_cuts(const Contour<3, double>&, std::span<const double>, const WorkOptions&);
template std::vector<CutMeasures> measure_cuts(const Contour<4, float>&, std::span<const double>, const WorkOptions&);
template std::vector<CutMeasures> measure_cuts(const Contour<4, double>&, std::span<const double>, const WorkOptions&);
template std::vector<CutMeasures> measure_cuts(const Contour<5, float>&, std::span<const double>, const WorkOptions&);
template std::vector<CutMeasures> measure_cuts(const Contour<5, double>&, std::span<const double>, const WorkOptions&);

}  // namespace tegl
