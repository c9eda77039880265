// SPDX-License-Identifier: BSD-3-Clause
//
// Where values differ nearly everywhere few tiles lie in the range of a neighbour, and the trees of seed_graph.hpp are
// nearly as many as tiles. Here a tile is also given up where several neighbours have its range between them, each a
// part of it, wide tiles last. What is left are fewer trees by far, with the same components at every isovalue.
#pragma once

#include "seed_graph.hpp"

namespace tegl::detail {

/// As make_seed_graph, with all links, in any order of the axes. Each tile belongs, from part to part of its range, to
/// trees that are active there; links are between those of neighbours. So a component of the graph is a component of
/// tiles, and a set of roots that meets all components of the graph is a seed set; a smallest one may be larger than
/// one of all tiles. Without levels and links if there are more of these than `most_links`: hardly a root can be spared
/// then. Near linear: a tile is looked at a few times, and what is left is fewer by half or more from round to round.
template <class Key>
SeedGraph make_region_graph(const RangeMap<Key>& map, Neighbourhood neighbourhood, std::size_t most_links,
                            const Progress& progress);

}  // namespace tegl::detail
