// SPDX-License-Identifier: BSD-3-Clause
//
// Places of all vertices of a tile's contour for given points on its edges, as the runtime computes them (table
// contract: "Positions"), in integers: the same on all machines. Copies of corners are an exception: the runtime puts
// them on their rays where the interpolant has the isovalue, which depends on the samples. Here they are half way. The
// entries that are searched have no copies of corners; copies are proved for all places on their rays.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "embedding/simplex_meeting.hpp"
#include "filling/facets.hpp"

namespace tegl::gen {

/// Where a contour's vertices are, for given points on the edges of its cell.
class ContourPlaces {
 public:
  virtual ~ContourPlaces() = default;
  /// The edges with a vertex.
  [[nodiscard]] virtual std::span<const std::uint8_t> edges() const noexcept = 0;
  /// The edges on which the place of a vertex depends (bit e).
  [[nodiscard]] virtual std::uint32_t edges_of(std::uint8_t vertex) const = 0;
  /// `at`: by edge, the distance from its first end, in (0, 2^kGridBits). `places`: 256, by local vertex.
  virtual void compute(std::span<const std::int64_t> at, std::span<GridPoint> places) const = 0;
};

/// Computes the places of one contour's vertices.
class VertexPlaces : public ContourPlaces {
 public:
  /// Copies what it needs of `contour`, a contour of `faces`, which must outlive this object.
  VertexPlaces(const FaceContours& faces, const TileContour& contour);

  [[nodiscard]] std::span<const std::uint8_t> edges() const noexcept override { return edges_; }
  [[nodiscard]] std::uint32_t edges_of(std::uint8_t vertex) const override { return edges_of_[vertex]; }
  void compute(std::span<const std::int64_t> at, std::span<GridPoint> places) const override;

 private:
  /// The simplices opposite to the apex of a cone, n - 1 or (in a 4-tile's cubes) two vertices each.
  struct Cone {
    std::uint8_t apex;
    std::uint8_t per_face;
    std::vector<LocalSimplex> faces;
  };
  void add_to_cone(const LocalSimplex& simplex, int count);
  [[nodiscard]] GridPoint barycentre(const Cone& cone, std::span<const GridPoint> places) const;
  [[nodiscard]] GridPoint mean(const Cone& cone, std::span<const GridPoint> places) const;
  [[nodiscard]] GridPoint side_place(std::uint64_t mask, std::span<const GridPoint> places) const;

  const Tile* tile_;
  Triangulation triangulation_;
  std::vector<std::uint8_t> edges_;
  std::vector<Cone> cones_;  ///< cones in faces first
  std::uint32_t first_side_;
  std::vector<std::uint64_t> side_masks_;
  std::array<std::uint32_t, 256> edges_of_{};
};

}  // namespace tegl::gen
