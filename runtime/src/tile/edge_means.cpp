// SPDX-License-Identifier: BSD-3-Clause
//
// Adds points on edges in the lanes of registers (see edge_means.hpp). Highway's foreach_target compiles this file once
// per instruction set. The operations are the same as in mask_place, in the same order, so that the positions are equal
// bit by bit.
#include "tile/edge_means.hpp"

#include <type_traits>
#include <utility>

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

template <int K>
HWY_INLINE void means_of_edges(const EdgeMeans<K>& means, typename EdgeMeans<K>::Coordinates& out) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<std::uint64_t, decltype(d)> bits;
  constexpr unsigned kEdges = tables::edge_count(K);
  alignas(64) std::array<std::uint64_t, EdgeMeans<K>::kMost> edges{};
  for (std::size_t i = 0; i < means.count; ++i) edges[i] = means.edges[i];
  for (std::size_t i = 0; i < means.count; i += hn::Lanes(d)) {
    hn::Vec<decltype(d)> sums[K];
    for (auto& sum : sums) sum = hn::Zero(d);
    auto total = hn::Zero(d);
    const auto of_lanes = hn::Load(bits, edges.data() + i);
    // Unrolled, so that the compiler knows the axes along which each edge is at 1.
    const auto add = [&]<unsigned E>(std::integral_constant<unsigned, E>) HWY_ATTR {
      const auto has = hn::RebindMask(d, hn::TestBit(of_lanes, hn::Set(bits, std::uint64_t{1} << E)));
      const auto weight = hn::IfThenElseZero(has, hn::Set(d, kUnevenWeights[(1u << K) + E]));
      const auto alpha = hn::IfThenElseZero(has, hn::Load(d, means.alphas[E].data() + i));
      [&]<unsigned... A>(std::integer_sequence<unsigned, A...>) HWY_ATTR {
        ((sums[A] = A == E >> (K - 1)          ? hn::Add(sums[A], hn::Mul(weight, alpha))
                    : kEdgeBases<K>[E][A] != 0 ? hn::Add(sums[A], weight)
                                               : sums[A]),
         ...);
      }
      (std::make_integer_sequence<unsigned, K>());
      total = hn::Add(total, weight);
    };
    [&]<unsigned... E>(std::integer_sequence<unsigned, E...>) HWY_ATTR {
      (add(std::integral_constant<unsigned, E>{}), ...);
    }
    (std::make_integer_sequence<unsigned, kEdges>());
    for (unsigned a = 0; a < K; ++a) {
      const auto mean = hn::Mul(hn::Set(d, 0.9), hn::Div(sums[a], total));
      hn::StoreU(hn::Add(hn::Set(d, own_coordinate(0.0, static_cast<int>(a), true)), mean), d, out[a].data() + i);
    }
  }
}

// Highway's dispatch tables cannot hold templates.
void means_in_cubes(const EdgeMeans<3>& means, EdgeMeans<3>::Coordinates& out) { means_of_edges<3>(means, out); }
void means_in_tesseracts(const EdgeMeans<4>& means, EdgeMeans<4>::Coordinates& out) { means_of_edges<4>(means, out); }

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(means_in_cubes);
HWY_EXPORT(means_in_tesseracts);

template <>
void find_means<3>(const EdgeMeans<3>& means, EdgeMeans<3>::Coordinates& out) noexcept {
  HWY_DYNAMIC_DISPATCH(means_in_cubes)(means, out);
}
template <>
void find_means<4>(const EdgeMeans<4>& means, EdgeMeans<4>::Coordinates& out) noexcept {
  HWY_DYNAMIC_DISPATCH(means_in_tesseracts)(means, out);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
