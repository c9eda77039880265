// SPDX-License-Identifier: BSD-3-Clause
//
// The faces of polytopes in memory of their own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "polytope/polytope_faces.hpp"

namespace tegl::detail {

/// Numbers the edges of a polygon or polyhedron in the order in which its rings first pass them; returns how many there
/// are. Sets `ring_edges`, as many as `rings`, and of `edges` and `faces_of` as many as edges: PolytopeFaces.
constexpr std::size_t number_edges(std::span<const std::uint8_t> rings, std::span<const std::uint16_t> ends,
                                   std::span<std::uint8_t> ring_edges, std::span<PolytopeFaces::Pair> edges,
                                   std::span<PolytopeFaces::Pair> faces_of) {
  std::size_t number = 0;
  for (std::size_t f = 0; f < ends.size(); ++f) {
    const std::size_t begin = f == 0 ? 0 : ends[f - 1], count = ends[f] - begin;
    for (std::size_t i = 0; i < count; ++i) {
      const auto [v, w] = std::minmax(rings[begin + i], rings[begin + (i + 1) % count]);
      std::size_t at = 0;
      while (at < number && (edges[at][0] != v || edges[at][1] != w)) ++at;
      ring_edges[begin + i] = static_cast<std::uint8_t>(at);
      const auto face = static_cast<std::uint8_t>(f);
      if (at < number) {
        faces_of[at][1] = face;
        continue;
      }
      edges[number] = {v, w};
      faces_of[number++] = {face, face};
    }
  }
  return number;
}

/// The faces of a polytope, with the memory for them. Copies share it.
class PolytopeShape : public PolytopeFaces {
 public:
  /// `rings`: one face after the other; `ends`: the end of each face. The faces of a polyhedron must be checked.
  PolytopeShape(std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends);
  /// The prism over a polyhedron.
  [[nodiscard]] static PolytopeShape prism_over(const PolytopeShape& base);
  /// A 4D polytope with these edges and facets.
  [[nodiscard]] static PolytopeShape of_solids(std::size_t corners, std::vector<Pair> edges,
                                               std::shared_ptr<const PolytopeSolids> solids);

 private:
  struct Arrays {
    std::vector<std::uint8_t> rings, ring_edges;
    std::vector<std::uint16_t> ends;
    std::vector<Pair> edges, faces_of;
    std::size_t corner_count;
    bool is_prism;
    std::shared_ptr<const PolytopeSolids> solids = nullptr;
  };
  explicit PolytopeShape(Arrays arrays);
  [[nodiscard]] static Arrays arrays_of(std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends);

  std::shared_ptr<const Arrays> arrays_;
};

}  // namespace tegl::detail
