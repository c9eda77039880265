// SPDX-License-Identifier: BSD-3-Clause
//
// Extracts only the component of a contour nearest to a point, at a cost proportional to that component.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "tegl/active_tiles.hpp"
#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// How the component was found.
template <int N>
requires DimensionBetween<N, 2, 5>
struct PickReport {
  bool found = false;               ///< whether any tile is active
  TileNumber tile = 0;              ///< the active tile nearest to the point
  std::array<std::size_t, N> at{};  ///< its lowest corner
  double distance = 0;              ///< distance from the point to `tile`, in grid steps
  std::uint64_t tiles = 0;          ///< number of tiles reached from `tile`
  std::uint64_t components = 0;     ///< number of components in those tiles, of which one was picked
};

/// A component of a contour, and how it was found.
template <int N, Coordinate Real = float>
requires DimensionBetween<N, 2, 5>
struct PickedComponent {
  Contour<N, Real> contour = {};  ///< the component
  PickReport<N> report = {};      ///< how it was found
};

/// Extracts the component of {value = isovalue} nearest to a point, given in world coordinates.
///
/// Rule. First, the active tile nearest to the point, in grid steps (of equal distances the one with the lower number).
/// Then, all tiles that are reached from it through faces that the contour passes. Of the components of the contour in
/// those tiles (several, if they share tiles), the one with the vertex nearest to the point, in grid steps. The result
/// is `extract` restricted to that component: the same vertices, normals and simplices in the same order, with the
/// vertices renumbered, next to missing values too. Without active tiles the contour is empty; with `close` it is the
/// component with the vertex nearest to the point, and the report has found = false.
///
/// Cost: proportional to the tiles of the component, the tiles beside them, and the tiles nearer to the point than the
/// contour. If components share tiles, as in noise, the tiles of those components are read too. In 5D and with `close`,
/// the whole contour is extracted and the component selected from it. Errors: those of `extract`; InvalidArgument for a
/// point outside of the image. Real: float or double. Source: propagation after Bajaj, Pascucci, Schikore 1996.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] PickedComponent<N, Real> extract_component(const Image<T, N>& image, double isovalue,
                                                         const std::type_identity_t<std::array<double, N>>& point,
                                                         const ExtractOptions& options = {});

}  // namespace tegl
