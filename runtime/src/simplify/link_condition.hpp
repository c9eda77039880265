// SPDX-License-Identifier: BSD-3-Clause
//
// Test of the link condition: the links of u and v share nothing but the link of the edge uv.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "simplify/few_vertices.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The links are given face by face, in the order of the functions: first the links of uv, then of u, then of v.
/// Vertices of the link of uv are numbered. Only faces that consist of them can be in both links, unless the links
/// share another vertex. Use one per thread.
template <int N>
class LinkCondition {
 public:
  /// Vertices of a face of a link. Faces of the link of uv have one vertex less than the others; the last one is
  /// ignored.
  using Face = std::array<Index, N - 1>;

  /// `most`: at least the number of vertices of all three links.
  void clear(std::size_t most) {
    vertices_.clear(most);
    count_ = 0;
    edges_of_uv_.clear();
    triangles_of_u_.clear();
  }

  void add_to_uv(const Face& face) {
    const auto number_of = [&](Index vertex) {
      std::uint32_t& number = vertices_[vertex];
      if (number == FewVertices::kNew) number = count_++;
      return number;
    };
    if constexpr (N == 3) number_of(face[0]);
    if constexpr (N == 4) edges_of_uv_.emplace_back(number_of(face[0]), number_of(face[1]));
  }

  /// Call it after the faces of uv.
  void complete_uv() {
    edges_.assign(std::size_t{count_} * count_, kNone);
    for (const auto& [a, b] : edges_of_uv_) edge(a, b) = kOfUv;
  }

  void add_to_u(const Face& face) {
    visit_known(
        face, [](std::uint32_t& number) { number = number == FewVertices::kNew ? kOnlyU : number; },
        [&](std::uint32_t a, std::uint32_t b) {
          std::uint8_t& known = edge(a, b);
          if (known == kNone) known = kOfU;
        },
        [&](const auto& triangle) { triangles_of_u_.push_back(triangle); });
  }

  /// Returns false if the face shows that the condition does not hold.
  [[nodiscard]] bool add_to_v(const Face& face) {
    bool holds = true;
    visit_known(
        face, [&](const std::uint32_t& number) { holds = holds && number != kOnlyU; },
        [&](std::uint32_t a, std::uint32_t b) { holds = holds && edge(a, b) != kOfU; },
        [&](const auto& triangle) {
          holds = holds && std::find(triangles_of_u_.begin(), triangles_of_u_.end(), triangle) == triangles_of_u_.end();
        });
    return holds;
  }

 private:
  static constexpr std::uint32_t kOnlyU = FewVertices::kNew - 1;
  using Triangle = std::array<std::uint32_t, 3>;
  enum EdgeOf : std::uint8_t { kNone, kOfUv, kOfU };

  std::uint8_t& edge(std::uint32_t a, std::uint32_t b) {
    return edges_[std::size_t{std::min(a, b)} * count_ + std::max(a, b)];
  }

  /// Calls on_vertex(number) for all vertices of a face of u or v; on_edge(a, b) and on_triangle(numbers) for its edges
  /// and triangles of numbered vertices.
  template <class OnVertex, class OnEdge, class OnTriangle>
  void visit_known(const Face& face, const OnVertex& on_vertex, const OnEdge& on_edge, const OnTriangle& on_triangle) {
    std::array<std::uint32_t, std::max(N, 3)> known{};
    int count = 0;
    for (const Index vertex : face) {
      std::uint32_t& number = vertices_[vertex];
      on_vertex(number);
      if (number < count_) known[count++] = number;
    }
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < i; ++j) on_edge(known[i], known[j]);
    if (count < 3) return;
    Triangle triangle{known[0], known[1], known[2]};
    std::sort(triangle.begin(), triangle.end());
    on_triangle(triangle);
  }

  FewVertices vertices_;
  std::uint32_t count_ = 0;  ///< numbered vertices
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_of_uv_;
  std::vector<std::uint8_t> edges_;  ///< count_ x count_, by the smaller and the larger number
  std::vector<Triangle> triangles_of_u_;
};

}  // namespace tegl::detail
