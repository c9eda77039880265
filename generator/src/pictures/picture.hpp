// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of tiles with their contours, as SVG text: corners, edges (hidden ones dashed), facets coloured by the side
// that one looks at.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "filling/tile_contour.hpp"

namespace tegl::gen {

/// A place in the plane (z = 0) or in space; tiles have unit size.
using Place = std::array<double, 3>;

/// A tile of a picture. Nothing is copied: tile and contour must outlive it.
struct PlacedTile {
  const Tile* tile;            ///< what it is
  Signature signature;         ///< which corners are high
  const TileContour* contour;  ///< null: none but the patches
  Place at{};                  ///< of the tile's frame
  std::vector<std::array<Place, 3>>
      patches{};  ///< triangles in the tile's frame, seen from their positive side if counter-clockwise
};

/// Tiles of dimension 2 or 3 in one picture, and segments drawn over them as marks.
struct Picture {
  std::string title;                        ///< for readers that cannot see it
  std::string caption;                      ///< below the picture; may be empty
  std::vector<PlacedTile> tiles;            ///< in any order
  std::vector<std::array<Place, 2>> marks;  ///< drawn over all
  double scale = 130;                       ///< pixels per unit
};

/// Where the local vertices of a contour's facet lie in a tile of size one: edge points half way, a facet's barycentre
/// at the mean of its edge points.
[[nodiscard]] Place place_of(const Tile& tile, const Facet& facet, std::uint8_t vertex);

/// The picture as one SVG element, the same bytes for the same picture. In space it is seen from in front, from above
/// and a little from the right: x to the right, y into the picture, z upwards. Errors: Internal for another dimension.
[[nodiscard]] std::string to_svg(const Picture& picture);

/// Pictures side by side, as one SVG element with a title.
[[nodiscard]] std::string to_svg(std::span<const Picture> row, const std::string& title);

}  // namespace tegl::gen
