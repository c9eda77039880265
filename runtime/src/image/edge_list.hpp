// SPDX-License-Identifier: BSD-3-Clause
//
// A list of critical edges along one axis, which are collected until there are enough for vector loops.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/bitplanes.hpp"
#include "image/sample_source.hpp"

namespace tegl::detail {

/// The edges are of several rows, or all of one row. In the latter case, the arrays below `at` hold at most a piece of
/// it: their values are equal along the row, or are consumed before the next piece.
template <int N, class Vertex>
struct EdgeList {
  std::size_t size = 0;
  std::vector<std::uint32_t> at;
  std::vector<std::ptrdiff_t> rows;
  std::array<std::vector<double>, N> start;  ///< as in EdgePoints
  std::vector<double> end;
  std::vector<double> alphas;
  std::vector<Vertex> points;   ///< edges of several rows
  std::vector<Vertex> normals;  ///< edges of several rows, if normals are requested
  std::vector<Word> critical;   ///< bits of the first samples of one row's edges
  bool has_bits = false;        ///< whether these are set

  static constexpr std::size_t kAtOnce = 8;  ///< entries per store
  /// Sets `count` entries of an array from entry `first` on, and up to kAtOnce - 1 after these.
  template <class Value>
  static void fill(std::vector<Value>& values, std::size_t first, std::size_t count, Value value) noexcept {
    Value* const to = values.data() + first;
    for (std::size_t i = 0; i < count; i += kAtOnce)
      for (std::size_t j = 0; j < kAtOnce; ++j) to[i + j] = value;
  }

  /// For `edges` positions, pieces of `piece` edges, and `together` edges of several rows. `words`: of a row.
  void allocate(std::size_t edges, std::size_t piece, std::size_t together, std::size_t words, bool has_end) {
    at.resize(edges);
    points.resize(together);
    rows.resize(piece);
    alphas.resize(piece);
    for (int a = 1; a + 1 < N; ++a) start[a].resize(piece);
    if (has_end) end.resize(piece);
    critical.resize(words);
  }

  /// The edges of a piece from edge `first` on.
  [[nodiscard]] EdgesInRows piece(std::size_t first, std::size_t count) const noexcept {
    return {rows.data(), at.data() + first, count, has_bits ? critical.data() : nullptr};
  }
};

}  // namespace tegl::detail
