// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the neighbours of the points of a contour's net (see contour_net.hpp).
#include "position/contour_net.hpp"

#include "base/workers.hpp"

namespace tegl::detail {

namespace {

template <int N>
constexpr std::uint32_t link_bits(typename ContourNet<N>::Side side, std::uint32_t point) {
  return static_cast<std::uint32_t>(side) << 30 | point;
}

}  // namespace

template <int N>
ContourNet<N>::ContourNet(const CriticalEdges<N>& edges, JoinsHigh<N> joins_high, unsigned threads) : edges_(edges) {
  links_.resize(std::size_t{edges.count()} * kCurves * 2);
  for (int axis = 0; axis < N; ++axis)
    for_each_part(edges.rows(), threads, {}, [&](std::size_t from, std::size_t end) {
      for (std::size_t row = from; row < end; ++row) link_row(axis, row, joins_high);
    });
}

template <int N>
void ContourNet<N>::link_row(int axis, std::size_t row, JoinsHigh<N> joins_high) {
  const CriticalEdges<N>& e = edges_;
  SampleIndex<N> index = e.index_of(row);
  if (axis > 0 && index[axis] + 1 >= e.sizes()[axis]) return;
  // the sample of a row and a position, moved by `steps` along axis b
  const auto moved = [&](std::size_t at_row, std::size_t i, int b, std::size_t steps) {
    return b == 0 ? std::pair(at_row, i + steps) : std::pair(at_row + steps * e.stride(b), i);
  };
  const auto is_high = [&](const std::pair<std::size_t, std::size_t>& at) { return e.is_high(at.first, at.second); };
  const auto is_missing = [&](const std::pair<std::size_t, std::size_t>& at) {
    return e.is_missing(at.first, at.second);
  };
  for (std::size_t w = 0; w < e.words(); ++w) {
    Word rest = e.critical(axis, row, w, true);
    if (rest == 0) continue;
    Number point = e.number(axis, row, w * kWordBits);
    for (; rest != 0; rest &= rest - 1, ++point) {
      const std::size_t i = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
      index[0] = i;
      Link* const links = links_.data() + std::size_t{point} * kCurves * 2;
      const auto low = std::pair(row, i);
      const auto up = moved(row, i, axis, 1);
      const bool low_high = is_high(low);
      for (int c = 0; c < kCurves; ++c) {
        const int b = other_axis(axis, c);
        for (unsigned side = 0; side < 2; ++side) {
          Link& link = links[2 * c + static_cast<int>(side)];
          link = {};
          if (side == 0 ? index[b] == 0 : index[b] + 1 >= e.sizes()[b]) continue;
          const std::size_t step = side == 0 ? ~std::size_t{0} : 1;
          const auto low_beyond = moved(low.first, low.second, b, step);
          const auto up_beyond = moved(up.first, up.second, b, step);
          if (is_missing(low_beyond) || is_missing(up_beyond)) continue;
          const bool differs_at_low = is_high(low_beyond) != low_high;
          const bool differs_at_up = is_high(up_beyond) == low_high;
          Side to = differs_at_low ? Side::lower : differs_at_up ? Side::upper : Side::across;
          if (differs_at_low && differs_at_up) {
            // ambiguous: separate high corners are cut off, each by the points at both of its edges
            auto base = index;
            if (side == 0) base[b] -= 1;
            const bool joined = joins_high(base, 1u << axis | 1u << b);
            to = low_high != joined ? Side::lower : Side::upper;
          }
          const auto& at = to == Side::across  ? low_beyond
                           : to == Side::lower ? (side == 0 ? low_beyond : low)
                                               : (side == 0 ? up_beyond : up);
          link.bits = link_bits<N>(to, e.number(to == Side::across ? axis : b, at.first, at.second));
        }
      }
    }
  }
}

template class ContourNet<2>;
template class ContourNet<3>;
template class ContourNet<4>;
template class ContourNet<5>;

}  // namespace tegl::detail
