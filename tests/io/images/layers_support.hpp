// SPDX-License-Identifier: BSD-3-Clause
//
// Compares layers read one by one with the image read as a whole.
#pragma once

#include "io_support.hpp"

namespace tegl::test {

template <class T>
bool same_bits(T a, T b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// Expects the layers of `opened`, one after the other, to be the image.
inline void expect_layers_of(const AnyImage& image, const AnyLayers& opened) {
  ASSERT_EQ(image.index(), opened.index());
  const auto compare = [](const auto& owned, auto& layers) {
    using T = typename std::decay_t<decltype(owned.values)>::value_type;
    const auto& grid = layers->grid();
    constexpr std::size_t kLast = std::tuple_size_v<decltype(grid.axes)> - 1;
    std::size_t size = 1;
    for (std::size_t a = 0; a <= kLast; ++a) {
      ASSERT_EQ(grid.axes[a].size(), owned.grid.axes[a].size());
      for (std::size_t i = 0; i < grid.axes[a].size(); ++i) EXPECT_EQ(grid.axes[a][i], owned.grid.axes[a][i]);
      EXPECT_EQ(grid.axes[a].name, owned.grid.axes[a].name);
      EXPECT_EQ(grid.axes[a].unit, owned.grid.axes[a].unit);
      if (a < kLast) size *= grid.axes[a].size();
    }
    EXPECT_EQ(grid.linear, owned.grid.linear);
    std::vector<T> layer(size);
    for (std::size_t k = 0; k < grid.axes[kLast].size(); ++k) {
      layers->read(k, layer.data());
      for (std::size_t i = 0; i < size; ++i)
        ASSERT_TRUE(same_bits(layer[i], owned.values[k * size + i])) << "layer " << k << ", sample " << i;
    }
  };
  std::visit(
      [&](const auto& typed, const auto& layers) {
        if constexpr (std::tuple_size_v<std::decay_t<decltype(std::get<0>(typed).grid.axes)>> ==
                      std::tuple_size_v<std::decay_t<decltype(std::get<0>(layers)->grid().axes)>>)
          std::visit(
              [&](const auto& owned, const auto& reader) {
                using Owned = typename std::decay_t<decltype(owned.values)>::value_type;
                using Read = typename std::decay_t<decltype(*reader)>::value_type;
                if constexpr (std::is_same_v<Owned, Read>)
                  compare(owned, reader);
                else
                  ADD_FAILURE() << "another value type";
              },
              typed, layers);
      },
      image, opened);
}

}  // namespace tegl::test
