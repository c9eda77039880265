// SPDX-License-Identifier: BSD-3-Clause
//
// Sigma of a tile, assembled from the contours of its faces.
#include "filling/face_contours.hpp"

#include <stdexcept>
#include <utility>

#include "tegl/table_contract.hpp"

namespace tegl::gen {

namespace {

std::uint32_t own_base_of(const Tile& tile) {
  const std::uint32_t slots = tile.dim == 4 ? tables::kFaceSlots : 0;
  return tile.edge_count() + slots * static_cast<std::uint32_t>(tile.faces.size());
}

}  // namespace

FaceContours::FaceContours(const Tile& tile, Alternative alternative, Triangulation triangulation,
                           std::vector<TileContour> of_faces)
    : tile_(&tile), alternative_(alternative), triangulation_(triangulation), contours_(std::move(of_faces)) {
  for (std::uint32_t f = 0; f < tile_->faces.size(); ++f) {
    for (const std::uint8_t e : tile_->faces[f].edge) faces_of_[e] |= 1u << f;
    if (tile_->dim == 4)
      for (std::uint32_t j = 0; j < tables::kFaceSlots; ++j)
        faces_of_[tile_->edge_count() + f * tables::kFaceSlots + j] |= 1u << f;
  }
}

std::uint32_t FaceContours::own_base() const { return own_base_of(*tile_); }

const TileContour& FaceContours::face_contour(std::uint32_t f, Signature signature) const {
  return contours_[tile_->restrict_to(f, signature)];
}

std::uint8_t FaceContours::lift(std::uint32_t f, std::uint8_t vertex) const {
  const SubTile& face = tile_->faces[f];
  if (vertex < face.edge.size()) return face.edge[vertex];
  const std::uint32_t slot = vertex - own_base_of(*face.tile);
  if (slot >= tables::kFaceSlots || tile_->dim != 4)
    throw std::logic_error("a face's contour has more vertices of its own than the contract has slots for");
  return static_cast<std::uint8_t>(tile_->edge_count() + f * tables::kFaceSlots + slot);
}

TileContour FaceContours::sigma(Signature signature) const {
  TileContour result;
  const int k = tile_->dim - 1;  // vertices per simplex of Sigma
  for (std::uint32_t f = 0; f < tile_->faces.size(); ++f)
    for (const LocalFacet& facet : face_contour(f, signature).facets)
      for (LocalSimplex simplex : facet.simplices) {
        for (int i = 0; i < k; ++i) simplex[i] = lift(f, simplex[i]);
        const int sign = tile_->faces[f].sign * orientation_ * facet.sign;
        if (k == 1) result.boundary_sign.push_back(static_cast<std::int8_t>(sign));
        if (k > 1 && sign < 0) std::swap(simplex[k - 1], simplex[k - 2]);
        result.boundary.push_back(simplex);
      }
  return result;
}

}  // namespace tegl::gen
