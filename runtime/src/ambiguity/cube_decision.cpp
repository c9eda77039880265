// SPDX-License-Identifier: BSD-3-Clause
//
// Resolves ambiguous squares and cubes one at a time and a word of tiles at a time.
#include "ambiguity/cube_decision.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "ambiguity/face_decision.hpp"
#include "ambiguity/saddle.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

template <>
unsigned resolved_key<2>(const FaceEstimator<2>& estimator, const std::array<std::size_t, 2>& base,
                         unsigned signature) noexcept {
  std::array<double, 4> values;
  estimator.source().corner_values(base, 3, values.data());
  return signature | (estimator.is_square_high(base, 3, values) ? 16u : 0u);
}

namespace {

/// By the face's axes: the axis of the image for axis number `axis` of the face.
constexpr auto kAxesOf = [] {
  std::array<std::array<std::uint8_t, 4>, 16> result{};
  for (unsigned axes = 0; axes < 16; ++axes)
    for (unsigned a = 0, number = 0; a < 4; ++a)
      if ((axes >> a & 1u) != 0) result[axes][number++] = static_cast<std::uint8_t>(a);
  return result;
}();

/// Corners of square 2 * across + side of a cube.
constexpr auto kCornersOfSquares = [] {
  std::array<std::array<std::uint8_t, 4>, 6> result{};
  for (unsigned square = 0; square < 6; ++square)
    for (unsigned c = 0; c < 4; ++c) result[square][c] = static_cast<std::uint8_t>(lifted_corner(square, c));
  return result;
}();

/// Sums of pairs of values at corners that differ along an axis.
template <unsigned Axis, std::size_t Count>
std::array<double, Count / 2> sums_along(const std::array<double, Count>& values) noexcept {
  constexpr std::size_t kStep = std::size_t{1} << Axis;
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<double, Count / 2>{(values[unsqueeze(I, Axis)] + values[unsqueeze(I, Axis) | kStep])...};
  }
  (std::make_index_sequence<Count / 2>());
}

/// Signs of the means of a cube's squares (bits 0 to 5) and of the cube (bit 6), and those that rounding could decide.
/// Without branches, which would be mispredicted in noise.
struct CubeMeans {
  unsigned high = 0, unsure = 0;

  CubeMeans(std::span<const double, 8> values, double isovalue) noexcept {
    std::array<double, 8> corners, sizes;
    for (std::size_t v = 0; v < 8; ++v) {
      corners[v] = values[v];
      sizes[v] = std::abs(values[v]);
    }
    const auto along_0 = sums_along<0>(corners), along_1 = sums_along<1>(corners);
    const auto across_0 = sums_along<1>(along_1), across_1 = sums_along<1>(along_0), across_2 = sums_along<0>(along_0);
    const std::array<double, 7> sums = {
        across_0[0], across_0[1], across_1[0], across_1[1], across_2[0], across_2[1], across_2[0] + across_2[1]};
    const double limit = 4.0 * isovalue;
    const double size = sums_along<0>(sums_along<0>(sums_along<0>(sizes)))[0] + 2.0 * std::abs(limit);
    // A bound of all rounding errors; infinite if values are too large or not finite.
    const double bound = size < 0x1p1000 ? 0x1p-46 * size : std::numeric_limits<double>::infinity();
    [&]<std::size_t... Q>(std::index_sequence<Q...>) {
      const auto take = [&](unsigned q, double difference) {
        high |= (difference > 0.0 ? 1u : 0u) << q;
        unsure |= (std::abs(difference) > bound ? 0u : 1u) << q;
      };
      (take(Q, sums[Q] - (Q < 6 ? limit : 2.0 * limit)), ...);
    }
    (std::make_index_sequence<7>());
  }
};

/// Decides the squares of a cube with an ambiguous signature, and its centre unless `separates`, by means. Returns
/// false if rounding could decide.
bool decide_by_means(std::span<const double, 8> values, double isovalue, unsigned signature, bool separates,
                     CubeDecision& decision) noexcept {
  const auto& table = tables::kTile3Resolved;
  const unsigned ambiguous = table.ambiguous_squares[signature];
  const CubeMeans means(values, isovalue);
  const unsigned r = packed_squares(means.high, ambiguous);
  const bool has_choice = !separates && table.entries[table.first_entry[signature] + r].components > 1;
  decision.high_squares = static_cast<std::uint8_t>(means.high & ambiguous);
  const auto centre = (means.high >> 6) != 0 ? tile::Choice::high : tile::Choice::low;
  decision.centre = has_choice ? centre : tile::Choice::separate;
  return (means.unsure & (ambiguous | (has_choice ? 64u : 0u))) == 0;
}

/// Decides face by face: `is_high(square, values)` decides an ambiguous square, `centre()` the interior.
template <class IsHigh, class Centre>
CubeDecision decide_faces(std::span<const double, 8> values, unsigned signature, const IsHigh& is_high,
                          const Centre& centre) noexcept {
  CubeDecision decision;
  const auto& table = tables::kTile3Resolved;
  const unsigned ambiguous = table.ambiguous_squares[signature];
  for (unsigned rest = ambiguous; rest != 0; rest &= rest - 1) {
    const auto square = static_cast<unsigned>(std::countr_zero(rest));
    const auto& of_square = kCornersOfSquares[square];
    const std::array<double, 4> corners = {values[of_square[0]], values[of_square[1]], values[of_square[2]],
                                           values[of_square[3]]};
    const unsigned bit = is_high(square, corners) ? 1 : 0;
    decision.high_squares = static_cast<std::uint8_t>(decision.high_squares | bit << square);
  }
  const unsigned r = packed_squares(decision.high_squares, ambiguous);
  if (table.entries[table.first_entry[signature] + r].components > 1) decision.centre = centre();
  return decision;
}

/// Decides the squares and the interior of a cube with an ambiguous signature by its values.
CubeDecision decide_by_values(FaceRule rule, std::span<const double, 8> values, double isovalue,
                              unsigned signature) noexcept {
  if (rule.by == FaceRule::By::saddles) {
    std::array<double, 8> corners;
    std::copy(values.begin(), values.end(), corners.begin());
    return rule.separates ? detail::decide_squares(corners, isovalue, signature)
                          : detail::decide_cube(corners, isovalue, signature);
  }
  CubeDecision decision;
  if (decide_by_means(values, isovalue, signature, rule.separates, decision)) return decision;
  return decide_faces(
      values, signature, [&](unsigned, const auto& corners) { return is_mean_high(corners, isovalue); },
      [&] {
        if (rule.separates) return tile::Choice::separate;
        return is_mean_high(values, isovalue) ? tile::Choice::high : tile::Choice::low;
      });
}

/// The same, also by a caller's estimator.
template <int N>
CubeDecision decide(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base, unsigned axes,
                    std::span<const double, 8> values, unsigned signature) noexcept {
  if (!estimator.is_callers()) {
    const FaceRule rule{estimator.is_by_saddles() ? FaceRule::By::saddles : FaceRule::By::means, estimator.separates()};
    return decide_by_values(rule, values, estimator.isovalue(), signature);
  }
  return decide_faces(
      values, signature,
      [&](unsigned square, const auto& corners) {
        const unsigned axis = kAxesOf[axes][square / 2];
        auto at = base;
        at[axis] += square % 2;
        return estimator.is_square_high(at, axes ^ 1u << axis, corners);
      },
      [&] { return estimator.choice(base, axes, values); });
}

CubeKey key_of(unsigned signature, const CubeDecision& decision) noexcept {
  const unsigned ambiguous = tables::kTile3Resolved.ambiguous_squares[signature];
  const unsigned r = packed_squares(decision.high_squares, ambiguous);
  return {signature, r, decision.centre};
}

}  // namespace

template <int N>
CubeKey cube_key(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base, unsigned axes,
                 unsigned signature) noexcept {
  if (!ambiguous_signatures<3>()[signature]) return CubeKey(signature);
  std::array<double, 8> values;
  estimator.source().corner_values(base, axes, values.data());
  return key_of(signature, decide<N>(estimator, base, axes, values, signature));
}
template CubeKey cube_key<3>(const FaceEstimator<3>&, const std::array<std::size_t, 3>&, unsigned, unsigned) noexcept;
template CubeKey cube_key<4>(const FaceEstimator<4>&, const std::array<std::size_t, 4>&, unsigned, unsigned) noexcept;

CubeKey cube_key(FaceRule rule, std::span<const double, 8> values, double isovalue, unsigned signature) noexcept {
  if (!ambiguous_signatures<3>()[signature]) return CubeKey(signature);
  return key_of(signature, decide_by_values(rule, values, isovalue, signature));
}

bool is_square_high(FaceRule rule, std::span<const double, 4> values, double isovalue) noexcept {
  if (rule.by == FaceRule::By::means) return is_mean_high(values, isovalue);
  return tegl::square_is_high<double>(values, isovalue);
}

template <>
unsigned resolved_key<3>(const FaceEstimator<3>& estimator, const std::array<std::size_t, 3>& base,
                         unsigned signature) noexcept {
  return cube_key<3>(estimator, base, 7, signature).bits();
}

template <int N>
const FaceBlock<N>& RowFaces<N>::look_at(std::size_t word) noexcept {
  if (word == word_) return block_;
  word_ = word;
  base_[0] = word * kWordBits;
  const std::size_t count = std::min(block_.kSamples, samples_ - base_[0]);
  block_.tiles = count - 1;
  estimator_.source().corner_rows(base_, count, block_.samples[0].data(), block_.kPitch);
  // the rest of the last register, of at most 16 lanes, and the sample after it
  static_assert(FaceBlock<N>::kSamples + 15 <= FaceBlock<N>::kPitch);
  for (auto& row : block_.samples) std::fill_n(row.data() + count, 15, 0.0);
  if (estimator_.is_by_means())
    decide_by_means(block_, estimator_.isovalue());
  else
    decide_by_saddles(block_, estimator_.isovalue());
  return block_;
}
template class RowFaces<3>;
template class RowFaces<4>;

namespace {

/// Values at the corners of a cube of a block, along `Axes` and based at corner `base` of tile `bit`.
template <int N, unsigned Axes>
std::array<double, 8> corners_of_cube(const FaceBlock<N>& block, unsigned bit, unsigned base) noexcept {
  std::array<double, 8> values;
  unsigned corner = base;
  for (double& value : values) {
    value = block.samples[corner >> 1][bit + (corner & 1u)];
    corner = base | (((corner | ~Axes) + 1) & Axes);
  }
  return values;
}

/// The questions with this answer, yes or unsure, as bits; those past the last question have no meaning.
Word with_answer(const JoinQuestions& questions, JoinQuestions::Answer answer) noexcept {
  static_assert(JoinQuestions::no == 0 && JoinQuestions::yes == 1 && JoinQuestions::unsure == 2);
  Word found = 0;
  for (std::size_t i = 0; i < JoinQuestions::kMost; i += 8) {
    std::uint64_t eight = 0;  // the first one lowest, whatever the order of bytes
    for (std::size_t j = 0; j < 8; ++j) eight |= std::uint64_t{questions.answers[i + j]} << (8 * j);
    const std::uint64_t chosen = eight >> (answer / 2) & 0x0101010101010101u;
    found |= chosen * 0x0102040810204080u >> 56 << i;
  }
  return found;
}

/// Decides the centres of cubes by the trilinear interpolant. Returns those that rounding could decide.
Word join(const FaceBlock<3>& block, double isovalue, const RowTable& table, const CubesByPairs& open,
          CubesOfWord& cubes) noexcept {
  const auto choose = [&](const OpenCubes& of, std::size_t i, unsigned choice) {
    cubes.change(of.numbers[i], table.variant(of.entries[i], 0), table.variant(of.entries[i], choice));
  };
  for (std::size_t i = 0; i < open.with_more.count; ++i) {
    const auto values = corners_of_cube<3, 7>(block, open.with_more.places[i], 0);
    choose(open.with_more, i, static_cast<unsigned>(decide_centre(values, isovalue, open.with_more.entries[i])));
  }
  if (open.with_one.count == 0) return 0;
  JoinQuestions questions;
  ask(block, open.with_one, questions);
  answer(questions, isovalue);
  const Word asked = ~Word{0} >> (kWordBits - open.with_one.count);
  for (Word rest = with_answer(questions, JoinQuestions::yes) & asked; rest != 0; rest &= rest - 1) {
    const auto q = static_cast<std::size_t>(std::countr_zero(rest));
    choose(open.with_one, q, 1u + unsigned{cube_joins()[open.with_one.entries[q]].high});  // separate, low, high
  }
  Word unsure = 0;
  for (Word rest = with_answer(questions, JoinQuestions::unsure) & asked; rest != 0; rest &= rest - 1)
    unsure |= Word{1} << open.with_one.numbers[static_cast<std::size_t>(std::countr_zero(rest))];
  return unsure;
}

/// The tiles in `ambiguous` (by number among the active tiles) that are at the positions `at`.
Word numbers_of(Word at, const CubesOfWord& cubes) noexcept {
  Word numbers = 0;
  for (Word rest = cubes.ambiguous; rest != 0; rest &= rest - 1) {
    const auto number = static_cast<unsigned>(std::countr_zero(rest));
    numbers |= (at >> (cubes.at[number] % kWordBits) & 1u) << number;
  }
  return numbers;
}

}  // namespace

Word resolve(const FaceEstimator<3>& estimator, const RowTable& table, const FaceBlock<3>& block,
             CubesOfWord& cubes) noexcept {
  // Cubes are decided by means, by the interpolant, or not at all.
  const CentreRule by_rule = estimator.is_by_means() ? CentreRule::by_bit : CentreRule::by_joins;
  const CentreRule rule = estimator.separates() ? CentreRule::separate : by_rule;
  CubesByPairs open;
  choose_variants(block.high.data(), table.variants, rule, cubes, open);
  const Word unsure = block.unsure == 0 ? 0 : numbers_of(block.unsure, cubes);
  return unsure | (rule == CentreRule::by_joins ? join(block, estimator.isovalue(), table, open, cubes) : 0);
}

}  // namespace tegl::detail
