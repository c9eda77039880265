// SPDX-License-Identifier: BSD-3-Clause
//
// Recognition of 3-spheres among closed 3-manifolds, fast enough for a test per cell. If a closed connected 3-manifold
// without one of its tetrahedra collapses to a point, the rest is a ball and the manifold is a sphere (J. H. C.
// Whitehead, Simplicial spaces, nuclei and m-groups, 1939). A manifold with homology modulo 2 in dimension 1 is no
// sphere.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tegl::tile {

/// Tests manifolds one after the other and reuses its memory. Not thread-safe.
class ThreeSphereTest {
 public:
  using Tetrahedron = std::array<std::uint16_t, 4>;  ///< four vertex numbers

  /// Whether the tetrahedra are proved to form a sphere. They must form a closed connected 3-manifold, vertices in any
  /// order. False: it has homology, or none of a few tries collapses it; no sphere for which all fail is known. Time:
  /// about linear in the number of tetrahedra, and cubic in the size of what is left of a manifold that does not
  /// collapse. Throws std::invalid_argument if a triangle does not belong to exactly two tetrahedra, std::length_error
  /// for more than 16 384 tetrahedra.
  [[nodiscard]] bool operator()(std::span<const Tetrahedron> tetrahedra);

 private:
  struct Triangle {
    std::array<std::uint16_t, 3> edges;
    std::array<std::uint16_t, 2> tetrahedra;
    bool is_left;
  };
  static constexpr std::uint16_t kNone = 0xffff;

  void renumber(std::span<const Tetrahedron> tetrahedra);
  void find_triangles();
  std::uint16_t edge_between(std::uint16_t a, std::uint16_t b);
  std::size_t collapse(unsigned attempt);
  void open_tree(unsigned attempt);
  [[nodiscard]] bool has_homology(std::size_t left);

  std::size_t vertex_count_ = 0, edge_count_ = 0;
  std::vector<std::uint16_t> number_;    ///< by vertex as given
  std::vector<Tetrahedron> tetrahedra_;  ///< with consecutive vertex numbers, ascending
  std::vector<Triangle> triangles_;
  std::vector<Tetrahedron> triangles_of_;     ///< by tetrahedron: its triangles
  std::vector<std::uint16_t> edge_of_;        ///< by pair of vertices
  std::vector<std::uint16_t> first_of_edge_;  ///< by edge: its triangle found last
  std::vector<std::uint16_t> next_, third_;   ///< by triangle: the triangle before it at its first edge; third vertex
  std::vector<std::uint16_t> queue_, degree_, sum_;
  std::vector<char> reached_;
  std::vector<std::vector<std::uint64_t>> rows_;
};

}  // namespace tegl::tile
