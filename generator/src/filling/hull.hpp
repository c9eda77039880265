// SPDX-License-Identifier: BSD-3-Clause
//
// Contours from convex hulls (private to the generator).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/tile_contour.hpp"

namespace tegl::gen {

/// All hyperplanes through the midpoints of a tile's edges; computes the hulls of signatures from them.
class HullContours {
 public:
  explicit HullContours(const Tile& tile);

  /// Facets of the convex hull of the `inside` corners and the midpoints of the critical edges, except facets in the
  /// tile's boundary. They are triangulated without further vertices: every face of the hull is coned from its smallest
  /// vertex, so the triangulation in a face of the tile equals that of the face's own hull. Vertices are edge numbers.
  /// The positive side faces out of the hull.
  [[nodiscard]] std::vector<LocalSimplex> contour(Signature inside) const;

 private:
  using Point = std::array<int, 4>;
  using Edges = std::uint64_t;  ///< set of edges
  struct Hyperplane {
    Point normal;
    Edges on = 0, above = 0, below = 0;  ///< sets of midpoints
    Signature corners_above = 0, corners_below = 0;
  };
  struct HullFacet {
    Edges vertices;
    Point outward;
  };

  void add_hyperplanes(std::vector<std::uint8_t>& chosen);
  [[nodiscard]] Point normal_of(const std::vector<std::uint8_t>& chosen) const;
  [[nodiscard]] bool spans_facet(Edges vertices) const;
  void pull(Edges face, int dim, const std::vector<Edges>& all, int depth, LocalSimplex& simplex, const Point& outward,
            std::vector<LocalSimplex>& result) const;
  void emit(LocalSimplex simplex, const Point& outward, std::vector<LocalSimplex>& result) const;

  const Tile& tile_;
  std::vector<Point> corners_, midpoints_;  ///< coordinates times 2
  std::vector<Edges> tile_faces_;
  std::vector<Hyperplane> hyperplanes_;
};

}  // namespace tegl::gen
