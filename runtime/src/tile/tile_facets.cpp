// SPDX-License-Identifier: BSD-3-Clause
//
// Builds single tiles of any dimension: checks the arguments and calls the builder.
#include "tegl/tile_facets.hpp"

#include <fmt/format.h>

#include "tegl/error.hpp"
#include "tile/built_tile.hpp"

namespace tegl {
template <int N>
requires DimensionBetween<N, 2, 6> std::size_t face_number(unsigned base, unsigned axes) {
  if ((base & axes) != 0 || (base | axes) >> N != 0)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("face with base {:#b} and axes {:#b}; expected disjoint sets of {} bits", base, axes, N));
  return detail::CubeFaces(N).number(base, axes);
}

template <int N>
requires DimensionBetween<N, 2, 6> tile::TileFacets tile_facets(std::uint64_t signature,
                                                                const tile::Resolution& resolution) {
  constexpr std::uint64_t kCorners = ~std::uint64_t{0} >> (64 - (1 << N));
  if ((signature & ~kCorners) != 0)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("signature {:#x} of a {}D tile; expected at most {:#x}", signature, N, kCorners));
  const std::size_t choices = resolution.choices.size();
  if (choices != 0 && choices != kFaceCount<N>)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} choices for the faces of a {}D tile; expected 0 or {}", choices, N, kFaceCount<N>));
  return detail::too_large_as_error(
      [&] { return tile::build_facets(tile::FaceLattice::cube(N), signature, resolution); });
}

#define TEGL_INSTANTIATE(N)                                          \
  template std::size_t face_number<N>(unsigned base, unsigned axes); \
  template tile::TileFacets tile_facets<N>(std::uint64_t, const tile::Resolution&);
TEGL_INSTANTIATE(2)
TEGL_INSTANTIATE(3)
TEGL_INSTANTIATE(4)
TEGL_INSTANTIATE(5)
TEGL_INSTANTIATE(6)
#undef TEGL_INSTANTIATE

}  // namespace tegl
