// SPDX-License-Identifier: BSD-3-Clause
//
// Evidence for the contour of a mesh cell: each component by itself, then each pair of components; what is not proved
// is searched.
#include "cells/cell_embedding.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <span>
#include <stdexcept>

#include "base/determinant.hpp"
#include "filling/position_search.hpp"

namespace tegl::gen {

namespace {

constexpr std::int64_t kEdgeLength = std::int64_t{1} << kGridBits;

Tile with_edges_of_faces(Tile tile) {
  for (SubTile& face : tile.faces)
    for (std::uint8_t e = 0; e < tile.edge_count(); ++e)
      if ((face.corners() >> tile.edges[e][0] & face.corners() >> tile.edges[e][1] & 1u) != 0) face.edge.push_back(e);
  return tile;
}

/// The corners at the ends of a mask's edges, and the mask's corners.
std::uint64_t corners_of(const Tile& tile, std::uint64_t mask) {
  std::uint64_t corners = mask & tile.full();
  for (std::uint64_t rest = mask >> tile.corner_count(); rest != 0; rest &= rest - 1) {
    const auto& [a, b] = tile.edges[static_cast<std::size_t>(std::countr_zero(rest))];
    corners |= std::uint64_t{1} << a | std::uint64_t{1} << b;
  }
  return corners;
}

/// Places of a mesh cell's vertices (cell_contract.hpp: "Positions of added vertices"), rounded down to the
/// grid.
class CellPlaces : public ContourPlaces {
 public:
  CellPlaces(const Tile& tile, const CellContour& contour)
      : tile_(tile),
        masks_(contour.masks),
        first_side_(contour.masks.size() - contour.added_count[2]),
        edges_of_(tile.edge_count() + contour.masks.size()) {
    std::uint32_t all = 0;
    for (std::uint32_t e = 0; e < tile.edge_count(); ++e) edges_of_[e] = 1u << e;
    for (std::size_t j = 0; j < masks_.size(); ++j)
      edges_of_[tile.edge_count() + j] = static_cast<std::uint32_t>(masks_[j] >> tile.corner_count());
    for (const LocalSimplex& s : contour.simplices)
      for (int i = 0; i < tile.dim; ++i) all |= edges_of_[s[static_cast<std::size_t>(i)]];
    for (; all != 0; all &= all - 1) edges_.push_back(static_cast<std::uint8_t>(std::countr_zero(all)));
  }
  [[nodiscard]] std::span<const std::uint8_t> edges() const noexcept override { return edges_; }
  [[nodiscard]] std::uint32_t edges_of(std::uint8_t vertex) const override { return edges_of_[vertex]; }

  void compute(std::span<const std::int64_t> at, std::span<GridPoint> places) const override {
    for (const std::uint8_t e : edges_)
      for (std::size_t k = 0; k < 4; ++k)
        places[e][k] =
            coordinate(tile_.edges[e][0], k) * (kEdgeLength - at[e]) + coordinate(tile_.edges[e][1], k) * at[e];
    for (std::size_t j = 0; j < masks_.size(); ++j) {
      GridPoint place = mean(masks_[j], places);
      if (j >= first_side_) {
        const GridPoint centre = mean(tile_.full(), places);
        for (std::size_t k = 0; k < 4; ++k) place[k] = (place[k] + centre[k]) / 2;
      }
      places[tile_.edge_count() + j] = place;
    }
  }

 private:
  [[nodiscard]] std::int64_t coordinate(std::size_t corner, std::size_t axis) const {
    return static_cast<std::int64_t>(tile_.corners[corner][axis]);
  }
  [[nodiscard]] GridPoint mean(std::uint64_t mask, std::span<const GridPoint> places) const {
    GridPoint sum{};
    for (std::uint64_t rest = mask; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<std::size_t>(std::countr_zero(rest));
      for (std::size_t k = 0; k < 4; ++k)
        sum[k] += v < tile_.corner_count() ? coordinate(v, k) * kEdgeLength : places[v - tile_.corner_count()][k];
    }
    for (std::int64_t& x : sum) x /= std::popcount(mask);
    return sum;
  }

  const Tile& tile_;
  std::vector<std::uint64_t> masks_;
  std::size_t first_side_;
  std::vector<std::uint32_t> edges_of_;
  std::vector<std::uint8_t> edges_;
};

using CornerRay = std::array<std::int64_t, 4>;

/// The corners from the cell's centre, in units in which they are integers.
std::vector<CornerRay> rays_to_corners(const Tile& tile) {
  std::vector<CornerRay> rays(tile.corner_count());
  for (std::size_t k = 0; k < 4; ++k) {
    std::int64_t sum = 0;
    for (const auto& corner : tile.corners) sum += static_cast<std::int64_t>(corner[k]);
    for (std::size_t v = 0; v < rays.size(); ++v)
      rays[v][k] = static_cast<std::int64_t>(tile.corners[v][k]) * tile.corner_count() - sum;
  }
  return rays;
}

/// True if a hyperplane through corners of a 4-cell has the supports `copy` and the cell's centre on one side, `other`
/// on the other one, and vertices of one of them at most. `points`: the corners, the centre is the origin.
bool are_divided(std::span<const std::array<std::int64_t, 4>> points, std::span<const std::uint64_t> copy,
                 std::span<const std::uint64_t> other) {
  for (std::uint64_t through = 0; through < std::uint64_t{1} << points.size(); ++through) {
    if (std::popcount(through) != 4) continue;
    std::array<CornerRay, 3> directions{};
    const CornerRay& base = points[static_cast<std::size_t>(std::countr_zero(through))];
    std::size_t row = 0;
    for (std::uint64_t rest = through & (through - 1); rest != 0; rest &= rest - 1, ++row)
      for (std::size_t k = 0; k < 4; ++k)
        directions[row][k] = points[static_cast<std::size_t>(std::countr_zero(rest))][k] - base[k];
    const CornerRay normal = cross_product(directions, 4);
    const auto height = [&](const CornerRay& point) {
      std::int64_t sum = 0;
      for (std::size_t k = 0; k < 4; ++k) sum += normal[k] * (point[k] - base[k]);
      return sum;
    };
    std::uint64_t above = 0, below = 0;
    for (std::size_t v = 0; v < points.size(); ++v) {
      above |= std::uint64_t{height(points[v]) > 0 ? 1u : 0u} << v;
      below |= std::uint64_t{height(points[v]) < 0 ? 1u : 0u} << v;
    }
    const std::int64_t centre = height({});
    for (const bool is_above : {true, false}) {  // the copy's side
      const std::uint64_t not_of_copy = is_above ? below : above, not_of_other = is_above ? above : below;
      const auto is_in = [&](std::uint64_t set) { return (set & (above | below)) == 0; };
      if ((above | below) == 0 || centre == 0 || (centre > 0) != is_above) continue;
      if (std::any_of(copy.begin(), copy.end(), [&](std::uint64_t set) { return (set & not_of_copy) != 0; })) continue;
      if (std::any_of(other.begin(), other.end(), [&](std::uint64_t set) { return (set & not_of_other) != 0; }))
        continue;
      if (std::none_of(copy.begin(), copy.end(), is_in) || std::none_of(other.begin(), other.end(), is_in)) return true;
    }
  }
  return false;
}

}  // namespace

CellEmbedding::CellEmbedding(const Cell& cell)
    : tile_(with_edges_of_faces(cell.tile)), rays_(rays_to_corners(tile_)), proof_(tile_) {}

std::uint64_t CellEmbedding::support_of(const CellContour& contour, std::uint8_t vertex) const {
  const std::uint32_t edges = tile_.edge_count();
  return vertex < edges ? std::uint64_t{1} << (tile_.corner_count() + vertex) : contour.masks[vertex - edges];
}

CellEmbedding::Kind CellEmbedding::kind_of(const CellContour& contour,
                                           const std::vector<LocalSimplex>& simplices) const {
  const std::size_t n = static_cast<std::size_t>(tile_.dim), first_own = tile_.edge_count() + contour.added_count[0],
                    first_side = first_own + contour.added_count[1];
  std::vector<std::uint8_t> apexes;
  for (std::size_t i = 0; i < n; ++i)
    if (simplices[0][i] >= first_own && simplices[0][i] < first_side) apexes.push_back(simplices[0][i]);
  for (const LocalSimplex& s : simplices) {
    if (std::any_of(s.begin(), s.begin() + tile_.dim, [&](std::uint8_t v) { return v >= first_side; }))
      return Kind::copy;
    std::erase_if(apexes, [&](std::uint8_t v) { return std::find(s.begin(), s.begin() + tile_.dim, v) == s.end(); });
  }
  return apexes.empty() ? Kind::flat : Kind::cone;
}

std::vector<CellEmbedding::Part> CellEmbedding::parts_of(const CellContour& contour) const {
  std::vector<Part> parts;
  std::vector<bool> seen(contour.simplices.size());
  for (std::size_t first = 0; first < contour.simplices.size(); ++first) {
    if (seen[first]) continue;
    std::vector<bool> vertices(256);
    Part& part = parts.emplace_back();
    for (bool has_grown = true; has_grown;) {
      has_grown = false;
      for (std::size_t i = first; i < contour.simplices.size(); ++i) {
        const LocalSimplex& s = contour.simplices[i];
        const bool is_next = part.simplices.empty() ||
                             std::any_of(s.begin(), s.begin() + tile_.dim, [&](std::uint8_t v) { return vertices[v]; });
        if (seen[i] || !is_next) continue;
        seen[i] = has_grown = true;
        for (int k = 0; k < tile_.dim; ++k) vertices[s[static_cast<std::size_t>(k)]] = true;
        part.simplices.push_back(s);
      }
    }
    part.kind = kind_of(contour, part.simplices);
  }
  return parts;
}

/// The orientation of a tetrahedron in a 3-face, seen from the cell's centre: 1 or -1 for all positions; 0 if it
/// depends on them, or if the vertices do not lie in the face. The determinant of the rays to the four vertices, which
/// are means with equal weights, is linear in each point's position, also if the point belongs to several means. So its
/// signs with each point at either end of its edge decide.
int CellEmbedding::orientation_in(std::size_t face, const std::array<std::uint64_t, 4>& supports) const {
  std::uint64_t all = 0;
  for (const std::uint64_t support : supports) all |= support;
  if ((corners_of(tile_, all) & ~tile_.faces[face].corners()) != 0) return 0;
  const std::uint64_t edges = all >> tile_.corner_count();
  int sign = 0;
  std::uint64_t at_second = 0;  // each subset of the edges
  do {
    std::array<CornerRay, 4> rows{};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::uint64_t rest = supports[i]; rest != 0; rest &= rest - 1) {
        auto v = static_cast<std::size_t>(std::countr_zero(rest));
        if (v >= tile_.corner_count()) {
          const std::size_t e = v - tile_.corner_count();
          v = tile_.edges[e][at_second >> e & 1u];
        }
        for (std::size_t k = 0; k < 4; ++k) rows[i][k] += rays_[v][k];
      }
    const std::int64_t det = cofactor_determinant(rows);
    const int own = det > 0 ? 1 : det < 0 ? -1 : 0;
    if (own * sign < 0) return 0;
    if (own != 0) sign = own;
    at_second = (at_second - edges) & edges;
  } while (at_second != 0);
  return sign;
}

/// Whether a component is the copy of an embedded side of the boundary, for all positions: each tetrahedron lies in a
/// 3-face before its vertices move or belongs to a collar, all others have the same orientation, and a corner that none
/// of them has is not covered (EmbeddingCertifier::is_proved_copy).
bool CellEmbedding::is_proved_copy(const CellContour& contour, const std::vector<LocalSimplex>& simplices) const {
  std::uint64_t all = 0;
  int orientation = 0;
  for (const LocalSimplex& s : simplices) {
    std::array<std::uint64_t, 4> supports{};
    for (std::size_t i = 0; i < 4; ++i) all |= supports[i] = support_of(contour, s[i]);
    std::array<std::uint64_t, 4> sorted = supports;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;  // of the collar, parallel to rays
    int own = 0;
    for (std::size_t face = 0; face < tile_.faces.size() && own == 0; ++face) own = orientation_in(face, supports);
    if (own == 0 || (orientation != 0 && own != orientation)) return false;
    orientation = own;
  }
  return (all & tile_.full()) != tile_.full();
}

/// Adds the pairs that EmbeddingProof does not prove to be apart. Its vertices have numbers below 64, so only
/// vertices of the two parts get numbers.
void CellEmbedding::add_meeting(const CellContour& contour, const Part& part, const Part& other,
                                std::vector<SimplexPair>& pairs) const {
  EmbeddingProof::Means means;
  std::vector<std::uint8_t> vertex_of;
  std::array<std::uint8_t, 256> local{};
  const auto renumbered = [&](std::vector<LocalSimplex> simplices) {
    for (LocalSimplex& s : simplices)
      for (int i = 0; i < tile_.dim; ++i) {
        std::uint8_t& v = s[static_cast<std::size_t>(i)];
        if (v < tile_.edge_count()) continue;
        if (local[v] == 0) {
          local[v] = static_cast<std::uint8_t>(tile_.edge_count() + vertex_of.size());
          vertex_of.push_back(v);
          means.push_back(static_cast<std::uint32_t>(support_of(contour, v) >> tile_.corner_count()));
        }
        v = local[v];
      }
    return simplices;
  };
  const std::vector<LocalSimplex> first = renumbered(part.simplices), second = renumbered(other.simplices);
  if (tile_.edge_count() + vertex_of.size() > 64) throw std::logic_error("more vertices than a proof has numbers for");
  std::vector<SimplexPair> found;
  if (&part == &other)
    proof_.add_meeting(first, means, found);
  else
    proof_.add_meeting(first, second, means, found);
  const auto original = [&](LocalSimplex s) {
    for (int i = 0; i < tile_.dim; ++i)
      if (std::uint8_t& v = s[static_cast<std::size_t>(i)]; v >= tile_.edge_count())
        v = vertex_of[v - tile_.edge_count()];
    return s;
  };
  for (const auto& [a, b] : found) pairs.emplace_back(original(a), original(b));
}

std::vector<SimplexPair> CellEmbedding::unproved_pairs(const CellContour& contour) const {
  std::vector<SimplexPair> result;
  const std::vector<Part> parts = parts_of(contour);
  const auto supports_of = [&](const Part& part) {
    std::vector<std::uint64_t> supports;
    for (const LocalSimplex& s : part.simplices)
      for (const std::uint8_t v : s) supports.push_back(corners_of(tile_, support_of(contour, v)));
    return supports;
  };
  for (std::size_t f = 0; f < parts.size(); ++f) {
    const Part& part = parts[f];
    const bool is_copy = part.kind == Kind::copy;
    if (part.kind == Kind::flat) add_meeting(contour, part, part, result);
    if (is_copy && !is_proved_copy(contour, part.simplices))
      for (std::size_t i = 0; i < part.simplices.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) result.emplace_back(part.simplices[i], part.simplices[j]);
    for (std::size_t g = 0; g < f; ++g) {
      const Part& other = parts[g];
      if (!is_copy && other.kind != Kind::copy)
        add_meeting(contour, part, other, result);
      else if (!are_divided(rays_, supports_of(is_copy ? part : other), supports_of(is_copy ? other : part)))
        for (const LocalSimplex& a : part.simplices)
          for (const LocalSimplex& b : other.simplices) result.emplace_back(a, b);
    }
  }
  return result;
}

Evidence CellEmbedding::of(const CellContour& contour, Signature signature, const std::vector<SimplexPair>& unproved,
                           const SearchPlan& plan) const {
  if (unproved.empty()) return Evidence::proved;
  PositionSearch search(tile_, std::make_unique<CellPlaces>(tile_, contour), unproved);
  return search.find(plan, signature) ? Evidence::absent : Evidence::searched;
}

}  // namespace tegl::gen
