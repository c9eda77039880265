// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the entries of a table are embedded: whether no two simplices of a tile intersect, wherever the contour meets
// the tile's edges.
#pragma once

#include "filling/embedding_proof.hpp"
#include "filling/facets.hpp"

namespace tegl::gen {

/// proved: for all positions. searched: a search over positions finds no intersection. absent: some positions let two
/// simplices intersect.
enum class Evidence { proved, searched, absent };
const char* name_of(Evidence evidence) noexcept;  ///< "proved", "searched", "absent"

/// Judges the entries of one builder. Thread-safe.
class EmbeddingCertifier {
 public:
  /// `builder` must outlive this object.
  explicit EmbeddingCertifier(const ContourBuilder& builder);

  /// Looks at the simplices only, not at how they were found, except for two constructions that are embedded by
  /// theorem: the cone from an own vertex inside the tile, from which every ray meets the tile's boundary once; and the
  /// copy of a side of the boundary, whose vertices move along such rays. Two facets with own vertices that are not
  /// separated for all weights of their means: searched.
  [[nodiscard]] Evidence of(const TileContour& contour) const;

 private:
  [[nodiscard]] EmbeddingProof::Means means_of(const TileContour& contour) const;
  [[nodiscard]] bool is_cone_from_inside(const LocalFacet& facet) const;
  [[nodiscard]] bool has_means(const LocalFacet& facet) const;

  const ContourBuilder* builder_;
  EmbeddingProof proof_;
};

}  // namespace tegl::gen
