// SPDX-License-Identifier: BSD-3-Clause
//
// Evidence for a tile's contour: each facet by itself, then each pair of facets.
#include "filling/embedding_evidence.hpp"

#include <algorithm>

namespace tegl::gen {

const char* name_of(Evidence evidence) noexcept {
  return evidence == Evidence::proved ? "proved" : evidence == Evidence::searched ? "searched" : "absent";
}

EmbeddingCertifier::EmbeddingCertifier(const ContourBuilder& builder) : builder_(&builder), proof_(builder.tile()) {}

/// The edges around each vertex that is coned: barycentres of faces in Sigma, and own vertices. A cone's first vertex
/// is its apex. The barycentres of faces are collected first, as cones from the tile's barycentres contain them.
EmbeddingProof::Means EmbeddingCertifier::means_of(const TileContour& contour) const {
  const std::uint32_t edges = builder_->tile().edge_count();
  EmbeddingProof::Means means(256 - edges, 0);
  const auto add = [&](const LocalSimplex& s, int count) {
    if (s[0] < edges) return;
    for (int i = 1; i < count; ++i) means[s[0] - edges] |= s[i] < edges ? 1u << s[i] : means[s[i] - edges];
  };
  for (const LocalSimplex& s : contour.boundary) add(s, builder_->dim() - 1);
  for (const LocalFacet& facet : contour.facets)
    if (facet.filling != Filling::side)
      for (const LocalSimplex& s : facet.simplices) add(s, builder_->dim());
  return means;
}

bool EmbeddingCertifier::is_cone_from_inside(const LocalFacet& facet) const {
  const std::uint8_t apex = facet.simplices.front()[0];
  return apex >= builder_->own_base() && std::all_of(facet.simplices.begin(), facet.simplices.end(),
                                                     [&](const LocalSimplex& s) { return s[0] == apex; });
}

bool EmbeddingCertifier::has_means(const LocalFacet& facet) const {
  const std::uint32_t edges = builder_->tile().edge_count();
  return std::any_of(facet.simplices.begin(), facet.simplices.end(), [&](const LocalSimplex& s) {
    return std::any_of(s.begin(), s.begin() + builder_->dim(), [&](std::uint8_t v) { return v >= edges; });
  });
}

Evidence EmbeddingCertifier::of(const TileContour& contour) const {
  if (builder_->dim() < 2) return Evidence::proved;
  const EmbeddingProof::Means means = means_of(contour);
  Evidence evidence = Evidence::proved;
  const auto lower = [&](bool searched) {
    evidence = std::max(evidence, searched ? Evidence::searched : Evidence::absent);
  };
  for (std::size_t f = 0; f < contour.facets.size(); ++f) {
    const LocalFacet& facet = contour.facets[f];
    const bool is_side = facet.filling == Filling::side;
    if (!is_side && !is_cone_from_inside(facet) && !proof_.holds(facet.simplices, means)) lower(has_means(facet));
    for (std::size_t g = 0; g < f; ++g) {
      const LocalFacet& other = contour.facets[g];
      if (is_side || other.filling == Filling::side)
        lower(true);
      else if (!proof_.holds_between(facet.simplices, other.simplices, means))
        lower(has_means(facet) || has_means(other));
    }
  }
  return evidence;
}

}  // namespace tegl::gen
