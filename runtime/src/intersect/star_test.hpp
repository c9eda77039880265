// SPDX-License-Identifier: BSD-3-Clause
//
// Proof that the simplices around a vertex do not intersect, for the whole star at once.
//
// Let v be a vertex, z the sum of the oriented link simplices of its star, and d a direction. If
// 1. z is closed: its boundary, as a sum of oriented faces, is 0,
// 2. all simplices of the star have the same orientation after projection along d, and
// 3. there is a direction that only one of the projected cones over the link simplices contains,
// then two simplices of the star meet only in the hull of their common vertices. Proof: z is mapped to the sphere of
// directions of the projection. By 1, almost all directions are covered equally often, counted with signs; by 2, all
// signs are equal; by 3, each is covered once. Let x be a common point of two cones, in the relative interior of the
// face F of the first. The link simplices that contain F form a cycle around x, by 1, so they cover all directions next
// to x. The second cone covers some of them, so it contains F.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "intersect/simplex_planes.hpp"

namespace tegl::detail {

/// Tests stars of vertices. One object per thread. There is no such proof for N = 2.
template <int N>
class StarTest {
 public:
  explicit StarTest(const SimplexPlanes<N>& simplices);

  /// Whether the simplices around v, its star, are shown to meet only in their common faces.
  [[nodiscard]] bool is_embedded(Index v, std::span<const Index> star);

 private:
  static constexpr std::size_t kMostLink = 96;  ///< larger stars are not tested
  using Projected = std::array<double, N - 1>;

  bool number_link(Index v, std::span<const Index> star);
  bool is_closed();
  bool find_direction(std::span<const Index> star);
  [[nodiscard]] bool is_direction(std::span<const Index> star) const;
  void project_link(Index v);
  bool is_covered_once();
  [[nodiscard]] int sign_of(const std::array<const Projected*, N - 1>& columns, double sizes) const;

  const SimplexPlanes<N>& simplices_;
  std::vector<Index> link_;                                 ///< vertices of the link
  std::vector<std::array<std::uint8_t, N - 1>> link_rows_;  ///< link simplices, oriented, numbers in link_
  std::vector<std::int16_t> balance_;                       ///< of oriented faces of link simplices; 0 between stars
  PointN<N> direction_{};                                   ///< its largest component is 1 or -1
  std::vector<Projected> projected_;                        ///< of link_, relative to v
  std::vector<double> sizes_;                               ///< bounds of projected_
};

extern template class StarTest<2>;
extern template class StarTest<3>;
extern template class StarTest<4>;

}  // namespace tegl::detail
