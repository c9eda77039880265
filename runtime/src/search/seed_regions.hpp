// SPDX-License-Identifier: BSD-3-Clause
//
// Trees of tiles for images whose values differ nearly everywhere. There, few tiles lie in the range of one neighbour,
// and seed_graph.hpp finds nearly as many trees as tiles. Here a tile is also given up if several neighbours together
// cover its range; wide tiles are processed first. Far fewer trees remain, with the same components at every isovalue.
#pragma once

#include <vector>

#include "search/seed_graph.hpp"
#include "search/seed_links.hpp"

namespace tegl::detail {

/// Trees in the order of their numbers, and links between them, which may overlap. The range of each tile is divided
/// into parts; each part belongs to a tree that is active there. Links connect the trees of neighbouring tiles. So the
/// components of trees and links correspond to the components of active tiles, and a set of roots that meets all of the
/// former is a seed set. The smallest such set may be larger than the smallest set of tiles.
template <class Key>
struct Regions {
  std::vector<Place> roots;
  std::vector<KeyLink<Key>> links;
};

/// Nearly linear time: each tile is visited a few times, and each round leaves at most about half of the trees. The
/// first round uses `threads` threads (0: all of the machine); the result does not depend on them.
template <class Key>
Regions<Key> make_regions(const RangeMap<Key>& map, Neighbourhood neighbourhood, unsigned threads,
                          const Progress& progress);

/// Roots that meet all components. Linear in the number of links: trees with consecutive numbers are selected in
/// groups.
template <class Key>
std::vector<Place> cover_regions(const RangeMap<Key>& map, const Regions<Key>& regions, const Progress& progress);

}  // namespace tegl::detail
