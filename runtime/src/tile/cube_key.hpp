// SPDX-License-Identifier: BSD-3-Clause
//
// Keys of cubes: a signature together with one of its fillings.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tegl/tile/choices.hpp"

namespace tegl::detail {

/// `signature | variant << 8`. Variant 0: the unresolved cube of the plain table. Variant 1 + 3 r + choice: resolution
/// r of the ambiguous squares (tables::ResolvedTable) and the cube's own choice.
class CubeKey {
 public:
  static constexpr unsigned kSignatures = 256;
  static constexpr unsigned kVariants = 1 + 3 * 64;

  explicit constexpr CubeKey(unsigned bits) noexcept : bits_(static_cast<std::uint16_t>(bits)) {}
  constexpr CubeKey(unsigned signature, unsigned resolution, tile::Choice choice) noexcept
      : CubeKey(of_variant(signature, 1 + 3 * resolution + static_cast<unsigned>(choice))) {}

  /// The cube with this signature and variant.
  [[nodiscard]] static constexpr CubeKey of_variant(unsigned signature, unsigned variant) noexcept {
    return CubeKey(signature | variant << 8);
  }

  [[nodiscard]] constexpr std::uint16_t bits() const noexcept { return bits_; }
  [[nodiscard]] constexpr unsigned signature() const noexcept { return bits_ & 255u; }
  [[nodiscard]] constexpr unsigned variant() const noexcept { return bits_ >> 8; }
  [[nodiscard]] constexpr bool is_plain() const noexcept { return variant() == 0; }
  /// For a plain cube: the first resolution, and Choice::separate.
  [[nodiscard]] constexpr unsigned resolution() const noexcept { return is_plain() ? 0 : (variant() - 1) / 3; }
  [[nodiscard]] constexpr tile::Choice choice() const noexcept {
    return is_plain() ? tile::Choice::separate : static_cast<tile::Choice>((variant() - 1) % 3);
  }

 private:
  std::uint16_t bits_;
};

/// Compresses the bits of `squares` at the positions of `ambiguous` into adjacent bits: the number of a resolution.
inline constexpr auto kPackedSquares = [] {
  std::array<std::array<std::uint8_t, 64>, 64> packed{};  // by `ambiguous`
  for (unsigned ambiguous = 0; ambiguous < 64; ++ambiguous)
    for (unsigned squares = 0; squares < 64; ++squares)
      for (unsigned q = 0, bit = 1; q < 6; ++q) {
        if ((ambiguous >> q & 1u) == 0) continue;
        if ((squares >> q & 1u) != 0)
          packed[ambiguous][squares] = static_cast<std::uint8_t>(packed[ambiguous][squares] | bit);
        bit *= 2;
      }
  return packed;
}();
[[nodiscard]] constexpr unsigned packed_squares(unsigned squares, unsigned ambiguous) noexcept {
  return kPackedSquares[ambiguous][squares & 63u];
}

/// Number of keys of squares and cubes, N = 2 or 3. A square's key is `signature | 16` if its centre is high.
template <int N>
inline constexpr std::size_t kKeys = N == 2 ? 32 : std::size_t{CubeKey::kSignatures} * CubeKey::kVariants;
template <int N>
constexpr unsigned signature_of(unsigned key) noexcept {
  return key & ((1u << (1u << N)) - 1);
}

}  // namespace tegl::detail
