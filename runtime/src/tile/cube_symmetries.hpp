// SPDX-License-Identifier: BSD-3-Clause
//
// Symmetries of the n-cube: permutations and reversals of its axes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tegl::detail {

/// Maps the frame of one tile to the frame of another: axis i becomes the i-th entry of a permutation, then the axes in
/// `flip` are reversed. All 0: the identity.
struct CubeSymmetry {
  std::uint16_t permutation = 0;
  std::uint8_t flip = 0;
};

/// A permutation of axes.
struct AxisPermutation {
  std::array<std::uint8_t, 32> spread{};  ///< where it takes a set of axes
  bool is_odd = false;
};

/// All permutations of the axes of the N-cube in lexicographic order, computed by the compiler.
template <unsigned N>
struct AxisPermutations {
  static constexpr std::size_t kCount = [] {
    std::size_t count = 1;
    for (unsigned n = 2; n <= N; ++n) count *= n;
    return count;
  }();
  std::array<AxisPermutation, kCount> all{};

  constexpr AxisPermutations() {
    std::array<std::uint8_t, N> axes{};
    for (std::size_t i = 0; i < N; ++i) axes[i] = static_cast<std::uint8_t>(i);
    for (AxisPermutation& p : all) {
      for (unsigned mask = 1; mask < 1u << N; ++mask) {
        const unsigned rest = mask & (mask - 1), axis = axes[static_cast<std::size_t>(std::countr_zero(mask))];
        p.spread[mask] = static_cast<std::uint8_t>(p.spread[rest] | 1u << axis);
      }
      for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = i + 1; j < N; ++j) p.is_odd = p.is_odd != (axes[i] > axes[j]);
      std::next_permutation(axes.begin(), axes.end());
    }
  }
};

template <unsigned N>
inline constexpr AxisPermutations<N> kAxisPermutations{};

/// All symmetries of the n-cube, n = 2 ... 5.
class CubeSymmetries {
 public:
  explicit CubeSymmetries(int n) noexcept : n_(static_cast<unsigned>(n)), permutations_(permutations_of(n)) {}

  /// Maps a set of axes from the first frame to the second.
  [[nodiscard]] unsigned axes(CubeSymmetry symmetry, unsigned axes) const noexcept {
    return permutations_[symmetry.permutation].spread[axes];
  }
  /// Lowest corner of a face in the second frame. `axes`: its axes in the second frame; `base`: its lowest corner in
  /// the first.
  [[nodiscard]] unsigned base(CubeSymmetry symmetry, unsigned base, unsigned axes) const noexcept {
    return permutations_[symmetry.permutation].spread[base] ^ (symmetry.flip & ~axes);
  }
  [[nodiscard]] bool is_mirror(CubeSymmetry symmetry) const noexcept {
    return permutations_[symmetry.permutation].is_odd != (std::popcount(symmetry.flip) % 2 != 0);
  }

  /// A symmetry to the frame of `signature` from a canonical one, in which upper halves have at least as many high
  /// corners as lower halves, with differences that do not increase from axis to axis. Equivalent signatures of
  /// half-spaces become equal there (R. O. Winder, Chow parameters in threshold logic, 1971); other equivalent
  /// signatures usually do.
  [[nodiscard]] CubeSymmetry to_frame_of(std::uint64_t signature) const noexcept {
    struct Weight {
      int more;
      std::uint8_t axis;
    };
    std::array<Weight, 6> weights;
    CubeSymmetry result;
    for (unsigned a = 0; a < n_; ++a) {
      const int more = 2 * std::popcount(signature & upper_half(a)) - std::popcount(signature);
      if (more < 0) result.flip = static_cast<std::uint8_t>(result.flip | 1u << a);
      weights[a] = {more < 0 ? -more : more, static_cast<std::uint8_t>(a)};
    }
    std::stable_sort(weights.begin(), weights.begin() + n_,
                     [](const Weight& x, const Weight& y) { return x.more > y.more; });
    // Number of the permutation in lexicographic order.
    unsigned number = 0;
    for (unsigned i = 0; i < n_; ++i) {
      unsigned smaller_later = 0;
      for (unsigned j = i + 1; j < n_; ++j) smaller_later += weights[j].axis < weights[i].axis ? 1 : 0;
      number = number * (n_ - i) + smaller_later;
    }
    result.permutation = static_cast<std::uint16_t>(number);
    return result;
  }

  /// Signature in the first frame that becomes `signature` in the second.
  [[nodiscard]] std::uint64_t before(CubeSymmetry symmetry, std::uint64_t signature) const noexcept {
    std::uint64_t result = 0;
    for (unsigned v = 0; v < 1u << n_; ++v) result |= (signature >> base(symmetry, v, 0) & 1u) << v;
    return result;
  }

 private:
  static constexpr std::span<const AxisPermutation> permutations_of(int n) noexcept {
    switch (n) {
      case 2:
        return kAxisPermutations<2>.all;
      case 3:
        return kAxisPermutations<3>.all;
      case 4:
        return kAxisPermutations<4>.all;
      default:
        return kAxisPermutations<5>.all;
    }
  }
  /// Corners v with (v >> axis & 1) set.
  static std::uint64_t upper_half(unsigned axis) noexcept {
    constexpr std::array<std::uint64_t, 6> kHalves = {0xaaaaaaaaaaaaaaaa, 0xcccccccccccccccc, 0xf0f0f0f0f0f0f0f0,
                                                      0xff00ff00ff00ff00, 0xffff0000ffff0000, 0xffffffff00000000};
    return kHalves[axis];
  }

  unsigned n_;
  std::span<const AxisPermutation> permutations_;  ///< in lexicographic order
};

}  // namespace tegl::detail
