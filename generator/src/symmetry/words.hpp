// SPDX-License-Identifier: BSD-3-Clause
//
// Group elements written as words: products of quarter turns, a mirror and the exchange of high and low. The words are
// computed, not typed: each is a shortest product of the named generators.
//
// Based on: M. Liversage, thesis, 1994, sections 6.5.3 and 7.4.4 to 7.4.10, table 7.5.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "symmetry/symmetry.hpp"

namespace tegl::gen {

/// A named generator of a group.
struct Generator {
  std::string name;     ///< the letter of a word, such as rho_x
  std::string meaning;  ///< one phrase, such as "quarter turn from y to z"
  Element element;      ///< the generator itself
};

/// The generators of group(n, kind, inversion), in this order:
/// - 2D: rho, the quarter turn from x to y (thesis, 6.5.3); for the full group mu_x, which maps x to 1 - x;
/// - 3D: rho_x, rho_y, rho_z, the quarter turns about the axes by the right-hand rule; for the full group mu, the
///   mirror in the centre (thesis, 7.4.5 to 7.4.10);
/// - 4D: rho_ij, the quarter turn from axis i to axis j, i < j; for the full group mu_x. The mirror in the centre is a
///   rotation in even dimensions, so it cannot extend the rotations there;
/// - with inversion, iota: the exchange of high and low.
/// Errors: InvalidArgument unless 2 <= n <= 4.
[[nodiscard]] std::vector<Generator> named_generators(int n, GroupKind kind, bool inversion);

/// A product of generators, as indices of them. The first is applied first, as in the thesis (7.4.6).
using Word = std::vector<std::uint8_t>;

/// The element that a word stands for; the identity for the empty word.
[[nodiscard]] Element product(const Word& word, std::span<const Generator> generators);

/// The word with powers: {0, 0, 1} is "rho_x^2 rho_y" in 3D, the empty word is "1".
[[nodiscard]] std::string word_text(const Word& word, std::span<const Generator> generators);

/// A strict order: shorter words first, then words of fewer powers, then higher powers first, then by the generators'
/// order. "rho_x^2 rho_y" precedes "rho_x rho_y^2", which precedes "rho_x rho_y rho_x".
[[nodiscard]] bool precedes(const Word& a, const Word& b);

/// For each element of a group its first word in the order of precedes(): a shortest one. A breadth-first search over
/// elements and last letters, O(|G| k^2) comparisons of words for k generators: immediate up to 4D. Errors: Internal if
/// the generators do not generate the group.
[[nodiscard]] std::vector<Word> shortest_words(std::span<const Element> group, std::span<const Generator> generators);

}  // namespace tegl::gen
