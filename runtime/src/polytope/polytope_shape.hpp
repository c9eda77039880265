// SPDX-License-Identifier: BSD-3-Clause
//
// The faces of polytopes in memory of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "polytope/polytope_faces.hpp"

namespace tegl::detail {

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
