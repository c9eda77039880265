// SPDX-License-Identifier: BSD-3-Clause
//
// Finds vertices at the same place, or within a tolerance.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// A hash table from boxes of a regular grid to the vertices in them. With tolerance 0 a box is a single place.
template <int N, class Real>
class CoincidentVertices {
 public:
  CoincidentVertices(std::span<const std::array<Real, N>> vertices, double tolerance)
      : vertices_(vertices),
        tolerance_(tolerance),
        next_(vertices.size(), kNone),
        first_(std::bit_ceil(vertices.size() + 1), kNone) {
    std::array<double, N> largest{};
    for (const auto& vertex : vertices)
      for (int a = 0; a < N; ++a) largest[a] = std::fmax(largest[a], std::abs(static_cast<double>(vertex[a])));
    // A place, and the place and the tolerance added to it, may be rounded: boxes are much wider than that.
    for (int a = 0; a < N; ++a)
      width_[a] = std::max(2.5 * tolerance, 16.0 * std::numeric_limits<double>::epsilon() * largest[a]);
  }

  /// By vertex: the nearest vertex before it that stays, if it is within the tolerance; else itself.
  [[nodiscard]] Buffer<Index> find(const Progress& progress) {
    Buffer<Index> kept(vertices_.size());
    in_parts(vertices_.size(), progress, [&](std::size_t from, std::size_t to) {
      for (std::size_t v = from; v < to; ++v) {
        const Index found = nearest(vertices_[v]);
        kept[v] = found == kNone ? static_cast<Index>(v) : found;
        if (found == kNone) insert(static_cast<Index>(v));
      }
    });
    return kept;
  }

 private:
  static constexpr Index kNone = std::numeric_limits<Index>::max();
  using Box = std::array<double, N>;

  /// Boxes are more than twice as wide as the tolerance, so that the places within the tolerance lie in two boxes along
  /// each axis at most.
  [[nodiscard]] double along(int axis, double x) const noexcept {
    if (tolerance_ == 0.0) return x;
    const double box = std::floor(x / width_[axis]);
    return std::isfinite(box) ? box : x;
  }

  [[nodiscard]] std::size_t slot(const Box& box) const noexcept {
    std::uint64_t hash = 0;
    for (const double x : box) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9E3779B97F4A7C15u;  // + 0.0: -0 is 0
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash * 0xBF58476D1CE4E5B9u >> 20) & (first_.size() - 1);
  }

  [[nodiscard]] double square_distance(const std::array<Real, N>& a, const std::array<Real, N>& b) const noexcept {
    double sum = 0.0;
    for (int i = 0; i < N; ++i) {
      const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
      sum += d * d;
    }
    return sum;
  }

  void insert(Index v) noexcept {
    Box box;
    for (int a = 0; a < N; ++a) box[a] = along(a, static_cast<double>(vertices_[v][a]));
    Index& first = first_[slot(box)];
    next_[v] = first;
    first = v;
  }

  [[nodiscard]] Index nearest(const std::array<Real, N>& place) const noexcept {
    Box low, high;
    for (int a = 0; a < N; ++a) {
      const auto x = static_cast<double>(place[a]);
      low[a] = along(a, x - tolerance_);
      high[a] = along(a, x + tolerance_);
    }
    Index best = kNone;
    double least = tolerance_ * tolerance_;
    for (unsigned corner = 0; corner < (1u << N); ++corner) {
      Box box = low;
      bool is_new = true;  // each box once
      for (int a = 0; a < N; ++a)
        if ((corner >> a & 1u) != 0) {
          box[a] = high[a];
          is_new = is_new && high[a] != low[a];
        }
      if (!is_new) continue;
      for (Index v = first_[slot(box)]; v != kNone; v = next_[v]) {
        const bool is_within = tolerance_ == 0.0 ? vertices_[v] == place : true;
        const double square = is_within ? square_distance(vertices_[v], place) : 0.0;
        if (!is_within || square > least || (square == least && best != kNone && best < v)) continue;
        best = v;
        least = square;
      }
    }
    return best;
  }

  std::span<const std::array<Real, N>> vertices_;
  double tolerance_;
  std::array<double, N> width_{};  ///< of a box, by axis
  std::vector<Index> next_;        ///< by vertex that stays: the next one in its slot
  std::vector<Index> first_;       ///< by slot
};

}  // namespace tegl::detail
