// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of all faces of an n-cube, computed by the compiler.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tegl::detail {

/// A face of a cube.
struct CubeFace {
  std::uint8_t base;  ///< lowest corner
  std::uint8_t axes;  ///< bit a: spans axis a
  std::uint8_t dim;   ///< dimension
};

/// The faces of the N-cube and their numbers: by dimension, then by their ascending corners in lexicographic order. For
/// faces of one dimension this is the order of their lowest corners, then of their ascending axes.
template <unsigned N>
struct CubeFaceArrays {
  /// Number of faces: 3^N.
  static constexpr std::size_t kCount = [] {
    std::size_t count = 1;
    for (unsigned a = 0; a < N; ++a) count *= 3;
    return count;
  }();
  std::array<CubeFace, kCount> faces{};                            ///< by number
  std::array<std::uint16_t, std::size_t{1} << (2 * N)> numbers{};  ///< at base << N | axes

  /// Lists all faces.
  constexpr CubeFaceArrays() {
    std::array<std::uint8_t, std::size_t{1} << N> sets{};  // of axes, ascending lists in lexicographic order
    for (unsigned i = 0; i < 1u << N; ++i)
      for (unsigned a = 0; a < N; ++a) sets[i] = static_cast<std::uint8_t>(sets[i] | (~i >> a & 1u) << (N - 1 - a));
    std::size_t count = 0;
    for (int dim = 0; dim <= static_cast<int>(N); ++dim)
      for (unsigned base = 0; base < 1u << N; ++base)
        for (const unsigned axes : sets) {
          if ((base & axes) != 0 || std::popcount(axes) != dim) continue;
          numbers[base << N | axes] = static_cast<std::uint16_t>(count);
          faces[count++] = {static_cast<std::uint8_t>(base), static_cast<std::uint8_t>(axes),
                            static_cast<std::uint8_t>(dim)};
        }
  }
};

/// The faces of the N-cube.
template <unsigned N>
inline constexpr CubeFaceArrays<N> kCubeFaceArrays{};

/// The faces of the n-cube, n = 1 ... 6, in the order of tile::FaceLattice. A view of constants.
class CubeFaces {
 public:
  /// `n`: from 1 to 6.
  constexpr explicit CubeFaces(int n) noexcept
      : CubeFaces(n == 1   ? CubeFaces(1, kCubeFaceArrays<1>.faces, kCubeFaceArrays<1>.numbers)
                  : n == 2 ? CubeFaces(2, kCubeFaceArrays<2>.faces, kCubeFaceArrays<2>.numbers)
                  : n == 3 ? CubeFaces(3, kCubeFaceArrays<3>.faces, kCubeFaceArrays<3>.numbers)
                  : n == 4 ? CubeFaces(4, kCubeFaceArrays<4>.faces, kCubeFaceArrays<4>.numbers)
                  : n == 5 ? CubeFaces(5, kCubeFaceArrays<5>.faces, kCubeFaceArrays<5>.numbers)
                           : CubeFaces(6, kCubeFaceArrays<6>.faces, kCubeFaceArrays<6>.numbers)) {}

  [[nodiscard]] constexpr int dim() const noexcept { return static_cast<int>(n_); }  ///< dimension of the cube
  /// All faces, by number; the cube itself is the last.
  [[nodiscard]] constexpr std::span<const CubeFace> cells() const noexcept { return faces_; }
  /// Number of the face with this base and axes.
  [[nodiscard]] constexpr std::uint16_t number(unsigned base, unsigned axes) const noexcept {
    return numbers_[base << n_ | axes];
  }
  /// Number of the cube itself.
  [[nodiscard]] constexpr std::size_t tile() const noexcept { return faces_.size() - 1; }
  /// Number of the first face of dimension 2. Choices exist for it and all later faces.
  [[nodiscard]] constexpr std::size_t first_choice() const noexcept {
    return (std::size_t{1} << n_) + (std::size_t{n_} << (n_ - 1));
  }

 private:
  constexpr CubeFaces(unsigned n, std::span<const CubeFace> faces, std::span<const std::uint16_t> numbers) noexcept
      : n_(n), faces_(faces), numbers_(numbers.data()) {}

  unsigned n_;
  std::span<const CubeFace> faces_;
  const std::uint16_t* numbers_;
};

}  // namespace tegl::detail
