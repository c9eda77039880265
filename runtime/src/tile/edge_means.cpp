// SPDX-License-Identifier: BSD-3-Clause
//
// Adds points on edges in the lanes of registers (see edge_means.hpp). Highway's foreach_target compiles this file once
// per instruction set. The operations are those of mask_place, in the same order, so that the positions are equal bit
// by bit.
#include "tile/edge_means.hpp"

#include "tile/extract_tables.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tile/edge_means.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void means_of_edges(const EdgeMeans& means, EdgeMeans::Coordinates& out) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<std::uint64_t, decltype(d)> bits;
  constexpr unsigned kEdges = tables::edge_count(3);
  alignas(64) std::array<std::uint64_t, EdgeMeans::kMost> edges{};
  for (std::size_t i = 0; i < means.count; ++i) edges[i] = means.edges[i];
  for (std::size_t i = 0; i < means.count; i += hn::Lanes(d)) {
    hn::Vec<decltype(d)> sums[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    auto total = hn::Zero(d);
    const auto of_lanes = hn::Load(bits, edges.data() + i);
    for (unsigned e = 0; e < kEdges; ++e) {
      const auto has = hn::RebindMask(d, hn::TestBit(of_lanes, hn::Set(bits, std::uint64_t{1} << e)));
      const auto weight = hn::IfThenElseZero(has, hn::Set(d, kUnevenWeights[8 + e]));
      const auto alpha = hn::IfThenElseZero(has, hn::Load(d, means.alphas[e].data() + i));
      for (unsigned a = 0; a < 3; ++a) {
        if (a == e >> 2)
          sums[a] = hn::Add(sums[a], hn::Mul(weight, alpha));
        else if (kEdgeBases<3>[e][a] != 0)
          sums[a] = hn::Add(sums[a], weight);
      }
      total = hn::Add(total, weight);
    }
    for (unsigned a = 0; a < 3; ++a) {
      const auto mean = hn::Mul(hn::Set(d, 0.9), hn::Div(sums[a], total));
      hn::StoreU(hn::Add(hn::Set(d, own_coordinate(0.0, static_cast<int>(a), true)), mean), d, out[a].data() + i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(means_of_edges);

void find_means(const EdgeMeans& means, EdgeMeans::Coordinates& out) noexcept {
  HWY_DYNAMIC_DISPATCH(means_of_edges)(means, out);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
