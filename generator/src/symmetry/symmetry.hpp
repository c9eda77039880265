// SPDX-License-Identifier: BSD-3-Clause
//
// The symmetry group of the n-cube, the hyperoctahedral group B_n, and its action on corners and signatures. No element
// is typed by hand: elements are products of the group's reflections, and the order is checked against 2^n n!.
//
// Based on: M. Liversage, thesis, 1994, sections 6.5 and 7.4 (action on tiles); H. S. M. Coxeter, 1935 (presentation of
// B_n by n reflections).
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

/// All symmetries of the cube, or only its rotations (determinant +1).
enum class GroupKind { Full, Rotations };

/// One symmetry of the n-cube. Corners map by `v -> pi(v) ^ flip`; if `inverts`, high and low are then exchanged.
///
/// Coordinate i of a corner becomes coordinate axis[i]: bit axis[i] of pi(v) is bit i of v. Then the bits in `flip` are
/// complemented: coordinate axis[i] of the image is `x_i` or `1 - x_i` according to bit axis[i] of flip. About the
/// cube's centre this is the signed permutation matrix M with M[axis[i]][i] = +-1 (- if flip has bit axis[i]) and zeros
/// elsewhere; `det` is its determinant. axis[i] = i for n <= i < 8.
/// axis[i]) and zeros elsewhere; `det` is its determinant. axis[i] = i for n <= i < 8.
struct Element {
  std::array<std::uint8_t, kMaxDim> axis{0, 1, 2, 3, 4, 5, 6, 7};  ///< image of each axis
  std::uint32_t flip = 0;                                          ///< image axes that are reversed
  int det = 1;           ///< +1 for a rotation, -1 for a reflection; inversion does not count
  bool inverts = false;  ///< also complements the signature

  /// The image of corner v.
  [[nodiscard]] std::uint32_t corner(std::uint32_t v) const noexcept;
  /// The image of a set of axes, given as a bit mask: pi only, without flip.
  [[nodiscard]] std::uint32_t permute_axes(std::uint32_t mask) const noexcept;
  /// True if the element reverses the orientation of facets: it is either a reflection or an inversion, not both.
  [[nodiscard]] bool reverses_orientation() const noexcept { return (det < 0) != inverts; }

  friend bool operator==(const Element&, const Element&) = default;  ///< memberwise
};

/// The determinant of the signed permutation matrix given by `axis` and `flip`.
[[nodiscard]] int determinant(const Element& g) noexcept;

/// "a after b": compose(a, b).corner(v) == a.corner(b.corner(v)).
[[nodiscard]] Element compose(const Element& a, const Element& b) noexcept;

/// The inverse of g.
[[nodiscard]] Element inverse(const Element& g) noexcept;

/// 2^n n!, halved for rotations, doubled with inversion. Errors: InvalidArgument unless 1 <= n <= 8.
[[nodiscard]] std::size_t group_order(int n, GroupKind kind, bool inversion);

/// All elements in ascending order of (inverts, axis[0], axis[1], ..., flip); the identity is the first. They are the
/// closure of the n reflections that generate B_n (for rotations: of their pairwise products), checked against
/// group_order. O(n |G| log |G|) time and O(|G|) memory: immediate up to n = 6 (46 080 elements), seconds and about a
/// gigabyte for n = 8. Errors: InvalidArgument unless 1 <= n <= 8; Internal if the check fails.
[[nodiscard]] std::vector<Element> group(int n, GroupKind kind, bool inversion);

/// The images of the 2^n corners, by corner.
[[nodiscard]] std::vector<std::uint32_t> corner_permutation(const Element& g, int n);

/// The image {g(v) : v in s} of a signature, complemented if g inverts. `permutation` is corner_permutation(g, n),
/// which callers can reuse. s has no bit at or above 2^n, n <= 5.
[[nodiscard]] std::uint32_t act(const Element& g, std::span<const std::uint32_t> permutation, std::uint32_t s) noexcept;

/// As act(g, permutation, s), but computes the permutation. Errors: InvalidArgument unless 1 <= n <= 5.
[[nodiscard]] std::uint32_t act(const Element& g, int n, std::uint32_t s);

}  // namespace tegl::gen
