// SPDX-License-Identifier: BSD-3-Clause
//
// A list of faces of simplices, and its Euler characteristic.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "track/sweep_result.hpp"

namespace tegl::detail {

/// A list of faces by their vertices, which counts each face once.
template <int N>
class Faces {
 public:
  void clear() { keys_.clear(); }

  /// Adds the faces of a simplex (vertices[0 … count - 1]) for which wanted(mask) is true; bit i of mask: vertex i.
  template <class Wanted>
  void add(const std::array<Index, N>& vertices, int count, const Wanted& wanted) {
    for (unsigned mask = 1; mask < (1u << count); ++mask) {
      if (!wanted(mask)) continue;
      Key key;
      key.fill(kNone);
      int size = 0;
      for (int i = 0; i < count; ++i)
        if (((mask >> i) & 1u) != 0) key[size++] = vertices[i];
      std::sort(key.begin(), key.begin() + size);
      keys_.push_back(key);
    }
  }

  /// Euler characteristic: number of vertices - edges + triangles - …
  [[nodiscard]] std::int64_t euler() {
    std::sort(keys_.begin(), keys_.end());
    const auto end = std::unique(keys_.begin(), keys_.end());
    std::int64_t sum = 0;
    for (auto key = keys_.begin(); key != end; ++key) {
      const auto dim = std::find(key->begin(), key->end(), kNone) - key->begin() - 1;
      sum += dim % 2 == 0 ? 1 : -1;
    }
    return sum;
  }

 private:
  using Key = std::array<Index, N>;
  std::vector<Key> keys_;
};

}  // namespace tegl::detail
