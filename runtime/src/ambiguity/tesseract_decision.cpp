// SPDX-License-Identifier: BSD-3-Clause
//
// Resolves ambiguous 4D tiles one at a time and a word of tiles at a time.
#include "ambiguity/tesseract_decision.hpp"

#include <bit>
#include <utility>

#include "ambiguity/saddle.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

namespace {

/// Maps a set of squares of cube f of the tesseract to the set of the tesseract's squares.
constexpr auto kSquaresOfCubes = [] {
  std::array<std::array<std::uint32_t, 64>, 8> result{};
  for (unsigned f = 0; f < 8; ++f)
    for (unsigned square = 0; square < 6; ++square) {
      const unsigned axis = lifted_axis(f, square / 2);
      const unsigned base = (f % 2) << (f / 2) | (square % 2) << axis;
      const unsigned axes = 15u ^ 1u << (f / 2) ^ 1u << axis;
      for (unsigned q = 0; q < 24; ++q)
        if (kTesseractSquares[q].base == base && kTesseractSquares[q].axes == axes)
          for (unsigned set = 0; set < 64; ++set)
            if ((set >> square & 1u) != 0) result[f][set] |= 1u << q;
    }
  return result;
}();

/// Corners of a face of the tesseract, in the face's own order.
template <std::size_t Count>
constexpr std::array<std::uint8_t, Count> corners_in(unsigned base, unsigned axes) noexcept {
  std::array<std::uint8_t, Count> result{};
  unsigned corner = base;
  for (std::uint8_t& of_face : result) {
    of_face = static_cast<std::uint8_t>(corner);
    corner = base | (((corner | ~axes) + 1) & axes);  // the next subset of the axes
  }
  return result;
}

/// Corners of the tesseract's squares and cubes.
constexpr auto kSquaresIn4D = [] {
  std::array<std::array<std::uint8_t, 4>, 24> result{};
  for (unsigned q = 0; q < 24; ++q) result[q] = corners_in<4>(kTesseractSquares[q].base, kTesseractSquares[q].axes);
  return result;
}();
constexpr auto kCubesIn4D = [] {
  std::array<std::array<std::uint8_t, 8>, 8> result{};
  for (unsigned f = 0; f < 8; ++f) result[f] = corners_in<8>((f % 2) << (f / 2), 15u ^ 1u << (f / 2));
  return result;
}();

template <std::size_t Count>
std::array<double, Count> values_at(const std::array<double, 16>& values,
                                    const std::array<std::uint8_t, Count>& corners) noexcept {
  return [&]<std::size_t... C>(std::index_sequence<C...>) { return std::array<double, Count>{values[corners[C]]...}; }
  (std::make_index_sequence<Count>());
}

std::array<std::size_t, 4> moved(std::array<std::size_t, 4> base, unsigned corner) noexcept {
  for (unsigned a = 0; a < 4; ++a) base[a] += corner >> a & 1u;
  return base;
}

}  // namespace

/// A tile without anything to decide.
static ResolvedTile settled_tile(const ResolvedCubes& cubes, unsigned signature) noexcept {
  ResolvedTile tile;
  tile.key.signature = static_cast<std::uint16_t>(signature);
  const std::uint64_t signatures = cubes.signatures(tile.key.signature);
  for (unsigned f = 0; f < 8; ++f) {
    tile.cubes[f] = static_cast<std::uint16_t>(signatures >> (8 * f) & 255);
    tile.lists[f] = cubes.list(tile.cubes[f], 0, tile::Choice::separate);
    if (cubes.own_vertices(tile.lists[f]) != 0)
      tile.with_vertices = static_cast<std::uint8_t>(tile.with_vertices | 1u << f);
  }
  return tile;
}

ResolvedTile resolved_tile(const FaceEstimator<4>& estimator, const std::array<std::size_t, 4>& base,
                           unsigned signature) noexcept {
  const auto& table = tables::kTile3Resolved;
  const ResolvedCubes& cubes = ResolvedCubes::instance(estimator.triangulation());
  if (!ambiguous_signatures<4>()[signature]) return settled_tile(cubes, signature);
  const auto& ambiguous_cubes = ambiguous_signatures<3>();
  std::array<double, 16> values;
  estimator.source().corner_values(base, 15, values.data());
  const std::uint64_t signatures = cubes.signatures(static_cast<std::uint16_t>(signature));
  // decide the ambiguous squares
  std::uint32_t ambiguous = 0;
  for (unsigned f = 0; f < 8; ++f)
    ambiguous |= kSquaresOfCubes[f][table.ambiguous_squares[signatures >> (8 * f) & 255]];
  ResolvedTile tile;
  tile.key.signature = static_cast<std::uint16_t>(signature);
  for (; ambiguous != 0; ambiguous &= ambiguous - 1) {
    const auto q = static_cast<unsigned>(std::countr_zero(ambiguous));
    const auto [corner, axes] = kTesseractSquares[q];
    const std::uint32_t is_high =
        estimator.is_square_high(moved(base, corner), axes, values_at(values, kSquaresIn4D[q])) ? 1 : 0;
    tile.key.squares |= is_high << q;
  }
  // decide the cubes
  const std::uint64_t squares = cubes.squares(tile.key.squares);
  for (unsigned f = 0; f < 8; ++f) {
    const auto in_cube = static_cast<unsigned>(signatures >> (8 * f) & 255);
    tile.cubes[f] = static_cast<std::uint16_t>(in_cube);
    tile.lists[f] = cubes.list_of_entry(table.first_entry[in_cube], tile::Choice::separate);
    if (!ambiguous_cubes[in_cube]) continue;
    const unsigned r =
        packed_squares(static_cast<unsigned>(squares >> (8 * f) & 255), table.ambiguous_squares[in_cube]);
    auto choice = tile::Choice::separate;
    if (table.entries[table.first_entry[in_cube] + r].components > 1) {
      const unsigned corner = (f % 2) << (f / 2);
      const unsigned axes = 15u ^ 1u << (f / 2);
      choice = estimator.choice(moved(base, corner), axes, values_at(values, kCubesIn4D[f]));
    }
    tile.cubes[f] = CubeKey(in_cube, r, choice).bits();
    tile.lists[f] = cubes.list_of_entry(table.first_entry[in_cube] + r, choice);
    if (choice == tile::Choice::low) tile.key.low_cubes = static_cast<std::uint8_t>(tile.key.low_cubes | 1u << f);
    if (choice == tile::Choice::high) tile.key.high_cubes = static_cast<std::uint8_t>(tile.key.high_cubes | 1u << f);
  }
  // cubes with vertices, and the tile itself
  for (unsigned f = 0; f < 8; ++f)
    if (cubes.own_vertices(tile.lists[f]) != 0)
      tile.with_vertices = static_cast<std::uint8_t>(tile.with_vertices | 1u << f);
  tile.key.tile = estimator.choice(base, 15, values);
  return tile;
}

/// Decides the centres of a tile's cubes by the trilinear interpolant. `entries`: of its cubes. Returns false if
/// rounding could decide.
static bool decide_centres(const FaceBlock<4>& block, unsigned bit, double isovalue,
                           const std::array<std::uint16_t, 8>& entries, std::array<tile::Choice, 8>& choices) noexcept {
  const auto& joins = cube_joins();
  const auto value = [&](unsigned f, unsigned corner) {
    const unsigned of_tile = kCubesIn4D[f][corner];
    return block.samples[of_tile >> 1][bit + (of_tile & 1u)];
  };
  // collect questions about cubes with one pair, decide cubes with several
  JoinQuestions questions;
  std::array<std::uint8_t, 8> asked;
  for (unsigned f = 0; f < 8; ++f) {
    const CubeJoin& join = joins[entries[f]];
    if (join.pairs == 1) {
      for (std::size_t e = 0; e < 8; ++e) questions.ends[e][questions.count] = value(f, join.corners[e]);
      questions.sign[questions.count] = join.high ? 1.0 : -1.0;
      asked[questions.count++] = static_cast<std::uint8_t>(f);
    } else if (join.pairs > 1) {
      std::array<double, 8> values;
      for (unsigned corner = 0; corner < 8; ++corner) values[corner] = value(f, corner);
      choices[f] = detail::decide_centre(values, isovalue, entries[f]);
    }
  }
  // apply the answers
  answer(questions, isovalue);
  for (std::size_t q = 0; q < questions.count; ++q) {
    if (questions.answers[q] == JoinQuestions::unsure) return false;
    const auto joined = joins[entries[asked[q]]].high ? tile::Choice::high : tile::Choice::low;
    if (questions.answers[q] == JoinQuestions::yes) choices[asked[q]] = joined;
  }
  return true;
}

bool resolve(const FaceEstimator<4>& estimator, const FaceBlock<4>& block, unsigned bit, unsigned signature,
             ResolvedTile& tile) noexcept {
  if (block.unsure[bit] != 0) return false;
  const ResolvedCubes& cubes = ResolvedCubes::instance(estimator.triangulation());
  const std::uint64_t high = block.high[bit];
  tile.key = {};
  tile.key.signature = static_cast<std::uint16_t>(signature);
  tile.key.squares = static_cast<std::uint32_t>(high) & 0xffffffu;
  const bool separates = estimator.separates();
  if (!separates) tile.key.tile = (high >> kTesseractFace & 1u) != 0 ? tile::Choice::high : tile::Choice::low;
  const std::uint64_t signatures = cubes.signatures(tile.key.signature), squares = cubes.squares(tile.key.squares);
  const auto entry_of = [&](unsigned f) {
    return cubes.entry(static_cast<unsigned>(signatures >> (8 * f) & 255),
                       static_cast<unsigned>(squares >> (8 * f) & 63));
  };
  // choices and lists of the cubes
  unsigned low = 0, joined = 0;
  if (separates) {
    for (unsigned f = 0; f < 8; ++f) tile.lists[f] = cubes.list_of_entry(entry_of(f), tile::Choice::separate);
  } else if (estimator.is_by_means()) {
    unsigned with_choice = 0;
    const auto high_cubes = static_cast<unsigned>(high >> kFirstCube<4>);
    for (unsigned f = 0; f < 8; ++f) {
      const ResolvedCubes::Entry entry = cubes.at_entry(entry_of(f));
      tile.lists[f] = entry.lists[entry.has_choice * (1 + (high_cubes >> f & 1u))];
      with_choice |= unsigned{entry.has_choice} << f;
    }
    joined = with_choice & high_cubes;
    low = with_choice & ~high_cubes;
  } else {
    std::array<std::uint16_t, 8> entries;
    std::array<tile::Choice, 8> choices{};
    for (unsigned f = 0; f < 8; ++f) entries[f] = static_cast<std::uint16_t>(entry_of(f));
    if (!decide_centres(block, bit, estimator.isovalue(), entries, choices)) return false;
    for (unsigned f = 0; f < 8; ++f) {
      low |= (choices[f] == tile::Choice::low ? 1u : 0u) << f;
      joined |= (choices[f] == tile::Choice::high ? 1u : 0u) << f;
      tile.lists[f] = cubes.list_of_entry(entries[f], choices[f]);
    }
  }
  tile.key.low_cubes = static_cast<std::uint8_t>(low);
  tile.key.high_cubes = static_cast<std::uint8_t>(joined);
  unsigned with_vertices = 0;  // without branches: few cubes have vertices, which is hard to predict
  for (unsigned f = 0; f < 8; ++f) with_vertices |= (cubes.own_vertices(tile.lists[f]) != 0 ? 1u : 0u) << f;
  tile.with_vertices = static_cast<std::uint8_t>(with_vertices);
  for (unsigned rest = with_vertices; rest != 0; rest &= rest - 1) {
    const auto f = static_cast<unsigned>(std::countr_zero(rest));
    tile.cubes[f] = cubes.key(tile.lists[f]);
  }
  return true;
}

ResolvedTile RowOfTesseracts::resolve(const std::array<std::size_t, 4>& base, std::uint32_t ordinal,
                                      unsigned signature) noexcept {
  if (!at_once_ || !ambiguous_signatures<4>()[signature]) return resolved_tile(estimator_, base, signature);
  const std::size_t word = base[0] / kWordBits;
  if (word != word_) {
    word_ = word;
    const auto& ambiguous = ambiguous_signatures<4>();
    std::size_t found = 0;
    for (std::uint32_t i = ordinal; i < tiles_.count && tiles_.at[i] / kWordBits == word; ++i)
      found += ambiguous[tiles_.signatures[i]] ? 1 : 0;
    has_many_ = found >= RowFaces<4>::kMany;
  }
  ResolvedTile tile;
  if (has_many_ && detail::resolve(estimator_, faces_.look_at(word), base[0] % kWordBits, signature, tile)) return tile;
  return resolved_tile(estimator_, base, signature);
}

}  // namespace tegl::detail
