// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the contours of 4D cells with decided quadrilaterals by tile::FacetBuilder.
#include <algorithm>
#include <bit>

#include <fmt/format.h>
#include <Eigen/LU>

#include "ambiguity/face_decision.hpp"
#include "complex/built_cells.hpp"
#include "tegl/error.hpp"
#include "tegl/tile/facets.hpp"
#include "tegl/tile/local_contour.hpp"

namespace tegl::detail {

namespace {

using tables::CellShape;

tile::FaceLattice lattice_of(CellShape shape) {
  std::vector<tile::Signature> facets;
  for (const CellFacet& facet : facets_of(shape)) {
    tile::Signature& corners = facets.emplace_back(0);
    for (unsigned v = 0; v < facet.corner_count; ++v) corners |= tile::Signature{1} << facet.corners[v];
  }
  return {4, facets};
}

/// The number of the edge with these two corners.
std::uint8_t edge_of(const tables::CellTable& table, tile::Signature corners) noexcept {
  std::uint8_t e = 0;
  while ((tile::Signature{1} << table.edges[2 * e] | tile::Signature{1} << table.edges[2 * e + 1]) != corners) ++e;
  return e;
}

/// The corners of a quadrilateral: the first one, its neighbours, the opposite one.
std::array<std::uint8_t, 4> around(const tables::CellTable& table, tile::Signature corners) noexcept {
  std::array<std::uint8_t, 4> result{static_cast<std::uint8_t>(std::countr_zero(corners))};
  tile::Signature neighbours = 0;
  for (unsigned e = 0; e < table.edge_count; ++e) {
    const tile::Signature ends = tile::Signature{1} << table.edges[2 * e] | tile::Signature{1}
                                                                                << table.edges[2 * e + 1];
    if ((ends & ~corners) == 0 && (ends >> result[0] & 1u) != 0) neighbours |= ends & (ends - 1);
  }
  result[1] = static_cast<std::uint8_t>(std::countr_zero(neighbours));
  result[2] = static_cast<std::uint8_t>(std::countr_zero(neighbours & (neighbours - 1)));
  result[3] = static_cast<std::uint8_t>(std::countr_zero(corners & ~neighbours & (corners - 1)));
  return result;
}

}  // namespace

DecidedCells::DecidedCells(CellShape shape, FaceRule rule, double isovalue)
    : BuiltCells(table_of(shape)), rule_(rule), isovalue_(isovalue), lattice_(lattice_of(shape)) {
  const auto is_cube = [](const CellFacet& facet) { return facet.shape == CellShape::hexahedron; };
  const auto facets = facets_of(shape);
  if (!rule.separates && std::any_of(facets.begin(), facets.end(), is_cube))
    throw Error(ErrorCode::InvalidArgument,
                "ambiguity by means or saddles in 4D cells with hexahedra as facets; expected low, high, squares or "
                "decider");
  const std::vector<tile::Face>& faces = lattice_.faces();
  edge_of_.resize(faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (faces[f].dim == 1) edge_of_[f] = edge_of(table_, faces[f].corners);
    if (faces[f].dim != 2 || std::popcount(faces[f].corners) != 4) continue;
    faces_.push_back(f);
    quadrilaterals_.push_back(around(table_, faces[f].corners));
  }
  reversed_ = is_reversed();
}

/// The contour around the single high corner 0 is convex, so one of its simplices fixes the sign for all.
bool DecidedCells::is_reversed() const {
  const tile::LocalContour contour =
      local_contour(lattice_, edge_of_, table_.edge_count, tile::build_facets(lattice_, 1), false);
  const auto corner = [&](unsigned v) {
    return Eigen::Vector4d(table_.corners[4 * v], table_.corners[4 * v + 1], table_.corners[4 * v + 2],
                           table_.corners[4 * v + 3]);
  };
  const auto place = [&](unsigned v) {  // the mean of the midpoints of edges
    std::uint64_t edges =
        v < table_.edge_count ? std::uint64_t{1} << v : contour.masks[v - table_.edge_count] >> table_.corner_count;
    const double count = std::popcount(edges);
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (; edges != 0; edges &= edges - 1) {
      const auto e = static_cast<unsigned>(std::countr_zero(edges));
      sum += (corner(table_.edges[2 * e]) + corner(table_.edges[2 * e + 1])) / 2;
    }
    return Eigen::Vector4d(sum / count);
  };
  const auto& simplex = contour.simplices.front();
  Eigen::Matrix4d columns;
  for (int k = 0; k < 3; ++k) columns.col(k) = place(simplex[static_cast<std::size_t>(k) + 1]) - place(simplex[0]);
  columns.col(3) = corner(0) - place(simplex[0]);
  return columns.determinant() < 0;
}

CellKey DecidedCells::key(unsigned signature, const Index* corners, std::span<const double> values) const noexcept {
  CellKey key{static_cast<std::uint16_t>(signature), {}};
  for (std::size_t q = 0; q < quadrilaterals_.size(); ++q) {
    const auto& at = quadrilaterals_[q];
    const auto is_high = [&](std::size_t i) { return (signature >> at[i] & 1u) != 0; };
    if (is_high(0) != is_high(3) || is_high(1) != is_high(2) || is_high(0) == is_high(1)) continue;
    const std::array<double, 4> of_corners = {values[corners[at[0]]], values[corners[at[1]]], values[corners[at[2]]],
                                              values[corners[at[3]]]};
    if (is_square_high(rule_, of_corners, isovalue_))
      key.fillings[q / 8] = static_cast<std::uint8_t>(key.fillings[q / 8] | 1u << q % 8);
  }
  return key;
}

void DecidedCells::fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const {
  tile::FacetBuilder builder(lattice_);
  std::vector<tile::Choice> choices(lattice_.faces().size(), tile::Choice::separate);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    for (std::size_t q = 0; q < faces_.size(); ++q)
      choices[faces_[q]] = (keys[k].fillings[q / 8] >> q % 8 & 1u) != 0 ? tile::Choice::high : tile::Choice::low;
    const tile::TileFacets& facets = builder.build(keys[k].signature, {choices, tile::Alternative::low});
    tile::LocalContour contour = local_contour(lattice_, edge_of_, table_.edge_count, facets, reversed_);
    contours[k].tetrahedra = std::move(contour.simplices);
    auto mask = contour.masks.begin();
    std::size_t kind = 0;
    for (auto* const masks : {&contours[k].shared, &contours[k].cones, &contours[k].sides}) {
      masks->assign(mask, mask + contour.added_count[kind]);
      mask += contour.added_count[kind++];
    }
  }
}

}  // namespace tegl::detail
