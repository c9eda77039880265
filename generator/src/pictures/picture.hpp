// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of tiles with their contours as SVG text: corners, edges (hidden ones dashed), and facets coloured by the
// side that faces the viewer.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/tile_contour.hpp"

namespace tegl::gen {

/// A point in the plane (z = 0) or in space; tiles have unit size.
using Place = std::array<double, 3>;

/// A tile in a picture. `tile` and `contour` are not owned and must outlive it.
struct PlacedTile {
  const Tile* tile;            ///< the tile
  Signature signature;         ///< set of high corners
  const TileContour* contour;  ///< null: draw only the patches
  Place at{};                  ///< position of the tile's frame
  std::vector<std::array<Place, 3>>
      patches{};  ///< triangles in the tile's frame; counter-clockwise seen from their positive side
};

/// Tiles of dimension 2 or 3 in one picture, with segments drawn over them as marks.
struct Picture {
  std::string title;                        ///< description for screen readers
  std::string caption;                      ///< below the picture; may be empty
  std::vector<PlacedTile> tiles;            ///< in any order
  std::vector<std::array<Place, 2>> marks;  ///< drawn above everything else
  double scale = 130;                       ///< pixels per unit
};

/// Position of a local vertex of a contour's facet in a tile of unit size: an edge point at the edge's middle, a
/// facet's barycentre at the mean of its edge points.
[[nodiscard]] Place place_of(const Tile& tile, const LocalFacet& facet, std::uint8_t vertex);

/// The picture as one SVG element; equal pictures give equal bytes. In 3D the view is from the front, above and
/// slightly from the left: x to the right, y into the picture, z upwards. Errors: Internal for dimensions other than 2
/// and 3.
[[nodiscard]] std::string to_svg(const Picture& picture);

/// Pictures in a row, as one SVG element with a title.
[[nodiscard]] std::string to_svg(std::span<const Picture> row, const std::string& title);

}  // namespace tegl::gen
