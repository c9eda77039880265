// SPDX-License-Identifier: BSD-3-Clause
//
// Contours closed at the border (thesis, 8.1.27) on noise: every value type, dimension and kind of table, samples at
// the isovalue, missing values, and points kept off the samples.
#include <gtest/gtest.h>

#include <string>

#include "ambiguity/variants.hpp"
#include "caps.hpp"
#include "fields.hpp"

namespace tegl::test {
namespace {

/// Different steps, one non-uniform axis, one descending.
template <int N>
Grid<N> uneven_grid(std::size_t samples) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(samples + static_cast<std::size_t>(a % 2), -0.7, 0.1 + a);
  std::vector<double> at(samples);
  for (std::size_t i = 0; i < samples; ++i)
    at[i] = 3.1 - 0.3 * static_cast<double>(i) - 0.05 * static_cast<double>(i * i);
  grid.axes[0] = Axis::rectilinear(at);
  return grid;
}

template <int N>
constexpr std::size_t kSamples = N == 2   ? 12
                                 : N == 3 ? 6
                                 : N == 4 ? 4
                                          : 2;

/// Two in 5D: cells are built one by one, and take longer.
template <int N>
std::vector<ExtractOptions> variants_in() {
  auto result = variants();
  if (N == 5) result.resize(2);
  return result;
}

template <class Pair>
class CloseNoise : public ::testing::Test {};
template <class T, int N>
struct Kind {
  using Value = T;
  static constexpr int kDim = N;
};
template <int N>
using Kinds = ::testing::Types<Kind<std::uint8_t, N>, Kind<std::int8_t, N>, Kind<std::uint16_t, N>,
                               Kind<std::int16_t, N>, Kind<std::int32_t, N>, Kind<float, N>, Kind<double, N>>;
TYPED_TEST_SUITE_P(CloseNoise);

TYPED_TEST_P(CloseNoise, IsWatertightWithCapsInTheBorder) {
  constexpr int N = TypeParam::kDim;
  using T = typename TypeParam::Value;
  const auto image = noise<T, N>(uneven_grid<N>(kSamples<N>), 31);
  for (ExtractOptions options : variants_in<N>())
    for (const double epsilon : {0.0, 0.2}) {
      if (N == 5 && epsilon > 0.0 && options.ambiguity == Ambiguity::low) continue;
      options.epsilon = epsilon;
      options.direction = epsilon > 0.0 ? GradientDirection::ascent : GradientDirection::descent;
      SCOPED_TRACE(describe(options) + ", epsilon " + std::to_string(epsilon));
      expect_closed_at_border<double>(image.view(), noise_isovalue<T>(), options);
      if (N < 5) expect_closed_at_border<float>(image.view(), noise_isovalue<T>(), options);
    }
}

TYPED_TEST_P(CloseNoise, IsWatertightWhereSamplesEqualTheIsovalue) {
  constexpr int N = TypeParam::kDim;
  using T = typename TypeParam::Value;
  const auto image = coarse_noise<T, N>(uneven_grid<N>(kSamples<N>), 32, 3);
  for (ExtractOptions options : variants_in<N>()) {
    options.epsilon = options.ambiguity == Ambiguity::high ? 0.1 : 0.0;
    SCOPED_TRACE(describe(options));
    expect_closed_at_border<double>(image.view(), 1.0, options);
  }
}

TYPED_TEST_P(CloseNoise, EndsAtMissingValuesAlone) {
  constexpr int N = TypeParam::kDim;
  using T = typename TypeParam::Value;
  if constexpr (std::is_floating_point_v<T> && N < 5) {
    const auto image = noise_with_missing<T, N>(uneven_grid<N>(kSamples<N> + 1), 33, N == 4 ? 0.01 : 0.05);
    for (ExtractOptions options : variants_in<N>())
      for (const double epsilon : {0.0, 0.2}) {
        options.epsilon = epsilon;
        SCOPED_TRACE(describe(options) + ", epsilon " + std::to_string(epsilon));
        expect_closed_up_to_missing_values<double>(image.view(), 0.4, options);
      }
  } else {
    // Integers have no missing values; 5D images with missing values are refused.
    SUCCEED();
  }
}

REGISTER_TYPED_TEST_SUITE_P(CloseNoise, IsWatertightWithCapsInTheBorder, IsWatertightWhereSamplesEqualTheIsovalue,
                            EndsAtMissingValuesAlone);
INSTANTIATE_TYPED_TEST_SUITE_P(In2d, CloseNoise, Kinds<2>);
INSTANTIATE_TYPED_TEST_SUITE_P(In3d, CloseNoise, Kinds<3>);
INSTANTIATE_TYPED_TEST_SUITE_P(In4d, CloseNoise, Kinds<4>);
INSTANTIATE_TYPED_TEST_SUITE_P(In5d, CloseNoise, Kinds<5>);

}  // namespace
}  // namespace tegl::test
