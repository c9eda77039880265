// SPDX-License-Identifier: BSD-3-Clause
//
// An image and its negative: rules that treat high and low alike give the same contour, so both enclose the whole image
// together.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/measure.hpp"

namespace tegl::test {
namespace {

template <class T, int N>
OwnedImage<T, N> negative(OwnedImage<T, N> image) {
  for (T& value : image.values) value = -value;
  return image;
}

/// The shares of the box that the closed contours of noise and of its negative enclose, added.
template <int N>
double enclosed_together(std::size_t samples, Ambiguity ambiguity, Triangulation triangulation) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  const auto image = noise<double, N>(sizes, 1994);
  ExtractOptions options;
  options.ambiguity = ambiguity;
  options.triangulation = triangulation;
  options.close = true;
  double middle = 0;  // about half of the samples are high
  for (const double value : image.values) middle += value / static_cast<double>(image.values.size());
  const auto other = negative(image);
  const auto content = [&](const OwnedImage<double, N>& of, double isovalue) {
    return measure(extract<double>(of.view(), isovalue, options), WorkOptions{}).content.value();
  };
  return (content(image, middle) + content(other, -middle)) / std::pow(static_cast<double>(samples - 1), N);
}

constexpr std::array kAlike = {Ambiguity::mean, Ambiguity::saddle};

TEST(Negative, NoiseAndItsNegativeEncloseTheWholeImage) {
  for (const Ambiguity ambiguity : kAlike)
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
      EXPECT_NEAR((enclosed_together<3>(32, ambiguity, triangulation)), 1.0, 0.005);
      EXPECT_NEAR((enclosed_together<4>(9, ambiguity, triangulation)), 1.0, 0.005);
    }
  // Low-connected contours separate what is high, so the low sides of both overlap: the test can fail.
  EXPECT_LT((enclosed_together<3>(32, Ambiguity::low, Triangulation::compact)), 0.9);
}

/// Simplices by ascending vertices, in ascending order.
template <int N>
std::vector<std::array<std::uint32_t, N>> unoriented(const Contour<N>& contour) {
  std::vector<std::array<std::uint32_t, N>> result;
  for (const auto& simplex : contour.simplices) {
    auto& sorted = result.emplace_back();
    std::copy(simplex.begin(), simplex.end(), sorted.begin());
    std::sort(sorted.begin(), sorted.end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

template <int N>
void expect_same_simplices(std::size_t samples, Ambiguity ambiguity, bool expect) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  OwnedImage<float, N> image{Grid<N>::unit(sizes), {}};
  std::array<std::size_t, N> at{};
  const double middle = 0.5 * static_cast<double>(samples - 1) + 0.1;
  do {
    double value = 0;  // of a ball: no face is ambiguous
    for (const std::size_t x : at) value += (static_cast<double>(x) - middle) * (static_cast<double>(x) - middle);
    image.values.push_back(static_cast<float>(value - 0.17 * static_cast<double>(samples * samples)));
    for (std::size_t i = 0; i < N && ++at[i] == samples; ++i) at[i] = 0;
  } while (image.values.size() < sample_count(image.grid));
  ExtractOptions options;
  options.ambiguity = ambiguity;
  const auto reversed = negative(image);
  const auto contour = extract(image.view(), 0.0, options), other = extract(reversed.view(), 0.0, options);
  ASSERT_GT(contour.simplices.size(), 1000u);
  ASSERT_EQ(contour.vertices, other.vertices);
  EXPECT_EQ(unoriented(contour) == unoriented(other), expect);
}

TEST(Negative, OfASmoothImageHasTheSameSimplices) {
  for (const Ambiguity ambiguity : kAlike) {
    expect_same_simplices<3>(31, ambiguity, true);
    expect_same_simplices<4>(12, ambiguity, true);
  }
  // Chords of the tables of fixed alternatives follow the low corners.
  expect_same_simplices<3>(30, Ambiguity::low, false);
}

}  // namespace
}  // namespace tegl::test
