// SPDX-License-Identifier: BSD-3-Clause
//
// The innermost loops; see extract_rows.hpp. This file is compiled once per instruction set (Highway's foreach_target).
#include "extract_rows.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "extract_rows.cpp"
#include "dispatch.hpp"
// Highway's own headers come after this one.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The tiles with high and low corners among the 64 that start at word w of `rows` (no word is looked at beyond w + 1).
template <std::size_t Rows>
HWY_INLINE Word mixed_word(const std::array<const Word*, Rows>& rows, std::size_t used, std::size_t w) {
  Word any = 0, all = ~Word{0}, next_any = 0, next_all = 1;
  for (std::size_t r = 0; r < used; ++r) {
    any |= rows[r][w];
    all &= rows[r][w];
    next_any |= rows[r][w + 1];
    next_all &= rows[r][w + 1];
  }
  return (any | any >> 1 | next_any << (kWordBits - 1)) & ~(all & (all >> 1 | next_all << (kWordBits - 1)));
}

/// mixed_word for all words of a row.
template <unsigned Used, std::size_t Rows>
HWY_INLINE void mixed_row(const std::array<const Word*, Rows>& rows, std::size_t words, Word* mixed) {
  std::size_t w = 0;
  const hn::ScalableTag<Word> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  for (; w + kLanes <= words; w += kLanes) {
    auto any = hn::LoadU(d, rows[0] + w), all = any;
    auto next_any = hn::LoadU(d, rows[0] + w + 1), next_all = next_any;
    for (unsigned r = 1; r < Used; ++r) {
      const auto here = hn::LoadU(d, rows[r] + w);
      const auto next = hn::LoadU(d, rows[r] + w + 1);
      any = hn::Or(any, here);
      all = hn::And(all, here);
      next_any = hn::Or(next_any, next);
      next_all = hn::And(next_all, next);
    }
    any = hn::Or(hn::Or(any, hn::ShiftRight<1>(any)), hn::ShiftLeft<kWordBits - 1>(next_any));
    all = hn::And(all, hn::Or(hn::ShiftRight<1>(all), hn::ShiftLeft<kWordBits - 1>(next_all)));
    hn::StoreU(hn::AndNot(all, any), d, mixed + w);
  }
  for (; w < words; ++w) mixed[w] = mixed_word(rows, Used, w);
}

/// Eight corners of 64 tiles, a word each, to a byte for each tile.
HWY_INLINE void corners_to_bytes(const Word* corners, unsigned count, std::uint8_t* bytes) {
  const hn::CappedTag<std::uint8_t, kWordBits> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
#if HWY_TARGET == HWY_SCALAR || __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  (void)d;
  (void)kLanes;
  for (unsigned i = 0; i < kWordBits; ++i) {
    bytes[i] = 0;
    for (unsigned c = 0; c < count; ++c) bytes[i] |= static_cast<std::uint8_t>((corners[c] >> i & 1u) << c);
  }
#else
  for (std::size_t i = 0; i < kWordBits; i += kLanes) {
    auto sum = hn::Zero(d);
    for (unsigned c = 0; c < count; ++c) {
      const auto* const bits = reinterpret_cast<const std::uint8_t*>(corners + c) + i / 8;
      sum = hn::Or(sum, hn::IfThenElseZero(hn::LoadMaskBits(d, bits), hn::Set(d, static_cast<std::uint8_t>(1u << c))));
    }
    hn::StoreU(sum, d, bytes + i);
  }
#endif
}

/// The signatures of the tiles `mixed` of word w, to `signatures`; returns their end.
template <int N>
HWY_INLINE std::uint16_t* signatures_of(const TileRow& row, std::size_t w, Word mixed, std::uint16_t* signatures) {
  constexpr unsigned kRows = 1u << (N - 1);
  constexpr unsigned kCorners = 2 * kRows;
  constexpr unsigned kFew = HWY_TARGET <= HWY_AVX3 ? 2 : HWY_TARGET <= HWY_AVX2 ? 4 : HWY_TARGET == HWY_SCALAR ? 64 : 8;
  Word corners[kCorners];
  for (unsigned r = 0; r < kRows; ++r) {
    corners[2 * r] = row.corners[r][w];
    corners[2 * r + 1] = row.corners[r][w] >> 1 | row.corners[r][w + 1] << (kWordBits - 1);
  }
  if (static_cast<unsigned>(std::popcount(mixed)) <= kFew) {
    for (; mixed != 0; mixed &= mixed - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(mixed));
      unsigned signature = 0;
      for (unsigned c = 0; c < kCorners; ++c) signature |= static_cast<unsigned>(corners[c] >> bit & 1u) << c;
      *signatures++ = static_cast<std::uint16_t>(signature);
    }
    return signatures;
  }
  alignas(64) std::uint8_t bytes[kCorners > 8 ? 2 : 1][kWordBits];
  corners_to_bytes(corners, std::min(kCorners, 8u), bytes[0]);
  if constexpr (kCorners > 8) corners_to_bytes(corners + 8, 8, bytes[1]);
  for (; mixed != 0; mixed &= mixed - 1) {
    const int bit = std::countr_zero(mixed);
    unsigned signature = bytes[0][bit];
    if constexpr (kCorners > 8) signature |= static_cast<unsigned>(bytes[1][bit]) << 8;
    *signatures++ = static_cast<std::uint16_t>(signature);
  }
  return signatures;
}

template <int N>
HWY_INLINE TileCount count_tiles(const TileRow& row, const RowTable& table, Word* active, std::uint16_t* signatures) {
  const std::uint32_t* const entries = table.entries();
  const std::size_t words = (row.tiles + 1 + kWordBits - 1) / kWordBits;  // of the samples
  mixed_row<1u << (N - 1)>(row.corners, words, active);
  TileCount count;
  for (std::size_t w = 0; w < words; ++w) {
    Word mixed = active[w];
    if (mixed == 0) continue;
    const std::size_t left = row.tiles - std::min(row.tiles, w * kWordBits);
    if (left < kWordBits) mixed &= (Word{1} << left) - 1;
    if (row.valid != nullptr) mixed &= row.valid[w];
    active[w] = mixed;
    const std::uint16_t* const first = signatures;
    signatures = signatures_of<N>(row, w, mixed, signatures);
    count.active += static_cast<std::uint32_t>(signatures - first);
    std::uint32_t simplices = 0;
    for (const std::uint16_t* s = first; s != signatures; ++s) {
      const std::uint32_t entry = entries[*s];
      simplices += entry & RowTable::kCountMask;
      if ((entry & RowTable::kOwnFlag) != 0) count.own_vertices += table.own_vertices(*s);
    }
    count.simplices += simplices;
  }
  return count;
}

/// As critical_edges, by table for 3D, and from two cubes in 4D.
template <int N>
HWY_INLINE std::uint32_t edges_of(unsigned signature) {
  if constexpr (N == 4) {
    // Edges along the first three axes at nibbles 0, 2, 4, to leave room for those of the other cube.
    static constexpr auto kSpread = [] {
      std::array<std::uint32_t, 256> spread{};
      for (unsigned s = 0; s < 256; ++s) {
        const std::uint32_t edges = critical_edges<3>(s);
        spread[s] = (edges & 0xf) | (edges & 0xf0) << 4 | (edges & 0xf00) << 8;
      }
      return spread;
    }();
    const unsigned lower = signature & 0xff, upper = signature >> 8;
    return kSpread[lower] | kSpread[upper] << 4 | (lower ^ upper) << 24;
  } else {
    static constexpr auto kEdges = [] {
      std::array<std::uint16_t, std::size_t{1} << (1u << N)> edges{};
      for (unsigned s = 0; s < edges.size(); ++s) edges[s] = static_cast<std::uint16_t>(critical_edges<N>(s));
      return edges;
    }();
    return kEdges[signature];
  }
}

/// One tile's simplices from its vertex numbers, in plain code: for all instruction sets and the last tiles of a row.
template <int N>
HWY_INLINE typename TileOutput<N>::Simplex* write_plain(const std::uint8_t* local, unsigned count, bool flip,
                                                        const Index* ids, typename TileOutput<N>::Simplex* out) {
  const unsigned last = flip ? N - 2 : N - 1;
  const unsigned before = flip ? N - 1 : N - 2;
  for (unsigned q = 0; q < count; ++q, ++out, local += N) {
    for (unsigned j = 0; j + 2 < N; ++j) (*out)[j] = ids[local[j]];
    (*out)[before] = ids[local[N - 2]];
    (*out)[last] = ids[local[N - 1]];
  }
  return out;
}

#if HWY_TARGET <= HWY_AVX3

/// The vertex numbers of a tile's edges in one or two registers.
template <int N>
struct Lanes {
  static constexpr unsigned kCount = N == 4 ? 2 : 1;
  __m512i first[kCount];

  HWY_INLINE explicit Lanes(const std::array<Index, TileOutput<N>::kEdges>& start) {
    alignas(64) Index padded[16 * kCount] = {};
    std::copy(start.begin(), start.end(), padded);
    for (unsigned i = 0; i < kCount; ++i) first[i] = _mm512_load_si512(padded + 16 * i);
  }
  /// Adds 1 where a bit is set.
  HWY_INLINE static __m512i plus(__m512i lanes, std::uint32_t bits, unsigned i) {
    return _mm512_mask_add_epi32(lanes, static_cast<__mmask16>(bits >> (16 * i)), lanes, _mm512_set1_epi32(1));
  }
};

/// Vertex numbers for up to 16 local vertices, N to a simplex.
template <int N, bool Flip>
HWY_INLINE __m512i looked_up(__m128i local, const __m512i* ids) {
  if constexpr (N == 4) {
    if (Flip) local = _mm_shuffle_epi8(local, _mm_setr_epi8(0, 1, 3, 2, 4, 5, 7, 6, 8, 9, 11, 10, 12, 13, 15, 14));
    return _mm512_permutex2var_epi32(ids[0], _mm512_cvtepu8_epi32(local), ids[1]);
  } else {
    static_assert(N == 3);
    if (Flip) local = _mm_shuffle_epi8(local, _mm_setr_epi8(0, 2, 1, 3, 5, 4, 6, 8, 7, 9, 11, 10, 12, 14, 13, 15));
    return _mm512_permutexvar_epi32(_mm512_cvtepu8_epi32(local), ids[0]);
  }
}

template <int N, bool Flip>
HWY_INLINE void write_lanes(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) {
  constexpr std::uint32_t kNext = next_edges<N>();
  constexpr unsigned kAtOnce = 16 / N;  // simplices
  constexpr auto kAllLocal = static_cast<__mmask16>((1u << (kAtOnce * N)) - 1);
  const std::uint32_t* const entries = table.entries();
  const std::uint8_t* const simplices = table.simplices();
  Lanes<N> lanes(row.first);
  auto* out = row.out;
  for (std::size_t i = 0; i < row.active; ++i) {
    const unsigned signature = row.signatures[i];
    const std::uint32_t edges = edges_of<N>(signature);
    const std::uint32_t moved = edges << 1 & kNext;
    const std::uint32_t entry = entries[signature];
    const unsigned count = entry & RowTable::kCountMask;
    const std::uint8_t* local = simplices + std::size_t{entry >> RowTable::kFirstShift} * N;
    __m512i ids[Lanes<N>::kCount];
    for (unsigned k = 0; k < Lanes<N>::kCount; ++k) ids[k] = Lanes<N>::plus(lanes.first[k], moved, k);
    if ((entry & RowTable::kOwnFlag) != 0) {
      alignas(64) Index stored[16 * Lanes<N>::kCount];
      for (unsigned k = 0; k < Lanes<N>::kCount; ++k) _mm512_store_si512(stored + 16 * k, ids[k]);
      out = own.write(own.self, signature, i, stored, out);
    } else {
      for (unsigned q = 0; q < count; q += kAtOnce, local += kAtOnce * N, out += kAtOnce) {
        const unsigned rest = count - q;
        const auto mask = rest >= kAtOnce ? kAllLocal : static_cast<__mmask16>((1u << (rest * N)) - 1);
        const __m512i numbers = looked_up<N, Flip>(_mm_maskz_loadu_epi8(mask, local), ids);
        _mm512_mask_storeu_epi32(out->data(), mask, numbers);
      }
      out -= (kAtOnce - count % kAtOnce) % kAtOnce;
    }
    const std::uint32_t advance = (edges & ~kNext) | moved;
    for (unsigned k = 0; k < Lanes<N>::kCount; ++k) lanes.first[k] = Lanes<N>::plus(lanes.first[k], advance, k);
  }
}

#endif

/// Adds 1 to the numbers where a bit is set, into `to`.
template <std::size_t Count>
HWY_INLINE void add_bits(const Index* numbers, std::uint32_t bits, Index* to) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t e = 0; e < Count; ++e) to[e] = numbers[e] + (bits >> e & 1u);
#else
  const hn::CappedTag<Index, 8> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  alignas(32) static constexpr Index kBits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  const auto bit = hn::Load(d, kBits);
  for (std::size_t e = 0; e < Count; e += kLanes) {
    const auto chosen = hn::Eq(hn::And(hn::Set(d, bits >> e), bit), bit);
    // A mask as a number is -1.
    const auto minus = hn::VecFromMask(d, chosen);
    hn::Store(hn::Sub(hn::Load(d, numbers + e), minus), d, to + e);
  }
#endif
}

template <int N>
HWY_INLINE void write_generic(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) {
  constexpr std::uint32_t kNext = next_edges<N>();
  constexpr unsigned kEdges = (TileOutput<N>::kEdges + 7) / 8 * 8;  // whole registers
  const std::uint32_t* const entries = table.entries();
  const std::uint8_t* const simplices = table.simplices();
  alignas(64) Index first[kEdges] = {};
  alignas(64) Index ids[kEdges];
  std::copy(row.first.begin(), row.first.end(), first);
  auto* out = row.out;
  for (std::size_t i = 0; i < row.active; ++i) {
    const unsigned signature = row.signatures[i];
    const std::uint32_t edges = edges_of<N>(signature);
    const std::uint32_t moved = edges << 1 & kNext;
    const std::uint32_t entry = entries[signature];
    add_bits<kEdges>(first, moved, ids);
    if ((entry & RowTable::kOwnFlag) != 0)
      out = own.write(own.self, signature, i, ids, out);
    else
      out = write_plain<N>(simplices + std::size_t{entry >> RowTable::kFirstShift} * N, entry & RowTable::kCountMask,
                           row.flip, ids, out);
    add_bits<kEdges>(first, (edges & ~kNext) | moved, first);
  }
}

#if HWY_TARGET != HWY_SCALAR

/// The four numbers of a 2D tile, and how they move on, in a register each.
void write_segments(const TileOutput<2>& row, const RowTable& table, const OwnTiles<2>& own) {
  struct Moves {
    alignas(16) std::array<std::array<Index, 4>, 16> moved{}, advance{};
  };
  static constexpr auto kMoves = [] {
    Moves moves;
    constexpr std::uint32_t kNext = next_edges<2>();
    for (unsigned s = 0; s < 16; ++s) {
      const std::uint32_t edges = critical_edges<2>(s);
      const std::uint32_t moved = edges << 1 & kNext;
      for (unsigned e = 0; e < 4; ++e) {
        moves.moved[s][e] = moved >> e & 1u;
        moves.advance[s][e] = ((edges & ~kNext) | moved) >> e & 1u;
      }
    }
    return moves;
  }();
  const hn::FixedTag<Index, 4> d;
  const hn::FixedTag<std::uint8_t, 16> bytes;
  const std::uint32_t* const entries = table.entries();
  auto first = hn::LoadU(d, row.first.data());
  TileOutput<2> last = row;
  // A segment too many takes the place of the next tile's, which comes later: so not for the last tile.
  for (std::size_t i = 0; i + 1 < row.active; ++i) {
    const unsigned signature = row.signatures[i];
    const auto ids = hn::Add(first, hn::Load(d, kMoves.moved[signature].data()));
    const auto chosen = hn::LoadU(bytes, table.segment_bytes(signature, row.flip));
    hn::StoreU(hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(bytes, ids), chosen)), d, last.out->data());
    last.out += entries[signature] & RowTable::kCountMask;
    first = hn::Add(first, hn::Load(d, kMoves.advance[signature].data()));
  }
  if (row.active == 0) return;
  hn::StoreU(first, d, last.first.data());
  last.signatures += row.active - 1;
  last.active = 1;
  write_generic<2>(last, table, own);
}

#endif

template <int N>
HWY_INLINE void write_tiles(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (N >= 3)
    return row.flip ? write_lanes<N, true>(row, table, own) : write_lanes<N, false>(row, table, own);
#endif
#if HWY_TARGET != HWY_SCALAR
  if constexpr (N == 2) return write_segments(row, table, own);
#endif
  return write_generic<N>(row, table, own);
}

// Highway's tables of functions hold no templates.
TileCount count2(const TileRow& r, const RowTable& t, Word* a, std::uint16_t* s) { return count_tiles<2>(r, t, a, s); }
TileCount count3(const TileRow& r, const RowTable& t, Word* a, std::uint16_t* s) { return count_tiles<3>(r, t, a, s); }
TileCount count4(const TileRow& r, const RowTable& t, Word* a, std::uint16_t* s) { return count_tiles<4>(r, t, a, s); }
void write2(const TileOutput<2>& r, const RowTable& t, const OwnTiles<2>& o) { write_tiles<2>(r, t, o); }
void write3(const TileOutput<3>& r, const RowTable& t, const OwnTiles<3>& o) { write_tiles<3>(r, t, o); }
void write4(const TileOutput<4>& r, const RowTable& t, const OwnTiles<4>& o) { write_tiles<4>(r, t, o); }

std::uint32_t count_edges(const Word* a, const Word* b, std::size_t samples, const Word* valid, Word* critical,
                          std::uint32_t* prefix) {
  const std::size_t cells = samples - (b == nullptr ? 1 : 0);
  const std::size_t words = (samples + kWordBits - 1) / kWordBits;
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < words; ++w) {
    Word bits = a[w] ^ (b == nullptr ? a[w] >> 1 | a[w + 1] << (kWordBits - 1) : b[w]);
    const std::size_t left = cells - std::min(cells, w * kWordBits);
    if (left < kWordBits) bits &= (Word{1} << left) - 1;
    if (valid != nullptr) bits &= valid[w];
    critical[w] = bits;
    prefix[w] = count;
    count += static_cast<std::uint32_t>(std::popcount(bits));
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(count2);
HWY_EXPORT(count3);
HWY_EXPORT(count4);
HWY_EXPORT(write2);
HWY_EXPORT(write3);
HWY_EXPORT(write4);
HWY_EXPORT(count_edges);

bool RowTable::can_use(const tables::TileTable& table) noexcept {
  return table.element_of == nullptr && table.max_simplices <= kCountMask &&
         table.simplex_count < (1u << (32 - kFirstShift));
}

RowTable::RowTable(const tables::TileTable& table)
    : table_(&table), entries_(std::size_t{1} << (1u << table.dim)), simplices_(table.simplices) {
  for (std::size_t s = 0; s < entries_.size(); ++s) {
    const tables::List& list = table.lists[table.list_of[s]];
    const bool own = list.cone_vertices != 0 || list.side_vertices != 0;
    entries_[s] = list.first_simplex << kFirstShift | (own ? kOwnFlag : 0) | list.simplex_count;
  }
  if (table.dim == 2) choose_segment_bytes();
}

void RowTable::choose_segment_bytes() {
  for (unsigned s = 0; s < 16; ++s)
    for (unsigned v = 0; v < 2 * (entries_[s] & kCountMask); ++v) {
      const unsigned edge = simplices_[2 * (entries_[s] >> kFirstShift) + v];
      for (unsigned byte = 0; byte < 4; ++byte) {
        segment_bytes_[0][s][4 * v + byte] = static_cast<std::uint8_t>(4 * edge + byte);
        segment_bytes_[1][s][4 * (v ^ 1) + byte] = static_cast<std::uint8_t>(4 * edge + byte);
      }
    }
}

template <>
TileCount count_tile_row<2>(const TileRow& row, const RowTable& table, Word* active, std::uint16_t* out) noexcept {
  return HWY_DYNAMIC_DISPATCH(count2)(row, table, active, out);
}
template <>
TileCount count_tile_row<3>(const TileRow& row, const RowTable& table, Word* active, std::uint16_t* out) noexcept {
  return HWY_DYNAMIC_DISPATCH(count3)(row, table, active, out);
}
template <>
TileCount count_tile_row<4>(const TileRow& row, const RowTable& table, Word* active, std::uint16_t* out) noexcept {
  return HWY_DYNAMIC_DISPATCH(count4)(row, table, active, out);
}
template <>
void write_tile_row<2>(const TileOutput<2>& row, const RowTable& table, const OwnTiles<2>& own) noexcept {
  HWY_DYNAMIC_DISPATCH(write2)(row, table, own);
}
template <>
void write_tile_row<3>(const TileOutput<3>& row, const RowTable& table, const OwnTiles<3>& own) noexcept {
  HWY_DYNAMIC_DISPATCH(write3)(row, table, own);
}
template <>
void write_tile_row<4>(const TileOutput<4>& row, const RowTable& table, const OwnTiles<4>& own) noexcept {
  HWY_DYNAMIC_DISPATCH(write4)(row, table, own);
}

std::uint32_t count_edge_row(const Word* a, const Word* b, std::size_t samples, const Word* valid, Word* critical,
                             std::uint32_t* prefix) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_edges)(a, b, samples, valid, critical, prefix);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
