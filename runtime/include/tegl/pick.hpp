// SPDX-License-Identifier: BSD-3-Clause
//
// The one component of a contour that is nearest to a point, at the cost of that component.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "tegl/active_tiles.hpp"
#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// What was picked.
template <int N>
requires DimensionBetween<N, 2, 5>
struct PickReport {
  bool found = false;               ///< whether any tile is active
  TileNumber tile = 0;              ///< the active tile that is nearest to the point
  std::array<std::size_t, N> at{};  ///< its lowest corner
  double distance = 0;              ///< from the point to it, in steps of the grid
  std::uint64_t tiles = 0;          ///< that were reached from it
  std::uint64_t components = 0;     ///< of the contour in those, of which one was picked
};

/// The component of {value = isovalue} that is nearest to a point of the world.
///
/// Nearest by this rule: the active tile nearest to the point, both seen in steps of the grid (of two as near the one
/// with the lower number); all tiles that are reached from it through faces that the contour passes; of the components
/// of the contour in those (often one: several where they pass one tile) the one with the vertex nearest to the point,
/// in steps of the grid. The result is `extract` restricted to that component: the same vertices, normals and simplices
/// in the same order, the vertices numbered anew, next to missing values too.
/// An image without active tiles gives an empty contour; or, with `close`, the component with the vertex nearest to the
/// point, and a report that has found no tile.
///
/// Cost: the tiles of the component and those beside them, and those that are nearer to the point than the contour is;
/// where components share tiles, as in noise, those of the others too; no others are looked at. 5D, and `close`, take
/// all of the contour instead and choose from it. Errors: those of `extract`; InvalidArgument for a point outside of
/// the image. Real: float or double. Source: propagation after Bajaj, Pascucci, Schikore 1996.
template <class Real = float, Value T, int N>
Contour<N, Real> extract_component(const Image<T, N>& image, double isovalue,
                                   const std::type_identity_t<std::array<double, N>>& point,
                                   const ExtractOptions& options = {}, PickReport<N>* report = nullptr);

}  // namespace tegl
