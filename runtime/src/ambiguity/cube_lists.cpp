// SPDX-License-Identifier: BSD-3-Clause
//
// Looks up the lists of cubes (see cube_lists.hpp). Highway's foreach_target compiles this file once per instruction
// set.
#include "ambiguity/cube_lists.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ambiguity/cube_lists.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::uint32_t kNumber = (1u << CubeListTable::kBits) - 1;

#if HWY_TARGET == HWY_SCALAR || __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__

void look_up(const std::uint32_t* words, const WantedLists* faces, std::size_t count, FoundLists* found) {
  for (std::size_t i = 0; i < count; ++i) {
    FoundLists& of = found[i];
    of.with_vertices = of.with_choice = of.with_pairs = 0;
    for (unsigned f = 0; f < ResolvedCubes::kCubes; ++f) {
      const std::uint32_t word =
          words[(faces[i].signatures >> (8 * f) & 255u) | (faces[i].squares >> (8 * f) & 63u) << 8];
      const unsigned second = faces[i].second >> f & 1u;
      of.wanted[f] = static_cast<std::uint16_t>(word >> (CubeListTable::kBits * second) & kNumber);
      of.second[f] = static_cast<std::uint16_t>(word >> CubeListTable::kBits & kNumber);
      const unsigned vertices = (word >> (CubeListTable::kFirstHasVertices + second) & 1u) << f;
      of.with_vertices = static_cast<std::uint8_t>(of.with_vertices | vertices);
      of.with_choice = static_cast<std::uint8_t>(of.with_choice | (word >> CubeListTable::kHasChoiceOrPair & 1u) << f);
      of.with_pairs = static_cast<std::uint8_t>(of.with_pairs | (word >> CubeListTable::kHasPairs & 1u) << f);
    }
  }
}

#else

/// The lanes of a mask as the bits of a set of cubes, from bit `first` on.
template <class D>
HWY_INLINE unsigned bits_from(D d, hn::Mask<D> mask, unsigned first) {
  std::uint8_t bits[8];
  hn::StoreMaskBits(d, mask, bits);
  return unsigned{bits[0]} << first;
}

void look_up(const std::uint32_t* words, const WantedLists* faces, std::size_t count, FoundLists* found) {
  const hn::CappedTag<std::uint32_t, 8> d;
  const hn::Rebind<std::int32_t, decltype(d)> signed_d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const hn::Rebind<std::uint16_t, decltype(d)> halves;
  constexpr unsigned kLanes = hn::MaxLanes(d);
  alignas(32) static constexpr std::uint32_t kBit[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  const auto number = hn::Set(d, kNumber);
  const auto store = [&](auto numbers, std::uint16_t* to) HWY_ATTR {
    hn::StoreU(hn::DemoteTo(halves, hn::BitCast(signed_d, hn::And(numbers, number))), halves, to);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const auto* const signatures = reinterpret_cast<const std::uint8_t*>(&faces[i].signatures);
    const auto* const squares = reinterpret_cast<const std::uint8_t*>(&faces[i].squares);
    unsigned with_vertices = 0, with_choice = 0, with_pairs = 0;
    for (unsigned f = 0; f < ResolvedCubes::kCubes; f += kLanes) {
      const auto high = hn::And(hn::PromoteTo(d, hn::LoadU(bytes, squares + f)), hn::Set(d, 63u));
      const auto at = hn::Or(hn::PromoteTo(d, hn::LoadU(bytes, signatures + f)), hn::ShiftLeft<8>(high));
      const auto word = hn::GatherIndex(d, words, hn::BitCast(signed_d, at));
      const auto takes_second = hn::TestBit(hn::Set(d, faces[i].second), hn::Load(d, kBit + f));
      const auto second = hn::ShiftRight<CubeListTable::kBits>(word);
      store(hn::IfThenElse(takes_second, second, word), found[i].wanted.data() + f);
      store(second, found[i].second.data() + f);
      const auto flag = hn::IfThenElse(takes_second, hn::Set(d, 1u << CubeListTable::kSecondHasVertices),
                                       hn::Set(d, 1u << CubeListTable::kFirstHasVertices));
      with_vertices |= bits_from(d, hn::TestBit(word, flag), f);
      with_choice |= bits_from(d, hn::TestBit(word, hn::Set(d, 1u << CubeListTable::kHasChoiceOrPair)), f);
      with_pairs |= bits_from(d, hn::TestBit(word, hn::Set(d, 1u << CubeListTable::kHasPairs)), f);
    }
    found[i].with_vertices = static_cast<std::uint8_t>(with_vertices);
    found[i].with_choice = static_cast<std::uint8_t>(with_choice);
    found[i].with_pairs = static_cast<std::uint8_t>(with_pairs);
  }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(look_up);

void find_lists(const CubeListTable& table, std::span<const WantedLists> faces, FoundLists* found) noexcept {
  HWY_DYNAMIC_DISPATCH(look_up)(table.words(), faces.data(), faces.size(), found);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
