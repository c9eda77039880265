// SPDX-License-Identifier: BSD-3-Clause
//
// Compares values with the isovalue and gathers the bits of cells' corners. Highway's foreach_target compiles this file
// once per instruction set: values are compared several at a time, and so are tetrahedra and quadrilaterals.
#include "complex/cell_signatures.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "complex/cell_signatures.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The signature of one cell.
template <std::size_t kCorners>
HWY_INLINE std::uint16_t signature_of(const Index* corners, const std::uint32_t* bits) {
  unsigned signature = 0;
  for (std::size_t v = 0; v < kCorners; ++v) signature |= (bits[corners[v] >> 5] >> (corners[v] & 31u) & 1u) << v;
  return static_cast<std::uint16_t>(signature);
}

/// Signatures of `count` cells of a fixed number of corners, so that the loop over corners unrolls.
template <std::size_t kCorners>
HWY_INLINE void gather_cells(const Index* corners, std::size_t count, const std::uint32_t* bits,
                             std::uint16_t* signatures) {
  std::size_t i = 0;
  if constexpr (kCorners == 4) {
    const hn::ScalableTag<std::uint32_t> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const auto low_bits = hn::Set(d, 31);
    const auto one = hn::Set(d, 1);
    const auto bit = [&](const auto& points) HWY_ATTR {
      const auto words = hn::GatherIndex(d, bits, hn::BitCast(di, hn::ShiftRight<5>(points)));
      return hn::And(hn::Shr(words, hn::And(points, low_bits)), one);
    };
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
      auto a = hn::Zero(d), b = a, c = a, e = a;
      hn::LoadInterleaved4(d, corners + 4 * i, a, b, c, e);
      const auto low = hn::Or(bit(a), hn::ShiftLeft<1>(bit(b)));
      const auto high = hn::Or(hn::ShiftLeft<2>(bit(c)), hn::ShiftLeft<3>(bit(e)));
      hn::StoreU(hn::DemoteTo(d16, hn::BitCast(di, hn::Or(low, high))), d16, signatures + i);
    }
  }
  for (; i < count; ++i) signatures[i] = signature_of<kCorners>(corners + kCorners * i, bits);
}

void compare(const double* values, std::size_t words, double isovalue, std::uint32_t* high, std::uint32_t* missing) {
  const hn::CappedTag<double, 8> d;
  const auto limit = hn::Set(d, isovalue);
  for (std::size_t w = 0; w < words; ++w, values += 32) {
    std::uint32_t is_high = 0, is_missing = 0;
    for (std::size_t i = 0; i < 32; i += hn::Lanes(d)) {
      const auto value = hn::LoadU(d, values + i);
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::Ge(value, limit), bits);
      is_high |= std::uint32_t{bits[0]} << i;
      hn::StoreMaskBits(d, hn::IsNaN(value), bits);
      is_missing |= std::uint32_t{bits[0]} << i;
    }
    high[w] = is_high;
    missing[w] = is_missing;
  }
}

void gather(std::size_t corner_count, const Index* corners, std::size_t count, const std::uint32_t* bits,
            std::uint16_t* signatures) {
  switch (corner_count) {
    case 3:
      return gather_cells<3>(corners, count, bits, signatures);
    case 4:
      return gather_cells<4>(corners, count, bits, signatures);
    case 5:
      return gather_cells<5>(corners, count, bits, signatures);
    case 6:
      return gather_cells<6>(corners, count, bits, signatures);
    case 8:
      return gather_cells<8>(corners, count, bits, signatures);
    case 10:
      return gather_cells<10>(corners, count, bits, signatures);
    case 12:
      return gather_cells<12>(corners, count, bits, signatures);
    default:
      return gather_cells<16>(corners, count, bits, signatures);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(gather);
void gather_signatures(const CellGroup& group, std::size_t from, std::size_t to, const std::uint32_t* bits,
                       std::uint16_t* signatures) noexcept {
  HWY_DYNAMIC_DISPATCH(gather)(group.corner_count, group.cell(from), to - from, bits, signatures);
}

HWY_EXPORT(compare);
void compare_values(const double* values, std::size_t words, double isovalue, std::uint32_t* high,
                    std::uint32_t* missing) noexcept {
  HWY_DYNAMIC_DISPATCH(compare)(values, words, isovalue, high, missing);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
