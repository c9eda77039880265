// SPDX-License-Identifier: BSD-3-Clause
//
// Membership of signatures in a set by lookups in registers (see signature_set.hpp). Highway's foreach_target compiles
// this file once per instruction set.
#include "tile/signature_set.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tile/signature_set.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

std::uint64_t members(const SignatureSet& set, const std::uint16_t* signatures, std::size_t count) {
  std::uint64_t result = 0;
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t i = 0; i < count; ++i) result |= std::uint64_t{set.contains(signatures[i])} << i;
#else
  const hn::CappedTag<std::uint8_t, 32> d;  // at least the 16 lanes of a table
  const hn::Half<decltype(d)> half;
  const hn::Rebind<std::int16_t, decltype(half)> wide;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const auto load = [&](const std::uint16_t* from) HWY_ATTR {
    return hn::DemoteTo(half, hn::LoadU(wide, reinterpret_cast<const std::int16_t*>(from)));
  };
  HWY_ALIGN static constexpr std::array<std::uint8_t, 16> kPowers = {1, 2, 4, 8, 16, 32, 64, 128,
                                                                     1, 2, 4, 8, 16, 32, 64, 128};
  const auto powers = hn::LoadDup128(d, kPowers.data());
  const auto lower = hn::LoadDup128(d, set.bits[0].data());
  const auto upper = hn::LoadDup128(d, set.bits[1].data());
  for (std::size_t i = 0; i < count; i += kLanes) {
    const auto s = hn::Combine(d, load(signatures + i + kLanes / 2), load(signatures + i));
    const auto column = hn::And(s, hn::Set(d, 15));
    const auto row = hn::TableLookupBytes(powers, hn::ShiftRight<4>(s));
    const auto in_row = hn::IfThenElse(hn::TestBit(s, hn::Set(d, 128)), hn::TableLookupBytes(upper, column),
                                       hn::TableLookupBytes(lower, column));
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(d, hn::TestBit(in_row, row), bytes.data());
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < (kLanes + 7) / 8; ++b) bits |= std::uint32_t{bytes[b]} << (8 * b);
    result |= std::uint64_t{bits} << i;
  }
  if (count < 64) result &= (std::uint64_t{1} << count) - 1;
#endif
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(members);
std::uint64_t members_of(const SignatureSet& set, const std::uint16_t* signatures, std::size_t count) noexcept {
  return HWY_DYNAMIC_DISPATCH(members)(set, signatures, count);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
