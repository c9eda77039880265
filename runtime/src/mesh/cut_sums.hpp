// SPDX-License-Identifier: BSD-3-Clause
//
// Sums over the cuts of simplices by many hyperplanes across the last axis: the size of each cut, and the content that
// it encloses.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/exact_sum.hpp"
#include "mesh/simplex_geometry.hpp"
#include "tegl/contour.hpp"
#include "tegl/measure.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Sums by value: the size of the cut, and N - 1 times the content that it encloses, with their rounding errors apart
/// (CompensatedSum). Each kind of sum in one array, so that several values can be added to at once.
class CutSums {
 public:
  /// Values after the last one that an addition of whole vectors may write to.
  static constexpr std::size_t kPadding = 64;

  CutSums() = default;
  explicit CutSums(std::size_t values) : stride_(values + kPadding), sums_(4 * stride_, 0.0) {}

  [[nodiscard]] double size(std::size_t value) const noexcept {
    return with_rest(sums_[value], sums_[stride_ + value]);
  }
  [[nodiscard]] double content(std::size_t value) const noexcept {
    return with_rest(sums_[2 * stride_ + value], sums_[3 * stride_ + value]);
  }
  /// By value: the sums of sizes, their rounding errors, and the same for contents.
  [[nodiscard]] std::array<double*, 4> arrays() noexcept {
    return {sums_.data(), sums_.data() + stride_, sums_.data() + 2 * stride_, sums_.data() + 3 * stride_};
  }

 private:
  std::size_t stride_ = 0;
  std::vector<double> sums_;
};

/// Which simplices are cut, and where.
template <int N>
struct CutInput {
  const SimplexView<N>& contour;
  const PointOf<N>& origin;        ///< contents are relative to it
  std::span<const double> values;  ///< of the last coordinate, ascending
  /// By vertex: the number of values below it, or at it. The values that cut a simplex between two of its vertices are
  /// those from the number of the lower to that of the higher one.
  std::span<const Index> counts;
};

/// Adds the cuts of the simplices from `from` to `to` - 1, in this order. N = 3, 4, 5.
template <int N>
void add_cuts(const CutInput<N>& input, std::size_t from, std::size_t to, CutSums& sums);

/// `measure_cuts` of a contour without periods. N = 3, 4, 5.
template <int N>
std::vector<CutMeasures> measure_cuts_of_view(const SimplexView<N>& contour, GradientDirection direction,
                                              std::span<const double> at, const WorkOptions& work);

}  // namespace tegl::detail
