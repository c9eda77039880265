// SPDX-License-Identifier: BSD-3-Clause
//
// Simplices as comparable keys, for chains: a boundary is a sorted list of signed keys.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "base/tile_contour.hpp"

namespace tegl::gen {

/// A set of up to four vertices in ascending order, one per byte; unused bytes are 0xff.
using Key = std::uint32_t;

inline Key key_of(std::array<std::uint8_t, 4> v, int count) {
  for (int i = count; i < 4; ++i) v[i] = 0xff;
  const auto order = [&](int i, int j) {
    if (v[i] > v[j]) std::swap(v[i], v[j]);
  };
  order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);  // a sorting network
  return Key{v[0]} << 24 | Key{v[1]} << 16 | Key{v[2]} << 8 | v[3];
}

/// Parity of the permutation that sorts the first `count` vertices: +1 or -1.
inline int parity(std::array<std::uint8_t, 4> v, int count) { return tile::sort_vertices(v, count); }

inline LocalSimplex without(const LocalSimplex& s, int drop, int n) {
  LocalSimplex face{};
  for (int i = 0, k = 0; i < n; ++i)
    if (i != drop) face[k++] = s[i];
  return face;
}

/// A simplex of a chain, with its coefficient.
struct SignedFace {
  Key key;
  int sign;
  bool operator<(const SignedFace& other) const { return key < other.key; }
  friend bool operator==(const SignedFace&, const SignedFace&) = default;
};

}  // namespace tegl::gen
