// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of noise, of all value types, are oriented manifolds with boundary only at the image border and at missing
// values.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

template <class T>
class NoiseOf : public ::testing::Test {};
using ValueTypes =
    ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(NoiseOf, ValueTypes);

template <class Real, Value T, int N>
void expect_sound(const OwnedImage<T, N>& image, double isovalue) {
  for (ExtractOptions options : variants()) {
    SCOPED_TRACE(describe(options));
    const auto contour = extract<Real>(image.view(), isovalue, options);
    EXPECT_GT(contour.simplices.size(), 0u);
    expect_oriented_manifold(contour);
    EXPECT_TRUE(is_open_only_where_data_end(contour, image.view()));
    options.close = true;
    expect_closed_manifold(extract<Real>(image.view(), isovalue, options));
  }
}

TYPED_TEST(NoiseOf, In2dIsAManifoldOpenOnlyAtTheBorder) {
  expect_sound<float>(noise<TypeParam, 2>({70, 23}, 1), noise_isovalue<TypeParam>());
  expect_sound<double>(noise<TypeParam, 2>({2, 65}, 2), noise_isovalue<TypeParam>());
}
TYPED_TEST(NoiseOf, In3dIsAManifoldOpenOnlyAtTheBorder) {
  expect_sound<float>(noise<TypeParam, 3>({11, 6, 7}, 3), noise_isovalue<TypeParam>());
  expect_sound<double>(noise<TypeParam, 3>({67, 3, 2}, 4), noise_isovalue<TypeParam>());
}
TYPED_TEST(NoiseOf, In4dIsAManifoldOpenOnlyAtTheBorder) {
  expect_sound<float>(noise<TypeParam, 4>({5, 4, 3, 4}, 5), noise_isovalue<TypeParam>());
  expect_sound<double>(noise<TypeParam, 4>({66, 2, 3, 2}, 6), noise_isovalue<TypeParam>());
}

TEST(Noise, Of24To4IsAManifold) {
  const auto image = noise<float, 4>(24, 7);
  const auto report = expect_oriented_manifold(extract<float>(image.view(), 0.5));
  EXPECT_GT(report.simplices, 3'000'000u);
}

TEST(Noise, Of14To4IsAManifoldInAllVariants) {
  const auto image = noise<float, 4>(14, 8);
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE(describe(options));
    expect_oriented_manifold(extract<float>(image.view(), 0.5, options));
  }
}

/// Sparse and dense noise contains signatures that are rare in uniform noise.
TEST(Noise, OfAnyShareOfHighSamplesIsAManifold) {
  for (const double isovalue : {0.03, 0.2, 0.8, 0.97}) {
    SCOPED_TRACE(isovalue);
    expect_sound<double>(noise<float, 2>(30, 11), isovalue);
    expect_sound<double>(noise<float, 3>(10, 12), isovalue);
    expect_sound<double>(noise<float, 4>(6, 13), isovalue);
  }
}

}  // namespace
}  // namespace tegl::test
