// SPDX-License-Identifier: BSD-3-Clause
//
// The contents of Incidence: vertex stars, simplices across faces, and counts of the faces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/faces_of_stars.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"
#include "tegl/incidence.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Counts of the (N-2)-faces with one vertex as their smallest one, if not all are in two simplices of opposite
/// orientations.
struct IrregularFaces {
  Index vertex = 0;
  std::uint32_t boundary = 0;   ///< in one simplex
  std::uint32_t several = 0;    ///< in more than two
  std::uint32_t conflicts = 0;  ///< in two that induce the same orientation
  std::uint32_t open = 0;       ///< orientations do not cancel
};

template <int N>
struct IncidenceData {
  std::uint64_t digest = 0;  ///< of the vertex numbers
  Stars stars;
  Buffer<std::array<Index, N>> across;  ///< by simplex; see Incidence
  Buffer<std::int32_t> euler_above;     ///< by vertex: alternating number of the faces with it as their smallest one
  /// N = 4, by vertex: number of its edges; those to vertices of the same block of `make_incidence`, and the others,
  /// which several threads count.
  Buffer<std::uint32_t> near_edges, far_edges;
  std::vector<IrregularFaces> irregular;  ///< by vertex, ascending

  [[nodiscard]] std::size_t vertex_count() const noexcept { return stars.first.size() - 1; }
  [[nodiscard]] std::size_t edges_of(Index v) const noexcept { return std::size_t{near_edges[v]} + far_edges[v]; }
};

/// Digest of an array of vertex numbers.
std::uint64_t digest_of(std::span<const Index> numbers) noexcept;

/// All vertex numbers must be below `vertex_count`. `rows`: #S x N, row = simplex. Without the digest. `with_counts`:
/// whether to find more than `stars` and `across`.
template <int N>
IncidenceData<N> make_incidence(std::span<const Index> rows, std::size_t vertex_count, bool with_counts,
                                unsigned threads, const Progress& progress);

/// Counts of the faces by the label of their vertices (without labels: one label for all), as `count_faces` of a
/// complex.
template <int N>
std::vector<FaceCounts> count_faces(const IncidenceData<N>& incidence, std::span<const Index> labels,
                                    std::size_t label_count) {
  std::vector<FaceCounts> result(label_count);
  const auto label_of = [&](std::size_t v) { return labels.empty() ? Index{0} : labels[v]; };
  for (std::size_t v = 0; v < incidence.vertex_count(); ++v)
    if (!incidence.stars.of(v).empty()) result[label_of(v)].euler += incidence.euler_above[v];
  for (const IrregularFaces& faces : incidence.irregular) {
    result[label_of(faces.vertex)].boundary += faces.boundary;
    result[label_of(faces.vertex)].open += faces.open;
  }
  return result;
}

/// Throws InvalidArgument unless the incidence was made of these simplices.
template <int N>
void require_incidence(const IncidenceData<N>& incidence, std::span<const Index> rows, std::size_t vertex_count);

}  // namespace tegl::detail
