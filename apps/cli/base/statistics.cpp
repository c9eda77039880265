// SPDX-License-Identifier: BSD-3-Clause
//
// Computes statistics of values, histograms and suggested isovalues.
#include "base/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace tegl::cli {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array kPercentiles = {1.0, 5.0, 25.0, 50.0, 75.0, 90.0, 95.0, 99.0};

template <class T>
bool is_finite(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value);
  } else {
    return true;
  }
}

/// Computes the counts and the range.
template <class T>
void measure_range(std::span<const T> values, ValueStatistics& result) {
  T low = std::numeric_limits<T>::max();
  T high = std::numeric_limits<T>::lowest();
  for (const T value : values) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value)) {
        ++(std::isnan(value) ? result.missing : result.infinite);
        continue;
      }
    }
    low = std::min(low, value);
    high = std::max(high, value);
  }
  result.samples = values.size();
  const bool any = result.finite() > 0;
  result.min = any ? static_cast<double>(low) : kNan;
  result.max = any ? static_cast<double>(high) : kNan;
}

/// Computes mean and deviation, from sums relative to the middle of the range, block by block to limit rounding errors.
template <class T>
void measure_moments(std::span<const T> values, ValueStatistics& result) {
  constexpr std::size_t kBlock = 4096;
  const double middle = result.min / 2 + result.max / 2;
  double sum = 0;
  double squares = 0;
  for (std::size_t first = 0; first < values.size(); first += kBlock) {
    double block_sum = 0;
    double block_squares = 0;
    for (const T value : values.subspan(first, std::min(kBlock, values.size() - first))) {
      if (!is_finite(value)) continue;
      const double offset = static_cast<double>(value) - middle;
      block_sum += offset;
      block_squares += offset * offset;
    }
    sum += block_sum;
    squares += block_squares;
  }
  const auto count = static_cast<double>(result.finite());
  const double shift = sum / count;
  result.mean = middle + shift;
  result.deviation = std::sqrt(std::max(0.0, squares / count - shift * shift));
}

/// Maps values to the bins of a histogram.
struct Binning {
  double low = 0;
  double width = 1;
  double per_unit = 1;
  std::size_t bins = 1;

  [[nodiscard]] std::size_t operator()(double value) const {
    const double at = (value - low) * per_unit;
    if (!(at > 0)) return 0;  // also for NaN: a range that overflows has one bin
    return at < static_cast<double>(bins) ? static_cast<std::size_t>(at) : bins - 1;
  }
};

/// One bin per integer if there are not too many, else equal parts of the range.
template <class T>
Binning make_binning(const ValueStatistics& result) {
  constexpr std::size_t kParts = 4096;
  constexpr double kMostNumbers = 65535;
  const double range = result.max - result.min;
  if (std::is_integral_v<T> && range < kMostNumbers) {
    return {.low = result.min, .width = 1, .per_unit = 1, .bins = static_cast<std::size_t>(range) + 1};
  }
  if (!(range > 0) || !std::isfinite(range)) return {.low = result.min, .width = range, .per_unit = 0, .bins = 1};
  const double width = range / static_cast<double>(kParts);
  if (!std::isnormal(width)) return {.low = result.min, .width = range, .per_unit = 0, .bins = 1};
  return {.low = result.min, .width = width, .per_unit = 1 / width, .bins = kParts};
}

template <class T>
Histogram make_histogram(std::span<const T> values, const Binning& binning) {
  Histogram histogram{.low = binning.low, .width = binning.width, .counts = {}};
  histogram.counts.resize(binning.bins);
  for (const T value : values) {
    if (is_finite(value)) ++histogram.counts[binning(static_cast<double>(value))];
  }
  return histogram;
}

/// Exact percentiles. The histogram gives the bin of each rank. A bin of one integer is the result itself; otherwise
/// only the samples in those bins are collected and partially sorted. Values increase with the bin number, so the
/// collected samples of all bins can be ordered together.
template <class T>
void measure_percentiles(std::span<const T> values, const Binning& binning, ValueStatistics& result) {
  // bin of each rank
  const auto& counts = result.histogram.counts;
  std::vector<bool> wanted(counts.size());
  std::vector<std::pair<std::uint64_t, std::size_t>> targets;  // (rank among the finite samples, its bin)
  std::uint64_t below = 0;
  std::size_t bin = 0;
  for (const double percent : kPercentiles) {
    const double rank = std::max(1.0, std::ceil(percent / 100 * static_cast<double>(result.finite())));
    const std::uint64_t from_zero = static_cast<std::uint64_t>(rank) - 1;
    while (below + counts[bin] <= from_zero) below += counts[bin++];
    targets.emplace_back(from_zero, bin);
    wanted[bin] = true;
  }
  // samples in these bins
  std::vector<T> candidates;
  const bool exact_bins = std::is_integral_v<T> && binning.width <= 1;
  if (!exact_bins) {
    for (const T value : values) {
      if (is_finite(value) && wanted[binning(static_cast<double>(value))]) candidates.push_back(value);
    }
  }
  std::uint64_t skipped = 0;  // samples in other bins below the current one
  std::size_t done = 0;
  auto ordered_to = candidates.begin();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const auto [rank, at] = targets[i];
    double value = binning.low + static_cast<double>(at);
    if (!exact_bins) {
      for (; done < at; ++done) skipped += wanted[done] ? 0 : counts[done];
      const auto place = candidates.begin() + static_cast<std::ptrdiff_t>(rank - skipped);
      std::nth_element(ordered_to, place, candidates.end());
      ordered_to = place;
      value = static_cast<double>(*place);
    }
    result.percentiles.emplace_back(kPercentiles[i], value);
  }
}

/// For each threshold k in [1, bins), which separates bins below k from the others: the number of grid edges that it
/// cuts, and the sum of |V(a) - V(b)| over them.
struct Spectrum {
  std::vector<std::int64_t> edges;
  std::vector<double> steps;
};

/// Adds +1 and +|step| at the edge's lower bin and subtracts them at its upper bin; prefix sums over the bins then give
/// the totals of every threshold. O(1) per edge.
template <class T>
Spectrum make_spectrum(std::span<const T> values, std::span<const std::size_t> sizes, const Binning& binning) {
  Spectrum spectrum{std::vector<std::int64_t>(binning.bins + 1), std::vector<double>(binning.bins + 1)};
  std::size_t stride = 1;
  for (const std::size_t size : sizes) {
    for (std::size_t first = 0; first < values.size(); first += stride * size) {
      const std::size_t end = first + stride * (size - 1);
      for (std::size_t i = first; i < end; ++i) {
        const T a = values[i];
        const T b = values[i + stride];
        if (a == b || !is_finite(a) || !is_finite(b)) continue;
        const auto [low, high] = std::minmax({static_cast<double>(a), static_cast<double>(b)});
        const std::size_t from = binning(low) + 1;
        const std::size_t to = binning(high) + 1;
        if (from == to) continue;
        spectrum.edges[from] += 1;
        spectrum.edges[to] -= 1;
        spectrum.steps[from] += high - low;
        spectrum.steps[to] -= high - low;
      }
    }
    stride *= size;
  }
  for (std::size_t k = 1; k <= binning.bins; ++k) {
    spectrum.edges[k] += spectrum.edges[k - 1];
    spectrum.steps[k] += spectrum.steps[k - 1];
  }
  return spectrum;
}

/// Otsu's threshold: the k with the maximum between-class variance w0 w1 (m0 - m1)^2.
std::size_t otsu_threshold(const std::vector<std::uint64_t>& counts) {
  double total = 0;
  double total_sum = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    total += static_cast<double>(counts[i]);
    total_sum += static_cast<double>(counts[i]) * static_cast<double>(i);
  }
  double weight = 0;
  double sum = 0;
  double best = -1;
  std::size_t first = 1;
  std::size_t last = 1;
  for (std::size_t k = 1; k < counts.size(); ++k) {
    weight += static_cast<double>(counts[k - 1]);
    sum += static_cast<double>(counts[k - 1]) * static_cast<double>(k - 1);
    const double rest = total - weight;
    if (weight == 0 || rest == 0) continue;
    const double gap = sum / weight - (total_sum - sum) / rest;
    const double variance = weight * rest * gap * gap;
    if (variance > best) {
      best = variance;
      first = k;
    }
    if (variance == best) last = k;
  }
  // Empty bins between the classes give a plateau; its middle has the greatest distance from both.
  return first + (last - first) / 2;
}

/// The threshold with the maximum mean step. At most 256 thresholds are tested, so that each has enough samples, and
/// the small contours of extreme values, which are noise, are excluded.
std::optional<std::size_t> contrast_threshold(const Spectrum& spectrum, std::size_t bins) {
  constexpr std::size_t kTried = 256;
  constexpr double kLeastShare = 0.25;
  const std::size_t stride = std::max<std::size_t>(1, bins / kTried);
  std::int64_t most = 0;
  for (std::size_t k = stride; k < bins; k += stride) most = std::max(most, spectrum.edges[k]);
  std::optional<std::size_t> best;
  double best_mean = 0;
  for (std::size_t k = stride; k < bins; k += stride) {
    if (spectrum.edges[k] == 0 || static_cast<double>(spectrum.edges[k]) < kLeastShare * static_cast<double>(most)) {
      continue;
    }
    const double mean = spectrum.steps[k] / static_cast<double>(spectrum.edges[k]);
    if (mean > best_mean) {
      best_mean = mean;
      best = k;
    }
  }
  return best;
}

/// Rounds a value to about a thousandth of the range.
double rounded(double value, double range) {
  const double unit = std::pow(10.0, std::floor(std::log10(range)) - 3);
  // Dividing by the inverse keeps decimal fractions short: 20.1, not 20.1000000003.
  return unit < 1 ? std::round(value / unit) / std::round(1 / unit) : std::round(value / unit) * unit;
}

/// `integers`: whether the values are.
void suggest(const Binning& binning, const Spectrum& spectrum, bool integers, ValueStatistics& result) {
  if (binning.bins < 2) return;
  const auto add = [&](double value, std::string method) {
    if (integers) {
      value = std::floor(value) + 0.5;
      if (value > result.max) value -= 1;
    } else if (const double round = rounded(value, result.max - result.min); std::isfinite(round)) {
      value = round;
    }
    if (!(value > result.min && value <= result.max)) return;
    const auto same = [&](const Suggestion& other) { return other.value == value; };
    if (std::any_of(result.suggestions.begin(), result.suggestions.end(), same)) return;
    // Threshold k lies between bins k - 1 and k.
    const std::size_t k = std::clamp<std::size_t>(binning(value) + (integers ? 1 : 0), 1, binning.bins - 1);
    if (spectrum.edges[k] <= 0) return;
    result.suggestions.push_back({value, std::move(method), static_cast<std::uint64_t>(spectrum.edges[k])});
  };
  // Integers: threshold k separates low + k - 1 from low + k; `add` moves it to the middle.
  const auto at = [&](std::size_t k) {
    return binning.low + binning.width * (static_cast<double>(k) - (integers ? 0.5 : 0.0));
  };
  add(at(otsu_threshold(result.histogram.counts)), "otsu");
  if (const auto k = contrast_threshold(spectrum, binning.bins)) add(at(*k), "contrast");
  for (const auto& [percent, value] : result.percentiles) {
    if (percent == 50) add(value, "median");
    if (percent == 75 || percent == 90) add(value, fmt::format("percentile {}", percent));
  }
}

}  // namespace

Histogram Histogram::coarser(std::size_t bins) const {
  const std::size_t group = std::max<std::size_t>(1, (counts.size() + bins - 1) / bins);
  Histogram result{low, width * static_cast<double>(group),
                   std::vector<std::uint64_t>((counts.size() + group - 1) / group)};
  for (std::size_t i = 0; i < counts.size(); ++i) result.counts[i / group] += counts[i];
  return result;
}

template <Value T>
ValueStatistics value_statistics(std::span<const T> values, std::span<const std::size_t> sizes) {
  ValueStatistics result;
  measure_range(values, result);
  if (result.finite() == 0) {
    result.mean = result.deviation = kNan;
    return result;
  }
  measure_moments(values, result);
  const Binning binning = make_binning<T>(result);
  result.histogram = make_histogram(values, binning);
  measure_percentiles(values, binning, result);
  suggest(binning, make_spectrum(values, sizes, binning), std::is_integral_v<T>, result);
  return result;
}

template ValueStatistics value_statistics(std::span<const std::uint8_t>, std::span<const std::size_t>);
template ValueStatistics value_statistics(std::span<const std::int8_t>, std::span<const std::size_t>);
template ValueStatistics value_statistics(std::span<const std::uint16_t>, std::span<const std::size_t>);
template ValueStatistics value_statistics(std::span<const std::int16_t>, std::span<const std::size_t>);
template ValueStatistics value_statistics(std::span<const std::int32_t>, std::span<const std::size_t>);
template ValueStatistics value_statistics(std::span<const float>, std::span<const std::size_t>);
template ValueStatistics value_statistics(std::span<const double>, std::span<const std::size_t>);

namespace {

/// Statistics of an image of one dimension, of any type.
template <class AnyTyped>
ValueStatistics statistics_of(const AnyTyped& image) {
  return std::visit(
      [](const auto& owned) {
        const auto sizes = owned.grid.sizes();
        return value_statistics(std::span(owned.values), std::span<const std::size_t>(sizes));
      },
      image);
}

template <class AnyTyped>
ValueRange range_of(const AnyTyped& image, double isovalue) {
  ValueRange range;
  std::visit([&](const auto& owned) { range.read(std::span(owned.values), isovalue, isovalue); }, image);
  return range;
}

}  // namespace

ValueStatistics value_statistics(const AnyImage& image) {
  return std::visit([](const auto& typed) { return statistics_of(typed); }, image);
}
ValueStatistics value_statistics(const AnyImage5d& image) { return statistics_of(image); }

ValueRange value_range(const AnyImage& image, double isovalue) {
  return std::visit([&](const auto& typed) { return range_of(typed, isovalue); }, image);
}
ValueRange value_range(const AnyImage5d& image, double isovalue) { return range_of(image, isovalue); }

}  // namespace tegl::cli
