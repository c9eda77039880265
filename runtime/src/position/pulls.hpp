// SPDX-License-Identifier: BSD-3-Clause
//
// How strongly the samples beside both ends of an edge pull its vertex across the edge, for gravitation (see
// gravitation.hpp): in each direction j, G_j = [b high] - [a high] + [d low] - [c low], from -2 to 2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "position/critical_edges.hpp"
#include "position/placed_source.hpp"

namespace tegl::detail {

/// The pulls in all directions across an edge as one number, with digits of base 5. Directions are in the order of
/// their axes, without the axis of the edge.
template <int N>
struct PullNumbers {
  static constexpr std::size_t kDirections = N - 1;
  static constexpr std::array<std::size_t, N> kDigits = [] {
    std::array<std::size_t, N> digits{1};
    for (std::size_t j = 1; j < N; ++j) digits[j] = 5 * digits[j - 1];
    return digits;
  }();
  static constexpr std::size_t kCount = kDigits[kDirections];
  /// The pull in direction `j` of a number.
  static constexpr int pull(std::size_t number, std::size_t j) { return static_cast<int>(number / kDigits[j] % 5) - 2; }
};

/// The pulls on edges along `Axis` that start in one layer. Nothing pulls vertices off the border. Missing samples
/// count as samples on the side of the end.
template <int N, int Axis>
class PullsInLayer {
 public:
  PullsInLayer(const SampleSigns<N>& signs, const LayerRows<N>& rows, std::size_t k)
      : signs_(signs), rows_(rows), k_(k), pitch_(signs.row_bytes()), bits_(signs.bytes_before(k * rows.size())) {
    for (int j = 0; j < N; ++j) {
      inner_[j] = signs.sizes()[j] - 2;
      if (j != 0) steps_[j] = signs.stride(j) * pitch_;
    }
    to_upper_ = Axis == 0 ? 0 : steps_[Axis];
    if (is_on_border(N - 1, k)) steps_[N - 1] = 0;  // the sum is 0, too
  }

  /// The number of the pulls on the edge from sample `at` of a row of the layer.
  template <bool AnyMissing>
  [[nodiscard]] std::size_t number(std::size_t row, std::size_t at) const noexcept {
    if constexpr (AnyMissing) return number_by_sample(row, at);
    if constexpr (Axis != 0)
      if (is_on_border(0, at)) [[unlikely]]
        return number_by_sample(row, at);
    for (int j = 1; j < N - 1; ++j)
      if (j != Axis && is_on_border(j, rows_.start(row)[j])) [[unlikely]]
        return number_by_sample(row, at);
    return number_by_bits(row, at);
  }

 private:
  using Numbers = PullNumbers<N>;

  [[nodiscard]] bool is_on_border(int axis, std::size_t i) const noexcept { return i - 1 >= inner_[axis]; }

  [[nodiscard]] std::size_t number_by_bits(std::size_t row, std::size_t at) const noexcept {
    // three samples, from the one before the lower end on
    const std::size_t before = at + kWordBits - 1;
    const std::byte* const lower = bits_ + (row * pitch_ + before / 8);
    const std::byte* const upper = lower + to_upper_;
    const auto samples = [&](const std::byte* from) {
      std::uint32_t word;
      std::memcpy(&word, from, sizeof(word));
      return word >> (before % 8);
    };
    const std::uint32_t ends = samples(lower);
    std::size_t number = Axis == 0 ? 0 : kAlongRow[(ends & 7u) | (samples(upper) & 7u) << 3];
    int digit = Axis == 0 ? 0 : 1;
    for (int j = 1; j < N; ++j) {
      if (j == Axis) continue;
      std::uint32_t sides = ends & 2u;
      if constexpr (Axis == 0) {
        sides += 2 * (samples(lower + steps_[j]) & 6u) + 8 * (samples(lower - steps_[j]) & 6u);
      } else {
        sides += 2 * (samples(lower + steps_[j]) & 2u) + 4 * (samples(upper + steps_[j]) & 2u);
        sides += 8 * (samples(lower - steps_[j]) & 2u) + 16 * (samples(upper - steps_[j]) & 2u);
      }
      number += Numbers::kDigits[digit++] * kAcrossRows[sides];
    }
    return number;
  }
  /// The same at the border and beside missing samples.
  [[nodiscard, gnu::noinline]] std::size_t number_by_sample(std::size_t row, std::size_t at) const noexcept {
    const SampleIndex<N> index = rows_.index(k_, row, at);
    const std::size_t lower = k_ * rows_.size() + row;
    const bool high = signs_.is_high(lower, at);
    std::size_t number = 0;
    int digit = 0;
    for (int j = 0; j < N; ++j) {
      if (j == Axis) continue;
      int pull = 0;
      const std::size_t across = j == 0 ? 0 : signs_.stride(j), along = j == 0 ? 1 : 0;
      for (std::size_t end = 0; end < (is_on_border(j, index[j]) ? 0u : 2u); ++end) {
        const std::size_t of_end = Axis == 0 ? lower : lower + end * signs_.stride(Axis);
        const std::size_t place = Axis == 0 ? at + end : at;
        const auto is_alike = [&](std::size_t r, std::size_t i) {
          return signs_.is_missing(r, i) || signs_.is_high(r, i) == (high != (end == 1)) ? 1 : 0;
        };
        pull += is_alike(of_end + across, place + along) - is_alike(of_end - across, place - along);
      }
      number += Numbers::kDigits[digit++] * static_cast<std::size_t>(pull + 2);
    }
    return number;
  }

  /// The pull, plus 2, by bits of the sides of samples: bit 1 is the side of the lower end; `ahead` and `behind` are
  /// the bits of the samples beside the lower and beside the upper end.
  static constexpr std::array<std::uint8_t, 64> pulls(std::array<unsigned, 2> ahead, std::array<unsigned, 2> behind) {
    std::array<std::uint8_t, 64> pulls{};
    for (unsigned sides = 0; sides < pulls.size(); ++sides) {
      const auto side = [&](unsigned bit) { return static_cast<int>(sides >> bit & 1u); };
      const int of_high = side(ahead[0]) - side(behind[0]) - side(ahead[1]) + side(behind[1]);  // for a high lower end
      pulls[sides] = static_cast<std::uint8_t>(side(1) != 0 ? 2 + of_high : 2 - of_high);
    }
    return pulls;
  }
  static constexpr auto kAlongRow = pulls({2, 5}, {0, 3}), kAcrossRows = pulls({2, 3}, {4, 5});

  const SampleSigns<N>& signs_;
  const LayerRows<N>& rows_;
  std::size_t k_;
  std::size_t pitch_;                   ///< bytes of a row
  const std::byte* bits_;               ///< a word before the first row of the layer
  SampleIndex<N> inner_{};              ///< samples along each axis without those on the border
  std::array<std::size_t, N> steps_{};  ///< bytes to the neighbouring row
  std::size_t to_upper_;                ///< bytes from the row of the lower ends to the row of the upper ends
};

}  // namespace tegl::detail
