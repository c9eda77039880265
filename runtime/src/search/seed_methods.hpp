// SPDX-License-Identifier: BSD-3-Clause
//
// Methods that find the places of seeds from the ranges of tiles.
#pragma once

#include <vector>

#include "search/seed_graph.hpp"

namespace tegl::detail {

/// Trees that cover all components of all levels (see level_sweep.hpp). `bound` is a lower bound of the size of any
/// cover.
struct SeedCover {
  std::vector<std::uint32_t> trees;  ///< ascending
  std::uint64_t bound = 0;
};
SeedCover cover_components(const SeedGraph& graph, const Progress& progress);
/// Only the bound.
std::uint64_t pack_components(const SeedGraph& graph, const Progress& progress);

enum class Dependence {
  sets,       ///< all trees connected by dependences form one set: fast, but more seeds remain
  ancestors,  ///< a tree may cover another if it does not depend on it
};
/// Whole2: the roots that the trees around their groups do not cover. `graph` has links of root groups. A removed root
/// depends on the fewest trees that cover it (minimum cover). Based on: Hung 2005, 3.4.2 to 3.4.4.
std::vector<std::uint32_t> whole2(const SeedGraph& graph, Dependence dependence, const Progress& progress);

/// Tiles that earlier tiles of a scan do not cover. Based on: Bajaj, Pascucci, Schikore, Fast isocontouring for
/// improved interactivity, 1996 (responsibility passes on in the direction of the sweep).
template <class Key>
std::vector<Place> sweep_tiles(const RangeMap<Key>& map, const std::vector<std::ptrdiff_t>& neighbours,
                               const std::vector<int>& order, const Progress& progress);

/// Seeds by growing the covered region from them: all tiles that become covered are added first; then the tile with the
/// widest range beside the region is the next seed.
template <class Key>
std::vector<Place> climb_tiles(const RangeMap<Key>& map, const std::vector<std::ptrdiff_t>& neighbours,
                               const std::vector<int>& order, const Progress& progress);

/// A skeleton of tiles that connects all extrema. Based on: Itoh, Yamaguchi, Koyamada, Volume thinning for automatic
/// isosurface propagation, 1996. Criterion for removal: Couprie, Bertrand, New characterizations of simple points in
/// 2D, 3D and 4D discrete spaces, 2009 (the common boundary of a tile with the others collapses to a point).
template <Value T>
std::vector<Place> thin_tiles(const SampleView<T>& samples, const PaddedTiles& tiles, const Progress& progress);

/// As the public function; compiled once per type, for all dimensions.
template <Value T>
SeedSet find_seeds(const SampleView<T>& samples, const SeedSetOptions& options);

}  // namespace tegl::detail
