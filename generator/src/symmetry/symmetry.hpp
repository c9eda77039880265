// SPDX-License-Identifier: BSD-3-Clause
//
// The symmetry group of the n-cube, the hyperoctahedral group B_n, and its action on corners and signatures.
// Nothing here is typed in from a table: elements come from composing the group's reflections, and the order
// is checked against 2^n n!.
//
// Based on: M. Liversage's thesis (1994), sections 6.5 and 7.4, for the action on tiles; the presentation of
// B_n by n reflections is Coxeter's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tegl::gen {

/// Highest dimension of an Element.
inline constexpr int kMaxDim = 8;

/// Highest dimension whose signatures (2^n bits) fit in 32 bits.
inline constexpr int kMaxSignatureDim = 5;

/// All symmetries of the cube, or only those of determinant +1.
enum class GroupKind { Full, Rotations };

/// One symmetry of the n-cube: corners move by `v -> pi(v) ^ flip`, and `inverts` says whether high and low are
/// exchanged afterwards.
///
/// Coordinate i of the corner becomes coordinate axis[i]: bit axis[i] of pi(v) is bit i of v. Then the bits in
/// `flip` are complemented: coordinate axis[i] of the image is `x_i` or `1 - x_i` according to bit axis[i] of flip.
/// About the cube's centre that is the signed permutation matrix M with M[axis[i]][i] = +-1 (- where flip has bit
/// axis[i]) and zeros elsewhere; `det` is its determinant. axis[i] = i for n <= i < 8.
struct Element {
  std::array<std::uint8_t, kMaxDim> axis{0, 1, 2, 3, 4, 5, 6, 7};  ///< where each axis goes
  std::uint32_t flip = 0;                                          ///< image axes that are reversed
  int det = 1;           ///< +1 for a rotation, -1 for a reflection; inversion does not count
  bool inverts = false;  ///< also complements the signature

  /// The image of corner v.
  [[nodiscard]] std::uint32_t corner(std::uint32_t v) const noexcept;
  /// The image of a set of axes, given as a bit mask: pi alone, without flip.
  [[nodiscard]] std::uint32_t permute_axes(std::uint32_t mask) const noexcept;
  /// Whether the element turns facets inside out: exactly one of a reflection and an inversion does.
  [[nodiscard]] bool reverses_orientation() const noexcept { return (det < 0) != inverts; }

  friend bool operator==(const Element&, const Element&) = default;  ///< member by member
};

/// The determinant of the signed permutation matrix that `axis` and `flip` describe.
[[nodiscard]] int determinant(const Element& g) noexcept;

/// "a after b": compose(a, b).corner(v) == a.corner(b.corner(v)).
[[nodiscard]] Element compose(const Element& a, const Element& b) noexcept;

/// The element that undoes g.
[[nodiscard]] Element inverse(const Element& g) noexcept;

/// 2^n n!, halved for rotations, doubled with inversion. Errors: InvalidArgument unless 1 <= n <= 8.
[[nodiscard]] std::size_t group_order(int n, GroupKind kind, bool inversion);

/// All elements, in ascending order of (inverts, axis[0], axis[1], ..., flip): the identity is the first.
/// Closed under composition from the n reflections that generate B_n (for rotations: from their products in pairs);
/// the result's size is checked against group_order.
/// O(n |G| log |G|) time and O(|G|) memory: immediate up to n = 6 (46 080 elements), seconds and about a
/// gigabyte for n = 8. Errors: InvalidArgument unless 1 <= n <= 8; Internal if the check fails.
[[nodiscard]] std::vector<Element> group(int n, GroupKind kind, bool inversion);

/// The images of the 2^n corners, in order.
[[nodiscard]] std::vector<std::uint32_t> corner_permutation(const Element& g, int n);

/// A signature's image {g(v) : v in s}, complemented if g inverts. `permutation` is corner_permutation(g, n); so one
/// that is used often is computed once. s has no bit at or above 2^n, n <= 5.
[[nodiscard]] std::uint32_t act(const Element& g, std::span<const std::uint32_t> permutation, std::uint32_t s) noexcept;

/// The same with the permutation computed on the way.
[[nodiscard]] std::uint32_t act(const Element& g, int n, std::uint32_t s);

}  // namespace tegl::gen
