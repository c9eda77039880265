// SPDX-License-Identifier: BSD-3-Clause
//
// Makes the net of a contour (see contour_net.hpp).
#include "position/contour_net.hpp"

#include "base/workers.hpp"

namespace tegl::detail {

template <int N>
ContourNet<N>::ContourNet(const SampleSigns<N>& signs, const CriticalEdges<N>& edges, JoinsHigh<N> joins_high,
                          unsigned threads)
    : edges_(edges) {
  links_.resize(std::size_t{edges.count()} * kCurves * 2);
  const NetRows<N> net{signs, edges, joins_high, links_.data()};
  for (int axis = 0; axis < N; ++axis)
    for_each_part(signs.rows(), threads, {},
                  [&](std::size_t from, std::size_t end) { link_rows(net, axis, from, end); });
}

template class ContourNet<2>;
template class ContourNet<3>;
template class ContourNet<4>;
template class ContourNet<5>;

}  // namespace tegl::detail
