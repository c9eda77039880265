// SPDX-License-Identifier: BSD-3-Clause
//
// What the values of an image look like, and which isovalues are worth a try.
//
// Based on: N. Otsu, A threshold selection method from gray-level histograms, 1979; C. Bajaj, V. Pascucci
// and D. Schikore, The contour spectrum, 1997 (the size of a contour as a function of its isovalue, and the
// gradient along it, from one pass over the grid).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tegl/io.hpp"

namespace tegl::cli {

/// Counts over equal intervals: bin i holds low + i * width <= value < low + (i + 1) * width; the last one
/// holds the greatest value too.
struct Histogram {
  double low = 0;
  double width = 0;
  std::vector<std::uint64_t> counts;

  /// The same counts over at most `bins` intervals, each a whole number of these.
  [[nodiscard]] Histogram coarser(std::size_t bins) const;
};

/// An isovalue worth a try.
struct Suggestion {
  double value = 0;
  std::string method;                ///< "otsu", "contrast", "median", "percentile 90"
  std::uint64_t critical_edges = 0;  ///< grid edges that it cuts: about the vertices of its contour
};

/// Statistics of an image's values. Missing (NaN) and infinite ones are counted, and left out of the rest.
struct ValueStatistics {
  std::uint64_t samples = 0;
  std::uint64_t missing = 0;
  std::uint64_t infinite = 0;
  double min = 0;  ///< NaN, with mean and deviation, when there is no finite value
  double max = 0;
  double mean = 0;
  double deviation = 0;                                ///< of the population (divided by n)
  std::vector<std::pair<double, double>> percentiles;  ///< (p, value): the least sample with >= p % at or below it
  Histogram histogram;                                 ///< at most 65535 bins; whole numbers: as exact as fits
  std::vector<Suggestion> suggestions;                 ///< none when all values are equal

  [[nodiscard]] std::uint64_t finite() const { return samples - missing - infinite; }
};

/// Statistics of the dense values of a grid, axis 0 fastest; the product of `sizes` is values.size().
/// O(n) for each dimension. The suggestions are
///   otsu        the threshold that splits the histogram with the greatest variance between the classes
///   contrast    the isovalue with the greatest mean step |V(a) - V(b)| over the grid edges that it cuts, of
///               those that cut at least a quarter of the edges that the largest contour does: boundaries between
///               materials
///   median, percentile 75, percentile 90
/// For whole-numbered data they lie half way between two numbers, where no sample equals the isovalue.
template <Value T>
ValueStatistics value_statistics(std::span<const T> values, std::span<const std::size_t> sizes);

ValueStatistics value_statistics(const AnyImage& image);

/// The least and the greatest sample, infinities included; NaN, NaN when all are missing.
struct ValueRange {
  double min = 0;
  double max = 0;
};
ValueRange value_range(const AnyImage& image);

}  // namespace tegl::cli
