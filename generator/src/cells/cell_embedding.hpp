// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the contours of mesh cells intersect themselves, for all positions of the points on edges: proofs and search
// as for the cells of images (filling/embedding_evidence.hpp), for cells with faces of any shapes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cells/cell_contours.hpp"
#include "embedding/embedding_proof.hpp"
#include "filling/embedding_evidence.hpp"

namespace tegl::gen {

/// Judges the contours of one cell: of its reference shape and, as signs of volumes keep, of its affine images.
/// Projective images have the same hyperplanes, with the same corners on each side, and cones from means stay cones
/// from points inside. So contours without a copy of a side are judged for these as well.
class CellEmbedding {
 public:
  explicit CellEmbedding(const Cell& cell);

  /// The pairs of simplices that no theorem shows to be apart; empty: the contour is proved to be embedded. Simplices
  /// in one 3-face of a 4-cell are not compared: that face is a cell itself.
  [[nodiscard]] std::vector<SimplexPair> unproved_pairs(const CellContour& contour) const;
  /// Evidence for a contour with these unproved pairs, as EmbeddingCertifier::of.
  [[nodiscard]] Evidence of(const CellContour& contour, Signature signature, const std::vector<SimplexPair>& unproved,
                            const SearchPlan& plan = {}) const;

 private:
  enum class Kind { flat, cone, copy };
  /// A connected component of the simplices.
  struct Part {
    Kind kind = Kind::flat;  ///< simplices on edges and faces; cone from inside; copy of a side
    std::vector<LocalSimplex> simplices;
  };
  [[nodiscard]] std::vector<Part> parts_of(const CellContour& contour) const;
  [[nodiscard]] Kind kind_of(const CellContour& contour, const std::vector<LocalSimplex>& simplices) const;
  [[nodiscard]] std::uint64_t support_of(const CellContour& contour, std::uint8_t vertex) const;
  [[nodiscard]] bool is_proved_copy(const CellContour& contour, const std::vector<LocalSimplex>& simplices) const;
  [[nodiscard]] int orientation_in(std::size_t face, const std::array<std::uint64_t, 4>& supports) const;
  void add_meeting(const CellContour& contour, const Part& part, const Part& other,
                   std::vector<SimplexPair>& pairs) const;

  Tile tile_;  ///< with the edges of faces
  std::vector<std::array<std::int64_t, 4>>
      rays_;  ///< from the centre to the corners, in units in which they are integers
  EmbeddingProof proof_;
};

}  // namespace tegl::gen
