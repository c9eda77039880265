// SPDX-License-Identifier: BSD-3-Clause
//
// The faces of a polytope by their sets of corners, with their incidences.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tegl::tile {

/// Set of corners of a tile: bit v = corner v.
using Signature = std::uint64_t;

/// A face of a polytope.
struct Face {
  int dim = 0;                         ///< dimension
  Signature corners = 0;               ///< the tile's corners in this face
  std::vector<std::uint32_t> faces{};  ///< indices of the faces of codimension one, ascending
  std::vector<int> signs{};            ///< incidence numbers of `faces` in this face's boundary, outward normal first
};

/// The faces of a polytope, of every dimension; the polytope itself is the last. Faces are sorted by dimension, then by
/// their ascending corners in lexicographic order. Consequence: an embedding of a face that keeps the order of corners
/// keeps the order of faces, and of everything built from them.
class FaceLattice {
 public:
  /// Builds the lattice from the corner sets of the faces of codimension one of a polytope of dimension `dim` with up
  /// to 64 corners. Throws std::invalid_argument for a dimension above 6 and if faces are missing or too many. The
  /// checks are necessary conditions only: some families of sets that belong to no polytope pass.
  FaceLattice(int dim, std::span<const Signature> maximal_faces);
  [[nodiscard]] static FaceLattice cube(int n);        ///< n = 1 ... 6; corner v has coordinate i = v >> i & 1
  [[nodiscard]] static FaceLattice simplex(int n);     ///< n = 1 ... 6; n + 1 corners
  [[nodiscard]] static FaceLattice octahedron(int n);  ///< n = 2 ... 6; corners 2 a and 2 a + 1 are the ends of axis a

  [[nodiscard]] int dim() const { return faces_.back().dim; }               ///< dimension of the polytope
  [[nodiscard]] const std::vector<Face>& faces() const& { return faces_; }  ///< all faces, ascending by dimension
  [[nodiscard]] std::vector<Face> faces() const&& { return faces_; }        ///< for a temporary: a copy
  /// Index of the face with exactly these corners, if there is one. Linear in the number of faces.
  [[nodiscard]] std::optional<std::uint32_t> find(Signature corners) const;
  /// Index of the polytope itself.
  [[nodiscard]] std::uint32_t tile() const { return static_cast<std::uint32_t>(faces_.size() - 1); }

 private:
  void check(const Face& face) const;
  void orient(Face& face);

  std::vector<Face> faces_;
};

}  // namespace tegl::tile
