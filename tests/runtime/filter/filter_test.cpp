// SPDX-License-Identifier: BSD-3-Clause
//
// Filters against their definitions, computed sample by sample in double; their borders, missing values and errors.
#include "tegl/filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "errors.hpp"
#include "fields.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::array kBorders = {FilterBorder::extended, FilterBorder::cyclic, FilterBorder::missing};

/// The sample with an index that may be outside; NaN if it is missing.
template <class T, int N>
double sample_at(const Image<T, N>& image, std::array<std::ptrdiff_t, N> index, FilterBorder border) {
  std::array<std::size_t, N> inside{};
  for (int a = 0; a < N; ++a) {
    const auto size = static_cast<std::ptrdiff_t>(image.size(a));
    std::ptrdiff_t i = index[a];
    if (border == FilterBorder::extended) i = std::clamp<std::ptrdiff_t>(i, 0, size - 1);
    if (border == FilterBorder::cyclic) i = ((i % size) + size) % size;
    if (i < 0 || i >= size) return kNaN;
    inside[a] = static_cast<std::size_t>(i);
  }
  return static_cast<double>(image(inside));
}

/// Calls visit(offset, value) for the box of these sizes around a sample.
template <class T, int N, class Visit>
void for_box(const Image<T, N>& image, const std::array<std::size_t, N>& index, const std::array<std::size_t, N>& sizes,
             FilterBorder border, const Visit& visit) {
  for_each_sample<N>(Grid<N>::unit(sizes), [&](std::size_t, const std::array<std::size_t, N>& place) {
    std::array<std::ptrdiff_t, N> at{}, offset{};
    for (int a = 0; a < N; ++a) {
      offset[a] = static_cast<std::ptrdiff_t>(place[a]) - static_cast<std::ptrdiff_t>(sizes[a] / 2);
      at[a] = static_cast<std::ptrdiff_t>(index[a]) + offset[a];
    }
    visit(offset, sample_at<T, N>(image, at, border));
  });
}

/// The sum of a convolution by its definition.
template <class T, int N>
double direct_sum(const Image<T, N>& image, const std::array<std::size_t, N>& index,
                  const std::array<std::size_t, N>& sizes, const std::vector<double>& weights, FilterBorder border,
                  bool fill) {
  const bool normalised = std::all_of(weights.begin(), weights.end(), [](double weight) { return weight >= 0; });
  double sum = 0, present = 0;
  std::size_t i = 0;
  bool missing = false;
  for_box<T, N>(image, index, sizes, border, [&](const auto&, double value) {
    const double weight = weights[i++];
    if (std::isnan(value)) {
      missing = missing || weight != 0;
      return;
    }
    sum += weight * value;
    present += weight;
  });
  if (!fill && std::isnan(static_cast<double>(image(index)))) return kNaN;
  if (!missing) return sum;
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  return normalised && present > 0 ? sum / present * all : kNaN;
}

template <int N>
std::array<std::size_t, N> uneven_sizes() {
  std::array<std::size_t, N> sizes{};
  constexpr std::array<std::size_t, 5> kSizes = {7, 5, 6, 4, 3};
  std::copy_n(kSizes.begin(), N, sizes.begin());
  return sizes;
}

/// Compares a result with `expected(index)`.
template <class Real, int N, class Expected>
void expect_samples(const OwnedImage<Real, N>& result, double tolerance, const Expected& expected) {
  for_each_sample<N>(result.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    const double wanted = expected(index);
    const auto got = static_cast<double>(result.values[i]);
    ASSERT_EQ(std::isnan(got), std::isnan(wanted)) << "sample " << i << ": " << got << ", not " << wanted;
    if (std::isnan(wanted)) return;
    ASSERT_NEAR(got, wanted, tolerance) << "sample " << i;
  });
}

template <class T, int N>
void compare_convolutions(const OwnedImage<T, N>& image, double tolerance) {
  std::mt19937_64 bits(11 + N);
  std::array<std::size_t, N> kernel{};
  kernel.fill(1);
  kernel[0] = 5;
  kernel[N - 1] = 3;
  if (N > 2) kernel[1] = 3;
  const std::size_t count = std::accumulate(kernel.begin(), kernel.end(), std::size_t{1}, std::multiplies<>());
  const double scale = std::is_integral_v<T> ? 1e4 : 1;
  for (const double least : {0.0, -0.5})
    for (const FilterBorder border : kBorders)
      for (const bool fill : {false, true}) {
        std::vector<double> weights(count);
        for (double& weight : weights) weight = unit_random(bits) + least;
        weights[count / 3] = 0;
        FilterOptions options{{border}, fill, {2, {}}};
        const auto result = filter_image(image.view(), Convolution{{kernel.begin(), kernel.end()}, weights}, options);
        expect_samples<FilteredValue<T>, N>(result, tolerance * scale, [&](const auto& index) {
          return direct_sum<T, N>(image.view(), index, kernel, weights, border, fill);
        });
      }
}

TEST(Filter, ConvolutionIsItsDirectSumIn2To5Dimensions) {
  compare_convolutions(noise<float, 2>({9, 1}, 1), 1e-5);  // a line
  compare_convolutions(noise<float, 2>(uneven_sizes<2>(), 1), 1e-5);
  compare_convolutions(noise<double, 3>(uneven_sizes<3>(), 2), 1e-13);
  compare_convolutions(noise<std::int16_t, 4>(uneven_sizes<4>(), 3), 1e-2);
  compare_convolutions(noise<float, 5>(uneven_sizes<5>(), 4), 1e-5);
}

TEST(Filter, ConvolutionOfMissingSamplesIsNormalised) {
  compare_convolutions(noise_with_missing<float, 2>(Grid<2>::unit(uneven_sizes<2>()), 5, 0.3), 1e-5);
  compare_convolutions(noise_with_missing<double, 3>(Grid<3>::unit(uneven_sizes<3>()), 6, 0.3), 1e-12);
  compare_convolutions(noise_with_missing<float, 4>(Grid<4>::unit(uneven_sizes<4>()), 7, 0.3), 1e-5);
}

/// The kernel of N dimensions that is the product of kernels along the axes.
template <int N>
std::pair<std::array<std::size_t, N>, std::vector<double>> product(const SeparableConvolution& filter) {
  std::array<std::size_t, N> sizes{};
  for (int a = 0; a < N; ++a) sizes[a] = std::max<std::size_t>(1, filter.weights[a].size());
  std::vector<double> weights;
  for_each_sample<N>(Grid<N>::unit(sizes), [&](std::size_t, const std::array<std::size_t, N>& index) {
    double weight = 1;
    for (int a = 0; a < N; ++a)
      if (!filter.weights[a].empty()) weight *= filter.weights[a][index[a]];
    weights.push_back(weight);
  });
  return {sizes, weights};
}

template <class T, int N>
void compare_separable(const OwnedImage<T, N>& image, double tolerance) {
  SeparableConvolution smooth, derivative;
  for (int a = 0; a < N; ++a) smooth.weights.push_back(gaussian_weights(a == 1 ? 0.0 : 0.4 + 0.2 * a));
  derivative.weights = smooth.weights;
  derivative.weights[0] = {-0.5, 0, 0.5};
  derivative.weights[N - 1] = {};
  for (const SeparableConvolution& filter : {smooth, derivative}) {
    const auto [sizes, weights] = product<N>(filter);
    const bool fills = &filter == &smooth;
    for (const FilterBorder border : kBorders) {
      const FilterOptions options{{border}, fills, {2, {}}};
      const auto result = filter_image(image.view(), filter, options);
      expect_samples<FilteredValue<T>, N>(result, tolerance,
                                          [&, &sizes = sizes, &weights = weights](const auto& index) {
                                            return direct_sum<T, N>(image.view(), index, sizes, weights, border, fills);
                                          });
    }
  }
}

TEST(Filter, SeparableConvolutionIsThatOfTheWholeKernel) {
  compare_separable(noise<float, 2>(uneven_sizes<2>(), 1), 1e-5);
  compare_separable(noise<double, 3>(uneven_sizes<3>(), 2), 1e-13);
  compare_separable(noise<std::uint8_t, 4>(uneven_sizes<4>(), 3), 1e-3);
  compare_separable(noise<float, 5>(uneven_sizes<5>(), 4), 1e-5);
}

TEST(Filter, SeparableConvolutionIsNormalisedAtMissingSamples) {
  const auto image = noise_with_missing<double, 3>(Grid<3>::unit({7, 6, 9}), 8, 0.3);
  SeparableConvolution filter;
  for (const double sigma : {0.5, 0.8, 0.6}) filter.weights.push_back(gaussian_weights(sigma));
  const auto [sizes, weights] = product<3>(filter);
  for (const FilterBorder border : kBorders)
    for (const bool fill : {false, true}) {
      const auto result = filter_image(image.view(), filter, {{border}, fill, {}});
      expect_samples<double, 3>(result, 1e-12, [&, &sizes = sizes, &weights = weights](const auto& index) {
        return direct_sum<double, 3>(image.view(), index, sizes, weights, border, fill);
      });
    }
}

TEST(Filter, SamplesWithoutWeightMayBeNaNOrInfinite) {
  // a shift of one sample along each axis in turn, with weights of both signs: missing samples are not normalised
  auto image = noise<double, 3>({6, 5, 4}, 12);
  const std::size_t strides[] = {1, 6, 30};
  const std::size_t middle = 2 + 6 * 2 + 30 * 2;
  image.values[middle] = std::numeric_limits<double>::quiet_NaN();
  image.values[middle + 1] = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    SeparableConvolution filter;
    filter.weights.resize(3);
    filter.weights[axis] = {-1, 0, 0};
    const auto result = filter_image(image.view(), filter, {{FilterBorder::extended}, true, {}});
    for (std::size_t i = 0; i < image.values.size(); ++i) {
      const double before =
          i / strides[axis] % image.grid.axes[axis].size() == 0 ? image.values[i] : image.values[i - strides[axis]];
      EXPECT_TRUE(result.values[i] == -before || (std::isnan(result.values[i]) && std::isnan(before))) << i;
    }
  }
}

TEST(Filter, BordersMayDifferByAxis) {
  const auto image = noise<double, 2>({6, 5}, 9);
  const FilterOptions options{{FilterBorder::cyclic, FilterBorder::extended}, false, {}};
  const auto result = filter_image(image.view(), SeparableConvolution{{{0.25, 0.5, 0.25}, {0, 0, 1}}}, options);
  const auto at = [&](std::size_t x, std::size_t y) { return image.view()({x, y}); };
  EXPECT_NEAR(result.values[0], 0.25 * at(5, 1) + 0.5 * at(0, 1) + 0.25 * at(1, 1), 1e-15);
  EXPECT_NEAR(result.values[4 * 6 + 5], 0.25 * at(4, 4) + 0.5 * at(5, 4) + 0.25 * at(0, 4), 1e-15);
}

TEST(Filter, MedianIsTheMiddleOfTheBox) {
  const auto image = noise_with_missing<float, 3>(Grid<3>::unit({6, 7, 5}), 10, 0.2);
  for (const FilterBorder border : kBorders) {
    const auto result = filter_image(image.view(), MedianFilter{{1, 2, 1}}, {{border}, true, {}});
    expect_samples<float, 3>(result, 1e-6, [&](const auto& index) {
      std::vector<double> box;
      for_box<float, 3>(image.view(), index, {3, 5, 3}, border, [&](const auto&, double value) {
        if (!std::isnan(value)) box.push_back(value);
      });
      std::sort(box.begin(), box.end());
      return box.empty() ? kNaN : (box[(box.size() - 1) / 2] + box[box.size() / 2]) / 2;
    });
  }
}

TEST(Filter, BilateralWeighsByDistanceAndByValue) {
  const auto image = noise_with_missing<double, 2>(Grid<2>::unit({9, 8}), 12, 0.1);
  const std::array<double, 2> sigmas = {1.2, 0.8};
  const double value_sigma = 0.3;
  const auto result = filter_image(image.view(), BilateralFilter{{1.2, 0.8}, value_sigma});
  expect_samples<double, 2>(result, 1e-6, [&](const std::array<std::size_t, 2>& index) {
    const double here = image.view()(index);
    double sum = 0, present = 0;
    for_box<double, 2>(image.view(), index, {7, 5}, FilterBorder::extended, [&](const auto& offset, double value) {
      const double square = std::pow(static_cast<double>(offset[0]) / sigmas[0], 2) +
                            std::pow(static_cast<double>(offset[1]) / sigmas[1], 2);
      const double difference = (value - here) / value_sigma;
      if (std::isnan(value) || square > 2.5 * 2.5 || std::abs(difference) >= 4) return;
      const double weight = std::exp(-square / 2) * std::exp(-difference * difference / 2);
      sum += weight * value;
      present += weight;
    });
    return std::isnan(here) ? kNaN : sum / present;
  });
}

TEST(Filter, BilateralKeepsAStepThatAGaussianBlurs) {
  OwnedImage<float, 2> step{Grid<2>::unit({20, 5}), std::vector<float>(100)};
  for (std::size_t i = 0; i < 100; ++i) step.values[i] = i % 20 < 10 ? 0.0F : 100.0F;
  EXPECT_EQ(filter_image(step.view(), BilateralFilter{{2, 2}, 5}).values, step.values);
  SeparableConvolution gaussian{{gaussian_weights(2), gaussian_weights(2)}};
  EXPECT_GT(filter_image(step.view(), gaussian).values[9], 30.0F);
}

TEST(Filter, ContextualLowPassSmoothsStepsAndKeepsDetails) {
  // A half-plane with steps, and a line of one sample's width.
  OwnedImage<std::uint8_t, 2> image{Grid<2>::unit({40, 30}), std::vector<std::uint8_t>(1200)};
  for (std::size_t y = 0; y < 30; ++y)
    for (std::size_t x = 0; x < 40; ++x) image.values[y * 40 + x] = y < 8 + x / 5 || y == 24 ? 1 : 0;
  const auto filtered = filter_image(image.view(), ContextualLowPass{0.5});
  std::size_t changed = 0;
  for (std::size_t i = 0; i < 1200; ++i) {
    EXPECT_EQ(filtered.values[i] >= 0.5F, image.values[i] != 0) << i;
    const bool is_changed = filtered.values[i] != static_cast<float>(image.values[i]);
    changed += is_changed ? 1 : 0;
    EXPECT_FALSE(is_changed && i / 40 >= 22) << "the line, at " << i;
  }
  EXPECT_GT(changed, 60u);
  // The points of the contour are closer to the line that the steps follow.
  const auto distance = [](const auto& contour) {
    double sum = 0;
    std::size_t count = 0;
    for (const auto& v : contour.vertices) {
      if (v[0] < 5 || v[0] > 35 || v[1] > 20) continue;
      const double off = (v[1] - (v[0] - 2) / 5 - 7.5) / std::sqrt(1.04);
      sum += off * off;
      ++count;
    }
    return std::sqrt(sum / static_cast<double>(count));
  };
  EXPECT_LT(distance(extract(filtered.view(), 0.5)), 0.7 * distance(extract(image.view(), 0.5)));
}

TEST(Filter, ContextualLowPassKeepsEverySideOfNoise) {
  const auto image = coarse_noise<std::int16_t, 3>(Grid<3>::unit({9, 8, 7}), 4, 5);
  const auto filtered = filter_image(image.view(), ContextualLowPass{2});
  for (std::size_t i = 0; i < image.values.size(); ++i) EXPECT_EQ(filtered.values[i] >= 2, image.values[i] >= 2) << i;
}

/// A kernel convolved with another.
AxisWeights convolved(const AxisWeights& a, const AxisWeights& b) {
  AxisWeights result(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  return result;
}

/// The difference of two kernels with the same centre.
double difference(const AxisWeights& a, const AxisWeights& b) {
  const std::size_t radius = std::max(a.size(), b.size()) / 2;
  double most = 0;
  for (std::size_t i = 0; i <= 2 * radius; ++i) {
    const auto at = [&](const AxisWeights& weights) {
      const std::size_t shift = radius - weights.size() / 2;
      return i < shift || i - shift >= weights.size() ? 0.0 : weights[i - shift];
    };
    most = std::max(most, std::abs(at(a) - at(b)));
  }
  return most;
}

double variance(const AxisWeights& weights) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double x = static_cast<double>(i) - static_cast<double>(weights.size() / 2);
    sum += weights[i] * x * x;
  }
  return sum;
}

TEST(FilterWeights, DiscreteGaussiansAreASemigroup) {
  for (const auto& [first, second] : {std::pair{0.3, 0.4}, {1.0, 2.0}, {3.0, 4.0}, {7.0, 24.0}}) {
    const double both = std::hypot(first, second);
    EXPECT_LT(difference(convolved(discrete_gaussian_weights(first), discrete_gaussian_weights(second)),
                         discrete_gaussian_weights(both)),
              2e-7)
        << first << ' ' << second;
    EXPECT_NEAR(variance(discrete_gaussian_weights(both)), both * both, 1e-4 * both * both);
  }
  // Sampled Gaussians are none at small scales.
  EXPECT_GT(difference(convolved(gaussian_weights(0.3), gaussian_weights(0.4)), gaussian_weights(0.5)), 0.01);
}

TEST(FilterWeights, DiscreteGaussianHasTheValuesOfBesselFunctions) {
  for (const double sigma : {0.2, 1.0, 2.5}) {
    const AxisWeights weights = discrete_gaussian_weights(sigma);
    const double t = sigma * sigma;
    for (std::size_t k = 0; k <= weights.size() / 2; ++k)
      EXPECT_NEAR(weights[weights.size() / 2 + k], std::exp(-t) * std::cyl_bessel_i(static_cast<double>(k), t), 2e-7);
  }
}

TEST(FilterWeights, AreSymmetricAndSumTo1) {
  for (const double sigma : {0.0, 0.1, 0.7, 2.0, 30.0})
    for (const AxisWeights& weights :
         {gaussian_weights(sigma), discrete_gaussian_weights(sigma), binomial_weights(sigma)}) {
      EXPECT_EQ(weights.size() % 2, 1u);
      EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-14);
      for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_EQ(weights[i], weights[weights.size() - 1 - i]);
    }
  EXPECT_EQ(binomial_weights(0.7), (AxisWeights{0.25, 0.5, 0.25}));
  EXPECT_NEAR(variance(binomial_weights(2.0)), 4.0, 1e-12);
  EXPECT_NEAR(variance(gaussian_weights(2.0)), 4.0, 0.02);
  EXPECT_EQ(gaussian_weights(2.0).size(), 17u);
}

TEST(Filter, SameBytesForAnyNumberOfThreadsAndByLayers) {
  const auto image = noise_with_missing<float, 3>(Grid<3>::unit({70, 65, 90}), 13, 0.001);
  SeparableConvolution gaussian{{gaussian_weights(1.5), gaussian_weights(2), gaussian_weights(3)}};
  for (const Filter& filter :
       {Filter(gaussian), Filter(MedianFilter{{1, 1, 1}}), Filter(BilateralFilter{{1, 1, 1}, 0.2}),
        Filter(Convolution{{3, 1, 5}, std::vector<double>(15, 0.1)}), Filter(ContextualLowPass{0.5})})
    for (const FilterBorder border : kBorders) {
      const auto one = filter_image(image.view(), filter, {{border}, false, {1, {}}});
      const auto bits = [](const auto& values) {
        std::vector<std::uint32_t> result(values.size());
        std::memcpy(result.data(), values.data(), 4 * result.size());
        return result;
      };
      const auto several = filter_image(image.view(), filter, {{border}, false, {3, {}}});
      EXPECT_EQ(bits(one.values), bits(several.values));
      FunctionLayers<float, 3> source(
          image.grid, [&](std::size_t k, float* to) { std::copy_n(image.values.data() + k * 70 * 65, 70 * 65, to); });
      const auto layers = filter_layers(source, filter, {{border}, false, {2, {}}});
      std::vector<float> streamed(image.values.size());
      for (std::size_t k = 0; k < 90; ++k) layers->read(k, streamed.data() + k * 70 * 65);
      EXPECT_EQ(bits(one.values), bits(streamed));
      layers->read(17, streamed.data() + 17 * 70 * 65);  // out of order
      EXPECT_EQ(bits(one.values), bits(streamed));
    }
}

/// Layers without a missing neighbour must not depend on those in the same batch: one thread takes 4 layers of this
/// size at once, three threads 12, and the source one.
TEST(Filter, SameBytesForAnyBatchBesideACluster) {
  constexpr std::size_t kLayer = 256 * 128, kLayers = 16;
  auto image = noise_with_missing<float, 3>(Grid<3>::unit({256, 128, kLayers}), 5, 0.0);
  for (std::size_t k = 3; k < 5; ++k)
    for (std::size_t i = 60; i < 63; ++i)
      image.values[k * kLayer + 40 * 256 + i] = std::numeric_limits<float>::quiet_NaN();
  const SeparableConvolution gaussian{{gaussian_weights(1), gaussian_weights(1), gaussian_weights(0.5)}};
  const auto one = filter_image(image.view(), gaussian, {{FilterBorder::extended}, false, {1, {}}});
  const auto same = [&](const std::vector<float>& values) {
    return std::memcmp(one.values.data(), values.data(), sizeof(float) * values.size()) == 0;
  };
  for (const unsigned threads : {2U, 3U, 5U})
    EXPECT_TRUE(same(filter_image(image.view(), gaussian, {{FilterBorder::extended}, false, {threads, {}}}).values))
        << threads;
  FunctionLayers<float, 3> source(
      image.grid, [&](std::size_t k, float* to) { std::copy_n(image.values.data() + k * kLayer, kLayer, to); });
  const auto layers = filter_layers(source, gaussian);
  std::vector<float> streamed(image.values.size());
  for (std::size_t k = 0; k < kLayers; ++k) layers->read(k, streamed.data() + k * kLayer);
  EXPECT_TRUE(same(streamed));
}

/// Mean distance of the contour's vertices from a point, in the world.
template <int N>
double mean_radius(const OwnedImage<double, N>& image, const std::array<double, N>& centre) {
  const auto contour = extract<double>(image.view(), 0.0);
  double sum = 0;
  for (const auto& vertex : contour.vertices) {
    double square = 0;
    for (int a = 0; a < N; ++a) square += (vertex[a] - centre[a]) * (vertex[a] - centre[a]);
    sum += std::sqrt(square);
  }
  return sum / static_cast<double>(contour.vertices.size());
}

/// A ball shrinks as r^2 = r0^2 - 2 (n - 1) t, also with steps of different lengths.
template <int N>
void expect_shrinking_ball(std::size_t size, double radius, double time, double precision) {
  OwnedImage<double, N> image{Grid<N>(), {}};
  std::array<double, N> centre;
  CurvatureFlow flow{{}, time};
  for (int a = 0; a < N; ++a) {
    const double step = a == 1 ? 0.75 : 1.0;
    image.grid.axes[a] =
        Axis::uniform(static_cast<std::size_t>(std::lround(static_cast<double>(size) / step)), 0.0, step);
    centre[a] = static_cast<double>(size) / 2 - 0.3;
    flow.spacing.push_back(step);
  }
  std::vector<double> values(sample_count(image.grid));
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    double square = 0;
    for (int a = 0; a < N; ++a) square += std::pow(image.grid.axes[a][index[a]] - centre[a], 2);
    values[i] = radius - std::sqrt(square);
  });
  image.values = std::move(values);
  const double expected = std::sqrt(radius * radius - 2 * (N - 1) * time);
  EXPECT_NEAR(mean_radius<N>(image, centre), radius, 0.01 * radius) << N;
  EXPECT_NEAR(mean_radius<N>(filter_image(image.view(), flow), centre), expected, precision * expected) << N;
}

TEST(CurvatureFlow, BallsShrinkByTheSumOfTheirCurvatures) {
  expect_shrinking_ball<2>(50, 20, 100, 0.01);
  expect_shrinking_ball<3>(36, 14, 20, 0.01);
  expect_shrinking_ball<4>(20, 8, 3, 0.015);
}

TEST(CurvatureFlow, KeepsConstantsPlanesAndTheRange) {
  OwnedImage<float, 3> constant{Grid<3>::unit({6, 5, 4}), std::vector<float>(120, 3.5F)};
  EXPECT_EQ(filter_image(constant.view(), CurvatureFlow{{1, 1, 1}, 5}).values, constant.values);
  OwnedImage<double, 2> plane{Grid<2>::unit({30, 30}), std::vector<double>(900)};
  for (std::size_t i = 0; i < 900; ++i) plane.values[i] = static_cast<double>(i % 30) + 2 * static_cast<double>(i / 30);
  const auto same = filter_image(plane.view(), CurvatureFlow{{1, 1}, 0.4});
  for (std::size_t y = 5; y < 25; ++y)
    for (std::size_t x = 5; x < 25; ++x) EXPECT_NEAR(same.values[x + 30 * y], plane.values[x + 30 * y], 1e-12);
  const auto rough = noise<float, 3>({20, 20, 20}, 3);
  const auto smooth = filter_image(rough.view(), CurvatureFlow{{1, 1, 1}, 30});
  const auto [least, most] = std::minmax_element(rough.values.begin(), rough.values.end());
  const auto [low, high] = std::minmax_element(smooth.values.begin(), smooth.values.end());
  EXPECT_GE(*low, *least);
  EXPECT_LE(*high, *most);
  EXPECT_LT(*high - *low, 0.5F * (*most - *least));
  EXPECT_EQ(filter_image(rough.view(), CurvatureFlow{{1, 1, 1}, 0}).values, rough.values);
}

TEST(CurvatureFlow, CyclicBordersMoveWithTheImage) {
  const auto image = noise<double, 2>({11, 9}, 5);
  OwnedImage<double, 2> moved = image;
  for (std::size_t y = 0; y < 9; ++y)
    for (std::size_t x = 0; x < 11; ++x) moved.values[(x + 4) % 11 + 11 * ((y + 7) % 9)] = image.values[x + 11 * y];
  const FilterOptions cyclic{{FilterBorder::cyclic}, false, {}};
  const auto one = filter_image(image.view(), CurvatureFlow{{1, 2}, 3}, cyclic);
  const auto other = filter_image(moved.view(), CurvatureFlow{{1, 2}, 3}, cyclic);
  for (std::size_t y = 0; y < 9; ++y)
    for (std::size_t x = 0; x < 11; ++x)
      EXPECT_EQ(other.values[(x + 4) % 11 + 11 * ((y + 7) % 9)], one.values[x + 11 * y]);
}

TEST(CurvatureFlow, AxesWithoutALengthDoNotTakePart) {
  const auto image = noise<double, 3>({9, 8, 3}, 6);
  const auto all = filter_image(image.view(), CurvatureFlow{{1, 1, 0}, 2});
  for (std::size_t k = 0; k < 3; ++k) {
    const Image<double, 2> layer(image.values.data() + 72 * k, Grid<2>::unit({9, 8}));
    const auto flat = filter_image(layer, CurvatureFlow{{1, 1}, 2});
    EXPECT_TRUE(std::equal(flat.values.begin(), flat.values.end(), all.values.data() + 72 * k));
  }
}

TEST(CurvatureFlow, IsMadeByLayersWithACyclicBorderOfAnAxisThatTakesNoPart) {
  const auto image = noise<float, 3>({9, 8, 5}, 7);
  const FilterOptions cyclic{{FilterBorder::cyclic}, false, {}};
  const CurvatureFlow flow{{1, 1, 0}, 2};
  const auto whole = filter_image(image.view(), flow, cyclic);
  FunctionLayers<float, 3> source(image.grid,
                                  [&](std::size_t k, float* to) { std::copy_n(image.values.data() + 72 * k, 72, to); });
  const auto layers = filter_layers(source, flow, cyclic);
  std::vector<float> layer(72);
  for (std::size_t k = 0; k < 5; ++k) {
    layers->read(k, layer.data());
    EXPECT_TRUE(std::equal(layer.begin(), layer.end(), whole.values.data() + 72 * k)) << k;
  }
}

TEST(CurvatureFlow, GivesTheSameBytesByLayersAndForAnyNumberOfThreads) {
  auto image = noise_with_missing<float, 3>(Grid<3>::unit({20, 15, 30}), 13, 0.01);
  const CurvatureFlow flow{{1, 1, 1}, 1.5};
  EXPECT_EQ(step_count(flow), 12u);
  const auto bits = [](const auto& values) {
    std::vector<std::uint32_t> result(values.size());
    std::memcpy(result.data(), values.data(), 4 * result.size());
    return result;
  };
  FunctionLayers<float, 3> source(
      image.grid, [&](std::size_t k, float* to) { std::copy_n(image.values.data() + k * 300, 300, to); });
  for (const FilterBorder border : {FilterBorder::extended, FilterBorder::missing}) {
    const auto one = filter_image(image.view(), flow, {{border}, false, {1, {}}});
    EXPECT_EQ(bits(one.values), bits(filter_image(image.view(), flow, {{border}, false, {3, {}}}).values));
    for (std::size_t i = 0; i < one.values.size(); ++i)
      EXPECT_EQ(std::isnan(one.values[i]), std::isnan(image.values[i]));
    const auto layers = filter_layers(source, flow, {{border}, false, {2, {}}});
    std::vector<float> streamed(image.values.size());
    for (std::size_t k = 0; k < 30; ++k) layers->read(k, streamed.data() + k * 300);
    layers->read(17, streamed.data() + 17 * 300);  // out of order
    EXPECT_EQ(bits(one.values), bits(streamed));
  }
  expect_error(ErrorCode::UnsupportedData, "cyclic border along the last axis", [&] {
    (void)filter_layers(source, flow, {{FilterBorder::cyclic}, false, {}});
  });
}

TEST(CurvatureFlow, RefusesWhatIsNoFlow) {
  const auto image = noise<float, 2>({5, 5}, 1);
  const auto refuse = [&](const std::string& part, const CurvatureFlow& flow) {
    expect_error(ErrorCode::InvalidArgument, part, [&] { (void)filter_image(image.view(), flow); });
  };
  refuse("3 lengths of steps for the flow; expected one for each of 2", {{1, 1, 1}, 1});
  refuse("the time of the flow is -1", {{1, 1}, -1});
  refuse("has the length -2", {{1, -2}, 1});
  refuse("without an axis that takes part", {{0, 0}, 1});
  refuse("expected at most 100000", {{1, 1}, 1e9});
}

TEST(Filter, LayersOfTheSourceAreReadOnceInOrder) {
  std::vector<std::size_t> read;
  FunctionLayers<std::uint16_t, 2> source(Grid<2>::unit({4, 30}), [&](std::size_t k, std::uint16_t* to) {
    read.push_back(k);
    std::fill_n(to, 4, static_cast<std::uint16_t>(k));
  });
  const auto layers = filter_layers(source, SeparableConvolution{{{}, {0.25, 0.5, 0.25}}});
  std::array<float, 4> row{};
  for (std::size_t k = 0; k < 30; ++k) layers->read(k, row.data());
  EXPECT_NEAR(row[0], 28.75F, 1e-5F);
  std::vector<std::size_t> expected(30);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(read, expected);
}

TEST(Filter, ReadsAnyStrides) {
  const auto image = noise<std::int32_t, 3>({5, 6, 7}, 14);
  const Image<std::int32_t, 3> turned(image.values.data() + 4, Grid<3>::unit({7, 5, 6}), {30, -1, 5});
  const auto result = filter_image(turned, MedianFilter{{0, 0, 0}});
  for_each_sample<3>(result.grid, [&](std::size_t i, const std::array<std::size_t, 3>& index) {
    EXPECT_EQ(result.values[i], static_cast<float>(turned(index)));
  });
}

TEST(Filter, SigmasInUnitsAreDividedByTheStep) {
  Grid<3> grid = Grid<3>::unit({4, 4, 4});
  grid.axes[0] = Axis::uniform(4, 1.0, -0.5);
  grid.linear[1][1] = 3.0;
  grid.axes[2] = Axis::rectilinear({0, 1, 3, 4});
  EXPECT_EQ((sigmas_in_samples<3>(grid, {1.0, 6.0, 0.0})), (std::array<double, 3>{2.0, 2.0, 0.0}));
  expect_error(ErrorCode::InvalidArgument, "whose steps differ", [&] {
    static_cast<void>(sigmas_in_samples<3>(grid, {0, 0, 1.0}));
  });
}

TEST(Filter, RefusesWhatIsNoFilter) {
  const auto image = noise<float, 2>({5, 5}, 1);
  const auto refuse = [&](const std::string& part, const Filter& filter, const FilterOptions& options = {}) {
    expect_error(ErrorCode::InvalidArgument, part,
                 [&] { static_cast<void>(filter_image(image.view(), filter, options)); });
  };
  refuse("4 weights along axis 1; expected an odd number", SeparableConvolution{{{1}, {1, 2, 2, 1}}});
  refuse("2 weights along axis 0; expected an odd number", Convolution{{2, 1}, {1, 1}});
  refuse("3 lists of weights; expected one for each of 2 axes", SeparableConvolution{{{}, {}, {}}});
  refuse("the kernel has 2 weights; expected 3", Convolution{{3, 1}, {1, 1}});
  refuse("a weight of the kernel is nan", Convolution{{1, 1}, {kNaN}});
  refuse("1 radii of the median; expected one for each of 2", MedianFilter{{1}});
  refuse("more than 1048576 samples", MedianFilter{{1000, 1000}});
  refuse("sigma of the values is 0; expected a positive number", BilateralFilter{{1, 1}, 0});
  refuse("sigma is -1 samples", BilateralFilter{{1, -1}, 1});
  refuse("3 borders; expected one for each of 2 axes", MedianFilter{{1, 1}}, {std::vector<FilterBorder>(3), false, {}});
  expect_error(ErrorCode::InvalidIsovalue, "the isovalue is nan",
               [&] { static_cast<void>(filter_image(image.view(), ContextualLowPass{kNaN})); });
  expect_error(ErrorCode::InvalidArgument, "sigma is -1 samples", [] { static_cast<void>(gaussian_weights(-1)); });
  expect_error(ErrorCode::InvalidArgument, "expected a number from 0 to 100",
               [] { static_cast<void>(binomial_weights(101)); });
}

TEST(Filter, CanBeCancelled) {
  const auto image = noise<float, 3>(50, 1);
  FilterOptions options;
  options.work.progress = [](double fraction) { return fraction < 0.3; };
  expect_error(ErrorCode::Cancelled, "cancelled", [&] {
    static_cast<void>(filter_image(image.view(), MedianFilter{{1, 1, 1}}, options));
  });
}

}  // namespace
}  // namespace tegl::test
