// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of resolved squares and cubes; see tile_variants.hpp.
#include "tile_variants.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "tegl/generated/tables.hpp"

namespace tegl::detail {
namespace {

/// Triangles of local vertices, three each, with own vertices by mask (tables::ResolvedList).
struct Polygons {
  static constexpr unsigned kFirstOwn = tables::first_tile_vertex(3);
  std::vector<std::uint8_t> triangles;
  unsigned cones = 0;  ///< of the own vertices, the first so many are barycentres
  std::vector<std::uint64_t> masks;

  explicit Polygons(const tables::ResolvedList& list) {
    const auto& table = tables::kTile3Resolved;
    const std::uint8_t* const first = table.triangles + std::size_t{list.first_triangle} * 3;
    triangles.assign(first, first + std::size_t{list.triangle_count} * 3);
    masks.assign(table.masks + list.first_mask, table.masks + list.first_mask + list.own_vertices);
  }
};

/// The triangles of each connected part.
std::vector<std::vector<std::uint8_t>> parts_of(const std::vector<std::uint8_t>& triangles) {
  std::array<std::uint8_t, 256> part{};
  for (unsigned v = 0; v < part.size(); ++v) part[v] = static_cast<std::uint8_t>(v);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      const std::uint8_t least = std::min({part[triangles[t]], part[triangles[t + 1]], part[triangles[t + 2]]});
      for (std::size_t j = t; j < t + 3; ++j) {
        changed = changed || part[triangles[j]] != least;
        part[triangles[j]] = least;
      }
    }
  }
  std::map<std::uint8_t, std::vector<std::uint8_t>> parts;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    parts[part[triangles[t]]].insert(parts[part[triangles[t]]].end(), &triangles[t], &triangles[t] + 3);
  std::vector<std::vector<std::uint8_t>> result;
  for (auto& [least, of_part] : parts) result.push_back(std::move(of_part));
  return result;
}

/// The edges around a connected part, each in its direction; none unless it is a disc.
std::vector<std::pair<std::uint8_t, std::uint8_t>> outline(const std::vector<std::uint8_t>& triangles) {
  std::set<std::uint8_t> vertices(triangles.begin(), triangles.end());
  std::set<std::pair<std::uint8_t, std::uint8_t>> directed;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    for (std::size_t j = 0; j < 3; ++j) directed.emplace(triangles[t + j], triangles[t + (j + 1) % 3]);
  std::vector<std::pair<std::uint8_t, std::uint8_t>> around;
  for (const auto& [from, to] : directed)
    if (!directed.contains({to, from})) around.emplace_back(from, to);
  const auto edges = (directed.size() + around.size()) / 2;
  const auto euler = static_cast<long>(vertices.size() + triangles.size() / 3) - static_cast<long>(edges);
  if (euler != 1) around.clear();
  return around;
}

/// The bits of a set of squares where those of another one, `ambiguous`, are set, pushed together.
constexpr auto kPackedSquares = [] {
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

unsigned packed_squares(unsigned squares, unsigned ambiguous) noexcept {
  return kPackedSquares[ambiguous][squares & 63u];
}

/// Cones every disc of more than a triangle from its barycentre. What is no disc stays as it is.
void cone_discs(Polygons& polygons) {
  constexpr unsigned kFirstOwn = Polygons::kFirstOwn;
  std::vector<std::vector<std::uint8_t>> kept;
  std::vector<std::uint8_t> triangles;
  for (std::vector<std::uint8_t>& part : parts_of(polygons.triangles)) {
    const auto around = outline(part);
    if (around.empty()) {
      kept.push_back(std::move(part));
    } else if (around.size() == 3) {
      triangles.insert(triangles.end(), part.begin(), part.end());
    } else {
      const auto apex = static_cast<std::uint8_t>(kFirstOwn + polygons.cones++);
      for (const auto& [from, to] : around) triangles.insert(triangles.end(), {apex, from, to});
    }
  }
  std::vector<std::uint64_t> masks;
  std::map<std::uint8_t, std::uint8_t> number;
  for (const std::vector<std::uint8_t>& part : kept)
    for (const std::uint8_t v : part) {
      if (v >= kFirstOwn && number.try_emplace(v, kFirstOwn + polygons.cones + masks.size()).second)
        masks.push_back(polygons.masks[v - kFirstOwn]);
      triangles.push_back(v < kFirstOwn ? v : number.at(v));
    }
  polygons.triangles = std::move(triangles);
  polygons.masks = std::move(masks);
}

}  // namespace

template <int N>
VariantTable<N>::VariantTable(int triangulation) : list_of_(kKeys<N>) {
  const tables::TileTable& plain = tables::tile_table(N, triangulation);
  for (unsigned s = 0; s < 1u << (1u << N); ++s) add_plain(s, plain, s, false);
  add_variants(triangulation);
  finish();
}

template <int N>
void VariantTable<N>::add(unsigned key, const std::vector<std::uint8_t>& simplices, unsigned cones,
                          const std::vector<std::uint64_t>& masks) {
  list_of_[key] = static_cast<std::uint16_t>(lists_.size());
  lists_.push_back({static_cast<std::uint32_t>(simplices_.size() / N), static_cast<std::uint16_t>(simplices.size() / N),
                    static_cast<std::uint8_t>(cones), static_cast<std::uint8_t>(masks.size()),
                    static_cast<std::uint32_t>(masks_.size())});
  simplices_.insert(simplices_.end(), simplices.begin(), simplices.end());
  masks_.insert(masks_.end(), masks.begin(), masks.end());
}

template <int N>
void VariantTable<N>::add_plain(unsigned key, const tables::TileTable& from, unsigned signature, bool reversed) {
  const tables::List& list = from.lists[from.list_of[signature]];
  const std::uint8_t* const first = from.simplices + std::size_t{list.first_simplex} * N;
  std::vector<std::uint8_t> simplices(first, first + std::size_t{list.simplex_count} * N);
  for (std::size_t q = 0; reversed && q < simplices.size(); q += N)
    std::swap(simplices[q + N - 2], simplices[q + N - 1]);
  const std::uint64_t* const masks = from.side_masks + list.first_side;
  add(key, simplices, list.cone_vertices, {masks, masks + list.side_vertices});
}

/// The high-connected square is the low-connected one of the complement, turned round (table contract).
template <>
void VariantTable<2>::add_variants(int triangulation) {
  for (unsigned s = 0; s < 16; ++s)
    if (ambiguous_signatures<2>()[s]) add_plain(s | 16, tables::tile_table(2, triangulation), ~s & 15, true);
}

template <>
void VariantTable<3>::add_variants(int triangulation) {
  const auto& table = tables::kTile3Resolved;
  for (unsigned s = 0; s < 256; ++s) {
    if (!ambiguous_signatures<3>()[s]) continue;
    const unsigned resolutions = 1u << std::popcount(unsigned{table.ambiguous_squares[s]});
    for (unsigned r = 0; r < resolutions; ++r) {
      const tables::ResolvedEntry& entry = table.entries[table.first_entry[s] + r];
      unsigned variant = 1 + 3 * r;
      for (const tables::ResolvedList* list : {&entry.separate, &entry.low, &entry.high}) {
        Polygons polygons(*list);
        if (triangulation == 0) cone_discs(polygons);
        add(s | variant++ << 8, polygons.triangles, polygons.cones, polygons.masks);
      }
    }
  }
}

template <int N>
void VariantTable<N>::finish() {
  tile_.version = tables::kContractVersion;
  tile_.dim = N;
  tile_.list_count = static_cast<std::uint32_t>(lists_.size());
  tile_.simplex_count = static_cast<std::uint32_t>(simplices_.size() / N);
  for (const tables::List& list : lists_) {
    tile_.max_simplices = std::max(tile_.max_simplices, std::uint32_t{list.simplex_count});
    tile_.max_tile_vertices = std::max(tile_.max_tile_vertices, std::uint32_t{list.cone_vertices} + list.side_vertices);
  }
  tile_.list_of = list_of_.data();
  tile_.lists = lists_.data();
  tile_.simplices = simplices_.data();
  tile_.side_masks = masks_.data();
  make_rows();
}

template <>
void VariantTable<2>::make_rows() {
  rows_.emplace_back(tile_, kKeys<2>);
}

template <>
void VariantTable<3>::make_rows() {
  const auto& table = tables::kTile3Resolved;
  std::array<unsigned, 256> counts{};
  std::vector<Variant> variants(4 * std::size_t{table.entry_count});
  for (unsigned s = 0; s < counts.size(); ++s) {
    const unsigned resolutions = 1u << std::popcount(unsigned{table.ambiguous_squares[s]});
    counts[s] = ambiguous_signatures<3>()[s] ? 1 + 3 * resolutions : 1;
    if (counts[s] == 1) continue;
    const tables::List& plain = lists_[list_of_[s]];
    for (unsigned r = 0; r < resolutions; ++r) {
      const unsigned entry = table.first_entry[s] + r;
      for (unsigned choice = 0; choice < 3; ++choice) {
        const unsigned chosen = table.entries[entry].components > 1 ? choice : 0;
        const unsigned key = s | (1 + 3 * r + chosen) << 8;
        const tables::List& list = lists_[list_of_[key]];
        variants[4 * entry + choice] = {static_cast<std::uint16_t>(key),
                                        static_cast<std::int8_t>(list.simplex_count - plain.simplex_count),
                                        static_cast<std::int8_t>(list.cone_vertices + list.side_vertices -
                                                                 plain.cone_vertices - plain.side_vertices)};
      }
    }
  }
  rows_.emplace_back(tile_, counts, std::move(variants));
}

template <int N>
const VariantTable<N>& variant_table(int triangulation) {
  if (triangulation == 0) {
    static const VariantTable<N> barycentric(0);
    return barycentric;
  }
  static const VariantTable<N> compact(1);
  return compact;
}

template <>
const std::array<bool, 16>& ambiguous_signatures<2>() noexcept {
  static constexpr auto kAmbiguous = [] {
    std::array<bool, 16> result{};
    result[0b0110] = result[0b1001] = true;
    return result;
  }();
  return kAmbiguous;
}

template <>
const std::array<bool, 256>& ambiguous_signatures<3>() noexcept {
  static const auto kAmbiguous = [] {
    const auto& table = tables::kTile3Resolved;
    std::array<bool, 256> result{};
    for (unsigned s = 0; s < 256; ++s)
      result[s] = table.ambiguous_squares[s] != 0 || table.entries[table.first_entry[s]].components > 1;
    return result;
  }();
  return kAmbiguous;
}

template <>
unsigned resolved_key<2>(const FaceEstimator<2>& estimator, const std::array<std::size_t, 2>& base,
                         unsigned signature) noexcept {
  std::array<double, 4> values;
  estimator.source().corner_values(base, 3, values.data());
  return signature | (estimator.is_square_high(base, 3, values) ? 16u : 0u);
}

namespace {

/// The axis of the image that is number `axis` of a face, by the face's axes.
constexpr auto kAxesOf = [] {
  std::array<std::array<std::uint8_t, 4>, 16> result{};
  for (unsigned axes = 0; axes < 16; ++axes)
    for (unsigned a = 0, number = 0; a < 4; ++a)
      if ((axes >> a & 1u) != 0) result[axes][number++] = static_cast<std::uint8_t>(a);
  return result;
}();

/// The corners of a cube that square 2 * across + side has.
constexpr auto kCornersOfSquares = [] {
  std::array<std::array<std::uint8_t, 4>, 6> result{};
  for (unsigned square = 0; square < 6; ++square)
    for (unsigned c = 0; c < 4; ++c)
      result[square][c] = static_cast<std::uint8_t>(unsqueeze(c, square / 2) | square % 2 << square / 2);
  return result;
}();

/// The sums of pairs of values at corners that differ along an axis.
template <unsigned Axis, std::size_t Count>
std::array<double, Count / 2> sums_along(const std::array<double, Count>& values) noexcept {
  constexpr std::size_t kStep = std::size_t{1} << Axis;
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<double, Count / 2>{(values[unsqueeze(I, Axis)] + values[unsqueeze(I, Axis) | kStep])...};
  }
  (std::make_index_sequence<Count / 2>());
}

/// The signs of the means of a cube's squares, at bits 0 to 5, and of its own, at bit 6; and those that rounding could
/// decide. In noise no branch would be foreseen: there are none.
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
    // More than all additions can have rounded off; what is too large, or not finite, is not less than any bound.
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

/// A cube whose signature is ambiguous, by means; false where rounding could decide.
bool decide_by_means(std::span<const double, 8> values, double isovalue, unsigned signature,
                     CubeDecision& decision) noexcept {
  const auto& table = tables::kTile3Resolved;
  const unsigned ambiguous = table.ambiguous_squares[signature];
  const CubeMeans means(values, isovalue);
  const unsigned r = packed_squares(means.high, ambiguous);
  const bool has_choice = table.entries[table.first_entry[signature] + r].components > 1;
  decision.high_squares = static_cast<std::uint8_t>(means.high & ambiguous);
  const auto centre = (means.high >> 6) != 0 ? facets::Choice::high : facets::Choice::low;
  decision.centre = has_choice ? centre : facets::Choice::separate;
  return (means.unsure & (ambiguous | (has_choice ? 64u : 0u))) == 0;
}

/// The squares and the inside of a cube whose signature is ambiguous.
template <int N>
CubeDecision decide(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base, unsigned axes,
                    std::span<const double, 8> values, unsigned signature) noexcept {
  if (estimator.is_by_cubes()) {
    std::array<double, 8> corners;
    std::copy(values.begin(), values.end(), corners.begin());
    return detail::decide_cube(corners, estimator.isovalue(), static_cast<std::uint8_t>(signature));
  }
  CubeDecision decision;
  if (estimator.is_by_means() && decide_by_means(values, estimator.isovalue(), signature, decision)) return decision;
  decision = {};
  const auto& table = tables::kTile3Resolved;
  const unsigned ambiguous = table.ambiguous_squares[signature];
  for (unsigned rest = ambiguous; rest != 0; rest &= rest - 1) {
    const auto square = static_cast<unsigned>(std::countr_zero(rest));
    const auto& of_square = kCornersOfSquares[square];
    const std::array<double, 4> corners = {values[of_square[0]], values[of_square[1]], values[of_square[2]],
                                           values[of_square[3]]};
    const unsigned axis = kAxesOf[axes][square / 2];
    auto at = base;
    at[axis] += square % 2;
    const unsigned is_high = estimator.is_square_high(at, axes ^ 1u << axis, corners) ? 1 : 0;
    decision.high_squares = static_cast<std::uint8_t>(decision.high_squares | is_high << square);
  }
  const unsigned r = packed_squares(decision.high_squares, ambiguous);
  if (table.entries[table.first_entry[signature] + r].components > 1)
    decision.centre = estimator.choice(base, axes, values);
  return decision;
}

unsigned key_of(unsigned signature, const CubeDecision& decision) noexcept {
  const unsigned ambiguous = tables::kTile3Resolved.ambiguous_squares[signature];
  const unsigned r = packed_squares(decision.high_squares, ambiguous);
  return signature | (1 + 3 * r + static_cast<unsigned>(decision.centre)) << 8;
}

/// The squares of the tesseract that are squares of its cube f, by set of those.
constexpr auto kSquaresOfCubes = [] {
  std::array<std::array<std::uint32_t, 64>, 8> result{};
  for (unsigned f = 0; f < 8; ++f)
    for (unsigned square = 0; square < 6; ++square) {
      const unsigned axis = square / 2 < f / 2 ? square / 2 : square / 2 + 1;
      const unsigned base = (f % 2) << (f / 2) | (square % 2) << axis;
      const unsigned axes = 15u ^ 1u << (f / 2) ^ 1u << axis;
      for (unsigned q = 0; q < 24; ++q)
        if (kTesseractSquares[q].base == base && kTesseractSquares[q].axes == axes)
          for (unsigned set = 0; set < 64; ++set)
            if ((set >> square & 1u) != 0) result[f][set] |= 1u << q;
    }
  return result;
}();

/// The corners of a face of the tesseract, in the face's own order.
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

/// Those of its squares and cubes.
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

template <int N>
unsigned cube_key(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base, unsigned axes,
                  unsigned signature) noexcept {
  if (!ambiguous_signatures<3>()[signature]) return signature;
  std::array<double, 8> values;
  estimator.source().corner_values(base, axes, values.data());
  return key_of(signature, decide<N>(estimator, base, axes, values, signature));
}
template unsigned cube_key<3>(const FaceEstimator<3>&, const std::array<std::size_t, 3>&, unsigned, unsigned) noexcept;
template unsigned cube_key<4>(const FaceEstimator<4>&, const std::array<std::size_t, 4>&, unsigned, unsigned) noexcept;

template <>
unsigned resolved_key<3>(const FaceEstimator<3>& estimator, const std::array<std::size_t, 3>& base,
                         unsigned signature) noexcept {
  return cube_key<3>(estimator, base, 7, signature);
}

template <int N>
const FaceBlock<N>& RowFaces<N>::look_at(std::size_t word) noexcept {
  if (word == word_) return block_;
  word_ = word;
  base_[0] = word * kWordBits;
  const std::size_t count = std::min(block_.kSamples, samples_ - base_[0]);
  block_.tiles = count - 1;
  estimator_.source().corner_rows(base_, count, block_.samples[0].data(), block_.kPitch);
  for (auto& row : block_.samples) std::fill(row.begin() + static_cast<std::ptrdiff_t>(count), row.end(), 0.0);
  if (estimator_.is_by_means())
    decide_by_means(block_, estimator_.isovalue());
  else
    decide_by_saddles(block_, estimator_.isovalue());
  return block_;
}
template class RowFaces<3>;
template class RowFaces<4>;

namespace {

/// The corners of a cell of a block along `axes` based at corner `base` of tile `bit`.
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

}  // namespace

void resolve(const FaceEstimator<3>& estimator, const RowTable& table, const FaceBlock<3>& block,
             TilesOfWord& tiles) noexcept {
  const auto& resolved = tables::kTile3Resolved;
  const bool by_means = estimator.is_by_means();
  const auto& joins = cube_joins();
  JoinQuestions questions;
  std::array<std::uint8_t, kWordBits> asked;
  std::array<std::uint16_t, kWordBits> entries;
  for (std::size_t j = 0; j < tiles.count; ++j) {
    const unsigned bit = tiles.bits[j], signature = tiles.signatures[j];
    const auto high = static_cast<unsigned>(block.high[bit]);
    const unsigned entry =
        resolved.first_entry[signature] + packed_squares(high, unsigned{resolved.ambiguous_squares[signature]});
    tiles.variants[j] = table.variant(entry, by_means ? 1 + (high >> kFirstCube<3>) : 0);
    if (block.unsure[bit] != 0) {
      tiles.variants[j] = {};
    } else if (!by_means && joins[entry].pairs == 1) {
      for (std::size_t e = 0; e < 8; ++e) {
        const unsigned corner = joins[entry].corners[e];
        questions.ends[e][questions.count] = block.samples[corner >> 1][bit + (corner & 1u)];
      }
      questions.sign[questions.count] = joins[entry].high ? 1.0 : -1.0;
      entries[questions.count] = static_cast<std::uint16_t>(entry);
      asked[questions.count++] = static_cast<std::uint8_t>(j);
    } else if (!by_means && joins[entry].pairs > 1) {
      const auto centre = detail::decide_centre(corners_of_cube<3, 7>(block, bit, 0), estimator.isovalue(), entry);
      tiles.variants[j] = table.variant(entry, static_cast<unsigned>(centre));
    }
  }
  answer(questions, estimator.isovalue());
  for (std::size_t q = 0; q < questions.count; ++q) {
    Variant& variant = tiles.variants[asked[q]];
    const auto joined = static_cast<unsigned>(joins[entries[q]].high ? facets::Choice::high : facets::Choice::low);
    if (questions.answers[q] == JoinQuestions::yes) variant = table.variant(entries[q], joined);
    if (questions.answers[q] == JoinQuestions::unsure) variant = {};
  }
}

/// A tile in which there is nothing to decide.
static ResolvedTile settled_tile(const ResolvedCubes& cubes, unsigned signature) noexcept {
  ResolvedTile tile;
  tile.key.signature = static_cast<std::uint16_t>(signature);
  const std::uint64_t signatures = cubes.signatures(tile.key.signature);
  for (unsigned f = 0; f < 8; ++f) {
    tile.cubes[f] = static_cast<std::uint16_t>(signatures >> (8 * f) & 255);
    tile.lists[f] = cubes.list(tile.cubes[f], 0, facets::Choice::separate);
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
  const std::uint64_t squares = cubes.squares(tile.key.squares);
  for (unsigned f = 0; f < 8; ++f) {
    const auto in_cube = static_cast<unsigned>(signatures >> (8 * f) & 255);
    tile.cubes[f] = static_cast<std::uint16_t>(in_cube);
    tile.lists[f] = cubes.list_of_entry(table.first_entry[in_cube], facets::Choice::separate);
    if (!ambiguous_cubes[in_cube]) continue;
    const unsigned r =
        packed_squares(static_cast<unsigned>(squares >> (8 * f) & 255), table.ambiguous_squares[in_cube]);
    auto choice = facets::Choice::separate;
    if (table.entries[table.first_entry[in_cube] + r].components > 1) {
      const unsigned corner = (f % 2) << (f / 2);
      const unsigned axes = 15u ^ 1u << (f / 2);
      choice = estimator.choice(moved(base, corner), axes, values_at(values, kCubesIn4D[f]));
    }
    tile.cubes[f] = static_cast<std::uint16_t>(in_cube | (1 + 3 * r + static_cast<unsigned>(choice)) << 8);
    tile.lists[f] = cubes.list_of_entry(table.first_entry[in_cube] + r, choice);
    if (choice == facets::Choice::low) tile.key.low_cubes = static_cast<std::uint8_t>(tile.key.low_cubes | 1u << f);
    if (choice == facets::Choice::high) tile.key.high_cubes = static_cast<std::uint8_t>(tile.key.high_cubes | 1u << f);
  }
  for (unsigned f = 0; f < 8; ++f)
    if (cubes.own_vertices(tile.lists[f]) != 0)
      tile.with_vertices = static_cast<std::uint8_t>(tile.with_vertices | 1u << f);
  tile.key.tile = estimator.choice(base, 15, values);
  return tile;
}

/// The centres of a tile's cubes by the trilinear interpolant, `entries` being those of its cubes; none where rounding
/// could decide.
static bool decide_centres(const FaceBlock<4>& block, unsigned bit, double isovalue,
                           const std::array<std::uint16_t, 8>& entries,
                           std::array<facets::Choice, 8>& choices) noexcept {
  const auto& joins = cube_joins();
  const auto value = [&](unsigned f, unsigned corner) {
    const unsigned of_tile = kCubesIn4D[f][corner];
    return block.samples[of_tile >> 1][bit + (of_tile & 1u)];
  };
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
  answer(questions, isovalue);
  for (std::size_t q = 0; q < questions.count; ++q) {
    if (questions.answers[q] == JoinQuestions::unsure) return false;
    const auto joined = joins[entries[asked[q]]].high ? facets::Choice::high : facets::Choice::low;
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
  tile.key.tile = (high >> kTesseractFace & 1u) != 0 ? facets::Choice::high : facets::Choice::low;
  const std::uint64_t signatures = cubes.signatures(tile.key.signature), squares = cubes.squares(tile.key.squares);
  std::array<std::uint16_t, 8> entries;
  for (unsigned f = 0; f < 8; ++f)
    entries[f] = static_cast<std::uint16_t>(cubes.entry(static_cast<unsigned>(signatures >> (8 * f) & 255),
                                                        static_cast<unsigned>(squares >> (8 * f) & 63)));
  std::array<facets::Choice, 8> choices{};
  if (estimator.is_by_means()) {
    unsigned with_choice = 0;
    for (unsigned f = 0; f < 8; ++f) {
      const auto is_high = static_cast<unsigned>(high >> (kFirstCube<4> + f) & 1u);
      const unsigned has_choice = cubes.has_choice(entries[f]) ? 1 : 0;
      choices[f] = static_cast<facets::Choice>(has_choice * (1 + is_high));
      with_choice |= has_choice << f;
    }
    const auto high_cubes = static_cast<unsigned>(high >> kFirstCube<4>);
    tile.key.high_cubes = static_cast<std::uint8_t>(with_choice & high_cubes);
    tile.key.low_cubes = static_cast<std::uint8_t>(with_choice & ~high_cubes);
  } else {
    if (!decide_centres(block, bit, estimator.isovalue(), entries, choices)) return false;
    unsigned low = 0, joined = 0;
    for (unsigned f = 0; f < 8; ++f) {
      low |= (choices[f] == facets::Choice::low ? 1u : 0u) << f;
      joined |= (choices[f] == facets::Choice::high ? 1u : 0u) << f;
    }
    tile.key.low_cubes = static_cast<std::uint8_t>(low);
    tile.key.high_cubes = static_cast<std::uint8_t>(joined);
  }
  unsigned with_vertices = 0;  // they are few, so a branch for each would be misled
  for (unsigned f = 0; f < 8; ++f) {
    tile.lists[f] = cubes.list_of_entry(entries[f], choices[f]);
    with_vertices |= (cubes.own_vertices(tile.lists[f]) != 0 ? 1u : 0u) << f;
  }
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

unsigned list_of_key(unsigned key) noexcept {
  const unsigned signature = signature_of<3>(key);
  if (signature == 0 || signature == 255) return ResolvedCubes::kNone;
  const unsigned variant = key >> 8;
  const unsigned r = variant == 0 ? 0 : (variant - 1) / 3;
  unsigned squares = 0;
  unsigned bit = 0;
  for (unsigned rest = tables::kTile3Resolved.ambiguous_squares[signature]; rest != 0; rest &= rest - 1, ++bit)
    if ((r >> bit & 1u) != 0) squares |= rest & (~rest + 1);
  const auto choice = variant == 0 ? facets::Choice::separate : static_cast<facets::Choice>((variant - 1) % 3);
  return ResolvedCubes::instance().list(signature, squares, choice);
}

const RowTable& estimated_tesseracts(int triangulation) {
  const auto make = [](bool all) {
    RowTable result(tables::tile_table(4, kCompact));
    for (unsigned s = 0; s < 65536; ++s)
      if (all || ambiguous_signatures<4>()[s]) result.mark_as_own(s);
    return result;
  };
  if (triangulation == kBarycentric) {
    static const RowTable barycentric = make(true);
    return barycentric;
  }
  static const RowTable compact = make(false);
  return compact;
}

template <>
const std::array<bool, 65536>& ambiguous_signatures<4>() noexcept {
  static const auto kAmbiguous = [] {
    std::array<bool, 65536> result{};
    for (unsigned s = 0; s < result.size(); ++s)
      result[s] = !ResolvedTesseract::is_settled(static_cast<std::uint16_t>(s));
    return result;
  }();
  return kAmbiguous;
}

template class VariantTable<2>;
template class VariantTable<3>;
template const VariantTable<2>& variant_table<2>(int);
template const VariantTable<3>& variant_table<3>(int);

}  // namespace tegl::detail
