// SPDX-License-Identifier: BSD-3-Clause
//
// Images whose rows are not contiguous are transposed layer by layer: the contour is equal byte by byte.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

/// The image with its axes in another memory order: order[0] fastest, flipped[a] in reverse.
template <class T, int N>
struct Elsewhere {
  std::vector<T> values;
  Image<T, N> view;

  Elsewhere(const OwnedImage<T, N>& image, const std::array<int, N>& order, const std::array<bool, N>& flipped)
      : view(image.view()) {
    const auto size = image.grid.sizes();
    typename Image<T, N>::Strides strides;
    std::ptrdiff_t step = 1, origin = 0;
    for (const int a : order) {
      strides[a] = flipped[a] ? -step : step;
      if (flipped[a]) origin += step * (static_cast<std::ptrdiff_t>(size[a]) - 1);
      step *= static_cast<std::ptrdiff_t>(size[a]);
    }
    values.resize(image.values.size());
    for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
      std::ptrdiff_t at = origin;
      for (int a = 0; a < N; ++a) at += static_cast<std::ptrdiff_t>(index[a]) * strides[a];
      values[static_cast<std::size_t>(at)] = image.values[i];
    });
    view = Image<T, N>(values.data() + origin, image.grid, strides);
  }
};

template <class T, int N>
void expect_same_in_any_order(const OwnedImage<T, N>& image, double isovalue) {
  ExtractOptions plain;
  plain.normals = Normals::differences;
  ExtractOptions saddle;
  saddle.ambiguity = Ambiguity::saddle;
  saddle.close = true;
  for (ExtractOptions options : {plain, saddle}) {
    options.work.threads = 1;
    const auto expected = extract<float>(image.view(), isovalue, options);
    ASSERT_GT(expected.simplices.size(), 100u);
    std::array<int, N> order;
    std::iota(order.begin(), order.end(), 0);
    for (unsigned n = 0; std::next_permutation(order.begin(), order.end()); ++n) {
      std::array<bool, N> flipped{};
      for (int a = 0; a < N; ++a) flipped[a] = (n >> a & 1u) != 0;
      const Elsewhere<T, N> other(image, order, flipped);
      for (const unsigned threads : {1u, 4u}) {
        options.work.threads = threads;
        SCOPED_TRACE(testing::Message() << "axis " << order[0] << " fastest, then " << order[1] << "; " << threads);
        const auto found = extract<float>(other.view, isovalue, options);
        EXPECT_TRUE(found.vertices == expected.vertices);
        EXPECT_TRUE(found.normals == expected.normals);
        EXPECT_TRUE(found.simplices == expected.simplices);
      }
    }
  }
}

TEST(ExtractTurned, ImagesInAnyOrderInMemoryGiveTheSameBytes) {
  expect_same_in_any_order<float, 2>(noise<float, 2>({311, 257}, 1), 0.5);
  expect_same_in_any_order<std::uint8_t, 3>(noise<std::uint8_t, 3>({67, 70, 73}, 2), 250.0);
  expect_same_in_any_order<double, 4>(noise<double, 4>({17, 21, 19, 13}, 3), 0.97);
}

TEST(ExtractTurned, MissingValuesToo) {
  expect_same_in_any_order<float, 3>(noise_with_missing<float, 3>(Grid<3>::unit({50, 45, 40}), 3, 0.01), 0.9);
}

}  // namespace
}  // namespace tegl::test
