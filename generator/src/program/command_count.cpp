// SPDX-License-Identifier: BSD-3-Clause
//
// `gen --count`: the number of classes, counted in two ways that share only the group's order: Burnside's lemma over
// pairs of partitions, and orbits of all signatures under the closed group.
#include <fmt/format.h>

#include "cells/cell.hpp"
#include "program/commands.hpp"
#include "symmetry/counting.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "symmetry/transversal.hpp"

namespace tegl::gen {

namespace {

/// Prints the result as text or JSON.
void print_count(const Options& options, std::size_t order, const std::string& orbits, bool enumerated) {
  const char* const group_name = options.group == GroupKind::Full ? "full" : "rotations";
  if (options.json) {
    fmt::print(
        "{{\"tile\": \"{}\", \"dim\": {}, \"group\": \"{}\", \"inversion\": {}, \"order\": {}, \"orbits\": {}}}\n",
        tile_text(options), options.dim, group_name, options.inversion, order, orbits);
  } else {
    fmt::print("tile       {}\ndimension  {}\ngroup      {}{}, order {}\norbits     {} ({})\n", tile_text(options),
               options.dim, group_name, options.inversion ? " with inversion" : "", order, orbits,
               enumerated ? "by Burnside's lemma and by enumeration" : "by Burnside's lemma");
  }
}

/// Tiles other than cubes: both counts use the permutations of the tile's corners.
int count_of_tile(const Options& options, const Tile& tile) {
  const auto elements = symmetries(tile, options.group, options.inversion);
  require_burnside_count(transversal(tile, elements), elements);
  print_count(options, elements.size(), burnside_orbits(elements).to_decimal(), true);
  return 0;
}

}  // namespace

int run_count(const Options& options) {
  if (options.cell != nullptr) return count_of_tile(options, mesh_cell(options.cell->shape).tile);
  if (options.tile != TileKind::cube)
    return count_of_tile(options, Lattice(options.tile, options.dim).tile(options.dim));
  const WideUint orbits = burnside_orbits(options.dim, options.group, options.inversion);
  const bool enumerated = options.dim <= kMaxEnumeratedDim;
  if (enumerated) {
    const Transversal classes = transversal(options.dim, group(options.dim, options.group, options.inversion));
    require_burnside_count(classes, options.dim, options.group, options.inversion);
  }
  const std::size_t order = group_order(options.dim, options.group, options.inversion);
  print_count(options, order, orbits.to_decimal(), enumerated);
  return 0;
}

}  // namespace tegl::gen
