// SPDX-License-Identifier: BSD-3-Clause
//
// Where values differ nearly everywhere few tiles lie in the range of a neighbour, and the trees of seed_graph.hpp are
// nearly as many as tiles. Here a tile is also given up where several neighbours have its range between them, each a
// part of it, wide tiles last. What is left are fewer trees by far, with the same components at every isovalue.
#pragma once

#include <vector>

#include "search/seed_graph.hpp"
#include "search/seed_links.hpp"

namespace tegl::detail {

/// Trees, in the order of their numbers, and links between them, which may overlap. Each tile belongs, from part to
/// part of its range, to trees that are active there; links are between those of neighbours. So a component of trees
/// and links is a component of tiles, and a set of roots that meets all of the former is a seed set; a smallest one may
/// be larger than one of all tiles.
template <class Key>
struct Regions {
  std::vector<Place> roots;
  std::vector<KeyLink<Key>> links;
};

/// Near linear: a tile is looked at a few times, and what is left is fewer by half or more from round to round.
template <class Key>
Regions<Key> make_regions(const RangeMap<Key>& map, Neighbourhood neighbourhood, const Progress& progress);

/// Roots that meet all components. Linear in links: trees with numbers in a row are chosen from at a time.
template <class Key>
std::vector<Place> cover_regions(const RangeMap<Key>& map, const Regions<Key>& regions, const Progress& progress);

}  // namespace tegl::detail
