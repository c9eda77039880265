// SPDX-License-Identifier: BSD-3-Clause
//
// Sigma as a simplicial complex (private to the generator).
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "base/simplex_key.hpp"
#include "base/tile_contour.hpp"
#include "filling/face_contours.hpp"

namespace tegl::gen {

/// The triangulation of one component of a 4-tile's Sigma. Decides which tetrahedra a filling may contain.
class SigmaComplex {
 public:
  SigmaComplex(const FaceContours& faces, const std::vector<LocalSimplex>& component);

  /// True if every edge and triangle of the tetrahedron that lies in a face of the tile belongs to Sigma, and the whole
  /// tetrahedron lies in no face.
  [[nodiscard]] bool allows(const LocalSimplex& tetrahedron) const;

 private:
  [[nodiscard]] bool allows_triangle(std::uint8_t a, std::uint8_t b, std::uint8_t c) const;

  const FaceContours& faces_;
  std::array<std::bitset<256>, 256> adjacent_;
  std::vector<Key> triangles_;  // keys, sorted
};

}  // namespace tegl::gen
