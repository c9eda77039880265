// SPDX-License-Identifier: BSD-3-Clause
//
// Highway's foreach_target compiles this file once per instruction set. Which axis an edge is along is hard to predict,
// so no branch depends on it.
#include "curved/curved_block.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "curved/curved_block.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using BlockTag = hn::CappedTag<double, 8>;

void places(CurvedBlock& block, std::size_t axis, double step) {
  const BlockTag d;
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    const auto index = hn::Max(hn::Mul(hn::LoadU(d, block.point[axis].data() + i), hn::Set(d, step)), hn::Zero(d));
    const auto base = hn::Floor(index);
    hn::StoreU(base, d, block.base[axis].data() + i);
    hn::StoreU(hn::Sub(index, base), d, block.share[axis].data() + i);
  }
}

void edges(CurvedBlock& block, unsigned along) {
  const BlockTag d;
  const auto one = hn::Set(d, 1.0);
  block.inside = 0;
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    auto sum = hn::Zero(d), axes = hn::Zero(d);
    for (std::size_t a = 0; a < CurvedBlock::kMostAxes; ++a) {
      if ((along >> a & 1u) == 0) continue;
      const auto share = hn::LoadU(d, block.share[a].data() + i);
      sum = hn::Add(sum, share);
      axes = hn::Add(axes, hn::IfThenElseZero(hn::Ne(share, hn::Zero(d)), one));
    }
    hn::StoreU(sum, d, block.edge_share.data() + i);
    const auto inside = hn::Or(hn::Gt(axes, one), hn::Eq(sum, one));
    if (hn::AllFalse(d, inside)) continue;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, inside, bits);
    block.inside |= std::uint64_t{bits[0]} << i;
  }
}

void coordinates(CurvedBlock& block, const CurvedArrays& arrays) {
  const BlockTag d;
  const hn::RebindToSigned<BlockTag> di;
  const auto one = hn::Set(d, 1.0);
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    auto at = hn::Zero(d), step = hn::Zero(d);
    for (std::size_t a = 0; a < CurvedBlock::kMostAxes; ++a) {
      if (arrays.strides[a] == 0) continue;
      const auto stride = hn::Set(d, static_cast<double>(arrays.strides[a]));
      at = hn::MulAdd(hn::LoadU(d, block.base[a].data() + i), stride, at);
      const auto share = hn::LoadU(d, block.share[a].data() + i);
      step = hn::Add(step, hn::IfThenElseZero(hn::Ne(share, hn::Zero(d)), stride));
    }
    const auto first = hn::ConvertTo(di, at), second = hn::ConvertTo(di, hn::Add(at, step));
    // the weights 1 and 0 for a coordinate that does not differ along the edge
    const auto share = hn::IfThenElseZero(hn::Ne(step, hn::Zero(d)), hn::LoadU(d, block.edge_share.data() + i));
    for (std::size_t k = 0; k < arrays.count; ++k) {
      const auto here = hn::GatherIndex(d, arrays.values[k], first);
      const auto next = hn::GatherIndex(d, arrays.values[k], second);
      hn::StoreU(hn::Add(hn::Mul(hn::Sub(one, share), here), hn::Mul(share, next)), d,
                 block.point[arrays.axis[k]].data() + i);
    }
  }
}

bool finite(const CurvedBlock& block, std::size_t axes) {
  const BlockTag d;
  auto sum = hn::Zero(d);  // 0 times infinity or NaN is NaN
  for (std::size_t a = 0; a < axes; ++a)
    for (std::size_t i = 0; i < block.count; i += hn::Lanes(d))
      sum = hn::MulAdd(hn::Zero(d), hn::LoadU(d, block.point[a].data() + i), sum);
  return hn::AllTrue(d, hn::Eq(sum, sum));
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(places);
HWY_EXPORT(edges);
HWY_EXPORT(coordinates);
HWY_EXPORT(finite);

void find_places(CurvedBlock& block, std::size_t axis, double step) noexcept {
  HWY_DYNAMIC_DISPATCH(places)(block, axis, step);
}

void find_edges(CurvedBlock& block, unsigned along) noexcept { HWY_DYNAMIC_DISPATCH(edges)(block, along); }

bool are_finite(const CurvedBlock& block, std::size_t axes) noexcept {
  return HWY_DYNAMIC_DISPATCH(finite)(block, axes);
}

void interpolate(CurvedBlock& block, const CurvedArrays& arrays) noexcept {
  HWY_DYNAMIC_DISPATCH(coordinates)(block, arrays);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
