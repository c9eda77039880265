// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the neighbours of the points of a contour's net, for the 64 samples of a word at a time (link_rows).
// Highway's foreach_target compiles this file once per instruction set, because of the bit counts.
#include "position/contour_net.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "position/net_rows.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

/// Bits of the word w of a row, moved by `shift` samples: bit i belongs to sample i + shift.
template <class Bits>
HWY_INLINE Word shifted(const Bits& bits, std::size_t w, std::size_t words, int shift) {
  const Word here = bits(w);
  if (shift == 0) return here;
  if (shift > 0) return here >> 1 | (w + 1 < words ? bits(w + 1) << (kWordBits - 1) : 0);
  return here << 1 | (w > 0 ? bits(w - 1) >> (kWordBits - 1) : 0);
}

/// The critical edges along one axis of one row, moved by `shift` samples.
template <int N>
struct EdgesOfRow {
  int axis = 0;
  std::size_t row = 0;
  int shift = 0;
  std::uint32_t next = 0;  ///< number of the first edge of the current word
  Word bits = 0;           ///< of the current word

  void start(const SampleSigns<N>& signs, const CriticalEdges<N>& edges) noexcept {
    next = edges.first_in_row(axis, row);
    if (shift > 0) next += static_cast<std::uint32_t>(signs.critical(axis, row, 0, true) & 1u);
    bits = 0;
  }
  HWY_INLINE void enter(const SampleSigns<N>& signs, std::size_t w) noexcept {
    next += static_cast<std::uint32_t>(std::popcount(bits));
    bits = shifted(Critical{signs, axis, row}, w, signs.words(), shift);
  }

 private:
  struct Critical {
    const SampleSigns<N>& signs;
    int axis;
    std::size_t row;
    Word operator()(std::size_t w) const noexcept { return signs.critical(axis, row, w, true); }
  };
};

/// The squares on one side of the edges of a row, in the planes along two axes.
template <int N>
struct SquaresOfRow {
  using Side = typename ContourNet<N>::Side;
  int other = 0;                          ///< axis across the edges of the row
  bool before = false;                    ///< whether the squares lie on the side of decreasing coordinates
  bool in_grid = false;                   ///< unless they are outside for the whole row
  std::array<EdgesOfRow<N>, 3> beside{};  ///< by Side: across, lower, upper
  Word none = 0;                          ///< squares outside of the image or with missing samples

  /// Squares of the edges along `axis` in the row, whose first sample has index `index`.
  void start(const SampleSigns<N>& signs, const CriticalEdges<N>& edges, int axis, std::size_t row,
             const SampleIndex<N>& index) noexcept {
    in_grid = other == 0 || (before ? index[other] > 0 : index[other] + 1 < signs.sizes()[other]);
    if (!in_grid) return;
    const int back = before && other == 0 ? -1 : 0;  // from the edge to the edges at its ends, along the row
    const std::size_t beyond = other == 0 ? row : before ? row - signs.stride(other) : row + signs.stride(other);
    const std::size_t base = before ? beyond : row;
    beside[0] = {axis, beyond, other == 0 ? (before ? -1 : 1) : 0};
    beside[1] = {other, base, back};
    beside[2] = {other, axis == 0 ? base : base + signs.stride(axis), axis == 0 ? 1 : back};
    for (EdgesOfRow<N>& list : beside) list.start(signs, edges);
  }
  HWY_INLINE void enter(const SampleSigns<N>& signs, std::size_t w) noexcept {
    if (!in_grid) return;
    for (EdgesOfRow<N>& list : beside) list.enter(signs, w);
    none = 0;
    if (other == 0) none = before ? (w == 0 ? 1 : 0) : last_sample(signs, w);
    if (signs.any_missing()) none |= missing(signs, w);
  }
  /// The link of the point at `bit` of the current word.
  HWY_INLINE std::uint32_t link(Word bit, Side side) const noexcept {
    const EdgesOfRow<N>& list = beside[static_cast<std::size_t>(side)];
    return static_cast<std::uint32_t>(side) << 30 |
           (list.next + static_cast<std::uint32_t>(std::popcount(list.bits & (bit - 1))));
  }

 private:
  static Word last_sample(const SampleSigns<N>& signs, std::size_t w) noexcept {
    const std::size_t last = signs.sizes()[0] - 1;
    return last / kWordBits == w ? Word{1} << (last % kWordBits) : 0;
  }
  /// Squares with a missing sample beyond the edge: at its lower or at its upper end.
  Word missing(const SampleSigns<N>& signs, std::size_t w) const noexcept {
    const EdgesOfRow<N>& across = beside[0];
    const auto of_row = [&](std::size_t row, int shift) {
      return shifted([&](std::size_t word) { return signs.missing(row, word); }, w, signs.words(), shift);
    };
    return of_row(across.row, across.shift) |
           (across.axis == 0 ? of_row(across.row, 1) : of_row(across.row + signs.stride(across.axis), across.shift));
  }
};

template <int N>
HWY_INLINE void link_row(const SampleSigns<N>& signs, const CriticalEdges<N>& edges, int axis, std::size_t row,
                         JoinsHigh<N> joins_high, typename ContourNet<N>::Link* all_links) {
  using Net = ContourNet<N>;
  using Side = typename Net::Side;
  SampleIndex<N> index = signs.index_of(row);
  std::array<SquaresOfRow<N>, 2 * Net::kCurves> squares;
  for (int c = 0; c < Net::kCurves; ++c)
    for (int side = 0; side < 2; ++side) {
      SquaresOfRow<N>& of_side = squares[2 * c + side];
      of_side.other = Net::other_axis(axis, c);
      of_side.before = side == 0;
      of_side.start(signs, edges, axis, row, index);
    }
  std::array<typename Net::Link*, Net::kCurves> links;
  const std::uint32_t first = edges.first_in_row(axis, row);
  for (std::size_t c = 0; c < links.size(); ++c) links[c] = all_links + 2 * (c * edges.count() + first);
  std::uint32_t left = edges.first_in_row(axis, row + 1) - first;
  for (std::size_t w = 0; left != 0; ++w) {
    for (SquaresOfRow<N>& of_side : squares) of_side.enter(signs, w);
    for (Word rest = signs.critical(axis, row, w, true); rest != 0; rest &= rest - 1, --left) {
      const Word bit = rest & (~rest + 1);
      for (std::size_t s = 0; s < squares.size(); ++s) {
        const SquaresOfRow<N>& of_side = squares[s];
        auto& link = *links[s / 2]++;
        link = {};
        if (!of_side.in_grid || (of_side.none & bit) != 0) continue;
        const bool at_low = (of_side.beside[1].bits & bit) != 0, at_up = (of_side.beside[2].bits & bit) != 0;
        Side to = at_low ? Side::lower : at_up ? Side::upper : Side::across;
        if (at_low && at_up) {
          // ambiguous: separate high corners are cut off, each by the points at both of its edges
          SampleIndex<N> base = index;
          base[0] = w * kWordBits + static_cast<std::size_t>(std::countr_zero(bit));
          const bool low_high = signs.is_high(row, base[0]);
          if (of_side.before) base[of_side.other] -= 1;
          to = low_high != joins_high(base, 1u << axis | 1u << of_side.other) ? Side::lower : Side::upper;
        }
        link.bits = of_side.link(bit, to);
      }
    }
  }
}

template <int N>
HWY_INLINE void link_all(const NetRows<N>& net, int axis, std::size_t from, std::size_t end) {
  for (std::size_t row = from; row < end; ++row)
    if (net.edges.has_edges(axis, row)) link_row<N>(net.signs, net.edges, axis, row, net.joins_high, net.links);
}

// Highway's dispatch tables cannot hold templates.
void link_rows2(const NetRows<2>& net, int axis, std::size_t from, std::size_t end) { link_all(net, axis, from, end); }
void link_rows3(const NetRows<3>& net, int axis, std::size_t from, std::size_t end) { link_all(net, axis, from, end); }
void link_rows4(const NetRows<4>& net, int axis, std::size_t from, std::size_t end) { link_all(net, axis, from, end); }
void link_rows5(const NetRows<5>& net, int axis, std::size_t from, std::size_t end) { link_all(net, axis, from, end); }

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

#define TEGL_DISPATCH(N, name)                                                                     \
  HWY_EXPORT(name);                                                                                \
  template <>                                                                                      \
  void link_rows<N>(const NetRows<N>& net, int axis, std::size_t from, std::size_t end) noexcept { \
    HWY_DYNAMIC_DISPATCH(name)(net, axis, from, end);                                              \
  }
TEGL_DISPATCH(2, link_rows2)
TEGL_DISPATCH(3, link_rows3)
TEGL_DISPATCH(4, link_rows4)
TEGL_DISPATCH(5, link_rows5)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
