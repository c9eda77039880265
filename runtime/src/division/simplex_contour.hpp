// SPDX-License-Identifier: BSD-3-Clause
//
// The contour in one simplex, in any dimension: the product of the simplices of its high and of its low vertices,
// divided by monotone paths.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tegl::detail {

/// Number of the edge between vertices i < j of an N-simplex.
template <int N>
constexpr std::size_t edge_number(int i, int j) noexcept {
  return static_cast<std::size_t>(i * (2 * N + 1 - i) / 2 + j - i - 1);
}

/// The contours in an N-simplex. If the vertices of all simplices of a complex are in a common order, neighbours divide
/// their common face alike.
template <int N>
class SimplexContour {
 public:
  static constexpr std::size_t kEdges = static_cast<std::size_t>(N * (N + 1) / 2);
  using Simplex = std::array<std::uint8_t, N>;  ///< numbers of edges

  /// Made by the compiler.
  [[nodiscard]] static const SimplexContour& instance() noexcept;

  /// The simplices for a signature (bit i: vertex i is high). Their positive side faces the high vertices, if the
  /// simplex is positive.
  [[nodiscard]] std::span<const Simplex> of(unsigned signature) const noexcept {
    return std::span(simplices_).subspan(first_[signature], count(signature));
  }
  [[nodiscard]] std::size_t count(unsigned signature) const noexcept {
    return static_cast<std::size_t>(first_[signature + 1] - first_[signature]);
  }

 private:
  /// Number of simplices for all signatures: of C(N + 1, h) with h high vertices, C(N - 1, h - 1) paths each.
  static constexpr std::size_t kSimplices = N == 2 ? 6 : N == 3 ? 20 : N == 4 ? 70 : 252;

  constexpr SimplexContour();

  std::array<Simplex, kSimplices> simplices_{};
  std::array<std::uint16_t, (1u << (N + 1)) + 1> first_{};
};

}  // namespace tegl::detail
