// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the entries of a table are embedded: whether no two simplices of a tile intersect, wherever the contour meets
// the tile's edges.
#pragma once

#include <mutex>
#include <vector>

#include "embedding/embedding_proof.hpp"
#include "embedding/region_proof.hpp"
#include "filling/facets.hpp"
#include "filling/position_search.hpp"

namespace tegl::gen {

/// proved: for all positions. searched: a search over positions found no intersection. absent: some positions let two
/// simplices intersect.
enum class Evidence { proved, searched, absent };
const char* name_of(Evidence evidence) noexcept;  ///< "proved", "searched", "absent"

/// Judges the entries of one builder. Thread-safe.
class EmbeddingCertifier {
 public:
  /// `builder` must outlive this object.
  explicit EmbeddingCertifier(const ContourBuilder& builder);

  /// The pairs of simplices that no theorem shows to be apart; empty: the contour is proved to be embedded. Looks at
  /// the simplices only, not at how they were found. Two constructions need no comparison of pairs: the cone from an
  /// own vertex inside the tile, from which every ray meets the tile's boundary once; and the copy of a side of the
  /// boundary, whose vertices move along such rays, if its tetrahedra in the cubes are proved to be positive.
  /// `contour` has passed TableCertifier.
  [[nodiscard]] std::vector<SimplexPair> unproved_pairs(const TileContour& contour) const;
  /// Evidence for a contour with these unproved pairs. Two simplices on edges only are absent without a search, since
  /// the proof is exact for them.
  [[nodiscard]] Evidence of(const TileContour& contour, Signature signature, const std::vector<SimplexPair>& unproved,
                            const SearchPlan& plan = {}) const;
  /// The same, with the pairs that it finds.
  [[nodiscard]] Evidence of(const TileContour& contour, Signature signature, const SearchPlan& plan = {}) const {
    return of(contour, signature, unproved_pairs(contour), plan);
  }

 private:
  /// The corners and edges whose positive combinations a facet's vertices are.
  struct Extent;

  [[nodiscard]] EmbeddingProof::Means means_of(const TileContour& contour) const;
  [[nodiscard]] bool is_cone_from_inside(const LocalFacet& facet) const;
  [[nodiscard]] bool is_proved_copy(const TileContour& contour, const LocalFacet& facet,
                                    const EmbeddingProof::Means& means) const;
  [[nodiscard]] std::uint64_t support_of(const TileContour& contour, std::uint8_t vertex,
                                         const EmbeddingProof::Means& means) const;
  [[nodiscard]] std::optional<RegionProof::Points> in_cube(std::size_t cube, std::uint64_t support) const;
  [[nodiscard]] Extent extent_of(const TileContour& contour, const LocalFacet& facet,
                                 const EmbeddingProof::Means& means) const;
  [[nodiscard]] static bool are_divided(const Extent& a, const Extent& b);

  const ContourBuilder* builder_;
  EmbeddingProof proof_;
  mutable std::mutex guard_;  ///< of regions_
  RegionProof regions_;
};

}  // namespace tegl::gen
