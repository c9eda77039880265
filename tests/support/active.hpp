// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles by definition, tile by tile: the reference for all search structures.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <vector>

#include "tegl/active_tiles.hpp"

namespace tegl::test {

/// A smooth field with few equal values: the ranges of most tiles lie in no neighbour's range.
struct Waves {
  template <class Point>
  double operator()(const Point& x) const {
    double sum = 0;
    for (std::size_t a = 0; a < x.size(); ++a)
      sum += std::sin(3.1 * x[a] + 2.0 * x[(a + 1) % x.size()]) * (1.0 + 0.1 * x[a]) + 0.3 * x[a];
    return sum;
  }
};

/// Ranges of all tiles as doubles. A tile with a missing corner has an empty range.
template <int N>
struct PlainRanges {
  std::vector<double> least, greatest;

  template <Value T>
  explicit PlainRanges(const Image<T, N>& image) {
    const TileGrid<N> grid(image.grid().sizes());
    for (TileNumber tile = 0; tile < grid.count(); ++tile) {
      const auto base = grid.index(tile);
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      bool missing = false;
      for (unsigned corner = 0; corner < 1u << N; ++corner) {
        auto index = base;
        for (int a = 0; a < N; ++a) index[a] += corner >> a & 1u;
        const auto value = static_cast<double>(image(index));
        missing = missing || std::isnan(value);
        low = std::min(low, value);
        high = std::max(high, value);
      }
      least.push_back(missing ? 0.0 : low);
      greatest.push_back(missing ? 0.0 : high);
    }
  }
  [[nodiscard]] std::vector<TileNumber> active(double isovalue) const {
    std::vector<TileNumber> tiles;
    for (TileNumber tile = 0; tile < least.size(); ++tile)
      if (least[tile] < isovalue && isovalue <= greatest[tile]) tiles.push_back(tile);
    return tiles;
  }
};

/// All values except NaN, ascending, without duplicates.
template <Value T, int N>
std::vector<double> distinct_values(const OwnedImage<T, N>& image) {
  std::vector<double> values;
  for (const T value : image.values)
    if (!std::isnan(static_cast<double>(value))) values.push_back(static_cast<double>(value));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// True if the environment has TEGL_ALL_ISOVALUES: tests then use all isovalues, which takes long.
inline bool wants_all_isovalues() { return std::getenv("TEGL_ALL_ISOVALUES") != nullptr; }

/// Isovalues at which the active tiles may differ, and the numbers just below and above each; about `most` of them
/// unless wants_all_isovalues().
template <Value T, int N>
std::vector<double> critical_isovalues(const OwnedImage<T, N>& image, std::size_t most) {
  const std::vector<double> values = distinct_values(image);
  std::vector<double> result;
  const std::size_t step = wants_all_isovalues() ? 1 : values.size() * 3 / most + 1;
  for (std::size_t i = 0; i < values.size(); i += step) {
    if (!std::isfinite(values[i])) continue;
    result.push_back(std::nextafter(values[i], -std::numeric_limits<double>::max()));
    result.push_back(values[i]);
    result.push_back(std::nextafter(values[i], std::numeric_limits<double>::max()));
  }
  return result;
}

/// A file in memory.
class MemoryFile final : public ByteSink, public ByteSource {
 public:
  void write(const void* data, std::size_t bytes) override {
    const auto* const from = static_cast<const unsigned char*>(data);
    content.insert(content.end(), from, from + bytes);
  }
  std::size_t read(void* data, std::size_t bytes) override {
    const std::size_t count = std::min(bytes, content.size() - at_);
    if (count > 0) std::memcpy(data, content.data() + at_, count);
    at_ += count;
    return count;
  }

  std::vector<unsigned char> content;

 private:
  std::size_t at_ = 0;
};

}  // namespace tegl::test
