// SPDX-License-Identifier: BSD-3-Clause
//
// The innermost loops of the extraction (see extract_rows.hpp). Highway's foreach_target compiles this file once per
// instruction set.
#include "kernel/extract_rows.hpp"

#include <algorithm>
#include <bit>

#include "base/request_memory.hpp"
#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/extract_rows.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/cache_control.h"
#include "hwy/highway.h"

namespace tegl::detail {
/// Whether the processor has GFNI. Highway's AVX3_DL does not include these instructions, but every processor with it
/// has them. Defined below, among the code for all processors.
extern const bool kHasGfni;
}  // namespace tegl::detail

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The lanes of a mask as bits, lane 0 lowest.
template <class D, class M>
HWY_INLINE Word bits_of(D d, M mask) {
  static_assert(hn::MaxLanes(D()) <= 8);
  alignas(8) std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0];
}

/// Active tiles among the 64 that start at word w of `rows`. Reads words w and w + 1 only.
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

/// Critical edges that a row of tiles counts (TileCount::edges) in the 64 positions of word w, by axis.
template <int N, std::size_t Rows>
HWY_INLINE std::array<Word, N> edge_words(const std::array<const Word*, Rows>& rows, std::size_t w) {
  constexpr unsigned kUpper = 1u << (N - 2);
  const Word here = rows[kUpper][w];
  std::array<Word, N> edges;
  edges[0] = here ^ (here >> 1 | rows[kUpper][w + 1] << (kWordBits - 1));
  for (unsigned a = 1; a + 1 < N; ++a) edges[a] = here ^ rows[kUpper | 1u << (a - 1)][w];
  edges[N - 1] = here ^ rows[0][w];
  return edges;
}

/// Computes mixed_word for `words` words of a row (at most 64) from word `first` on. Bit i of the result is set if word
/// first + i is not 0. Adds the critical edges to `edges`. If the row's last sample is high, this counts one edge along
/// the row too many.
template <int N, std::size_t Rows>
HWY_INLINE Word mixed_words(const std::array<const Word*, Rows>& rows, std::size_t first, std::size_t words,
                            Word* mixed, std::array<std::uint32_t, 4>& edges) {
  constexpr unsigned kRows = 1u << (N - 1);
  constexpr unsigned kUpper = kRows / 2;
  const hn::ScalableTag<Word> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  Word present = 0;
  std::array<hn::Vec<decltype(d)>, N> sums;
  for (auto& sum : sums) sum = hn::Zero(d);
  std::size_t i = 0;
  // whole registers
  for (; i + kLanes <= words; i += kLanes) {
    const std::size_t w = first + i;
    std::array<hn::Vec<decltype(d)>, kRows> here;
    // any and all corners of each tile
    auto any = hn::Zero(d), next_any = any;
    auto all = hn::Not(any), next_all = all;
    for (unsigned r = 0; r < kRows; ++r) {
      here[r] = hn::LoadU(d, rows[r] + w);
      const auto next = hn::LoadU(d, rows[r] + w + 1);
      any = hn::Or(any, here[r]);
      all = hn::And(all, here[r]);
      next_any = hn::Or(next_any, next);
      next_all = hn::And(next_all, next);
    }
    // critical edges
    const auto next = hn::LoadU(d, rows[kUpper] + w + 1);
    const auto shifted = hn::Or(hn::ShiftRight<1>(here[kUpper]), hn::ShiftLeft<kWordBits - 1>(next));
    sums[0] = hn::Add(sums[0], hn::PopulationCount(hn::Xor(here[kUpper], shifted)));
    for (unsigned a = 1; a + 1 < N; ++a)
      sums[a] = hn::Add(sums[a], hn::PopulationCount(hn::Xor(here[kUpper], here[kUpper | 1u << (a - 1)])));
    sums[N - 1] = hn::Add(sums[N - 1], hn::PopulationCount(hn::Xor(here[kUpper], here[0])));
    // active tiles
    any = hn::Or(hn::Or(any, hn::ShiftRight<1>(any)), hn::ShiftLeft<kWordBits - 1>(next_any));
    all = hn::And(all, hn::Or(hn::ShiftRight<1>(all), hn::ShiftLeft<kWordBits - 1>(next_all)));
    const auto found = hn::AndNot(all, any);
    hn::StoreU(found, d, mixed + w);
    present |= bits_of(d, hn::Ne(found, hn::Zero(d))) << i;
  }
  for (unsigned a = 0; a < N; ++a) edges[a] += static_cast<std::uint32_t>(hn::GetLane(hn::SumOfLanes(d, sums[a])));
  // remaining words
  for (; i < words; ++i) {
    mixed[first + i] = mixed_word(rows, kRows, first + i);
    present |= Word{mixed[first + i] != 0} << i;
    const auto here = edge_words<N>(rows, first + i);
    for (unsigned a = 0; a < N; ++a) edges[a] += static_cast<std::uint32_t>(std::popcount(here[a]));
  }
  return present;
}

/// Transposes `count` (at most 8) words, each with one corner of 64 tiles, to one byte per tile.
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

#if HWY_TARGET <= HWY_AVX3_DL

/// Transposes eight words, each with one corner of 64 tiles, to one byte per tile.
HWY_INLINE __m512i corner_bytes(__m512i words) {
  if (HWY_UNLIKELY(!kHasGfni)) {
    alignas(64) Word corners[8];
    alignas(64) std::uint8_t bytes[kWordBits];
    _mm512_store_si512(corners, words);
    corners_to_bytes(corners, 8, bytes);
    return _mm512_load_si512(bytes);
  }
  // byte 7 - c of block b: byte b of corner c
  alignas(64) static constexpr auto kByBlock = [] {
    std::array<std::uint8_t, 64> order{};
    for (unsigned i = 0; i < 64; ++i) order[i] = static_cast<std::uint8_t>((7 - i % 8) * 8 + i / 8);
    return order;
  }();
  const __m512i blocks = _mm512_permutexvar_epi8(_mm512_load_si512(kByBlock.data()), words);
  // Each block is a matrix of 8 x 8 bits, its first row in the highest byte. Multiplied by the unit vectors, it gives
  // its columns. Not by the compiler's intrinsic, which the target's options exclude.
  const __m512i units = _mm512_set1_epi64(static_cast<long long>(0x8040201008040201));
  __m512i columns;
  asm("vgf2p8affineqb $0, %2, %1, %0" : "=v"(columns) : "v"(units), "v"(blocks));
  return columns;
}

/// Signatures of the 64 tiles from word w on, one byte each. N = 4: lower (`half` = 0) or upper eight corners.
template <int N>
HWY_INLINE __m512i signature_bytes(const TileRow& row, std::size_t w, unsigned half) {
  const auto two = [&](unsigned r) HWY_ATTR {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(row.corners[4 * half + r] + w));
  };
  __m512i words = _mm512_inserti64x2(_mm512_zextsi128_si512(two(0)), two(1), 1);
  if constexpr (N > 2) words = _mm512_inserti64x2(_mm512_inserti64x2(words, two(2), 2), two(3), 3);
  const __m512i here = _mm512_unpacklo_epi64(words, words);
  return corner_bytes(_mm512_mask_shrdi_epi64(here, 0xAA, here, _mm512_unpackhi_epi64(words, words), 1));
}

/// Sums of the entries of `signatures` in a table of 256, to be added up.
HWY_INLINE __m512i sums_of_entries(__m512i signatures, const std::uint8_t* table) {
  const __m512i low = _mm512_permutex2var_epi8(_mm512_loadu_si512(table), signatures, _mm512_loadu_si512(table + 64));
  const __m512i high =
      _mm512_permutex2var_epi8(_mm512_loadu_si512(table + 128), signatures, _mm512_loadu_si512(table + 192));
  const __m512i entries = _mm512_mask_blend_epi8(_mm512_movepi8_mask(signatures), low, high);
  return _mm512_sad_epu8(entries, _mm512_setzero_si512());
}

/// A sum of numbers of simplices.
class SimplexSum {
 public:
  HWY_INLINE SimplexSum() : sums_(_mm512_setzero_si512()) {}
  HWY_INLINE void add(__m512i sums) { sums_ = _mm512_add_epi64(sums_, sums); }
  HWY_INLINE void add(std::uint64_t number) { number_ += number; }
  HWY_INLINE std::uint64_t total() const {
    return number_ + static_cast<std::uint64_t>(_mm512_reduce_add_epi64(sums_));
  }

 private:
  __m512i sums_;
  std::uint64_t number_ = 0;
};

/// Writes signatures and positions of the tiles `mixed` of word w, starting at entry `at`. Adds the number of their
/// simplices to `simplices`. In 2D and 3D the only branch on the number of tiles is whether there are more than 32.
template <int N>
HWY_INLINE void take_tiles(const TileRow& row, const RowTable& table, std::size_t w, Word mixed, const TileRoom& room,
                           std::size_t at, SimplexSum& simplices) {
  alignas(64) static constexpr auto kCountUp = [] {
    std::array<std::uint8_t, 64> numbers{};
    for (unsigned i = 0; i < 64; ++i) numbers[i] = static_cast<std::uint8_t>(i);
    return numbers;
  }();
  const auto count = static_cast<unsigned>(std::popcount(mixed));
  const __m512i first = _mm512_set1_epi16(static_cast<short>(w * kWordBits));
  const auto half_of = [](__m512i bytes, int half) HWY_ATTR {
    return _mm512_cvtepu8_epi16(half == 0 ? _mm512_castsi512_si256(bytes) : _mm512_extracti64x4_epi64(bytes, 1));
  };
  const auto store = [&](std::uint16_t* to, auto words_of) HWY_ATTR {
    _mm512_storeu_si512(to, words_of(0));
    if (count > 32) _mm512_storeu_si512(to + 32, words_of(1));
  };
  // positions of the tiles
  const __m512i along = _mm512_maskz_compress_epi8(mixed, _mm512_load_si512(kCountUp.data()));
  store(room.at + at, [&](int half) HWY_ATTR { return _mm512_add_epi16(first, half_of(along, half)); });
  // signatures and number of simplices
  const __m512i low = _mm512_maskz_compress_epi8(mixed, signature_bytes<N>(row, w, 0));
  std::uint16_t* const out = room.signatures + at;
  if constexpr (N == 4) {
    const __m512i high = _mm512_maskz_compress_epi8(mixed, signature_bytes<N>(row, w, 1));
    store(out, [&](int half)
                   HWY_ATTR { return _mm512_or_si512(half_of(low, half), _mm512_slli_epi16(half_of(high, half), 8)); });
    std::uint64_t sum = 0;
    for (unsigned i = 0; i < count && row.sizes; ++i) sum += table.entries[out[i]] & RowTable::kCountMask;
    simplices.add(sum);
  } else {
    store(out, [&](int half) HWY_ATTR { return half_of(low, half); });
    simplices.add(sums_of_entries(low, table.counts));  // unused lanes have signature 0, which has no simplices
  }
}

#else

/// A sum of numbers of simplices.
class SimplexSum {
 public:
  HWY_INLINE void add(std::uint64_t number) { number_ += number; }
  HWY_INLINE std::uint64_t total() const { return number_; }

 private:
  std::uint64_t number_ = 0;
};

/// Writes signatures and positions of the tiles `mixed` of word w, starting at entry `at`. Adds the number of their
/// simplices to `sum`.
template <int N>
HWY_INLINE void take_tiles(const TileRow& row, const RowTable& table, std::size_t w, Word mixed, const TileRoom& room,
                           std::size_t at, SimplexSum& sum) {
  constexpr unsigned kRows = 1u << (N - 1);
  constexpr unsigned kCorners = 2 * kRows;
  constexpr unsigned kFew = HWY_TARGET <= HWY_AVX3 ? 2 : HWY_TARGET <= HWY_AVX2 ? 4 : HWY_TARGET == HWY_SCALAR ? 64 : 8;
  Word corners[kCorners];
  for (unsigned r = 0; r < kRows; ++r) {
    corners[2 * r] = row.corners[r][w];
    corners[2 * r + 1] = row.corners[r][w] >> 1 | row.corners[r][w + 1] << (kWordBits - 1);
  }
  const auto first = static_cast<unsigned>(w * kWordBits);
  std::uint64_t simplices = 0;
  const auto take = [&](unsigned bit, unsigned signature) HWY_ATTR {
    room.signatures[at] = static_cast<std::uint16_t>(signature);
    // few tiles: gather the corners of each
    room.at[at++] = static_cast<std::uint16_t>(first + bit);
    if (N < 4 || row.sizes) simplices += table.entries[signature] & RowTable::kCountMask;
  };
  if (static_cast<unsigned>(std::popcount(mixed)) <= kFew) {
    for (; mixed != 0; mixed &= mixed - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(mixed));
      unsigned signature = 0;
      for (unsigned c = 0; c < kCorners; ++c) signature |= static_cast<unsigned>(corners[c] >> bit & 1u) << c;
      take(bit, signature);
    }
    // many tiles: transpose all 64
    return sum.add(simplices);
  }
  alignas(64) std::uint8_t bytes[kCorners > 8 ? 2 : 1][kWordBits];
  corners_to_bytes(corners, std::min(kCorners, 8u), bytes[0]);
  if constexpr (kCorners > 8) corners_to_bytes(corners + 8, 8, bytes[1]);
  for (; mixed != 0; mixed &= mixed - 1) {
    const auto bit = static_cast<unsigned>(std::countr_zero(mixed));
    unsigned signature = bytes[0][bit];
    if constexpr (kCorners > 8) signature |= static_cast<unsigned>(bytes[1][bit]) << 8;
    take(bit, signature);
  }
  sum.add(simplices);
}

#endif

template <int N>
HWY_INLINE TileCount count_tiles(const TileRow& row, const RowTable& table, const TileRoom& room) {
  const std::size_t words = (row.tiles + 1 + kWordBits - 1) / kWordBits;  // words of samples
  TileCount count;
  SimplexSum simplices;
  // find active words of up to 64, then the signatures of their tiles
  for (std::size_t block = 0; block < words; block += kWordBits) {
    Word present = mixed_words<N>(row.corners, block, std::min(kWordBits, words - block), room.active, count.edges);
    if (block + kWordBits >= words) room.active[words - 1] &= (Word{1} << (row.tiles % kWordBits)) - 1;
    for (; present != 0; present &= present - 1) {
      const std::size_t w = block + static_cast<std::size_t>(std::countr_zero(present));
      if (row.valid != nullptr) room.active[w] &= row.valid[w];
      const Word mixed = room.active[w];
      take_tiles<N>(row, table, w, mixed, room, count.active, simplices);
      count.active += static_cast<std::uint32_t>(std::popcount(mixed));
    }
  }
  count.simplices = simplices.total();
  if (row.own_vertices && row.sizes && table.has_own_vertices())
    for (std::uint32_t i = 0; i < count.active; ++i) count.own_vertices += table.own_vertices(room.signatures[i]);
  // sums over the row
  const Word* const upper = row.corners[1u << (N - 2)];
  count.edges[0] -= static_cast<std::uint32_t>(upper[row.tiles / kWordBits] >> (row.tiles % kWordBits) & 1u);
  return count;
}

#if HWY_TARGET <= HWY_AVX3

/// Appends to `out` the positions of those tiles whose edge between corners Base and Base + Step is critical. Returns
/// their number.
template <unsigned Base, unsigned Step, class D>
HWY_INLINE std::size_t list_edges(D d, hn::Vec<D> signatures, hn::Vec<D> at, hn::Mask<D> used, std::uint32_t* out) {
  const auto differ = hn::Xor(signatures, hn::ShiftRight<Step>(signatures));
  const auto critical = hn::And(hn::TestBit(differ, hn::Set(d, 1u << Base)), used);
  // Compressed in registers: compressing stores are slow on some processors.
  hn::StoreU(hn::Compress(at, critical), d, out);
  return hn::CountTrue(d, critical);
}

template <int N>
HWY_INLINE void tile_edges(const TileEdges& row) {
  constexpr unsigned kUpper = 1u << (N - 1);
  const hn::ScalableTag<std::uint32_t> d;
  const hn::Rebind<std::uint16_t, decltype(d)> narrow;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  std::array<std::uint32_t*, 4> out = row.out;
  for (std::size_t i = 0; i < row.active; i += kLanes) {
    const auto signatures = hn::PromoteTo(d, hn::LoadU(narrow, row.signatures + i));
    const auto at = hn::PromoteTo(d, hn::LoadU(narrow, row.at + i));
    const auto used = hn::FirstN(d, row.active - i);
    out[0] += list_edges<kUpper, 1>(d, signatures, at, used, out[0]);
    if constexpr (N > 2) out[1] += list_edges<kUpper, 2>(d, signatures, at, used, out[1]);
    if constexpr (N > 3) out[2] += list_edges<kUpper, 4>(d, signatures, at, used, out[2]);
    out[N - 1] += list_edges<0, kUpper>(d, signatures, at, used, out[N - 1]);
  }
}

#else

template <int N>
HWY_INLINE void tile_edges(const TileEdges& row) {
  constexpr unsigned kUpper = 1u << (N - 1);
  std::array<std::uint32_t*, 4> out = row.out;
  for (std::size_t i = 0; i < row.active; ++i) {
    const unsigned signature = row.signatures[i];
    // A non-critical edge does not advance `out`, so the next edge overwrites it.
    for (unsigned a = 0; a + 1 < N; ++a) {
      *out[a] = row.at[i];
      out[a] += (signature >> kUpper ^ signature >> (kUpper + (1u << a))) & 1u;
    }
    *out[N - 1] = row.at[i];
    out[N - 1] += (signature ^ signature >> kUpper) & 1u;
  }
}

#endif

/// Equals critical_edges. 2D and 3D: table lookup; 4D: combined from two cubes.
template <int N>
HWY_INLINE std::uint32_t edges_of(unsigned signature) {
  if constexpr (N == 4) {
    // Move edges along the first three axes to nibbles 0, 2 and 4. Nibbles 1, 3 and 5 are for the upper cube.
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

/// Writes one tile's simplices from its vertex numbers, without vector instructions.
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

/// Index of a key's entry in RowTable::entries.
template <int N, bool Variants>
HWY_INLINE unsigned entry_place(const RowTable& table, unsigned key) {
  if constexpr (N == 3 && Variants) return table.place_of(key);
  return key;
}

/// Tiles between the one that is written and the one whose entry is fetched: those of 4D tiles are seldom in a cache.
/// Lists of signatures have entries past the end (TileRoom).
constexpr std::size_t kAhead = 4;

#if HWY_TARGET <= HWY_AVX3

/// First vertex numbers of a tile's edge streams, in one or two registers.
template <int N>
struct Lanes {
  static constexpr unsigned kCount = N == 4 ? 2 : 1;
  __m512i first[kCount];

  HWY_INLINE explicit Lanes(const std::array<Index, TileOutput<N>::kEdges>& start) {
    alignas(64) Index padded[16 * kCount] = {};
    std::copy(start.begin(), start.end(), padded);
    for (unsigned i = 0; i < kCount; ++i) first[i] = _mm512_load_si512(padded + 16 * i);
  }
  /// Adds 1 to the lanes whose bit is set; lanes of register i.
  HWY_INLINE static __m512i plus(__m512i lanes, std::uint32_t bits, unsigned i) {
    return _mm512_mask_add_epi32(lanes, static_cast<__mmask16>(bits >> (16 * i)), lanes, _mm512_set1_epi32(1));
  }
};

/// Maps up to 16 local vertices, N per simplex, to vertex numbers.
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

template <int N, bool Flip, bool Variants>
HWY_INLINE void write_lanes(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) {
  constexpr std::uint32_t kNext = next_edges<N>();
  constexpr unsigned kAtOnce = 16 / N;  // simplices
  const std::uint32_t* const entries = table.entries;
  const std::uint8_t* const simplices = table.simplices;
  Lanes<N> lanes(row.first);
  auto* out = row.out;
  // Whole registers are stored where the next tiles, of at least one simplex each, overwrite what is too much.
  const std::size_t roomy = row.active - std::min<std::size_t>(row.active, kAtOnce);
  for (std::size_t i = 0; i < row.active; ++i) {
    const unsigned signature = row.signatures[i];
    if constexpr (N == 4) hwy::Prefetch(entries + row.signatures[i + kAhead]);
    const std::uint32_t edges = edges_of<N>(Variants ? signature_of<N>(signature) : signature);
    const std::uint32_t moved = edges << 1 & kNext;
    const std::uint32_t entry = entries[entry_place<N, Variants>(table, signature)];
    const unsigned count = entry & RowTable::kCountMask;
    const std::uint8_t* local = simplices + std::size_t{entry >> RowTable::kFirstShift} * N;
    // vertex numbers of this tile's edges
    __m512i ids[Lanes<N>::kCount];
    for (unsigned k = 0; k < Lanes<N>::kCount; ++k) ids[k] = Lanes<N>::plus(lanes.first[k], moved, k);
    if constexpr (N == 3)
      if ((entry & RowTable::kOwnFlag) != 0) {
        const __m512i number = _mm512_setr_epi32(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3);
        const Index first = own.first_own(own.self, signature, i);
        ids[0] = _mm512_mask_add_epi32(ids[0], 0xF000, number, _mm512_set1_epi32(static_cast<int>(first)));
      }
    // its simplices
    if (N != 3 && (entry & RowTable::kOwnFlag) != 0) {
      alignas(64) Index stored[16 * Lanes<N>::kCount];
      for (unsigned k = 0; k < Lanes<N>::kCount; ++k) _mm512_store_si512(stored + 16 * k, ids[k]);
      if constexpr (N != 3) out = own.write(own.self, signature, i, stored, out);
    } else {
      auto* to = out;
      out += count;
      if constexpr (N == 3) request_ahead(to);
      for (; to < out; to += kAtOnce, local += kAtOnce * N) {
        const __m512i numbers = looked_up<N, Flip>(_mm_loadu_si128(reinterpret_cast<const __m128i*>(local)), ids);
        if (i < roomy) {
          _mm512_storeu_si512(to->data(), numbers);
          continue;
        }
        const auto rest = std::min<std::size_t>(static_cast<std::size_t>(out - to), kAtOnce);
        _mm512_mask_storeu_epi32(to->data(), static_cast<__mmask16>((1u << (rest * N)) - 1), numbers);
      }
    }
    // advance the streams
    const std::uint32_t advance = (edges & ~kNext) | moved;
    for (unsigned k = 0; k < Lanes<N>::kCount; ++k) lanes.first[k] = Lanes<N>::plus(lanes.first[k], advance, k);
  }
}

#endif

/// Writes numbers[e] + (bit e of `bits`) to to[e].
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
    // A true mask lane is -1 as a number.
    const auto minus = hn::VecFromMask(d, chosen);
    hn::Store(hn::Sub(hn::Load(d, numbers + e), minus), d, to + e);
  }
#endif
}

template <int N, bool Variants>
HWY_INLINE void write_generic(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) {
  constexpr std::uint32_t kNext = next_edges<N>();
  constexpr unsigned kEdges = (TileOutput<N>::kEdges + 7) / 8 * 8;  // rounded up to whole registers
  const std::uint32_t* const entries = table.entries;
  const std::uint8_t* const simplices = table.simplices;
  alignas(64) Index first[kEdges] = {};
  alignas(64) Index ids[kEdges];
  std::copy(row.first.begin(), row.first.end(), first);
  auto* out = row.out;
  for (std::size_t i = 0; i < row.active; ++i) {
    const unsigned signature = row.signatures[i];
    if constexpr (N == 4) hwy::Prefetch(entries + row.signatures[i + kAhead]);
    const std::uint32_t edges = edges_of<N>(Variants ? signature_of<N>(signature) : signature);
    const std::uint32_t moved = edges << 1 & kNext;
    const std::uint32_t entry = entries[entry_place<N, Variants>(table, signature)];
    add_bits<kEdges>(first, moved, ids);
    const bool has_own = (entry & RowTable::kOwnFlag) != 0;
    if constexpr (N == 3)
      if (has_own) {
        const Index first_own = own.first_own(own.self, signature, i);
        for (unsigned j = 0; j < OwnTiles<3>::kMost; ++j) ids[tables::edge_count(3) + j] = first_own + j;
      }
    if constexpr (N != 3)
      if (has_own) out = own.write(own.self, signature, i, ids, out);
    if (N == 3 || !has_own)
      out = write_plain<N>(simplices + std::size_t{entry >> RowTable::kFirstShift} * N, entry & RowTable::kCountMask,
                           row.flip, ids, out);
    add_bits<kEdges>(first, (edges & ~kNext) | moved, first);
  }
}

#if HWY_TARGET != HWY_SCALAR

/// Writes the segments of a row of 2D tiles. The four vertex numbers of a tile are in one register, their increments in
/// another.
void write_segments(const TileOutput<2>& row, const RowTable& table, const OwnTiles<2>& own) {
  struct Moves {
    alignas(16) std::array<std::array<Index, 4>, 32> moved{}, advance{};  // by key
  };
  static constexpr auto kMoves = [] {
    Moves moves;
    constexpr std::uint32_t kNext = next_edges<2>();
    for (unsigned s = 0; s < 32; ++s) {
      const std::uint32_t edges = critical_edges<2>(signature_of<2>(s));
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
  const std::uint32_t* const entries = table.entries;
  auto first = hn::LoadU(d, row.first.data());
  TileOutput<2> last = row;
  // Each store writes two segments; the next tile overwrites a superfluous second one. The last tile is written
  // exactly.
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
  write_generic<2, true>(last, table, own);
}

#endif

template <int N, bool Variants>
HWY_INLINE void write_by(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (N >= 3)
    return row.flip ? write_lanes<N, true, Variants>(row, table, own)
                    : write_lanes<N, false, Variants>(row, table, own);
#endif
  return write_generic<N, Variants>(row, table, own);
}

template <int N>
HWY_INLINE void write_tiles(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (N == 2) return write_segments(row, table, own);
#endif
  if constexpr (N < 4)
    if (table.more_keys) return write_by<N, true>(row, table, own);
  return write_by<N, false>(row, table, own);
}

// Highway's dispatch tables cannot hold templates.
TileCount count2(const TileRow& r, const RowTable& t, const TileRoom& m) { return count_tiles<2>(r, t, m); }
TileCount count3(const TileRow& r, const RowTable& t, const TileRoom& m) { return count_tiles<3>(r, t, m); }
TileCount count4(const TileRow& r, const RowTable& t, const TileRoom& m) { return count_tiles<4>(r, t, m); }
void edges2(const TileEdges& r) { tile_edges<2>(r); }
void write2(const TileOutput<2>& r, const RowTable& t, const OwnTiles<2>& o) { write_tiles<2>(r, t, o); }
void edges3(const TileEdges& r) { tile_edges<3>(r); }
void write3(const TileOutput<3>& r, const RowTable& t, const OwnTiles<3>& o) { write_tiles<3>(r, t, o); }
void edges4(const TileEdges& r) { tile_edges<4>(r); }
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

#if HWY_ARCH_X86
const bool kHasGfni = [] {
  __builtin_cpu_init();
  return __builtin_cpu_supports("gfni") != 0;
}();
#endif

#define TEGL_DISPATCH(N)                                                                                     \
  HWY_EXPORT(count##N);                                                                                      \
  HWY_EXPORT(edges##N);                                                                                      \
  HWY_EXPORT(write##N);                                                                                      \
  template <>                                                                                                \
  TileCount count_tile_row<N>(const TileRow& row, const RowTable& table, const TileRoom& room) noexcept {    \
    return HWY_DYNAMIC_DISPATCH(count##N)(row, table, room);                                                 \
  }                                                                                                          \
  template <>                                                                                                \
  void list_tile_edges<N>(const TileEdges& row) noexcept {                                                   \
    HWY_DYNAMIC_DISPATCH(edges##N)(row);                                                                     \
  }                                                                                                          \
  template <>                                                                                                \
  void write_tile_row<N>(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) noexcept { \
    HWY_DYNAMIC_DISPATCH(write##N)(row, table, own);                                                         \
  }
TEGL_DISPATCH(2)
TEGL_DISPATCH(3)
TEGL_DISPATCH(4)
#undef TEGL_DISPATCH

HWY_EXPORT(count_edges);
std::uint32_t count_edge_row(const Word* a, const Word* b, std::size_t samples, const Word* valid, Word* critical,
                             std::uint32_t* prefix) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_edges)(a, b, samples, valid, critical, prefix);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
