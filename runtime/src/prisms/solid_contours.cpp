// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the contours of 4D polytopes, block by block.
#include "prisms/solid_contours.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/workers.hpp"
#include "prisms/solid_cell.hpp"

namespace tegl::detail {

namespace {

/// The loops that are coned though they have a fan: one of its diagonals is in another cell as well, as in the contour
/// of the polyhedra at one time (separate_diagonals).
struct ConedLoops {
  std::map<std::pair<Index, Index>, std::vector<std::uint8_t>> at_ends;  ///< of prisms: by polyhedron and layer
  /// In facets of other polytopes: by key_of_facet and the smallest ends of an edge.
  std::set<std::array<Index, 6>> in_facets;
};

/// The key of a loop in a facet of a polytope that is no prism.
std::array<Index, 6> key_of_loop(const Polytopes& polytopes, Index cell, const SolidFacet& facet,
                                 std::span<const std::uint8_t> loop) {
  const Index* const points = polytopes.cell(cell);
  std::array<Index, 2> smallest = {~Index{0}, ~Index{0}};
  for (const std::uint8_t e : loop) {
    const auto& [a, b] = facet.shape.edges()[e];
    const auto [p, q] = std::minmax(points[facet.corners[a]], points[facet.corners[b]]);
    smallest = std::min(smallest, std::array<Index, 2>{p, q});
  }
  const auto key = key_of_facet(facet, points, polytopes.entangled_facet(cell, facet));
  return {key[0], key[1], key[2], key[3], smallest[0], smallest[1]};
}

/// The loops in facets without a table, of polytopes that are no prisms, with a diagonal that another facet has, too.
std::set<std::array<Index, 6>> coned_in_facets(const Polytopes& polytopes, std::span<const double> values,
                                               const PolytopeRules& rules) {
  std::vector<std::pair<std::array<Index, 4>, std::array<Index, 6>>> diagonals;  // ends of both edges, and the loop
  Loops loops;
  std::array<double, kPolytopeCorners> at;
  for (const Index c : polytopes.entangled()) {
    const Index* const points = polytopes.cell(c);
    for (const SolidFacet& facet : facets_of_solid(polytopes.shape(c))) {
      bool is_missing = facet.is_tabled();
      for (std::size_t v = 0; v < facet.corners.size(); ++v) {
        at[v] = values[points[facet.corners[v]]];
        is_missing = is_missing || std::isnan(at[v]);
      }
      if (is_missing) continue;
      loops.for_each(facet.shape, at.data(), rules, [&](std::span<const std::uint8_t> loop) {
        const auto start = fan_of_loop(rules, facet, loop, points);
        if (loop.size() < 4 || !start) return;
        const auto ends = [&](std::size_t i) -> std::array<Index, 2> {
          const auto& [a, b] = facet.shape.edges()[loop[(*start + i) % loop.size()]];
          const auto [p, q] = std::minmax(points[facet.corners[a]], points[facet.corners[b]]);
          return {p, q};
        };
        const auto key = key_of_loop(polytopes, c, facet, loop);
        for (std::size_t i = 2; i + 1 < loop.size(); ++i) {
          const auto first = std::min(ends(0), ends(i)), second = std::max(ends(0), ends(i));
          diagonals.push_back({{first[0], first[1], second[0], second[1]}, key});
        }
      });
    }
  }
  std::sort(diagonals.begin(), diagonals.end());
  diagonals.erase(std::unique(diagonals.begin(), diagonals.end()), diagonals.end());  // the cells at a facet
  std::set<std::array<Index, 6>> coned;
  for (std::size_t i = 1; i < diagonals.size(); ++i)
    if (diagonals[i].first == diagonals[i - 1].first) coned.insert({diagonals[i - 1].second, diagonals[i].second});
  return coned;
}

ConedLoops find_coned_loops(const Polytopes& prisms, std::span<const double> values, const PolytopeRules& rules) {
  struct Diagonal {
    std::array<Index, 4> ends;  ///< of both edges
    std::pair<Index, Index> at;
    std::uint8_t loop;
    auto operator<=>(const Diagonal&) const = default;
  };
  ConedLoops result;
  if (!rules.is_compact || prisms.entangled().empty()) return result;
  if (prisms.shape(0).solids() != nullptr) {
    result.in_facets = coned_in_facets(prisms, values, rules);
    return result;
  }
  auto& coned = result.at_ends;
  std::vector<Diagonal> diagonals;
  Loops loops;
  std::array<double, kPolytopeCorners> at;
  const auto layers = static_cast<Index>(prisms.size() / prisms.base_count() + 1);
  for (const Index c : prisms.entangled())
    for (Index k = 0; k < layers; ++k) {
      const std::size_t prism = c + std::size_t{k > 0 ? k - 1 : 0} * prisms.base_count();
      const PolytopeFaces& shape = prisms.shape(prism);
      const Index* const points = prisms.cell(prism) + (k > 0 ? shape.base_corners() : 0);
      for (std::size_t v = 0; v < shape.base_corners(); ++v) at[v] = values[points[v]];
      if (std::any_of(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(shape.base_corners()),
                      [](double value) { return std::isnan(value); }))
        continue;
      loops.for_each(shape, at.data(), rules, [&](std::span<const std::uint8_t> loop) {
        std::size_t start = 0;
        if (loop.size() < 4 || !find_fan(shape, loop, start)) return;
        const auto ends = [&](std::size_t i) -> std::array<Index, 2> {
          const auto& [a, b] = shape.edges()[loop[(start + i) % loop.size()]];
          return {std::min(points[a], points[b]), std::max(points[a], points[b])};
        };
        for (std::size_t i = 2; i + 1 < loop.size(); ++i) {
          const auto first = std::min(ends(0), ends(i)), second = std::max(ends(0), ends(i));
          diagonals.push_back({{first[0], first[1], second[0], second[1]}, {c, k}, loop[0]});
        }
      });
    }
  std::sort(diagonals.begin(), diagonals.end());
  for (std::size_t i = 1; i < diagonals.size(); ++i)
    if (diagonals[i].ends == diagonals[i - 1].ends)
      for (const Diagonal& diagonal : {diagonals[i - 1], diagonals[i]}) coned[diagonal.at].push_back(diagonal.loop);
  for (auto& [at_end, of] : coned) std::sort(of.begin(), of.end());
  return result;
}

/// Builds the contours of the cells of a block.
class SolidBlockBuilder {
 public:
  SolidBlockBuilder(const Polytopes& polytopes, std::span<const double> values, const PolytopeRules& rules,
                    const ConedLoops& coned, PolytopeBlock& block)
      : polytopes_(polytopes), values_(values), rules_(rules), coned_(coned), block_(block), cell_(rules) {}

  void add(Index cell) {
    const std::span<const Index> points = polytopes_.points_of(cell);
    std::size_t high = 0;
    bool is_missing = false;
    for (std::size_t v = 0; v < points.size(); ++v) {
      at_[v] = values_[points[v]];
      high += at_[v] >= rules_.isovalue ? 1 : 0;
      is_missing = is_missing || std::isnan(at_[v]);
    }
    if (is_missing) block_.missing.push_back(cell);
    if (is_missing || high == 0 || high == points.size()) return;
    ++block_.active;
    const PolytopeFaces& shape = polytopes_.shape(cell);
    cell_.build(shape, points.data(), at_.data(), entangled(cell));
    vertex_on_.resize(shape.edges().size());
    for (std::size_t e = 0; e < shape.edges().size(); ++e) {
      const auto& [a, b] = shape.edges()[e];
      if ((at_[a] >= rules_.isovalue) == (at_[b] >= rules_.isovalue)) continue;
      vertex_on_[e] = static_cast<std::uint32_t>(crossed_.size());
      crossed_.push_back({std::min(points[a], points[b]), std::max(points[a], points[b])});
    }
    write(cell, points);
  }

  void finish() {
    set_edges(block_, crossed_);
    block_.simplices = block_.tetrahedra.size();
    block_.own = block_.own_vertices.size();
  }

 private:
  using Kind = PolytopeBlock::InnerVertex::Kind;

  [[nodiscard]] EntangledSolid entangled(Index cell) const {
    EntangledSolid result;
    result.is_one = polytopes_.is_entangled(cell);
    if (!coned_.in_facets.empty())
      result.is_coned = [this, cell](const SolidFacet& facet, std::span<const std::uint8_t> loop) {
        return !facet.is_tabled() && coned_.in_facets.count(key_of_loop(polytopes_, cell, facet, loop)) != 0;
      };
    if (result.is_one && !coned_.at_ends.empty())
      result.is_coned = [this, cell](const SolidFacet& facet, std::span<const std::uint8_t> loop) {
        if (facet.kind != SolidFacet::Kind::end) return false;
        const auto base = static_cast<Index>(polytopes_.base_count());
        const Index layer = cell / base + (facet.corners[0] == 0 ? 0 : 1);
        const auto found = coned_.at_ends.find({cell % base, layer});
        return found != coned_.at_ends.end() && std::binary_search(found->second.begin(), found->second.end(), loop[0]);
      };
    return result;
  }

  /// Appends the contour of a cell.
  void write(Index cell, std::span<const Index> points) {
    const auto shared = static_cast<std::uint32_t>(block_.shared.size());
    const auto cones = static_cast<std::uint32_t>(block_.own_vertices.size());
    const auto sides = static_cast<std::uint32_t>(cones + cell_.cones().size());
    for (const SolidCell::Inner& inner : cell_.shared()) add_shared(cell, inner, points);
    for (const SolidCell::Inner& inner : cell_.cones()) add_inner(block_.own_vertices, Kind::mean, cell, inner, points);
    for (const SolidCell::Inner& inner : cell_.sides())
      add_inner(block_.own_vertices, Kind::inwards, cell, inner, points);
    for (const SolidCell::Inner& inner : cell_.collars())
      add_inner(block_.own_vertices, Kind::collar, cell, inner, points);
    const auto collars = static_cast<std::uint32_t>(sides + cell_.sides().size());
    for (const SolidCell::Tetrahedron& t : cell_.tetrahedra()) {
      auto& to = block_.tetrahedra.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t v = t[k];
        to[k] = v >= SolidCell::kCollars    ? PolytopeBlock::kOwn | (collars + v - SolidCell::kCollars)
                : v >= SolidCell::kSides    ? PolytopeBlock::kOwn | (sides + v - SolidCell::kSides)
                : v >= cell_.first_cone()   ? PolytopeBlock::kOwn | (cones + v - cell_.first_cone())
                : v >= cell_.first_shared() ? PolytopeBlock::kShared | (shared + v - cell_.first_shared())
                                            : vertex_on_[v];
      }
    }
    block_.pieces.push_back({cell, static_cast<std::uint32_t>(block_.tetrahedra.size()), false});
  }

  void add_shared(Index cell, const SolidCell::Inner& inner, std::span<const Index> points) {
    const SolidFacet& facet = cell_.facets()[inner.facet];
    const Kind kind = inner.is_in_cube ? Kind::in_cube : facet.is_tabled() ? Kind::polygon : Kind::loop;
    PolytopeBlock::InnerVertex& vertex = add_inner(block_.shared, kind, cell, inner, points);
    vertex.mask = inner.mask;
    if (kind == Kind::in_cube) {
      for (std::size_t v = 0; v < 8; ++v) vertex.points[v] = points[facet.corners[kHexahedronCorners[v]]];
    } else if (kind == Kind::loop) {
      const std::array<Index, 4> key = key_of_facet(facet, points.data(), polytopes_.entangled_facet(cell, facet));
      std::copy(key.begin(), key.end(), vertex.points.begin());
    }
  }

  PolytopeBlock::InnerVertex& add_inner(std::vector<PolytopeBlock::InnerVertex>& to, Kind kind, Index cell,
                                        const SolidCell::Inner& inner, std::span<const Index> points) {
    PolytopeBlock::InnerVertex& vertex = to.emplace_back();
    vertex.kind = kind;
    vertex.cell = cell;
    vertex.first_vertex = static_cast<std::uint32_t>(block_.inner_vertices.size());
    vertex.first_corner = static_cast<std::uint32_t>(block_.inner_corners.size());
    for (const SolidCell::Local v : inner.points)
      if (v < cell_.first_shared())
        block_.inner_vertices.push_back(vertex_on_[v]);
      else if (v >= cell_.first_corner())
        block_.inner_corners.push_back(points[v - std::size_t{cell_.first_corner()}]);
    vertex.vertices_end = static_cast<std::uint32_t>(block_.inner_vertices.size());
    vertex.corners_end = static_cast<std::uint32_t>(block_.inner_corners.size());
    return vertex;
  }

  const Polytopes& polytopes_;
  std::span<const double> values_;
  const PolytopeRules& rules_;
  const ConedLoops& coned_;
  PolytopeBlock& block_;
  SolidCell cell_;
  std::array<double, 2 * kPolytopeCorners> at_{};
  std::vector<std::uint32_t> vertex_on_;  ///< by edge of the cell: position in crossed_
  std::vector<std::array<Index, 2>> crossed_;
};

}  // namespace

std::vector<PolytopeBlock> build_solid_contours(const Polytopes& polytopes, std::span<const double> values,
                                                const PolytopeRules& rules, const std::vector<Index>* listed,
                                                const WorkOptions& work) {
  const ConedLoops coned = find_coned_loops(polytopes, values, rules);
  return build_blocks(512, polytopes, listed, work,
                      [&](PolytopeBlock& block) { return SolidBlockBuilder(polytopes, values, rules, coned, block); });
}

}  // namespace tegl::detail
