// SPDX-License-Identifier: BSD-3-Clause
//
// Statistics of an image's values, and suggestions of isovalues.
//
// Based on: N. Otsu, A threshold selection method from gray-level histograms, 1979; C. Bajaj, V. Pascucci and D.
// Schikore, The contour spectrum, 1997 (the size of a contour as a function of its isovalue, and the gradient along it,
// from one pass over the grid).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tegl/io/images.hpp"

namespace tegl::cli {

/// A histogram of equal intervals: bin i counts low + i * width <= value < low + (i + 1) * width; the last bin includes
/// the maximum.
struct Histogram {
  double low = 0;
  double width = 0;
  std::vector<std::uint64_t> counts;

  /// The same counts in at most `bins` intervals, each a multiple of these.
  [[nodiscard]] Histogram coarser(std::size_t bins) const;
};

/// A suggested isovalue.
struct Suggestion {
  double value = 0;
  std::string method;                ///< "otsu", "contrast", "median", "percentile 90"
  std::uint64_t critical_edges = 0;  ///< grid edges that it cuts: about the number of vertices of its contour
};

/// Statistics of an image's values. Missing (NaN) and infinite values are counted, and excluded from the rest.
struct ValueStatistics {
  std::uint64_t samples = 0;
  std::uint64_t missing = 0;
  std::uint64_t infinite = 0;
  double min = 0;  ///< NaN, with mean and deviation, if there is no finite value
  double max = 0;
  double mean = 0;
  double deviation = 0;                                ///< of the population (divided by n)
  std::vector<std::pair<double, double>> percentiles;  ///< (p, value): smallest sample with >= p % at or below it
  Histogram histogram;                                 ///< at most 65535 bins; integers: one per bin if they fit
  std::vector<Suggestion> suggestions;                 ///< empty if all values are equal

  [[nodiscard]] std::uint64_t finite() const { return samples - missing - infinite; }
};

/// Statistics of the dense values of a grid, axis 0 fastest; the product of `sizes` is values.size(). O(n) for each
/// dimension. The suggestions are
///   otsu        the threshold with the maximum variance between the classes of the histogram
///   contrast    the isovalue with the maximum mean step |V(a) - V(b)| over the grid edges that it cuts, of those that
///               cut at least a quarter of the edges that the largest contour cuts: boundaries between materials
///   median, percentile 75, percentile 90
/// For integer data they lie half way between two integers, so no sample equals the isovalue.
template <Value T>
ValueStatistics value_statistics(std::span<const T> values, std::span<const std::size_t> sizes);

ValueStatistics value_statistics(const AnyImage& image);
ValueStatistics value_statistics(const AnyImage5d& image);

/// Minimum and maximum of the samples read so far, infinities included; NaN, NaN if all are missing.
struct ValueRange {
  double min = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();

  /// Whether each isovalue from `least` to `most` has samples on both sides: one below it, and one at or above it.
  [[nodiscard]] bool has_both_sides(double least, double most) const noexcept { return min < least && most <= max; }
  [[nodiscard]] bool has_both_sides(double isovalue) const noexcept { return has_both_sides(isovalue, isovalue); }
  /// Reads samples until each isovalue from `least` to `most` has samples on both sides.
  template <Value T>
  void read(std::span<const T> values, double least, double most) noexcept {
    constexpr std::size_t kBlock = 4096;
    for (std::size_t first = 0; first < values.size() && !has_both_sides(least, most); first += kBlock)
      for (const T value : values.subspan(first, std::min(kBlock, values.size() - first))) {
        const auto wide = static_cast<double>(value);
        if (std::isnan(wide)) continue;
        if (!(min <= wide)) min = wide;
        if (!(max >= wide)) max = wide;
      }
  }
};

/// The range of an image's samples, which are read until the isovalue has some on both sides: complete if it has not.
ValueRange value_range(const AnyImage& image, double isovalue);
ValueRange value_range(const AnyImage5d& image, double isovalue);

}  // namespace tegl::cli
