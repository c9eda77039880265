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

/// The corners of 64 cells, at most `Corners` of each, and those cells that are active.
template <std::size_t Corners>
class CellWord {
 public:
  HWY_INLINE explicit CellWord(const LatticeCellRow& row) : row_(row), corners_(row.cell->corners.size()) {
    for (std::size_t c = 0; c < corners_; ++c) {
      from_[c] = row.bits + row.corners[c];
      shift_[c] = row.cell->shifts[c];
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
    const hn::CappedTag<Word, Corners> d;
    constexpr std::size_t kLanes = hn::MaxLanes(d);
    const auto one = hn::Set(d, Word{1} << bit);
    unsigned signature = 0;
    for (std::size_t c = 0; c < Corners; c += kLanes) {
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
  std::array<const Word*, Corners> from_;
  std::array<std::size_t, Corners> shift_;
  alignas(64) std::array<Word, Corners> bits_{};  // 0 for corners that the cell does not have
};

/// Calls visit(word, signature) for the active cells of a row in order, and counts them.
template <std::size_t Corners, class Visit>
HWY_INLINE std::uint32_t for_each_active(const LatticeCellRow& row, const Visit& visit) {
  CellWord<Corners> cells(row);
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < row.words; ++w) {
    const Word active = cells.read(w);
    if (active == 0) continue;
    count += static_cast<std::uint32_t>(std::popcount(active));
    for (Word rest = active; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      visit(w * kWordBits + bit, cells.signature(bit));
    }
  }
  return count;
}
template <class Visit>
HWY_INLINE std::uint32_t for_each_active(const LatticeCellRow& row, const Visit& visit) {
  if (row.cell->corners.size() <= 8) return for_each_active<8>(row, visit);
  return for_each_active<LatticeCellRow::kMostCorners>(row, visit);
}

std::size_t list_active(const LatticeCellRow& row, ActiveInRow* out) {
  return for_each_active(row, [&](std::size_t at, unsigned signature) HWY_ATTR {
    *out++ = {static_cast<std::uint32_t>(at), signature};
  });
}

std::uint32_t mark_active(const LatticeCellRow& row, std::atomic<bool>* occurs) {
  return for_each_active(row, [&](std::size_t, unsigned signature) HWY_ATTR {
    // most are marked: a store would take the memory from other threads
    if (!occurs[signature].load(std::memory_order_relaxed)) occurs[signature].store(true, std::memory_order_relaxed);
  });
}

LatticeCellCount count_active(const LatticeCellRow& row) {
  LatticeCellCount count;
  const LatticeCell::Contour* const contours = row.cell->contours.data();
  count.active = for_each_active(row, [&](std::size_t, unsigned signature) HWY_ATTR {
    count.simplices += contours[signature].simplices;
    count.own += contours[signature].own;
  });
  return count;
}

/// Numbers of the vertices of 64 cells: on their edges, then own vertices, as many as Lanes.
template <std::size_t Lanes>
class EdgeWord {
 public:
  /// `own`: number of the first own vertex.
  HWY_INLINE EdgeWord(const EdgeStream* streams, std::size_t edges, Index own) : streams_(streams), edges_(edges) {
    set_own(own);
  }

  /// The number of own vertices of a cell that have a lane.
  [[nodiscard]] HWY_INLINE std::size_t own_lanes() const { return Lanes - edges_; }
  /// `own`: number of the first own vertex of the next cell.
  HWY_INLINE void set_own(Index own) {
    for (std::size_t v = edges_; v < Lanes; ++v) first_[v] = Word{own} + (v - edges_);
  }

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
  /// The numbers of `Count` vertices of one of the cells from `from` on; of edges, if these are crossed.
  template <std::size_t Count>
  HWY_INLINE hn::Vec<hn::CappedTag<Index, Count>> numbers(unsigned bit, std::size_t from = 0) const {
    const hn::CappedTag<Word, Count> d;
    const hn::Rebind<Index, decltype(d)> part;
    const hn::CappedTag<Index, Count> whole;
    constexpr std::size_t kPart = hn::MaxLanes(d);
    const auto below = hn::Set(d, (Word{1} << bit) - 1);
    const auto of = [&](std::size_t e) HWY_ATTR {
      const auto count = hn::PopulationCount(hn::And(hn::Load(d, bits_.data() + e), below));
      return hn::TruncateTo(part, hn::Add(count, hn::Load(d, first_.data() + e)));
    };
    if constexpr (kPart == Count)
      return of(from);
    else
      return hn::Combine(whole, of(from + kPart), of(from));
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

/// The most numbers of vertices in a register.
template <std::size_t Lanes>
inline constexpr std::size_t kInRegister = hn::MaxLanes(hn::CappedTag<Index, Lanes>());
/// Whether the numbers of all vertices are in one register, or in two of the largest.
template <std::size_t Lanes>
inline constexpr bool kInRegisters = kInRegister<Lanes> == Lanes || (kInRegister<Lanes> == 16 && Lanes == 32);

/// Writes the simplices of a cell by a list of its vertices, a whole register at a time.
template <std::size_t N, std::size_t Lanes>
HWY_INLINE void put_by_register(const EdgeWord<Lanes>& vertices, unsigned bit, const std::uint8_t* list,
                                std::size_t count, Index* out, const Index* end) {
  constexpr std::size_t kLanes = kInRegister<Lanes>, kAtOnce = kLanes / N * N;
  const hn::CappedTag<Index, kLanes> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const auto numbers = vertices.template numbers<kLanes>(bit);
  const auto others = vertices.template numbers<kLanes>(bit, Lanes - kLanes);
  for (std::size_t done = 0; done < N * count; done += kAtOnce) {
    const auto corners = hn::PromoteTo(d, hn::LoadU(bytes, list + done));
    auto some = numbers;
    if constexpr (kLanes == Lanes) {
      some = hn::TableLookupLanes(numbers, hn::IndicesFromVec(d, corners));
    } else {
      const auto at = hn::IndicesFromVec(d, hn::And(corners, hn::Set(d, Index{kLanes - 1})));
      some = hn::IfThenElse(hn::Lt(corners, hn::Set(d, Index{kLanes})), hn::TableLookupLanes(numbers, at),
                            hn::TableLookupLanes(others, at));
    }
    if (HWY_LIKELY(end - (out + done) >= static_cast<std::ptrdiff_t>(kLanes))) {
      hn::StoreU(some, d, out + done);
      continue;
    }
    alignas(64) std::array<Index, kLanes> last;
    hn::Store(some, d, last.data());
    std::copy_n(last.begin(), std::min<std::ptrdiff_t>(end - (out + done), kLanes), out + done);
  }
}

#endif

/// Writes the simplices of a cell, one after the other. `crossed`: its edges; `own`: of its own vertices the first one.
template <std::size_t N, std::size_t Lanes>
HWY_INLINE void put_one_by_one(const EdgeWord<Lanes>& edges, unsigned bit, const LatticeCell& cell,
                               std::uint32_t crossed, const LatticeCell::Contour& contour, Index own,
                               std::array<Index, N>* out) {
  std::array<Index, 256> vertices;
  for (; crossed != 0; crossed &= crossed - 1) {
    const auto e = static_cast<unsigned>(std::countr_zero(crossed));
    vertices[e] = edges.number(e, bit);
  }
  for (Index j = 0; j < contour.own; ++j) vertices[cell.edges.size() + j] = own + j;
  const std::uint8_t* list = cell.lists.data() + contour.first;
  for (std::size_t s = 0; s < contour.simplices; ++s, ++out, list += N)
    for (std::size_t v = 0; v < N; ++v) (*out)[v] = vertices[list[v]];
}

template <std::size_t N, std::size_t Lanes, std::size_t Corners>
HWY_INLINE std::array<Index, N>* write_of(const LatticeCellRow& row, const EdgeStream* streams, Index& own,
                                          std::array<Index, N>* out, [[maybe_unused]] std::array<Index, N>* end) {
  const LatticeCell& cell = *row.cell;
  const LatticeCell::Contour* const contours = cell.contours.data();
  [[maybe_unused]] const std::uint8_t* const lists = cell.lists.data();
  CellWord<Corners> cells(row);
  EdgeWord<Lanes> edges(streams, cell.edges.size(), own);
  for (std::size_t w = 0; w < row.words; ++w) {
    Word rest = cells.read(w);
    if (rest == 0) continue;
    edges.read(w);
    for (; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      const unsigned signature = cells.signature(bit);
      const LatticeCell::Contour contour = contours[signature];
      const auto put = [&]() HWY_ATTR {
#if HWY_TARGET <= HWY_AVX2
        if constexpr (kInRegisters<Lanes>)
          if (HWY_LIKELY(contour.own <= edges.own_lanes()))
            return put_by_register<N, Lanes>(edges, bit, lists + contour.first, contour.simplices, out->data(),
                                             end->data());
#endif
        put_one_by_one<N, Lanes>(edges, bit, cell, cell.crossed[signature], contour, own, out);
      };
      put();
      out += contour.simplices;
      if (contour.own == 0) continue;
      own += contour.own;
      edges.set_own(own);
    }
  }
  return out;
}

template <std::size_t N>
HWY_INLINE std::array<Index, N>* write(const LatticeCellRow& row, const EdgeStream* streams, Index& own,
                                       std::array<Index, N>* out, std::array<Index, N>* end) {
  if constexpr (N < 4) {
    if (row.cell->edges.size() <= 8) return write_of<N, 8, 8>(row, streams, own, out, end);
    return write_of<N, 16, 8>(row, streams, own, out, end);
  } else {
    if (row.cell->corners.size() <= 8) return write_of<N, 32, 8>(row, streams, own, out, end);
    return write_of<N, 32, LatticeCellRow::kMostCorners>(row, streams, own, out, end);
  }
}

std::array<Index, 2>* write2(const LatticeCellRow& row, const EdgeStream* streams, Index& own,
                             std::array<Index, 2>* out, std::array<Index, 2>* end) {
  return write(row, streams, own, out, end);
}
std::array<Index, 3>* write3(const LatticeCellRow& row, const EdgeStream* streams, Index& own,
                             std::array<Index, 3>* out, std::array<Index, 3>* end) {
  return write(row, streams, own, out, end);
}
std::array<Index, 4>* write4(const LatticeCellRow& row, const EdgeStream* streams, Index& own,
                             std::array<Index, 4>* out, std::array<Index, 4>* end) {
  return write(row, streams, own, out, end);
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

HWY_EXPORT(mark_active);
std::uint32_t mark_signatures(const LatticeCellRow& row, std::atomic<bool>* occurs) noexcept {
  return HWY_DYNAMIC_DISPATCH(mark_active)(row, occurs);
}

HWY_EXPORT(count_active);
LatticeCellCount count_cells(const LatticeCellRow& row) noexcept { return HWY_DYNAMIC_DISPATCH(count_active)(row); }

#define TEGL_DISPATCH(N, name)                                                                            \
  HWY_EXPORT(name);                                                                                       \
  std::array<Index, N>* write_simplices(const LatticeCellRow& row, const EdgeStream* streams, Index& own, \
                                        std::array<Index, N>* out, std::array<Index, N>* end) noexcept {  \
    return HWY_DYNAMIC_DISPATCH(name)(row, streams, own, out, end);                                       \
  }
TEGL_DISPATCH(2, write2)
TEGL_DISPATCH(3, write3)
TEGL_DISPATCH(4, write4)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
