// SPDX-License-Identifier: BSD-3-Clause
//
// A tile with the contours of its faces: the input to filling Sigma.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/tile_contour.hpp"

namespace tegl::gen {

/// The contours of all faces of a tile, in the tile's numbering.
class FaceContours {
 public:
  /// `of_faces`: the contour of every signature of the face's tile; empty for n = 1. `tile` must outlive this object.
  FaceContours(const Tile& tile, Alternative alternative, Triangulation triangulation,
               std::vector<TileContour> of_faces);

  [[nodiscard]] const Tile& tile() const { return *tile_; }                     ///< the tile
  [[nodiscard]] int dim() const { return tile_->dim; }                          ///< dimension of the tile
  [[nodiscard]] Alternative alternative() const { return alternative_; }        ///< resolution of ambiguous squares
  [[nodiscard]] Triangulation triangulation() const { return triangulation_; }  ///< triangulation of facets
  /// Sign between the boundary of the contour and the lifted, signed contours of the faces.
  [[nodiscard]] int orientation() const { return orientation_; }
  /// First local number of the tile's own vertices.
  [[nodiscard]] std::uint32_t own_base() const;
  /// The contour of face f, as a tile of its own, for the restriction of `signature`.
  [[nodiscard]] const TileContour& face_contour(std::uint32_t f, Signature signature) const;
  /// Converts a local vertex of face f to a local vertex of the tile.
  [[nodiscard]] std::uint8_t lift(std::uint32_t f, std::uint8_t vertex) const;
  /// The faces (bit f) that contain a local vertex; 0 for the tile's own vertices.
  [[nodiscard]] std::uint32_t faces_of(std::uint8_t vertex) const { return faces_of_[vertex]; }
  /// A contour without facets: only Sigma, the lifted facets of all faces with the signs of the boundary.
  [[nodiscard]] TileContour sigma(Signature signature) const;

 protected:
  void reverse_orientation() { orientation_ = -orientation_; }

 private:
  const Tile* tile_;
  Alternative alternative_;
  Triangulation triangulation_;
  int orientation_ = 1;                ///< sign that makes the positive side face high
  std::vector<TileContour> contours_;  ///< by signature of the tile of one dimension less
  std::array<std::uint32_t, 256> faces_of_{};
};

}  // namespace tegl::gen
