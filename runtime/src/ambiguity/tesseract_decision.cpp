// SPDX-License-Identifier: BSD-3-Clause
//
// Resolves ambiguous 4D tiles one at a time and a word of tiles at a time.
#include "ambiguity/tesseract_decision.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include "ambiguity/connected_sides.hpp"
#include "ambiguity/cube_lists.hpp"
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

namespace {

/// Resolves the tiles of a word, one step for all of them after the other.
class WordResolver {
 public:
  WordResolver(const FaceEstimator<4>& estimator, const FaceBlock<4>& block, TesseractsOfWord& of) noexcept
      : estimator_(estimator), block_(block), of_(of), cubes_(ResolvedCubes::instance(estimator.triangulation())) {}

  void resolve() noexcept {
    find_cubes();
    if (decides_joins()) decide_joins();
    find_apart();
  }

 private:
  [[nodiscard]] bool decides_joins() const noexcept { return !estimator_.separates() && !estimator_.is_by_means(); }
  [[nodiscard]] const CubeListTable& lists() const noexcept {
    using Content = CubeListTable::Content;
    const Content by_centre = estimator_.is_by_means() ? Content::by_centre : Content::with_joins;
    return CubeListTable::instance(estimator_.separates() ? Content::separate : by_centre, estimator_.triangulation());
  }

  /// Squares, tiles and cubes; joins are not decided.
  void find_cubes() noexcept {
    const bool separates = estimator_.separates();
    of_.unsure = 0;
    for (std::size_t j = 0; j < of_.count; ++j) {
      const unsigned bit = of_.bits[j], signature = of_.signatures[j];
      const std::uint64_t high = block_.high[bit];
      of_.unsure |= (block_.unsure >> bit & 1u) << j;
      ResolvedKey& key = of_.tiles[j].key;
      key.signature = static_cast<std::uint16_t>(signature);
      key.squares = static_cast<std::uint32_t>(high) & 0xffffffu;
      const auto choice = (high >> kTesseractFace & 1u) != 0 ? tile::Choice::high : tile::Choice::low;
      key.tile = separates ? tile::Choice::separate : choice;
      const unsigned high_cubes = estimator_.is_by_means() ? static_cast<unsigned>(high >> kFirstCube<4>) & 255u : 0;
      faces_[j] = {cubes_.signatures(key.signature), cubes_.squares(key.squares), high_cubes};
    }
    find_lists(lists(), {faces_.data(), of_.count}, found_.data());
    for (std::size_t j = 0; j < of_.count; ++j) {
      ResolvedTile& tile = of_.tiles[j];
      tile.lists = found_[j].wanted;
      tile.with_vertices = found_[j].with_vertices;
      const unsigned with_choice = decides_joins() ? 0u : found_[j].with_choice;
      tile.key.high_cubes = static_cast<std::uint8_t>(with_choice & faces_[j].second);
      tile.key.low_cubes = static_cast<std::uint8_t>(with_choice & ~faces_[j].second);
    }
  }

  /// The entry of a cube in the table of resolved cubes.
  [[nodiscard]] unsigned entry_of(std::size_t j, unsigned cube) const noexcept { return found_[j].second[cube]; }

  /// Decides the centres of cubes by the trilinear interpolant. Those with one pair of edges are listed without
  /// branches; whether they join is decided for all together.
  void decide_joins() noexcept {
    std::array<std::uint16_t, 8 * kWordBits> asked;  // 8 * tile + cube
    std::size_t count = 0;
    for (std::size_t j = 0; j < of_.count; ++j) {
      for (unsigned f = 0; f < 8; ++f) {
        asked[count] = static_cast<std::uint16_t>(8 * j + f);
        count += found_[j].with_choice >> f & 1u;
      }
      unsigned with_more = found_[j].with_pairs;
      for (; with_more != 0; with_more &= with_more - 1) {
        const auto f = static_cast<unsigned>(std::countr_zero(with_more));
        std::array<double, 8> values;
        for (unsigned corner = 0; corner < 8; ++corner) values[corner] = value(j, f, corner);
        join_cube(j, f, detail::decide_centre(values, estimator_.isovalue(), entry_of(j, f)));
      }
    }
    for (std::size_t first = 0; first < count; first += JoinQuestions::kMost)
      ask_about({asked.data() + first, std::min(JoinQuestions::kMost, count - first)});
  }
  void ask_about(std::span<const std::uint16_t> asked) noexcept {
    JoinQuestions questions;
    for (const unsigned cube : asked)
      questions.add(join_of(cube), [&](unsigned corner) { return value(cube / 8, cube % 8, corner); });
    answer(questions, estimator_.isovalue());
    for (std::size_t q = 0; q < asked.size(); ++q) {
      const unsigned joined = 1u + unsigned{join_of(asked[q]).high};  // choices as numbers: separate, low, high
      const bool is_joined = questions.answers[q] == JoinQuestions::yes;
      of_.unsure |= std::uint64_t{questions.answers[q] == JoinQuestions::unsure} << (asked[q] / 8u);
      join_cube(asked[q] / 8u, asked[q] % 8u, static_cast<tile::Choice>(joined * static_cast<unsigned>(is_joined)));
    }
  }
  [[nodiscard]] const tables::CubeJoin& join_of(unsigned cube) const noexcept {
    return cube_joins()[entry_of(cube / 8, cube % 8)];
  }
  void join_cube(std::size_t j, unsigned f, tile::Choice choice) noexcept {
    ResolvedTile& tile = of_.tiles[j];
    const unsigned list = tile.lists[f] = cubes_.list_of_entry(entry_of(j, f), choice);
    const unsigned with_vertices = (cubes_.own_vertices(list) != 0 ? 1u : 0u) << f;
    tile.with_vertices = static_cast<std::uint8_t>((tile.with_vertices & ~(1u << f)) | with_vertices);
    const auto is_low = static_cast<unsigned>(choice == tile::Choice::low);
    const auto is_high = static_cast<unsigned>(choice == tile::Choice::high);
    tile.key.low_cubes = static_cast<std::uint8_t>(tile.key.low_cubes | is_low << f);
    tile.key.high_cubes = static_cast<std::uint8_t>(tile.key.high_cubes | is_high << f);
  }
  [[nodiscard]] double value(std::size_t j, unsigned cube, unsigned corner) const noexcept {
    static constexpr auto kAt = [] {
      std::array<std::array<std::uint16_t, 8>, 8> at{};
      for (unsigned f = 0; f < 8; ++f)
        for (unsigned v = 0; v < 8; ++v)
          at[f][v] = static_cast<std::uint16_t>((kCubesIn4D[f][v] >> 1) * FaceBlock<4>::kPitch + kCubesIn4D[f][v] % 2u);
      return at;
    }();
    return block_.samples[0].data()[kAt[cube][corner] + of_.bits[j]];
  }

  void find_apart() noexcept {
    BoundarySides sides;
    for (std::size_t j = 0; j < of_.count; ++j) {
      const ResolvedKey& key = of_.tiles[j].key;
      sides.add(key.signature, key.squares, key.high_cubes);
      sides.add(~std::uint32_t{key.signature}, ~key.squares, key.low_cubes);
    }
    find_connected(sides);
    for (std::size_t j = 0; j < of_.count; ++j) {
      const auto choice = of_.tiles[j].key.tile;
      const unsigned high = sides.apart[2 * j], low = sides.apart[2 * j + 1];
      // one of the sides is connected, and the other one is not joined by the tile's centre
      const bool is_high = low == 0 && high != BoundarySides::kScattered && (high == 0 || choice != tile::Choice::high);
      const bool is_low = high == 0 && low != BoundarySides::kScattered && choice != tile::Choice::low;
      of_.tiles[j].apart = is_high ? high : is_low ? low : ResolvedTesseract::kNotKnown;
    }
  }

  const FaceEstimator<4>& estimator_;
  const FaceBlock<4>& block_;
  TesseractsOfWord& of_;
  const ResolvedCubes& cubes_;
  std::array<WantedLists, kWordBits> faces_;
  std::array<FoundLists, kWordBits> found_;
};

}  // namespace

void resolve(const FaceEstimator<4>& estimator, const FaceBlock<4>& block, TesseractsOfWord& of) noexcept {
  WordResolver(estimator, block, of).resolve();
}

/// Lists the word's ambiguous tiles from `ordinal` on and, if they are many, resolves them.
void RowOfTesseracts::begin_word(std::size_t word, std::uint32_t ordinal) noexcept {
  const auto& ambiguous = ambiguous_signatures<4>();
  word_ = word;
  first_ = ordinal;
  of_word_.count = 0;
  for (std::uint32_t i = ordinal; i < tiles_.count && tiles_.at[i] / kWordBits == word; ++i) {
    const unsigned signature = tiles_.signatures[i];
    number_[i - ordinal] = static_cast<std::uint8_t>(of_word_.count);
    of_word_.bits[of_word_.count] = static_cast<std::uint8_t>(tiles_.at[i] % kWordBits);
    of_word_.signatures[of_word_.count] = static_cast<std::uint16_t>(signature);
    of_word_.count += ambiguous[signature] ? 1 : 0;
  }
  has_many_ = of_word_.count >= RowFaces<4>::kMany;
  if (has_many_) detail::resolve(estimator_, faces_.look_at(word), of_word_);
}

const ResolvedTile& RowOfTesseracts::resolve(const std::array<std::size_t, 4>& base, std::uint32_t ordinal,
                                             unsigned signature) noexcept {
  if (at_once_ && ambiguous_signatures<4>()[signature]) {
    if (base[0] / kWordBits != word_) begin_word(base[0] / kWordBits, ordinal);
    const std::size_t number = number_[ordinal - first_];
    if (has_many_ && (of_word_.unsure >> number & 1u) == 0) return of_word_.tiles[number];
  }
  return alone_ = resolved_tile(estimator_, base, signature);
}

}  // namespace tegl::detail
