// SPDX-License-Identifier: BSD-3-Clause
//
// The kernel against the definitions: vertices are bitwise equal and in the same order, and each tile has the simplices
// that plain_contour.hpp finds by recursion over dimension. Tested for all value types, row lengths around the 64 bits
// of a word, and all numbers of threads.
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "fields.hpp"
#include "plain_contour.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

template <int N, class Real>
::testing::AssertionResult same_bytes(const Contour<N, Real>& a, const Contour<N, Real>& b) {
  if (a.vertices.size() != b.vertices.size() || a.simplices.size() != b.simplices.size())
    return ::testing::AssertionFailure() << a.vertices.size() << " vertices and " << a.simplices.size()
                                         << " simplices against " << b.vertices.size() << " and " << b.simplices.size();
  for (std::size_t v = 0; v < a.vertices.size(); ++v)
    if (std::memcmp(&a.vertices[v], &b.vertices[v], sizeof a.vertices[v]) != 0)
      return ::testing::AssertionFailure() << "vertex " << v << " differs";
  if (a.simplices == b.simplices) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "the simplices differ";
}

/// The options with each number of threads, if the library has threads.
template <class Options>
std::vector<Options> with_threads(Options options) {
  std::vector<Options> result;
  for (int threads = 1; threads <= 4; ++threads) {
    if constexpr (requires { options.work.threads = threads; }) options.work.threads = threads;
    result.push_back(options);
  }
  return result;
}

/// Barycentres of the plain contour have no position; in the kernel's contour they must lie in the image.
template <int N, class Real>
void expect_vertices(const Contour<N, Real>& contour, const Contour<N, Real>& plain) {
  ASSERT_GE(contour.vertices.size(), plain.vertices.size());
  std::size_t differ = 0;
  for (std::size_t v = 0; v < plain.vertices.size(); ++v) {
    const bool is_point = plain.vertices[v][0] == plain.vertices[v][0];
    for (int a = 0; a < N; ++a)
      differ += is_point ? std::memcmp(&contour.vertices[v][a], &plain.vertices[v][a], sizeof(Real)) != 0
                         : !std::isfinite(contour.vertices[v][a]);
  }
  EXPECT_EQ(differ, 0u) << "coordinates of " << plain.vertices.size() << " vertices";
}

template <int N, class Real>
void expect_simplices(const Contour<N, Real>& contour, const PlainContour<N, Real>& plain) {
  ASSERT_EQ(contour.simplices.size(), plain.contour.simplices.size());
  std::size_t first = 0;
  for (const auto& tile : plain.tiles) {
    ASSERT_EQ(sorted_simplices(contour, first, tile), sorted_simplices(plain.contour, first, tile));
    first = tile.end;
  }
}

/// Merges vertices that are duplicated beside missing values, where sheets touch. Other vertices must differ.
template <int N, class Real>
void merge_doubled_vertices(Contour<N, Real>& contour, std::size_t vertices) {
  std::map<std::array<Real, N>, Index> number;
  for (std::size_t v = 0; v < vertices; ++v) number.emplace(contour.vertices[v], static_cast<Index>(v));
  ASSERT_EQ(number.size(), vertices);
  for (auto& simplex : contour.simplices)
    for (Index& v : simplex)
      if (v >= vertices) v = number.at(contour.vertices[v]);
  contour.vertices.resize(vertices);
}

template <class Real, Value T, int N>
void expect_plain(const Image<T, N>& image, double isovalue, const ExtractOptions& options,
                  RecursiveBuilder<N>& builder) {
  const auto plain = plain_contour<Real>(image, isovalue, options, builder);
  const auto first = extract<Real>(image, isovalue, options);
  for (const ExtractOptions& threaded : with_threads(options))
    EXPECT_TRUE(same_bytes(extract<Real>(image, isovalue, threaded), first));
  auto contour = first;
  ASSERT_GE(contour.vertices.size(), plain.contour.vertices.size());
  if (contour.vertices.size() > plain.contour.vertices.size())
    merge_doubled_vertices(contour, plain.contour.vertices.size());
  expect_vertices(contour, plain.contour);
  expect_simplices(contour, plain);
}

constexpr std::size_t kRowSizes[] = {1, 2, 3, 31, 62, 63, 64, 65, 66, 96, 127, 128, 129, 130};

/// Noise in rows of all sizes; the other axes have the given sizes.
template <class Real, Value T, int N>
void expect_plain_rows(std::array<std::size_t, N> sizes, std::uint64_t seed) {
  static std::map<int, RecursiveBuilder<N>> builders;
  ExtractOptions options;
  options.ambiguity = seed % 2 == 0 ? Ambiguity::low : Ambiguity::high;
  auto& builder = builders.try_emplace(static_cast<int>(seed % 2), options).first->second;
  for (const std::size_t size : kRowSizes) {
    SCOPED_TRACE("rows of " + std::to_string(size) + ", seed " + std::to_string(seed));
    sizes[0] = size;
    const auto image = noise<T, N>(sizes, seed++);
    expect_plain<Real>(image.view(), noise_isovalue<T>(), options, builder);
  }
}

template <class T>
class PlainOf : public ::testing::Test {};
using ValueTypes =
    ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(PlainOf, ValueTypes);

TYPED_TEST(PlainOf, EqualsTheKernelIn2d) {
  expect_plain_rows<float, TypeParam, 2>({0, 9}, 100);
  expect_plain_rows<double, TypeParam, 2>({0, 2}, 131);
}
TYPED_TEST(PlainOf, EqualsTheKernelIn3d) {
  expect_plain_rows<float, TypeParam, 3>({0, 4, 3}, 200);
  expect_plain_rows<double, TypeParam, 3>({0, 2, 5}, 231);
}
TYPED_TEST(PlainOf, EqualsTheKernelIn4d) {
  expect_plain_rows<float, TypeParam, 4>({0, 2, 3, 2}, 300);
  expect_plain_rows<double, TypeParam, 4>({0, 3, 2, 3}, 331);
}

/// Tests all kinds of grids and options.
template <class Real, int N>
void expect_plain_options(std::array<std::size_t, N> sizes, std::uint64_t seed) {
  Grid<N> grid = Grid<N>::unit(sizes);
  for (const ExtractOptions& variant : variants()) {
    RecursiveBuilder<N> builder(variant);
    SCOPED_TRACE(describe(variant));
    ExtractOptions options = variant;
    const auto image = noise<float, N>(grid, seed++);
    expect_plain<Real>(image.view(), 0.5, options, builder);
    for (const double share : {0.05, 0.95}) expect_plain<Real>(image.view(), share, options, builder);
    const auto coarse = coarse_noise<std::int16_t, N>(grid, seed++, 3);  // samples at the isovalue
    expect_plain<Real>(coarse.view(), 1.0, options, builder);
    options.epsilon = 0.125;
    options.direction = GradientDirection::ascent;
    expect_plain<Real>(coarse.view(), 1.0, options, builder);

    Grid<N> uneven = grid;
    std::vector<double> coordinates(sizes[0]);
    for (std::size_t i = 0; i < sizes[0]; ++i) coordinates[i] = -0.37 * static_cast<double>(i * i + 3 * i);
    uneven.axes[0] = Axis::rectilinear(coordinates);
    uneven.axes[N - 1] = Axis::uniform(sizes[N - 1], 0.3, 0.7);
    expect_plain<Real>(Image<float, N>(image.values.data(), uneven), 0.5, options, builder);
    expect_plain<Real>(Image<std::int16_t, N>(coarse.values.data(), uneven), 1.0, options, builder);
    uneven.linear[0][1] = 0.4;
    uneven.linear[N - 1][N - 1] = -1.7;
    uneven.offset[0] = 11.3;
    expect_plain<Real>(Image<float, N>(image.values.data(), uneven), 0.5, options, builder);
    if (N == 4) uneven.linear[N - 1][0] = 0.1;  // the last axis then has no layers
    expect_plain<Real>(Image<float, N>(image.values.data(), uneven), 0.5, options, builder);
  }
}

TEST(Plain, EqualsTheKernelIn2dWithAllOptions) {
  expect_plain_options<float, 2>({70, 6}, 400);
  expect_plain_options<double, 2>({5, 70}, 420);
}
TEST(Plain, EqualsTheKernelIn3dWithAllOptions) {
  expect_plain_options<float, 3>({67, 4, 3}, 440);
  expect_plain_options<double, 3>({5, 6, 20}, 460);
}
TEST(Plain, EqualsTheKernelIn4dWithAllOptions) {
  expect_plain_options<float, 4>({66, 3, 2, 3}, 480);
  expect_plain_options<double, 4>({4, 3, 5, 9}, 500);
}

/// Equal samples stored in other orders, with gaps, and backwards.
template <int N>
void expect_plain_strides(std::uint64_t seed) {
  std::array<std::size_t, N> sizes;
  sizes.fill(4);
  sizes[0] = 70;
  const auto many = noise<float, 2>({70, 4000}, seed);
  RecursiveBuilder<N> builder(ExtractOptions{});
  for (int order = 0; order < 3; ++order) {
    SCOPED_TRACE(order);
    std::array<std::ptrdiff_t, N> strides;
    std::ptrdiff_t stride = order == 0 ? 2 : 1;
    for (int i = 0; i < N; ++i) {
      const int axis = order == 1 ? N - 1 - i : i;
      strides[axis] = order == 2 ? -stride : stride;
      stride *= static_cast<std::ptrdiff_t>(sizes[axis]);
    }
    const float* const data = many.values.data() + (order == 2 ? many.values.size() - 1 : 0);
    expect_plain<float>(Image<float, N>(data, Grid<N>::unit(sizes), strides), 0.5, {}, builder);
  }
}

TEST(Plain, EqualsTheKernelForAnyStrides) {
  expect_plain_strides<2>(600);
  expect_plain_strides<3>(601);
  expect_plain_strides<4>(602);
}

/// 2D and 3D only: beside missing values, contours of 4D images have further vertices and simplices
/// (split_nonmanifold_test.cpp).
template <int N>
void expect_plain_missing(std::array<std::size_t, N> sizes, std::uint64_t seed) {
  for (const ExtractOptions& options : variants()) {
    if (N == 3 && options.triangulation == Triangulation::barycentric) continue;  // duplicates have no position
    RecursiveBuilder<N> builder(options);
    for (const double share : {0.001, 0.02, 0.3}) {
      SCOPED_TRACE(describe(options) + ", missing " + std::to_string(share));
      const auto image = noise_with_missing<float, N>(Grid<N>::unit(sizes), seed++, share);
      expect_plain<double>(image.view(), 0.5, options, builder);
    }
  }
}

TEST(Plain, EqualsTheKernelNextToMissingValues) {
  expect_plain_missing<2>({130, 20}, 700);
  expect_plain_missing<3>({67, 9, 8}, 720);
  expect_plain_missing<3>({9, 8, 30}, 740);
}

/// Skipped rows follow rows with a contour in the same storage, with missing values in both.
TEST(Plain, EqualsTheKernelWhereBusyAndEmptyLayersAlternate) {
  RecursiveBuilder<3> builder(ExtractOptions{});
  for (std::uint64_t seed = 760; seed < 764; ++seed) {
    SCOPED_TRACE(seed);
    constexpr std::size_t kLayer = 20 * 70;
    auto image = noise_with_missing<float, 3>(Grid<3>::unit({20, 70, 24}), seed, seed % 2 == 0 ? 0.0 : 0.001);
    for (std::size_t i = 0; i < image.values.size(); ++i)
      if (i / kLayer % 6 >= 3 && !(seed % 2 != 0 && i % 1999 == 0)) image.values[i] = seed < 762 ? 0.0F : 1.0F;
    expect_plain<double>(image.view(), 0.5, {}, builder);
  }
}

/// Rows of 2^16 samples, and of slightly more.
TEST(Plain, EqualsTheKernelInLongRows) {
  RecursiveBuilder<2> builder(ExtractOptions{});
  expect_plain<float>(view_of(noise<float, 2>({65536, 3}, 780)), 0.5, {}, builder);
  expect_plain<float>(view_of(noise<float, 2>({65536 + 70, 3}, 781)), 0.5, {}, builder);
}

/// Ambiguous cells are found at their positions in rows longer than positions of 16 bits: the same image along another
/// axis has the same contour.
TEST(Plain, RulesFromTheDataAreTheSameInLongRowsAndInManyLayers) {
  const auto row = noise<float, 3>({65536 + 70, 3, 3}, 782);
  OwnedImage<float, 3> column{Grid<3>::unit({3, 3, 65536 + 70}), std::vector<float>(row.values.size())};
  for (std::size_t x = 0; x < 65536 + 70; ++x)
    for (std::size_t yz = 0; yz < 9; ++yz) column.values[9 * x + yz] = row.values[x + (65536 + 70) * yz];
  for (const Ambiguity rule : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares}) {
    ExtractOptions options;
    options.ambiguity = rule;
    const auto along_row = extract<double>(view_of(row), 0.5, options);
    const auto along_column = extract<double>(view_of(column), 0.5, options);
    EXPECT_EQ(along_row.vertices.size(), along_column.vertices.size());
    EXPECT_EQ(along_row.simplices.size(), along_column.simplices.size());
    EXPECT_NE(along_row.simplices.size(), extract<double>(view_of(row), 0.5).simplices.size());
  }
}

/// Images as large as several of the kernel's work units along every axis.
TEST(Plain, EqualsTheKernelForImagesOfManyRowsAndLayers) {
  RecursiveBuilder<2> builder2(ExtractOptions{});
  expect_plain<float>(view_of(noise<float, 2>({100, 700}, 800)), 0.5, {}, builder2);
  RecursiveBuilder<3> builder3(ExtractOptions{});
  expect_plain<float>(view_of(noise<std::uint16_t, 3>({65, 20, 40}, 801)), noise_isovalue<std::uint16_t>(), {},
                      builder3);
  RecursiveBuilder<4> builder4(ExtractOptions{});
  expect_plain<float>(view_of(noise<float, 4>({9, 7, 8, 24}, 802)), 0.5, {}, builder4);
}

}  // namespace
}  // namespace tegl::test
