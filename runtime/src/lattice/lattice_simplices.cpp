// SPDX-License-Identifier: BSD-3-Clause
//
// Finds active cells, numbers their vertices and writes their simplices. Highway's foreach_target compiles this file
// once per instruction set.
#include "lattice/lattice_simplices.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lattice/lattice_simplices.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The corners of 64 cells, and those cells that are active.
class CellWord {
 public:
  HWY_INLINE explicit CellWord(const LatticeCellRow& row) : row_(row), corners_(row.cell->corners.size()) {
    for (std::size_t c = 0; c < corners_; ++c) {
      const std::ptrdiff_t along = row.cell->corners[c][0];
      from_[c] = row.corners[c] + (along < 0 ? -1 : 0);
      shift_[c] = along < 0 ? kWordBits - 1 : static_cast<std::size_t>(along);
    }
  }

  /// Reads the corners of the cells from word w on. Returns the active cells.
  HWY_INLINE Word read(std::size_t w) {
    Word any = 0, all = ~Word{0};
    for (std::size_t c = 0; c < corners_; ++c) {
      const Word* const from = from_[c] + w;
      bits_[c] = from[0] >> shift_[c] | from[1] << 1 << (kWordBits - 1 - shift_[c]);
      any |= bits_[c];
      all &= bits_[c];
    }
    return any & ~all & in_range(w);
  }

  /// The signature of one of the cells.
  HWY_INLINE unsigned signature(unsigned bit) const {
    const hn::CappedTag<Word, LatticeCellRow::kMostCorners> d;
    constexpr std::size_t kLanes = hn::MaxLanes(d);
    const auto one = hn::Set(d, Word{1} << bit);
    unsigned signature = 0;
    for (std::size_t c = 0; c < LatticeCellRow::kMostCorners; c += kLanes) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::TestBit(hn::Load(d, bits_.data() + c), one), bits);
      signature |= unsigned{bits[0]} << c;
    }
    return signature;
  }

 private:
  HWY_INLINE Word in_range(std::size_t w) const {
    const auto from = static_cast<std::ptrdiff_t>(w * kWordBits);
    constexpr auto kBits = static_cast<std::ptrdiff_t>(kWordBits);
    if (row_.first <= from && from + kBits <= row_.end) return ~Word{0};
    const auto low = static_cast<unsigned>(std::clamp<std::ptrdiff_t>(row_.first - from, 0, kBits));
    const auto high = static_cast<unsigned>(std::clamp<std::ptrdiff_t>(row_.end - from, 0, kBits));
    return low >= high ? 0 : ~Word{0} >> (kWordBits - (high - low)) << low;
  }

  const LatticeCellRow& row_;
  std::size_t corners_;
  std::array<const Word*, LatticeCellRow::kMostCorners> from_;
  std::array<std::size_t, LatticeCellRow::kMostCorners> shift_;
  alignas(64) std::array<Word, LatticeCellRow::kMostCorners> bits_{};  // 0 for corners that the cell does not have
};

std::size_t list_active(const LatticeCellRow& row, ActiveInRow* out) {
  CellWord cells(row);
  std::size_t count = 0;
  for (std::size_t w = 0; w < row.words; ++w)
    for (Word rest = cells.read(w); rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      out[count++] = {static_cast<std::uint32_t>(w * kWordBits + bit), cells.signature(bit)};
    }
  return count;
}

LatticeCellCount count_active(const LatticeCellRow& row) {
  LatticeCellCount count;
  CellWord cells(row);
  const std::uint8_t* const sizes = row.cell->sizes.data();
  for (std::size_t w = 0; w < row.words; ++w) {
    const Word active = cells.read(w);
    if (active == 0) continue;
    count.active += static_cast<std::uint32_t>(std::popcount(active));
    for (Word rest = active; rest != 0; rest &= rest - 1)
      count.simplices += sizes[cells.signature(static_cast<unsigned>(std::countr_zero(rest)))];
  }
  return count;
}

/// Numbers of the vertices of 64 cells on their edges, as many as Lanes.
template <std::size_t Lanes>
class EdgeWord {
 public:
  HWY_INLINE EdgeWord(const EdgeStream* streams, std::size_t edges) : streams_(streams), edges_(edges) {}

  /// Reads the crossings of the cells from word w on.
  HWY_INLINE void read(std::size_t w) {
    for (std::size_t e = 0; e < edges_; ++e) {
      const EdgeStream& stream = streams_[e];
      const Word here = stream.bits[w];
      Word first = Word{stream.first} + stream.before[w];
      // the edge of the sample before or after: one bit aside, which is counted apart if it is in another word
      if (stream.at < 0) {
        const Word last = w == 0 ? 0 : stream.bits[w - 1] >> (kWordBits - 1);
        bits_[e] = here << 1 | last;
        first_[e] = first - last;
      } else {
        const auto ahead = static_cast<unsigned>(stream.at);
        bits_[e] = here >> ahead;
        first_[e] = first + (here & ahead);
      }
    }
  }

#if HWY_TARGET <= HWY_AVX2
  using Numbers = hn::Vec<hn::CappedTag<Index, Lanes>>;
  /// The number of each edge's vertex of one of the cells, if the edge is crossed.
  HWY_INLINE Numbers numbers(unsigned bit) const {
    const hn::CappedTag<Word, Lanes> d;
    const hn::Rebind<Index, decltype(d)> part;
    const hn::CappedTag<Index, Lanes> whole;
    constexpr std::size_t kPart = hn::MaxLanes(d);
    const auto below = hn::Set(d, (Word{1} << bit) - 1);
    const auto of = [&](std::size_t e) HWY_ATTR {
      const auto count = hn::PopulationCount(hn::And(hn::Load(d, bits_.data() + e), below));
      return hn::TruncateTo(part, hn::Add(count, hn::Load(d, first_.data() + e)));
    };
    if constexpr (kPart == Lanes)
      return of(0);
    else
      return hn::Combine(whole, of(kPart), of(0));
  }
#endif

  HWY_INLINE Index number(std::size_t e, unsigned bit) const {
    return static_cast<Index>(first_[e] + static_cast<Word>(std::popcount(bits_[e] & ((Word{1} << bit) - 1))));
  }

 private:
  const EdgeStream* streams_;
  std::size_t edges_;
  alignas(64) std::array<Word, Lanes> bits_{}, first_{};
};

#if HWY_TARGET <= HWY_AVX2

/// Whether the numbers of all vertices are in one register.
template <std::size_t Lanes>
inline constexpr bool kInRegister = hn::MaxLanes(hn::CappedTag<Index, Lanes>()) == Lanes;

/// Writes the simplices of a cell by a list of its vertices, a whole register at a time.
template <std::size_t N, std::size_t Lanes>
HWY_INLINE void put_by_register(const EdgeWord<Lanes>& edges, unsigned bit, const std::uint8_t* list, std::size_t count,
                                Index* out, const Index* end) {
  const hn::CappedTag<Index, Lanes> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  constexpr std::size_t kAtOnce = Lanes / N * N;
  const auto numbers = edges.numbers(bit);
  for (std::size_t done = 0; done < N * count; done += kAtOnce) {
    const auto corners = hn::IndicesFromVec(d, hn::PromoteTo(d, hn::LoadU(bytes, list + done)));
    const auto some = hn::TableLookupLanes(numbers, corners);
    if (HWY_LIKELY(end - (out + done) >= static_cast<std::ptrdiff_t>(Lanes))) {
      hn::StoreU(some, d, out + done);
      continue;
    }
    alignas(64) std::array<Index, Lanes> last;
    hn::Store(some, d, last.data());
    std::copy_n(last.begin(), std::min<std::ptrdiff_t>(end - (out + done), Lanes), out + done);
  }
}

#endif

template <std::size_t N, std::size_t Lanes>
HWY_INLINE std::array<Index, N>* write_of(const LatticeCellRow& row, const EdgeStream* streams,
                                          std::array<Index, N>* out, [[maybe_unused]] std::array<Index, N>* end) {
  const LatticeCell& cell = *row.cell;
  const std::uint8_t* const sizes = cell.sizes.data();
  const std::uint8_t* const lists = cell.lists.data();
  CellWord cells(row);
  EdgeWord<Lanes> edges(streams, cell.edges.size());
  for (std::size_t w = 0; w < row.words; ++w) {
    Word rest = cells.read(w);
    if (rest == 0) continue;
    edges.read(w);
    for (; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      const unsigned signature = cells.signature(bit);
      const std::uint8_t* const list = lists + signature * LatticeCell::kList;
      const std::size_t count = sizes[signature];
#if HWY_TARGET <= HWY_AVX2
      if constexpr (kInRegister<Lanes>) {
        put_by_register<N, Lanes>(edges, bit, list, count, out->data(), end->data());
        out += count;
        continue;
      }
#endif
      std::array<Index, Lanes> vertices;
      for (std::uint32_t crossed = cell.contours[signature].crossed; crossed != 0; crossed &= crossed - 1) {
        const auto e = static_cast<unsigned>(std::countr_zero(crossed));
        vertices[e] = edges.number(e, bit);
      }
      for (std::size_t s = 0; s < count; ++s, ++out)
        for (std::size_t v = 0; v < N; ++v) (*out)[v] = vertices[list[N * s + v]];
    }
  }
  return out;
}

template <std::size_t N>
HWY_INLINE std::array<Index, N>* write(const LatticeCellRow& row, const EdgeStream* streams, std::array<Index, N>* out,
                                       std::array<Index, N>* end) {
  if (row.cell->edges.size() <= 8) return write_of<N, 8>(row, streams, out, end);
  return write_of<N, 16>(row, streams, out, end);
}

std::array<Index, 2>* write2(const LatticeCellRow& row, const EdgeStream* streams, std::array<Index, 2>* out,
                             std::array<Index, 2>* end) {
  return write(row, streams, out, end);
}
std::array<Index, 3>* write3(const LatticeCellRow& row, const EdgeStream* streams, std::array<Index, 3>* out,
                             std::array<Index, 3>* end) {
  return write(row, streams, out, end);
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(list_active);
std::size_t list_cells(const LatticeCellRow& row, ActiveInRow* out) noexcept {
  return HWY_DYNAMIC_DISPATCH(list_active)(row, out);
}

HWY_EXPORT(count_active);
LatticeCellCount count_cells(const LatticeCellRow& row) noexcept { return HWY_DYNAMIC_DISPATCH(count_active)(row); }

HWY_EXPORT(write2);
std::array<Index, 2>* write_simplices(const LatticeCellRow& row, const EdgeStream* streams, std::array<Index, 2>* out,
                                      std::array<Index, 2>* end) noexcept {
  return HWY_DYNAMIC_DISPATCH(write2)(row, streams, out, end);
}
HWY_EXPORT(write3);
std::array<Index, 3>* write_simplices(const LatticeCellRow& row, const EdgeStream* streams, std::array<Index, 3>* out,
                                      std::array<Index, 3>* end) noexcept {
  return HWY_DYNAMIC_DISPATCH(write3)(row, streams, out, end);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
