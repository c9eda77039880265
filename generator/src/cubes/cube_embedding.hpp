// SPDX-License-Identifier: BSD-3-Clause
//
// Whether contours of a cube with resolved ambiguities are embedded: whether no two triangles intersect, wherever the
// contour meets the cube's edges, and wherever its own vertices are on their rays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cubes/cube_frame.hpp"
#include "embedding/embedding_proof.hpp"
#include "filling/embedding_evidence.hpp"

namespace tegl::gen {

/// Proofs for surfaces with the same own vertices. A vertex with corners in its mask is free on its ray; one with edges
/// only is a positive combination of their points.
class CubeEmbedding {
 public:
  /// `masks`: of the own vertices, as in tables::ResolvedTable. `frame` must outlive this object.
  CubeEmbedding(const CubeFrame& frame, std::span<const std::uint32_t> masks);

  /// True if no two of the triangles intersect outside of their common vertices and edges, and none can be flat.
  [[nodiscard]] bool is_embedded(const CubeTriangles& triangles) const;
  /// True if no triangle of `first` intersects one of `second`.
  [[nodiscard]] bool holds_between(const CubeTriangles& first, const CubeTriangles& second) const;
  /// True if a triangle intersects none of the others outside of common vertices and edges. For searches: remembers
  /// which sets of three vertices may intersect.
  [[nodiscard]] bool may_add(const CubeTriangle& triangle, const CubeTriangles& others);

 private:
  [[nodiscard]] LocalSimplex local(const CubeTriangle& triangle) const;
  [[nodiscard]] std::vector<LocalSimplex> local(const CubeTriangles& triangles) const;

  std::vector<std::uint8_t> number_;  ///< by vertex: its number in the proof, in which rays follow edges
  std::size_t first_mean_;
  EmbeddingProof::Means means_;
  EmbeddingProof proof_;
  std::vector<std::int8_t> are_apart_;  ///< by two sets of three vertices; kUnknown: not computed
};

}  // namespace tegl::gen
