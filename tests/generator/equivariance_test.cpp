// SPDX-License-Identifier: BSD-3-Clause
//
// Building commutes with every one of the 384 symmetries, for every signature of 4D. It suffices to test
// representatives: a signature is h(r) for a representative r, so g after h is a single element, and equivariance under
// g h and under h implies it under g.
#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "filling/facets.hpp"
#include "symmetry/transversal.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {
namespace {

constexpr int kDim = 4;

/// A vertex by its meaning, not by its number: edges (bits 0 to 31), corners (bits 32 to 47) and a kind. An edge point
/// has its edge; a barycentre the edges around its facet; a side vertex the corners and edges of its mean.
using Place = std::uint64_t;
enum Kind : Place { kPoint = 0, kCubeBarycentre = 1, kOwnBarycentre = 2, kSide = 3 };
constexpr Place place(Kind kind, Place corners, Place edges) { return Place{kind} << 60 | corners << 32 | edges; }

/// The action of a symmetry on places.
class Motion {
 public:
  Motion(const Element& g, const Tile& tile) : det_(g.det) {
    for (std::uint32_t v = 0; v < tile.corner_count(); ++v) corner_[v] = g.corner(v);
    for (std::uint32_t e = 0; e < tile.edge_count(); ++e)
      for (std::uint32_t f = 0; f < tile.edge_count(); ++f) {
        const auto [a, b] = tile.edges[e];
        const auto [c, d] = tile.edges[f];
        if (std::minmax(corner_[a], corner_[b]) == std::minmax<std::uint32_t>(c, d)) edge_[e] = f;
      }
  }
  [[nodiscard]] Place operator()(Place p) const {
    Place moved = p >> 60 << 60;
    for (std::uint32_t e = 0; e < 32; ++e)
      if ((p >> e & 1u) != 0) moved |= Place{1} << edge_[e];
    for (std::uint32_t v = 0; v < 16; ++v)
      if ((p >> (32 + v) & 1u) != 0) moved |= Place{1} << (32 + corner_[v]);
    return moved;
  }
  [[nodiscard]] Signature signature(Signature s) const {
    Signature moved = 0;
    for (std::uint32_t v = 0; v < 16; ++v)
      if ((s >> v & 1u) != 0) moved |= Signature{1} << corner_[v];
    return moved;
  }
  [[nodiscard]] int det() const { return det_; }

 private:
  std::array<std::uint32_t, 16> corner_{};
  std::array<std::uint32_t, 32> edge_{};
  int det_;
};

using PlacedSimplex = std::pair<std::array<Place, kDim>, int>;

PlacedSimplex sorted(std::array<Place, kDim> s, int sign) {
  for (int i = 1; i < kDim; ++i)
    for (int j = i; j > 0 && s[j] < s[j - 1]; --j) std::swap(s[j], s[j - 1]), sign = -sign;
  return {s, sign};
}

Place edges_of(const std::vector<std::uint8_t>& points) {
  Place edges = 0;
  for (const std::uint8_t e : points) edges |= Place{1} << e;
  return edges;
}

/// The places of a contour's local vertices.
std::array<Place, 256> places_of(const ContourBuilder& builder, Signature s, const TileContour& contour) {
  std::array<Place, 256> places{};
  const Tile& tile = builder.tile();
  for (std::uint32_t e = 0; e < tile.edge_count(); ++e) places[e] = place(kPoint, 0, Place{1} << e);
  for (std::uint32_t f = 0; f < tile.faces.size(); ++f) {
    std::uint32_t slot = 0;
    for (const LocalFacet& facet : builder.face_contour(f, s).facets) {
      if (facet.filling != Filling::cone) continue;
      Place edges = 0;
      for (const std::uint8_t e : facet.points) edges |= Place{1} << tile.faces[f].edge[e];
      places[tile.edge_count() + f * tables::kFaceSlots + slot++] = place(kCubeBarycentre, 0, edges);
    }
  }
  std::uint32_t cone = 0;
  for (const LocalFacet& facet : contour.facets)
    if (facet.filling == Filling::cone)
      places[builder.own_base() + cone++] = place(kOwnBarycentre, 0, edges_of(facet.points));
  for (std::uint32_t j = 0; j < contour.side_masks.size(); ++j)
    places[builder.own_base() + cone + j] =
        place(kSide, contour.side_masks[j] & 0xffff, contour.side_masks[j] >> 16 & 0xffffffff);
  return places;
}

std::vector<PlacedSimplex> placed(const ContourBuilder& builder, Signature s) {
  const TileContour contour = builder.build(s);
  const auto places = places_of(builder, s, contour);
  std::vector<PlacedSimplex> result;
  for (const LocalFacet& facet : contour.facets)
    for (const LocalSimplex& t : facet.simplices)
      result.push_back(sorted({places[t[0]], places[t[1]], places[t[2]], places[t[3]]}, 1));
  std::sort(result.begin(), result.end());
  return result;
}

/// The properties of a facet that do not depend on its triangulation: points, Euler characteristic and size of its
/// boundary.
using FacetKind = std::tuple<Place, int, std::uint32_t>;

std::vector<FacetKind> facets_of(const ContourBuilder& builder, Signature s) {
  std::vector<FacetKind> result;
  for (const LocalFacet& facet : builder.build(s).facets)
    result.emplace_back(edges_of(facet.points), facet.boundary_euler, facet.boundary_facets);
  std::sort(result.begin(), result.end());
  return result;
}

class Equivariance4d : public testing::TestWithParam<Alternative> {
 protected:
  Equivariance4d() : lattice_(kDim), elements_(group(kDim, GroupKind::Full, false)) {
    classes_ = transversal(kDim, elements_);
    for (const Element& g : elements_) motions_.emplace_back(g, lattice_.tile(kDim));
  }
  CubeLattice lattice_;
  std::vector<Element> elements_;
  std::vector<Motion> motions_;
  Transversal classes_;
};

TEST_P(Equivariance4d, BarycentricContoursMoveWithEverySymmetryOrientationIncluded) {
  const ContourBuilder builder(lattice_, kDim, GetParam(), Triangulation::barycentric);
  std::vector<std::vector<PlacedSimplex>> built(65536);
  for (const Signature r : classes_.representatives) {
    const auto contour = placed(builder, r);
    for (const Motion& g : motions_) {
      const Signature image = g.signature(r);
      auto moved = contour;
      for (auto& [places, sign] : moved) {
        for (Place& p : places) p = g(p);
        std::tie(places, sign) = sorted(places, sign * g.det());
      }
      std::sort(moved.begin(), moved.end());
      if (built[image].empty()) built[image] = placed(builder, image);
      ASSERT_TRUE(moved == built[image]) << "representative " << r << ", image " << image;
    }
  }
}

TEST_P(Equivariance4d, FacetsOfCompactContoursMoveWithEverySymmetry) {
  const ContourBuilder builder(lattice_, kDim, GetParam(), Triangulation::compact);
  std::vector<std::vector<FacetKind>> built(65536);
  for (const Signature r : classes_.representatives) {
    const auto facets = facets_of(builder, r);
    for (const Motion& g : motions_) {
      const Signature image = g.signature(r);
      auto moved = facets;
      for (FacetKind& facet : moved) std::get<0>(facet) = g(std::get<0>(facet));
      std::sort(moved.begin(), moved.end());
      if (built[image].empty()) built[image] = facets_of(builder, image);
      ASSERT_EQ(moved, built[image]) << "representative " << r << ", image " << image;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BothAlternatives, Equivariance4d, testing::Values(Alternative::low, Alternative::high));

}  // namespace
}  // namespace tegl::gen
