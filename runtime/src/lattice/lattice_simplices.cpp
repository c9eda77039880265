// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the vertices of active cells and writes their simplices. Highway's foreach_target compiles this file once per
// instruction set.
#include "lattice/lattice_simplices.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lattice/lattice_simplices.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

template <std::size_t N>
HWY_INLINE std::array<Index, N>* write_of(const LatticeCell& cell, const EdgeStream* streams, const ActiveInRow* active,
                                          std::size_t count, std::array<Index, N>* simplices) {
  const LatticeCell::Contour* const contours = cell.contours.data();
  std::array<Index, 32> vertices;
  for (std::size_t c = 0; c < count; ++c) {
    const LatticeCell::Contour& contour = contours[active[c].signature];
    for (std::uint32_t crossed = contour.crossed; crossed != 0; crossed &= crossed - 1) {
      const auto e = static_cast<unsigned>(std::countr_zero(crossed));
      const EdgeStream& stream = streams[e];
      const std::size_t i = active[c].at + static_cast<std::size_t>(stream.at), w = i / kWordBits;
      const Word below = stream.crossed.bits[w] & ((Word{1} << (i % kWordBits)) - 1);
      vertices[e] = stream.first + stream.crossed.before[w] + static_cast<Index>(std::popcount(below));
    }
    const std::uint8_t* local = contour.vertices.data();
    for (std::uint32_t s = 0; s < contour.simplices; ++s, ++simplices, local += N)
      for (std::size_t v = 0; v < N; ++v) (*simplices)[v] = vertices[local[v]];
  }
  return simplices;
}

std::array<Index, 2>* write2(const LatticeCell& cell, const EdgeStream* streams, const ActiveInRow* active,
                             std::size_t count, std::array<Index, 2>* simplices) {
  return write_of(cell, streams, active, count, simplices);
}
std::array<Index, 3>* write3(const LatticeCell& cell, const EdgeStream* streams, const ActiveInRow* active,
                             std::size_t count, std::array<Index, 3>* simplices) {
  return write_of(cell, streams, active, count, simplices);
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(write2);
std::array<Index, 2>* write_simplices(const LatticeCell& cell, const EdgeStream* streams,
                                      std::span<const ActiveInRow> active, std::array<Index, 2>* simplices) noexcept {
  return HWY_DYNAMIC_DISPATCH(write2)(cell, streams, active.data(), active.size(), simplices);
}
HWY_EXPORT(write3);
std::array<Index, 3>* write_simplices(const LatticeCell& cell, const EdgeStream* streams,
                                      std::span<const ActiveInRow> active, std::array<Index, 3>* simplices) noexcept {
  return HWY_DYNAMIC_DISPATCH(write3)(cell, streams, active.data(), active.size(), simplices);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
