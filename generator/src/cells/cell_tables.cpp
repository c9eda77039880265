// SPDX-License-Identifier: BSD-3-Clause
//
// Makes the tables of mesh cells.
#include "cells/cell_tables.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "cells/cell_contours.hpp"
#include "cells/cell_embedding.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "tegl/tile/tile_certifier.hpp"

namespace tegl::gen {

namespace {

/// A triangle or segment whose added vertices are replaced by their masks, in an order that does not depend on numbers.
using NamedSimplices = std::vector<std::vector<std::uint64_t>>;

/// The simplices of a contour after a symmetry, up to orientation. `edges`: images of edges.
NamedSimplices named(const Tile& tile, const CellContour& contour, const std::vector<std::uint8_t>& edges) {
  const std::uint32_t corners = tile.corner_count();
  const auto moved = [&](std::uint64_t mask) {
    std::uint64_t result = 0;
    for (std::uint32_t e = 0; e < edges.size(); ++e) result |= (mask >> (corners + e) & 1u) << (corners + edges[e]);
    return result;
  };
  NamedSimplices result;
  for (const LocalSimplex& s : contour.simplices) {
    std::vector<std::uint64_t> vertices;
    for (std::size_t i = 0; i < static_cast<std::size_t>(tile.dim); ++i)
      vertices.push_back(
          moved(s[i] < edges.size() ? std::uint64_t{1} << (corners + s[i]) : contour.masks[s[i] - edges.size()]));
    std::sort(vertices.begin(), vertices.end());
    result.push_back(std::move(vertices));
  }
  std::sort(result.begin(), result.end());
  return result;
}

Signature image_of(const TileSymmetry& g, Signature signature) {
  Signature result = 0;
  for (std::size_t v = 0; v < g.corner.size(); ++v) result |= (signature >> v & 1u) << g.corner[v];
  return result;
}

/// Throws unless the contour of g(s) is g(the contour of s) for all signatures s and symmetries g.
void require_equivariance(const Cell& cell, const std::vector<CellContour>& contours,
                          const std::vector<TileSymmetry>& group) {
  const std::vector<std::uint8_t> identity = edge_permutation(cell.tile, group.front().corner);
  for (const TileSymmetry& g : group) {
    const std::vector<std::uint8_t> edges = edge_permutation(cell.tile, g.corner);
    for (Signature s = 0; s < contours.size(); ++s)
      if (named(cell.tile, contours[s], edges) != named(cell.tile, contours[image_of(g, s)], identity))
        throw Error(ErrorCode::CertificateFailed,
                    fmt::format("{}: the contour of signature {} does not move with a symmetry", cell.name, s));
  }
}

/// Adds a contour as a list.
void add_list(CellTables& table, const CellContour& contour) {
  const auto n = static_cast<std::size_t>(table.tile.dim);
  tables::CellList list{};
  list.first_simplex = static_cast<std::uint32_t>(table.simplices.size() / n);
  list.first_mask = static_cast<std::uint32_t>(table.masks.size());
  list.simplex_count = static_cast<std::uint16_t>(contour.simplices.size());
  list.shared_vertices = contour.added_count[0];
  list.cone_vertices = contour.added_count[1];
  list.side_vertices = contour.added_count[2];
  table.lists.push_back(list);
  for (const LocalSimplex& s : contour.simplices)
    table.simplices.insert(table.simplices.end(), s.begin(), s.begin() + static_cast<std::ptrdiff_t>(n));
  table.masks.insert(table.masks.end(), contour.masks.begin(), contour.masks.end());
  table.max_simplices = std::max(table.max_simplices, std::uint32_t{list.simplex_count});
  table.max_added = std::max(table.max_added, list.added());
}

bool has_other(const tile::TileFacets& facets, int dim) {
  const int sphere = dim % 2 == 0 ? 2 : 0;  // Sigma has dimension dim - 2
  return std::any_of(facets.sigma_euler.begin(), facets.sigma_euler.end(), [=](int e) { return e != sphere; });
}

/// Builds and certifies contours of a cell.
class CertifiedCell {
 public:
  CertifiedCell(const Cell& cell, Triangulation triangulation)
      : cell_(cell),
        contours_(cell, triangulation),
        certifier_(cell.lattice,
                   [this](Signature s, const tile::Resolution&) -> const tile::TileFacets& { return facets(s); }) {}

  CellContour operator()(Signature signature) {
    if (const tile::Fault fault = certifier_.certify(signature, {}); fault != tile::Fault::none)
      throw Error(ErrorCode::CertificateFailed,
                  fmt::format("{}: signature {}: {}", cell_.name, signature, tile::name_of(fault)));
    return contours_.local();
  }
  [[nodiscard]] bool has_other_components() const { return has_other(*facets_, cell_.tile.dim); }

 private:
  const tile::TileFacets& facets(Signature signature) {
    facets_ = &contours_.build(signature);
    return *facets_;
  }

  const Cell& cell_;
  CellContours contours_;
  tile::TileCertifier certifier_;
  const tile::TileFacets* facets_ = nullptr;
};

/// The default search, with fewer random positions for contours with very many pairs: at most 2^22
/// tests of pairs, but at least 64 positions of both kinds.
SearchPlan plan_for(std::size_t pairs) {
  SearchPlan plan;
  while (plan.uniform > 64 && pairs * (plan.uniform + plan.near_ends) > std::size_t{1} << 22) {
    plan.uniform /= 2;
    plan.near_ends /= 2;
  }
  return plan;
}

/// Adds the evidence that the contour of `entries` signatures is embedded. Throws if it is not.
void add_evidence(const Cell& cell, const CellEmbedding& embedding, const CellContour& contour, Signature signature,
                  std::uint64_t entries, CellTables& table) {
  const std::vector<SimplexPair> unproved = embedding.unproved_pairs(contour);
  const SearchPlan plan = plan_for(unproved.size());
  switch (embedding.of(contour, signature, unproved, plan)) {
    case Evidence::proved:
      table.proved += entries;
      break;
    case Evidence::searched:
      table.searched.push_back({signature, entries, unproved.size(), plan.uniform});
      break;
    case Evidence::absent:
      throw Error(ErrorCode::CertificateFailed,
                  fmt::format("{}: the contour of signature {} intersects itself", cell.name, signature));
  }
}

/// One list per signature.
void add_all_signatures(const Cell& cell, const std::vector<TileSymmetry>& group, CellTables& table) {
  CertifiedCell make(cell, table.triangulation);
  const CellEmbedding embedding(cell);
  std::vector<CellContour> contours;
  for (Signature s = 0; s <= cell.tile.full(); ++s) {
    contours.push_back(make(s));
    add_list(table, contours.back());
    add_evidence(cell, embedding, contours.back(), s, 1, table);
    table.list_of.push_back(static_cast<std::uint16_t>(s));
    table.total_simplices += contours.back().simplices.size();
    table.others += make.has_other_components() ? 1 : 0;
  }
  table.certified = contours.size();
  if (table.triangulation == Triangulation::barycentric) require_equivariance(cell, contours, group);
}

/// One list per class.
void add_classes(const Cell& cell, const std::vector<TileSymmetry>& group, const Transversal& classes,
                 CellTables& table) {
  CertifiedCell make(cell, table.triangulation);
  const CellEmbedding embedding(cell);
  for (std::size_t c = 0; c < classes.representatives.size(); ++c) {
    const CellContour contour = make(classes.representatives[c]);
    add_list(table, contour);
    add_evidence(cell, embedding, contour, classes.representatives[c], classes.orbit_length[c], table);
    table.total_simplices += contour.simplices.size() * classes.orbit_length[c];
    table.others += make.has_other_components() ? classes.orbit_length[c] : 0;
  }
  table.certified = classes.representatives.size();
  for (std::size_t s = 0; s < classes.class_of.size(); ++s) {
    table.list_of.push_back(static_cast<std::uint16_t>(classes.class_of[s]));
    table.element_of.push_back(static_cast<std::uint16_t>(classes.element_of[s]));
  }
  for (const TileSymmetry& g : group) {
    for (const std::uint32_t v : g.corner) table.permutations.push_back(static_cast<std::uint8_t>(v));
    const auto edges = edge_permutation(cell.tile, g.corner);
    table.permutations.insert(table.permutations.end(), edges.begin(), edges.end());
    table.reverses.push_back(g.reverses_orientation() ? 1 : 0);
  }
}

}  // namespace

CellTables make_cell_tables(const Cell& cell, Triangulation triangulation) {
  CellTables table{cell.name, triangulation, cell.tile};
  const std::vector<TileSymmetry> group = symmetries(cell.tile, GroupKind::Full, false);
  const Transversal classes = transversal(cell.tile, group);
  require_burnside_count(classes, group);
  table.group_order = group.size();
  table.classes = classes.representatives.size();
  if (cell.tile.dim < 4)
    add_all_signatures(cell, group, table);
  else
    add_classes(cell, group, classes, table);
  return table;
}

std::vector<CellTables> make_all_cell_tables() {
  std::vector<CellTables> tables;
  for (const Cell& cell : mesh_cells()) {
    tables.push_back(make_cell_tables(cell, Triangulation::barycentric));
    if (cell.tile.dim < 4) tables.push_back(make_cell_tables(cell, Triangulation::compact));
  }
  return tables;
}

}  // namespace tegl::gen
