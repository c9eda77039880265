// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the few tiles of a row whose signatures belong to a given set, such as the ambiguous ones. Compiled for several
// instruction sets, the best of which is chosen at run time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tegl::detail {

/// A set of signatures of squares or cubes, in the form that table lookups in registers need.
struct SignatureSet {
  /// By signature & 15: those with signature >> 4 below 8, and from 8 on, as bits.
  alignas(16) std::array<std::array<std::uint8_t, 16>, 2> bits{};

  SignatureSet() = default;
  template <std::size_t Signatures>
  constexpr explicit SignatureSet(const std::array<bool, Signatures>& members) noexcept {
    static_assert(Signatures <= 256);
    for (std::size_t s = 0; s < Signatures; ++s)
      if (members[s]) bits[s >> 7][s & 15] |= static_cast<std::uint8_t>(1u << (s >> 4 & 7u));
  }
  [[nodiscard]] constexpr bool contains(unsigned signature) const noexcept {
    return (bits[signature >> 7 & 1u][signature & 15u] >> (signature >> 4 & 7u) & 1u) != 0;
  }
};

/// Bit i of the result: whether `set` contains signatures[i], for i < count <= 64. Up to 31 entries past the end are
/// read.
std::uint64_t members_of(const SignatureSet& set, const std::uint16_t* signatures, std::size_t count) noexcept;

}  // namespace tegl::detail
