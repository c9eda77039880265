// SPDX-License-Identifier: BSD-3-Clause
//
// The figures of certified tables and the numbers of classes as text and as JSON, for all commands that print them.
#pragma once

#include <string>
#include <vector>

#include "base/lattice.hpp"
#include "program/options.hpp"
#include "symmetry/symmetry.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

void print_figures(TileKind tile, int dim, const CertifiedFigures& f);

std::string figures_json(const CertifiedFigures& f);

/// A group of the tile's symmetries and its classes of signatures.
struct GroupCount {
  GroupKind kind;
  bool inversion;
  std::size_t order = 0;
  std::size_t classes = 0;
};

/// Counts the classes of all four groups by enumeration and by Burnside's lemma. Throws Error{CountMismatch} if the two
/// differ.
std::vector<GroupCount> count_classes(const Tile& tile);

/// The same by Burnside's lemma alone, for cubes that are too large to enumerate. N = 5.
std::vector<GroupCount> count_classes_by_burnside(int dim);

/// Prints the counts as the head of a summary. `corners`: number of the tile's corners.
void print_group_counts(const Options& options, unsigned corners, const std::vector<GroupCount>& counts);

/// The tile and its counts as the first members of a JSON object.
std::string group_counts_json(const Options& options, unsigned corners, const std::vector<GroupCount>& counts);

}  // namespace tegl::gen
