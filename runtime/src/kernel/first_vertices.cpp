// SPDX-License-Identifier: BSD-3-Clause
//
// From counts to vertex numbers (see vertex_numbers.hpp): prefix sums over the chunks of a layer or slab. The prefix
// sums over the rows of a chunk are computed while the rows are counted: offset_layer_row and offset_slab_row in
// extract_count.cpp.
#include "kernel/extract_count.hpp"

namespace tegl::detail {

template <int N>
std::uint64_t Counter<N>::place_layer(Layer<N>& layer, std::uint64_t first) const {
  std::uint64_t next = first;
  for (std::size_t chunk = 0; chunk < shape_.chunks(); ++chunk) {
    for (EdgePlane& plane : layer.edges) plane.chunk_first[chunk] = static_cast<Index>(next);
    if (has_cubes_) layer.cubes.chunk_first[chunk] = static_cast<Index>(next);
    next += layer.chunk_vertices[chunk];
  }
  return next;
}

template <int N>
std::uint64_t Counter<N>::place_slab(Slab<N>& slab, std::uint64_t first, std::uint64_t& first_simplex) const {
  std::uint64_t next = first;
  for (std::size_t chunk = 0; chunk < shape_.chunks(); ++chunk) {
    slab.edges.chunk_first[chunk] = static_cast<Index>(next);
    if (has_cubes_)
      for (CubePlane& plane : slab.cubes) plane.chunk_first[chunk] = static_cast<Index>(next);
    slab.chunks[chunk].first_simplex = first_simplex;
    next += slab.chunks[chunk].vertices;
    first_simplex += slab.chunks[chunk].simplices;
  }
  return next;
}

template class Counter<2>;
template class Counter<3>;
template class Counter<4>;

}  // namespace tegl::detail
