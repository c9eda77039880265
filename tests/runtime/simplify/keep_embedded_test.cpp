// SPDX-License-Identifier: BSD-3-Clause
//
// SimplifyOptions::keep_embedded: no two simplices of the result intersect, where they do without the option.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "errors.hpp"
#include "invariants.hpp"
#include "random_fields.hpp"
#include "share.hpp"
#include "tegl/extract.hpp"
#include "tegl/intersections.hpp"
#include "tegl/simplify.hpp"

namespace tegl::test {
namespace {

template <int N, class Real>
Contour<N, Real> contour_of_noise(std::size_t samples) {
  std::mt19937_64 bits(31);
  const auto field = random_field<N>(bits, samples, 1 << 20, true);
  const auto image = image_of<float>(field);
  return extract<Real>(image.view(), 0.5, {});
}

/// Two parallel sheets, half a cell apart, that are waved.
Contour<3, double> waved_sheets() {
  constexpr std::size_t kSize = 40;
  OwnedImage<float, 3> image{Grid<3>::unit({kSize, kSize, 9}), {}};
  for (std::size_t z = 0; z < 9; ++z)
    for (std::size_t y = 0; y < kSize; ++y)
      for (std::size_t x = 0; x < kSize; ++x) {
        const double height =
            4.2 + 1.5 * std::sin(0.7 * static_cast<double>(x)) * std::cos(0.6 * static_cast<double>(y));
        image.values.push_back(static_cast<float>(0.3 - std::abs(static_cast<double>(z) - height)));
      }
  return extract<double>(image.view(), 0.0, {});
}

template <int N, class Real>
Simplification<N, Real> simplified(const Contour<N, Real>& contour, double ratio, SimplifyMethod method, bool keep) {
  SimplifyOptions<N> options;
  options.ratio = ratio;
  options.method = method;
  options.measure = false;
  options.keep_embedded = keep;
  return simplify(contour, options);
}

template <int N, class Real>
void expect_kept(const Contour<N, Real>& contour, double ratio, SimplifyMethod method, double most_left) {
  ASSERT_TRUE(find_intersections(contour).is_embedded());
  EXPECT_GT(find_intersections(simplified(contour, ratio, method, false).contour).pair_count, 0u) << "tests nothing";
  const auto kept = simplified(contour, ratio, method, true).contour;
  EXPECT_TRUE(find_intersections(kept).is_embedded());
  EXPECT_TRUE(is_oriented_manifold(check(kept)));
  EXPECT_LT(static_cast<double>(kept.simplices.size()), most_left * static_cast<double>(contour.simplices.size()));
}

TEST(KeepEmbedded, LinesOfNoise) {
  expect_kept(contour_of_noise<2, double>(60), 0.1, SimplifyMethod::quadric, 0.3);
  expect_kept(contour_of_noise<2, float>(60), 0.1, SimplifyMethod::vertices, 0.5);
}

TEST(KeepEmbedded, SurfacesOfNoise) {
  const auto contour = contour_of_noise<3, double>(12);
  for (const auto method : {SimplifyMethod::quadric, SimplifyMethod::facets, SimplifyMethod::vertices})
    expect_kept(contour, 0.3, method, 0.4);
  expect_kept(contour_of_noise<3, float>(12), 0.3, SimplifyMethod::quadric, 0.4);
}

TEST(KeepEmbedded, SmoothSheetsThatAreNear) { expect_kept(waved_sheets(), 0.02, SimplifyMethod::quadric, 0.2); }

TEST(KeepEmbedded, SolidsOfNoise) { expect_kept(contour_of_noise<4, double>(4), 0.5, SimplifyMethod::quadric, 0.8); }

TEST(KeepEmbedded, HoldsWithErrorBounds) {
  const auto contour = contour_of_noise<3, double>(8);
  SimplifyOptions<3> options;
  options.max_error = 0.4;
  options.keep_embedded = true;
  const auto kept = simplify(contour, options);
  EXPECT_TRUE(find_intersections(kept.contour).is_embedded());
  EXPECT_LT(kept.stats.simplices_after, kept.stats.simplices_before);
  EXPECT_LE(*kept.stats.error(), 0.4);
}

TEST(KeepEmbedded, IsNotForTheFastMethod) {
  const auto contour = contour_of_noise<3, double>(4);
  expect_error(ErrorCode::InvalidArgument, "keep_embedded for the method fast",
               [&] { simplified(contour, 0.5, SimplifyMethod::fast, true); });
}

}  // namespace
}  // namespace tegl::test
