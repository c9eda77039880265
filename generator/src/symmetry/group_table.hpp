// SPDX-License-Identifier: BSD-3-Clause
//
// A group of symmetries as tables for reading: each element with its word, its kind and the signatures that it fixes;
// each class of signatures with its isotropy group.
//
// Based on: M. Liversage, thesis, 1994, tables 6.8 (fixed points), 6.9 (isotropy groups), 7.5 (elements as words).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "symmetry/symmetry.hpp"
#include "symmetry/words.hpp"

namespace tegl::gen {

/// One element of a group.
struct ElementRow {
  Element element;          ///< the element itself
  Word word;                ///< a shortest product of the generators
  std::vector<int> cycles;  ///< lengths of its cycles of axes: positive cycles first, then negative ones as -length;
                            ///< each descending by length
  std::string kind;         ///< in 2D and 3D: "quarter turn about a face axis", ...; empty in 4D
  std::uint32_t order = 1;  ///< smallest k > 0 with g^k = 1
  std::uint64_t fixed = 0;  ///< number of signatures s with g(s) = s
  std::vector<std::uint32_t> fixed_signatures;  ///< these signatures, ascending; in 2D and 3D, empty in 4D
};

/// One class of signatures.
struct ClassRow {
  std::uint32_t signature = 0;           ///< the smallest of the class
  int high_corners = 0;                  ///< number of its high corners
  std::uint32_t orbit_length = 0;        ///< number of signatures in the class
  std::vector<std::size_t> isotropy;     ///< the elements that fix the signature, as indices of rows, ascending
  std::vector<std::size_t> isotropy_by;  ///< some of them that generate the others; none can be left out
};

/// A group and its classes of signatures.
struct GroupTable {
  int dim = 0;                        ///< dimension
  GroupKind kind = GroupKind::Full;   ///< all symmetries or rotations
  bool inversion = false;             ///< also the exchange of high and low
  std::vector<Generator> generators;  ///< letters of the words
  std::vector<ElementRow> elements;   ///< rotations, then reflections; then both with inversion; within these in
                                      ///< 3D by kind in the order of table 7.5, then by word
  std::uint64_t fixed_sum = 0;        ///< sum of `fixed`: the group's order times the number of classes
  std::vector<ClassRow> classes;      ///< by high corners, then by signature, as table 6.9
};

/// Computes the table. Two checks: Burnside's lemma on the sum of the fixed points against the enumerated classes, and
/// |orbit| |isotropy group| = |G| for each class. Immediate for n = 2 and 3; O(classes |G| 2^n), well below a second,
/// for n = 4. Errors: InvalidArgument unless 2 <= n <= 4; CountMismatch if a check fails.
[[nodiscard]] GroupTable group_table(int n, GroupKind kind, bool inversion);

/// The name of an isotropy group: "G" for the whole group, else its elements, "{1, rho^2}", if there are at most four,
/// else generators, "<rho_x, mu>".
[[nodiscard]] std::string isotropy_name(const GroupTable& table, const ClassRow& row);

}  // namespace tegl::gen
