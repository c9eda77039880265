// SPDX-License-Identifier: BSD-3-Clause
//
// Cells whose ambiguous quadrilaterals are resolved from the data. Hexahedra have the resolved cubes of images, tunnels
// included. In octahedra, a tunnel may connect two opposite corners. In other cells each polygon is a disc: the lists
// of the low- or the high-connected alternative, or, if a wedge has one quadrilateral of each, the only polygon, coned.
#include <algorithm>
#include <optional>
#include <span>

#include "ambiguity/face_decision.hpp"
#include "ambiguity/lone_pair.hpp"
#include "complex/built_cells.hpp"
#include "complex/cell_cases.hpp"
#include "complex/edge_alpha.hpp"
#include "image/cube_heights.hpp"
#include "regions/cube_frame.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/extract_tables.hpp"
#include "tile/tesseract_fill.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {

namespace {

using tables::CellShape;

/// Lists of hexahedra: three for each entry of kTile3Resolved, then one for each signature that is not ambiguous.
constexpr std::size_t kPlainHexahedra = 3 * 656;

/// The number of a wedge's list: corner `odd` of the upper triangle is unlike the others of its layer, as are two
/// corners of the lower one; `joined` is the corner whose side with `odd` is high-connected.
constexpr unsigned wedge_list(unsigned odd, unsigned joined, bool is_odd_high) noexcept {
  return 4 * odd + (joined == (odd + 1) % 3 ? 2u : 0u) + (is_odd_high ? 1u : 0u);
}

/// Whether a contour has a directed edge between vertices on these edges of the cell.
bool has_directed_edge(const CellContour& contour, unsigned from, unsigned to) noexcept {
  for (unsigned i = 0; i < contour.list().simplex_count; ++i)
    for (unsigned k = 0; k < 3; ++k)
      if (contour.vertex(i, k) == (contour.reverses() ? to : from) &&
          contour.vertex(i, (k + 1) % 3) == (contour.reverses() ? from : to))
        return true;
  return false;
}

}  // namespace

std::span<const std::array<std::uint8_t, 4>> quadrilaterals_of(CellShape shape) noexcept {
  static constexpr std::array<std::uint8_t, 4> kBase[] = {{0, 1, 2, 3}};
  static constexpr std::array<std::uint8_t, 4> kSides[] = {{0, 1, 3, 4}, {1, 2, 4, 5}, {2, 0, 5, 3}};
  static constexpr std::array<std::uint8_t, 4> kSquares[] = {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5},
                                                             {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};
  if (shape == CellShape::wedge) return kSides;
  if (shape == CellShape::hexahedron) return kSquares;
  if (shape == CellShape::quadrilateral || shape == CellShape::pyramid) return kBase;
  return {};
}

bool is_ambiguous_square(unsigned signature, const std::array<std::uint8_t, 4>& corners) noexcept {
  unsigned bits = 0;
  for (unsigned i = 0; i < 4; ++i) bits |= (signature >> corners[i] & 1u) << i;
  return ambiguous_signatures<2>()[bits];
}

ResolvedCells::ResolvedCells(CellShape shape, const tables::CellTable& table, Triangulation triangulation,
                             FaceRule rule, double isovalue)
    : shape_(shape), table_(table), rule_(rule), isovalue_(isovalue), ambiguous_(std::size_t{1} << table.corner_count) {
  if (shape == CellShape::hexahedron) {
    ambiguous_.assign(ambiguous_.size(), true);  // the others have other diagonals than in the plain table
    add_hexahedra(triangulation);
  } else {
    for (unsigned s = 0; s < ambiguous_.size(); ++s)
      for (const auto& corners : quadrilaterals_of(shape))
        if (is_ambiguous_square(s, corners)) ambiguous_[s] = true;
    if (shape == CellShape::wedge) add_wedges();
    if (shape == CellShape::octahedron && !rule.separates) add_tunnels(table);
  }
  table_.element_of = nullptr;
  table_.lists = lists_.data();
  table_.simplices = simplices_.data();
  table_.masks = masks_.data();
}

void ResolvedCells::add_hexahedra(Triangulation triangulation) {
  for (unsigned e = 0; e < 12; ++e) {
    const unsigned base = edge_base(3, e);
    cube_edges_[e] = static_cast<std::uint8_t>(edge_between(table_, base, base | 1u << e / 4));
  }
  const auto edge_mask = [&](std::uint64_t edges) {
    std::uint64_t mask = 0;
    for (; edges != 0; edges &= edges - 1)
      mask |= std::uint64_t{256} << cube_edges_[static_cast<std::size_t>(std::countr_zero(edges))];
    return mask;
  };
  const auto& resolved = tables::kTile3Resolved;
  lists_.resize(kPlainHexahedra + 256);
  const auto add = [&](CubeKey key, tables::CellList& list) {
    const SimplexList<3> cube(variant_table<3>(triangulation).tile, key.bits());
    list = {static_cast<std::uint32_t>(simplices_.size() / 3),
            static_cast<std::uint32_t>(masks_.size()),
            static_cast<std::uint16_t>(cube.size()),
            0,
            cube.list().cone_vertices,
            cube.list().side_vertices,
            0};
    std::vector<std::uint64_t> coned(cube.list().cone_vertices);  // the edges around each barycentre
    for (unsigned q = 0; q < cube.size(); ++q)
      for (unsigned j = 0; j < 3; ++j) {
        const unsigned v = cube.stored(q, cube.reversed() && j > 0 ? 3 - j : j);
        simplices_.push_back(v < 12 ? cube_edges_[cube.mapped(v)] : static_cast<std::uint8_t>(v));
        const unsigned apex = cube.stored(q, 0);
        if (v < 12 && apex >= 12 && apex - 12 < coned.size()) coned[apex - 12] |= std::uint64_t{1} << cube.mapped(v);
      }
    for (const std::uint64_t edges : coned) masks_.push_back(edge_mask(edges));
    for (unsigned j = 0; j < cube.list().side_vertices; ++j)
      masks_.push_back((cube.side_mask(j) & 255u) | edge_mask(cube.side_mask(j) >> 8));
  };
  for (unsigned signature = 0; signature < 256; ++signature) {
    add(CubeKey(signature), lists_[kPlainHexahedra + signature]);
    if (!ambiguous_signatures<3>()[signature]) continue;
    const int squares = std::popcount(unsigned{resolved.ambiguous_squares[signature]});
    for (unsigned r = 0; r < 1u << squares; ++r)
      for (unsigned choice = 0; choice < 3; ++choice)
        add(CubeKey(signature, r, static_cast<tile::Choice>(choice)),
            lists_[3 * (resolved.first_entry[signature] + std::size_t{r}) + choice]);
  }
}

void ResolvedCells::add_wedges() {
  lists_.resize(12);
  for (unsigned odd = 0; odd < 3; ++odd)
    for (const unsigned joined : {(odd + 1) % 3, (odd + 2) % 3})
      for (const bool is_odd_high : {false, true}) {
        const unsigned a = joined, b = 3 - odd - joined, c = odd;
        // The side of a and c separates the corners that are low, that of b and c the high ones, if c is high above.
        // Otherwise the layers are exchanged, so that the lower triangle has the odd corner high.
        const unsigned low = is_odd_high ? 0 : 3, up = 3 - low;
        const std::array<std::array<unsigned, 2>, 7> around = {{{a + low, c + low},
                                                                {c + low, c + up},
                                                                {b + up, c + up},
                                                                {a + up, c + up},
                                                                {a + low, a + up},
                                                                {b + low, b + up},
                                                                {b + low, c + low}}};
        const bool is_even = (b == (a + 1) % 3) == is_odd_high;
        tables::CellList& list = lists_[wedge_list(odd, joined, is_odd_high)];
        list = {static_cast<std::uint32_t>(simplices_.size() / 3),
                static_cast<std::uint32_t>(masks_.size()),
                7,
                0,
                1,
                0,
                0};
        std::uint64_t mask = 0;
        for (std::size_t i = 0; i < 7; ++i) {
          const auto edge = [&](std::size_t k) {
            return static_cast<std::uint8_t>(edge_between(table_, around[k % 7][0], around[k % 7][1]));
          };
          mask |= std::uint64_t{1} << (table_.corner_count + edge(i));
          simplices_.push_back(static_cast<std::uint8_t>(table_.edge_count));
          simplices_.push_back(is_even ? edge(i + 1) : edge(i));
          simplices_.push_back(is_even ? edge(i) : edge(i + 1));
        }
        masks_.push_back(mask);
      }
}

/// A tunnel is a ring of four quadrilaterals between the loops around two opposite corners, each coned from its centre:
/// no diagonal depends on the numbers of points. A quadrilateral is in the tetrahedron of the two corners and of two
/// neighbouring ones of the others, so no two of them meet.
void ResolvedCells::add_tunnels(const tables::CellTable& table) {
  for (unsigned pair = 0; pair < 3; ++pair)
    for (const bool is_high : {false, true}) {
      const unsigned signature = is_high ? 3u << 2 * pair : 63u & ~(3u << 2 * pair);
      ambiguous_[signature] = true;
      const unsigned b = 2 * ((pair + 1) % 3), c = 2 * ((pair + 2) % 3), p = 2 * pair, q = p + 1;
      const std::array<unsigned, 4> around = {b, c, b + 1, c + 1};
      lists_.push_back({static_cast<std::uint32_t>(simplices_.size() / 3), static_cast<std::uint32_t>(masks_.size()),
                        16, 0, 4, 0, 0});
      const CellContour discs(table, signature, false);
      for (unsigned i = 0; i < 4; ++i) {
        const unsigned from = around[i], to = around[(i + 1) % 4];
        const std::array<unsigned, 4> loop = {edge_between(table, p, from), edge_between(table, p, to),
                                              edge_between(table, q, to), edge_between(table, q, from)};
        const bool is_forward = has_directed_edge(discs, loop[0], loop[1]);
        std::uint64_t mask = 0;
        for (unsigned k = 0; k < 4; ++k) {
          const unsigned next = loop[(k + 1) % 4];
          mask |= std::uint64_t{1} << (table.corner_count + loop[k]);
          for (const unsigned v : {table.edge_count + i, is_forward ? loop[k] : next, is_forward ? next : loop[k]})
            simplices_.push_back(static_cast<std::uint8_t>(v));
        }
        masks_.push_back(mask);
      }
    }
}

std::uint16_t ResolvedCells::tunnel_variant(const LonePair& pair) noexcept {
  return static_cast<std::uint16_t>(2 + 2 * pair.pair + (pair.is_high ? 1u : 0u));
}

std::uint16_t ResolvedCells::variant(const double* values, unsigned signature) const noexcept {
  if (shape_ == CellShape::octahedron) {
    const auto pair = lone_pair(signature, 3);
    return pair && has_tunnel_between(*pair, {values, 6}, isovalue_) ? tunnel_variant(*pair) : std::uint16_t{0};
  }
  if (shape_ == CellShape::hexahedron) {
    const CubeKey key = cube_key(rule_, std::span<const double, 8>(values, 8), isovalue_, signature);
    if (key.is_plain()) return static_cast<std::uint16_t>(2 + kPlainHexahedra + signature);
    const unsigned entry = tables::kTile3Resolved.first_entry[signature] + key.resolution();
    return static_cast<std::uint16_t>(2 + 3 * entry + static_cast<unsigned>(key.choice()));
  }
  unsigned ambiguous = 0, high = 0;
  const auto quadrilaterals = quadrilaterals_of(shape_);
  for (unsigned q = 0; q < quadrilaterals.size(); ++q) {
    const auto& corners = quadrilaterals[q];
    if (!is_ambiguous_square(signature, corners)) continue;
    const std::array<double, 4> at = {values[corners[0]], values[corners[1]], values[corners[2]], values[corners[3]]};
    ambiguous |= 1u << q;
    high |= (is_square_high(rule_, at, isovalue_) ? 1u : 0u) << q;
  }
  return variant(signature, ambiguous, high);
}

std::uint16_t ResolvedCells::variant(unsigned signature, unsigned ambiguous, unsigned high) noexcept {
  if (high == 0 || high == ambiguous) return high == 0 ? 0 : 1;
  const auto joined = static_cast<unsigned>(std::countr_zero(high));  // a wedge's side that is high-connected
  unsigned odd = 0;  // the corner whose column is unlike the two others
  const unsigned lower = signature & 7u;
  while (lower != 1u << odd && lower != (7u ^ 1u << odd)) ++odd;
  const unsigned other = joined == odd ? (odd + 1) % 3 : joined;
  return static_cast<std::uint16_t>(2 + wedge_list(odd, other, (signature >> (3 + odd) & 1u) != 0));
}

std::array<double, 3> ResolvedCells::place(std::uint64_t mask, const std::array<double, 8>& values,
                                           double epsilon) const noexcept {
  std::uint32_t cube = static_cast<std::uint32_t>(mask & 255u);
  for (unsigned e = 0; e < 12; ++e) cube |= static_cast<std::uint32_t>(mask >> (8 + cube_edges_[e]) & 1u) << (8 + e);
  return place_in_cube(cube, values, isovalue_, epsilon);
}

std::array<double, 3> ResolvedCells::place_in_cube(std::uint32_t mask, const std::array<double, 8>& values,
                                                   double isovalue, double epsilon) noexcept {
  const auto on_edge = [&](unsigned e) {
    const unsigned base = edge_base(3, e);
    return edge_point<3>(e, alpha_of(values[base], values[base | 1u << e / 4], isovalue, epsilon));
  };
  return cube_own_place(mask, on_edge, [&](std::uint32_t corners) {
    CubeHeights heights{values, epsilon};
    for (double& at : heights.at) at -= isovalue;
    return heights.level(corners);
  });
}

unsigned DecidedCells::ambiguous_in(std::size_t facet, unsigned signature) const noexcept {
  unsigned bits = 0;
  const auto& in_facet = quadrilaterals_in_[facet];
  for (unsigned q = 0; q < in_facet.size(); ++q)
    bits |= (is_ambiguous_square(signature, quadrilaterals_[in_facet[q]]) ? 1u : 0u) << q;
  return bits;
}

unsigned DecidedCells::high_in(std::size_t facet, const CellKey& key) const noexcept {
  unsigned bits = 0;
  const auto& in_facet = quadrilaterals_in_[facet];
  for (unsigned q = 0; q < in_facet.size(); ++q) bits |= (key.squares >> in_facet[q] & 1u) << q;
  return bits;
}

CellKey DecidedCells::key(unsigned signature, const Index* corners, std::span<const double> values) const noexcept {
  CellKey key;
  key.signature = static_cast<std::uint16_t>(signature);
  std::array<double, 16> at{};
  for (unsigned v = 0; v < table_.corner_count; ++v) at[v] = values[corners[v]];
  for (std::size_t q = 0; q < quadrilaterals_.size(); ++q) {
    const auto& of = quadrilaterals_[q];
    if (!is_ambiguous_square(signature, of)) continue;
    const std::array<double, 4> of_corners = {at[of[0]], at[of[1]], at[of[2]], at[of[3]]};
    key.squares |= (is_square_high(rule_, of_corners, isovalue_) ? 1u : 0u) << q;
  }
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const Facet& facet = facets_[f];
    const unsigned bits = facet_signature(facet, signature);
    if (bits == 0 || bits + 1 == 1u << facet.of->corner_count) continue;
    const std::array<Index, 8> points = points_of(facet, corners);
    if (const auto pair = lone_pair_in(f, bits); pair && !rule_.separates) {
      std::array<double, 6> of_octahedron;
      for (std::size_t v = 0; v < 6; ++v) of_octahedron[v] = at[facet.of->corners[v]];
      if (has_tunnel_between(*pair, of_octahedron, isovalue_)) {
        key.cubes = static_cast<std::uint16_t>(
            key.cubes | static_cast<unsigned>(pair->is_high ? tile::Choice::high : tile::Choice::low) << 2 * f);
        continue;
      }
    }
    if (facet.of->shape != CellShape::hexahedron) {
      if (triangulation_ == Triangulation::barycentric) continue;
      const std::uint16_t variant = ResolvedCells::variant(bits, ambiguous_in(f, signature), high_in(f, key));
      if (variant > 1) continue;
      const FaceFillings& of = fillings_.at(facet.of->shape)[variant];
      key.fillings[f] = facet.has_own ? of.own(bits) : of.choose(bits, points.data());
      continue;
    }
    std::array<double, 8> of_cube;
    for (std::size_t v = 0; v < 8; ++v) of_cube[v] = at[facet.of->corners[v]];
    const tile::Choice choice = cube_key(rule_, of_cube, isovalue_, bits).choice();
    key.cubes = static_cast<std::uint16_t>(key.cubes | static_cast<unsigned>(choice) << 2 * f);
    if (!facet.has_own && has_frame(bits, high_in(f, key), choice))
      key.fillings[f] = static_cast<std::uint8_t>(CubeFrame::number_of(points.data()));
  }
  if (shape_ == CellShape::hexahedron_prism && !rule_.separates &&
      !ResolvedTesseract::is_settled(static_cast<std::uint16_t>(signature)))
    key.tile = is_mean_high(at, isovalue_) ? tile::Choice::high : tile::Choice::low;
  if (shape_ == CellShape::cell16 && !rule_.separates) key.tile = choice_of_cross_polytope(signature, at);
  return key;
}

DecidedFacet DecidedCells::in_facet(std::size_t f, const CellKey& key, const Index* corners) const {
  const Facet& facet = facets_[f];
  const unsigned bits = facet_signature(facet, key.signature);
  DecidedFacet result;
  if (facet.of->shape == CellShape::hexahedron) {
    const auto choice = static_cast<tile::Choice>(key.cubes >> 2 * f & 3u);
    const unsigned squares = high_in(f, key);
    const std::array<Index, 8> points = points_of(facet, corners);
    // contours that are the same in all frames: the frame in which neighbouring cubes of a grid have the same diagonals
    const bool is_active = bits != 0 && bits != 255;
    const unsigned frame =
        is_active && has_frame(bits, squares, choice) ? key.fillings[f] : CubeFrame::number_of(points.data());
    result.cube.emplace(frame, bits, squares, choice);
    return result;
  }
  if (has_ring(f, key)) {
    result.tunnel = lone_pair_in(f, bits);
    return result;
  }
  const unsigned variant = facet.of->shape == CellShape::octahedron
                               ? 0
                               : ResolvedCells::variant(bits, ambiguous_in(f, key.signature), high_in(f, key));
  result.is_compact = triangulation_ == Triangulation::compact && variant < 2;
  if (result.is_compact) result.triangles = fillings_.at(facet.of->shape)[variant].triangles(bits, key.fillings[f]);
  return result;
}

tile::Choice DecidedCells::choice_of_cross_polytope(unsigned signature, std::span<const double> at) const noexcept {
  if (!high_pairs(signature, 4)) return tile::Choice::separate;
  const bool is_high = is_mean_high(at.first(8), isovalue_);
  // two spheres around the corners of a lone pair; otherwise a torus
  if (const auto pair = lone_pair(signature, 4); pair && pair->is_high != is_high) return tile::Choice::separate;
  return is_high ? tile::Choice::high : tile::Choice::low;
}

std::optional<LonePair> DecidedCells::lone_pair_in(std::size_t facet, unsigned bits) const noexcept {
  return facets_[facet].of->shape == CellShape::octahedron ? lone_pair(bits, 3) : std::nullopt;
}

bool DecidedCells::has_ring(std::size_t facet, const CellKey& key) const noexcept {
  return facets_[facet].of->shape == CellShape::octahedron && (key.cubes >> 2 * facet & 3u) != 0;
}

}  // namespace tegl::detail
