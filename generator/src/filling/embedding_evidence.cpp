// SPDX-License-Identifier: BSD-3-Clause
//
// Evidence for a tile's contour: each facet by itself, then each pair of facets; what is not proved is searched.
#include "filling/embedding_evidence.hpp"

#include <algorithm>
#include <bit>

namespace tegl::gen {

namespace {

/// On which side of a hyperplane through corners a cube's centre is: 1 above, -1 below, 0 in it. The heights of
/// opposite corners have the same sum, and at least one corner is in the hyperplane.
int side_of_centre(const Tile& cube, std::uint32_t above, std::uint32_t below) {
  const std::uint32_t last = cube.corner_count() - 1;
  for (std::uint32_t v = 0; v <= last; ++v) {
    if (((above | below) >> v & 1u) != 0) continue;
    const std::uint32_t opposite = last - v;
    return static_cast<int>(above >> opposite & 1u) - static_cast<int>(below >> opposite & 1u);
  }
  return 0;
}

}  // namespace

const char* name_of(Evidence evidence) noexcept {
  return evidence == Evidence::proved ? "proved" : evidence == Evidence::searched ? "searched" : "absent";
}

EmbeddingCertifier::EmbeddingCertifier(const ContourBuilder& builder) : builder_(&builder), proof_(builder.tile()) {}

/// The edges around each vertex that is coned: barycentres of faces in Sigma, and own vertices. A cone's first vertex
/// is its apex. The barycentres of faces are collected first, as cones from the tile's barycentres contain them.
EmbeddingProof::Means EmbeddingCertifier::means_of(const TileContour& contour) const {
  const std::uint32_t edges = builder_->tile().edge_count();
  constexpr std::size_t kLocalVertices = 256;  // as many as a byte numbers
  EmbeddingProof::Means means(kLocalVertices - edges, 0);
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

/// The corners (bit v) and edges (bit 16 + e) of which a vertex is a positive combination. A side vertex: before it
/// moves towards the tile's centre.
std::uint64_t EmbeddingCertifier::support_of(const TileContour& contour, std::uint8_t vertex,
                                             const EmbeddingProof::Means& means) const {
  const std::uint32_t edges = builder_->tile().edge_count(), first_side = builder_->own_base() + contour.cone_vertices;
  if (vertex >= first_side) return contour.side_masks[vertex - first_side];
  return std::uint64_t{vertex < edges ? 1u << vertex : means[vertex - edges]} << 16;
}

/// Corners and edges in the numbering of a cube of the tile; nothing if some are not in the cube.
std::optional<RegionProof::Points> EmbeddingCertifier::in_cube(std::size_t cube, std::uint64_t support) const {
  const SubTile& face = builder_->tile().faces[cube];
  RegionProof::Points result = 0;
  const auto take = [&](const std::vector<std::uint8_t>& numbers, unsigned from, unsigned to) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::uint64_t bit = std::uint64_t{1} << (from + numbers[i]);
      if ((support & bit) != 0) result |= RegionProof::Points{1} << (to + i);
      support &= ~bit;
    }
  };
  take(face.corner, 0, 0);
  take(face.edge, 16, 8);
  return support == 0 ? std::optional(result) : std::nullopt;
}

/// Whether a facet is the copy of an embedded side of the boundary, for all positions. Each tetrahedron lies in a cube
/// before its vertices move; all must be positive in the orientation of the boundary, or all negative. Then they cover
/// the parts of the boundary between components of Sigma equally often on each of its sides; a corner that none of them
/// has is not covered, so the other side is covered once.
bool EmbeddingCertifier::is_proved_copy(const TileContour& contour, const LocalFacet& facet,
                                        const EmbeddingProof::Means& means) const {
  const std::lock_guard lock(guard_);
  std::uint64_t all = 0;
  int orientation = 0;
  const bool are_positive = std::all_of(facet.simplices.begin(), facet.simplices.end(), [&](const LocalSimplex& s) {
    std::array<std::uint64_t, 4> supports;
    for (std::size_t i = 0; i < 4; ++i) all |= supports[i] = support_of(contour, s[i], means);
    for (std::size_t cube = 0; cube < builder_->tile().faces.size(); ++cube) {
      std::array<std::optional<RegionProof::Points>, 4> p;
      for (std::size_t i = 0; i < 4; ++i) p[i] = in_cube(cube, supports[i]);
      if (!p[0] || !p[1] || !p[2] || !p[3]) continue;
      const RegionProof::Sign sign = regions_.sign(*p[0], *p[1], *p[2], *p[3]);
      if (sign != RegionProof::Sign::positive && sign != RegionProof::Sign::negative) return false;
      const int own = builder_->tile().faces[cube].sign * (sign == RegionProof::Sign::positive ? 1 : -1);
      if (orientation == 0) orientation = own;
      return own == orientation;
    }
    return false;
  });
  return are_positive && (all & builder_->tile().full()) != builder_->tile().full();
}

struct EmbeddingCertifier::Extent {
  std::vector<bool> above, below, touched;  ///< by hyperplane: whether a vertex may be above, below, or lies in it
};

EmbeddingCertifier::Extent EmbeddingCertifier::extent_of(const TileContour& contour, const LocalFacet& facet,
                                                         const EmbeddingProof::Means& means) const {
  const Tile& tile = builder_->tile();
  std::vector<std::uint32_t> corners;  // by vertex: the corners of which it is a positive combination
  for (const LocalSimplex& s : facet.simplices)
    for (int i = 0; i < tile.dim; ++i) {
      const std::uint64_t support = support_of(contour, s[i], means);
      auto set = static_cast<std::uint32_t>(support & 0xffffu);
      for (std::uint64_t rest = support >> 16; rest != 0; rest &= rest - 1) {
        const auto& [a, b] = tile.edges[static_cast<std::size_t>(std::countr_zero(rest))];
        set |= 1u << a | 1u << b;
      }
      corners.push_back(set);
    }
  const bool has_centre = facet.filling == Filling::side;  // side vertices move towards the centre
  Extent extent;
  for (const auto& [above, below] : proof_.hyperplanes()) {
    const int centre = has_centre ? side_of_centre(tile, above, below) : 0;
    bool some_above = centre > 0, some_below = centre < 0, some_in = has_centre && centre == 0;
    for (const std::uint32_t set : corners) {
      some_above = some_above || (set & above) != 0;
      some_below = some_below || (set & below) != 0;
      some_in = some_in || (set & (above | below)) == 0;
    }
    extent.above.push_back(some_above);
    extent.below.push_back(some_below);
    extent.touched.push_back(some_in);
  }
  return extent;
}

/// True if a hyperplane has the facets on different sides and vertices of one of them at most.
bool EmbeddingCertifier::are_divided(const Extent& a, const Extent& b) {
  for (std::size_t k = 0; k < a.above.size(); ++k) {
    const bool apart = (!a.above[k] && !b.below[k]) || (!a.below[k] && !b.above[k]);
    if (apart && !(a.touched[k] && b.touched[k])) return true;
  }
  return false;
}

std::vector<SimplexPair> EmbeddingCertifier::unproved_pairs(const TileContour& contour) const {
  std::vector<SimplexPair> result;
  if (builder_->dim() < 2) return result;
  const EmbeddingProof::Means means = means_of(contour);
  const auto all_between = [&](const LocalFacet& facet, const LocalFacet& other) {
    for (std::size_t i = 0; i < facet.simplices.size(); ++i)
      for (std::size_t j = 0; j < (&facet == &other ? i : other.simplices.size()); ++j)
        result.emplace_back(facet.simplices[i], other.simplices[j]);
  };
  for (std::size_t f = 0; f < contour.facets.size(); ++f) {
    const LocalFacet& facet = contour.facets[f];
    const bool is_side = facet.filling == Filling::side;
    if (is_side && !is_proved_copy(contour, facet, means)) all_between(facet, facet);
    if (!is_side && !is_cone_from_inside(facet)) proof_.add_meeting(facet.simplices, means, result);
    for (std::size_t g = 0; g < f; ++g) {
      const LocalFacet& other = contour.facets[g];
      if (!is_side && other.filling != Filling::side)
        proof_.add_meeting(facet.simplices, other.simplices, means, result);
      else if (!are_divided(extent_of(contour, facet, means), extent_of(contour, other, means)))
        all_between(facet, other);
    }
  }
  return result;
}

Evidence EmbeddingCertifier::of(const TileContour& contour, Signature signature,
                                const std::vector<SimplexPair>& unproved, const SearchPlan& plan) const {
  if (unproved.empty()) return Evidence::proved;
  const auto is_on_edges = [&](const LocalSimplex& s) {
    return std::all_of(s.begin(), s.begin() + builder_->dim(),
                       [&](std::uint8_t v) { return v < builder_->tile().edge_count(); });
  };
  if (std::any_of(unproved.begin(), unproved.end(),
                  [&](const SimplexPair& pair) { return is_on_edges(pair.first) && is_on_edges(pair.second); }))
    return Evidence::absent;
  return PositionSearch(*builder_, contour, unproved).find(plan, signature) ? Evidence::absent : Evidence::searched;
}

}  // namespace tegl::gen
