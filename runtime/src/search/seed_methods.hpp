// SPDX-License-Identifier: BSD-3-Clause
//
// Ways to find seeds, from ranges of tiles to places of seeds.
#pragma once

#include <vector>

#include "search/seed_graph.hpp"
#include "tegl/image.hpp"

namespace tegl::detail {

/// Trees that cover all components of all levels: see level_sweep.hpp. `bound`: no cover is smaller.
struct SeedCover {
  std::vector<std::uint32_t> trees;  ///< ascending
  std::uint64_t bound = 0;
};
SeedCover cover_components(const SeedGraph& graph, const Progress& progress);
/// The bound alone.
std::uint64_t pack_components(const SeedGraph& graph, const Progress& progress);

enum class Dependence {
  sets,       ///< trees that depend on each other in any way are one set: quick, and more seeds stay
  ancestors,  ///< a tree may cover another unless it depends on it
};
/// Whole2: roots that the trees around their groups do not cover. `graph` has links of root groups. Minimum cover: the
/// fewest trees that will do. Based on: Hung 2005, 3.4.2 to 3.4.4.
std::vector<std::uint32_t> whole2(const SeedGraph& graph, Dependence dependence, const Progress& progress);

/// Tiles that those before them in a scan do not cover. Based on: Bajaj, Pascucci, Schikore, Fast isocontouring for
/// improved interactivity, 1996 (responsibility is handed on in the direction of the sweep).
template <class Key>
std::vector<Place> sweep_tiles(const RangeMap<Key>& map, const std::vector<std::ptrdiff_t>& neighbours,
                               const std::vector<int>& order, const Progress& progress);

/// The same where what is covered grows from the seeds: all tiles that are covered come first, then the one with the
/// widest range beside them is the next seed.
template <class Key>
std::vector<Place> climb_tiles(const RangeMap<Key>& map, const std::vector<std::ptrdiff_t>& neighbours,
                               const std::vector<int>& order, const Progress& progress);

/// A skeleton of tiles that joins all extrema. Based on: Itoh, Yamaguchi, Koyamada, Volume thinning for automatic
/// isosurface propagation, 1996; which tiles may go: Couprie, Bertrand, New characterizations of simple points in 2D,
/// 3D and 4D discrete spaces, 2009 (those whose common boundary with the others collapses to a point).
template <Value T, int N>
std::vector<Place> thin_tiles(const Image<T, N>& image, const PaddedTiles& tiles, const Progress& progress);

}  // namespace tegl::detail
