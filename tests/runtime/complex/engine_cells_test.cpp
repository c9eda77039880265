// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of single cells, and those of the general engine, which builds each cell from its faces alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "complex/cell_cases.hpp"
#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "complex/engine_cells.hpp"
#include "invariants.hpp"
#include "tegl/complex.hpp"
#include "tegl/extract.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/shape_places.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr Ambiguity kFixed[] = {Ambiguity::low, Ambiguity::high};

/// Cells of one type with random signatures, `kApart` apart along the first axis; values are 1 and -1, so that vertices
/// on edges are midpoints.
template <int N>
struct RandomCells {
  static constexpr double kApart = 8;

  RandomCells(const detail::CellKind& kind, std::size_t count, std::uint64_t seed) {
    const tables::CellTable& table = detail::table_of(kind.shape);
    const std::size_t corners = table.corner_count;
    std::mt19937_64 random(seed);
    std::vector<std::array<double, N>> points;
    std::vector<double> values;
    std::vector<Index> cells;
    for (std::size_t c = 0; c < count; ++c) {
      signatures.push_back(random() % (tile::Signature{1} << corners));
      const std::vector<Index> number = add_corners<N>(kind, random, points, cells);
      values.resize(points.size());
      for (std::size_t v = 0; v < corners; ++v) {
        points[number[v]][0] += kApart * static_cast<double>(c);
        values[number[v]] = (signatures[c] >> v & 1u) != 0 ? 1.0 : -1.0;
      }
    }
    complex = Complex<N>(points, kind.type, cells);
    complex.set_values(values);
  }

  std::vector<tile::Signature> signatures;
  Complex<N> complex{{}, std::span<const CellType>(), {}};
};

/// The contour of each of random cells. `faces`: of their shape.
template <int N>
std::vector<CellPieces<N>> pieces_by_cell(const Contour<N, double>& contour, const tables::CellTable& table,
                                          const std::vector<tile::Face>& faces, std::size_t count) {
  std::map<std::array<double, N>, tile::Signature> middles;
  for (const tile::Face& face : faces) {
    if (face.dim != 1) continue;
    std::array<double, N> middle{};
    for (std::size_t v = 0; v < table.corner_count; ++v)
      for (std::size_t a = 0; a < N; ++a)
        middle[a] += (face.corners >> v & 1u) != 0 ? table.corners[N * v + a] / 2.0 : 0.0;
    middles[middle] = face.corners;
  }
  std::vector<CellPieces<N>> of_cell(count);
  constexpr double kApart = RandomCells<N>::kApart;
  const auto cell_of = [&](std::size_t v) { return static_cast<std::size_t>((contour.vertices[v][0] + 2) / kApart); };
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    const std::size_t c = cell_of(v);
    auto place = contour.vertices[v];
    place[0] -= kApart * static_cast<double>(c);
    const auto found = middles.find(place);
    of_cell[c].edge_of[v] = found == middles.end() ? 0 : found->second;
  }
  for (const auto& simplex : contour.simplices) {
    CellPieces<N>& pieces = of_cell[cell_of(simplex[0])];
    pieces.simplices.emplace_back();
    std::copy(simplex.begin(), simplex.end(), pieces.simplices.back().begin());
  }
  return of_cell;
}

/// The contours of random cells that do not touch, and of each cell by the general engine.
template <int N>
void expect_contours_of_the_engine(CellType type, std::size_t count, std::uint64_t seed) {
  SCOPED_TRACE(name_of(type));
  const detail::CellKind& kind = *detail::find_kind(type);
  const tables::CellTable& table = detail::table_of(kind.shape);
  const RandomCells<N> cells(kind, count, seed);
  tile::FacetBuilder engine(tile::FaceLattice(N, hull_facets<N>(table)));
  const std::vector<tile::Face>& faces = engine.lattice().faces();
  for (const Ambiguity rule : kFixed) {
    ExtractOptions options;
    options.triangulation = Triangulation::barycentric;
    options.ambiguity = rule;
    const auto of_cell = pieces_by_cell<N>(extract<double>(cells.complex, 0.0, options), table, faces, count);
    std::array<std::size_t, 2> different{};  // by orientation: that of the lattice of faces has no coordinates
    std::size_t plain = 0;
    for (std::size_t c = 0; c < count; ++c) {
      // by definition: one vertex on each edge whose ends are on different sides, and on no other edge
      std::multiset<tile::Signature> expected, crossed;
      for (const tile::Face& face : faces)
        if (face.dim == 1 && std::popcount(face.corners & cells.signatures[c]) == 1) expected.insert(face.corners);
      for (const auto& [v, edge] : of_cell[c].edge_of)
        if (edge != 0) crossed.insert(edge);
      EXPECT_EQ(expected, crossed) << "signature " << cells.signatures[c];
      const auto alternative = rule == Ambiguity::low ? tile::Alternative::low : tile::Alternative::high;
      const tile::TileFacets& built = engine.build(cells.signatures[c], {.choices = {}, .alternative = alternative});
      const CellPieces<N> pieces = pieces_of<N>(built, faces);
      EXPECT_EQ(pieces.boundary_and_euler(), of_cell[c].boundary_and_euler()) << "signature " << cells.signatures[c];
      // which side is copied depends on the numbers of corners
      if (std::any_of(built.facets.begin(), built.facets.end(),
                      [](const tile::Facet& facet) { return facet.filling == tile::Filling::side; }))
        continue;
      ++plain;
      for (const unsigned flip : {0u, 1u}) different[flip] += pieces.by_edges(flip) != of_cell[c].by_edges(0) ? 1 : 0;
    }
    EXPECT_EQ(0u, std::min(different[0], different[1]));
    EXPECT_GT(plain, count / 2);
  }
}

TEST(EngineCells, RandomCellsOfEveryTypeHaveTheContoursOfTheGeneralEngine) {
  for (const CellType type : {CellType::triangle, CellType::pixel, CellType::quadrilateral})
    expect_contours_of_the_engine<2>(type, 100, 11);
  for (const CellType type : {CellType::tetrahedron, CellType::voxel, CellType::hexahedron, CellType::wedge,
                              CellType::pyramid, CellType::octahedron})
    expect_contours_of_the_engine<3>(type, 300, 12);
  for (const CellType type :
       {CellType::simplex4, CellType::tetrahedron_prism, CellType::voxel_prism, CellType::hexahedron_prism,
        CellType::wedge_prism, CellType::pyramid_prism, CellType::cell16, CellType::octahedron_prism})
    expect_contours_of_the_engine<4>(type, 200, 13);
}

/// Compact contours and those by rules from the data have other simplices than the engine's, and the same topology.
/// Returns whether `mean` joins what `squares` separates.
template <int N>
bool expect_topology_of_the_engine(CellType type, RandomCells<N>& cells, const std::vector<double>& values) {
  const std::size_t count = cells.signatures.size();
  const tables::CellTable& table = detail::table_of(detail::find_kind(type)->shape);
  cells.complex.set_values(values);
  std::vector<std::vector<double>> of_cell(count);
  const detail::CellGroups& groups = detail::ComplexAccess::cells(cells.complex);
  EXPECT_EQ(1u, groups.groups.size());
  for (std::size_t c = 0; c < count; ++c)
    for (std::size_t v = 0; v < table.corner_count; ++v) of_cell[c].push_back(values[groups.groups[0].cell(c)[v]]);
  tile::FacetBuilder engine(tile::FaceLattice(N, hull_facets<N>(table)));
  const std::vector<tile::Face>& faces = engine.lattice().faces();
  std::map<Ambiguity, std::vector<std::pair<int, std::size_t>>> expected;
  for (const Ambiguity rule : kAllRules) {
    std::vector<tile::Choice> choices;
    for (std::size_t c = 0; c < count; ++c) {
      const tile::Resolution resolution = resolution_of<N>(table, faces, of_cell[c], rule, choices);
      expected[rule].push_back(topology_of(pieces_of<N>(engine.build(cells.signatures[c], resolution), faces)));
    }
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
      SCOPED_TRACE(testing::Message() << name_of(type) << " " << static_cast<int>(rule) << " "
                                      << static_cast<int>(triangulation));
      ExtractOptions options;
      options.triangulation = triangulation;
      options.ambiguity = rule;
      const auto contour = extract<double>(cells.complex, 0.0, options);
      expect_oriented_manifold(contour);
      std::vector<CellPieces<N>> pieces(count);
      for (const auto& simplex : contour.simplices) {
        const double x = contour.vertices[simplex[0]][0];
        auto& of = pieces[static_cast<std::size_t>((x + 2) / RandomCells<N>::kApart)].simplices.emplace_back();
        std::copy(simplex.begin(), simplex.end(), of.begin());
      }
      for (std::size_t c = 0; c < count; ++c)
        EXPECT_EQ(expected[rule][c], topology_of(pieces[c])) << "signature " << cells.signatures[c] << ", cell " << c;
    }
  }
  const bool joins = expected[Ambiguity::mean] != expected[Ambiguity::squares];
  EXPECT_EQ(joins, expected[Ambiguity::saddle] != expected[Ambiguity::decider]) << name_of(type);
  // random values of octahedra and 16-cells rarely have tunnels
  bool may_join = false, has_cubes = false;
  for (const tile::Face& face : faces) {
    may_join = may_join || (face.dim > 2 && is_cube_or_cross(face, faces));
    has_cubes = has_cubes || (face.dim == 3 && std::popcount(face.corners) == 8);
  }
  EXPECT_TRUE(joins ? may_join : !has_cubes) << name_of(type);
  return joins;
}

/// Of cells with random signatures and values.
template <int N>
void expect_topology_of_the_engine(CellType type, std::size_t count, std::uint64_t seed) {
  RandomCells<N> cells(*detail::find_kind(type), count, seed);
  // distances from the isovalue of their own, by point; the signs stay
  std::mt19937_64 random(seed);
  std::vector<double> values(cells.complex.values().begin(), cells.complex.values().end());
  for (double& value : values) value *= 0.05 + 0.95 * static_cast<double>(random() >> 11) * 0x1p-53;
  (void)expect_topology_of_the_engine<N>(type, cells, values);
}

/// Of cells with all signatures, each with a centre that is high and one that is low.
template <int N>
void expect_every_resolution_of_the_engine(CellType type) {
  const detail::CellKind& kind = *detail::find_kind(type);
  const std::size_t corners = detail::table_of(kind.shape).corner_count;
  RandomCells<N> cells(kind, std::size_t{2} << corners, 1);
  const detail::CellGroups& groups = detail::ComplexAccess::cells(cells.complex);
  std::vector<double> values(cells.complex.values().size());
  for (std::size_t c = 0; c < cells.signatures.size(); ++c) {
    cells.signatures[c] = c / 2;
    for (std::size_t v = 0; v < corners; ++v) {
      const bool is_high = (c / 2 >> v & 1u) != 0;
      values[groups.groups[0].cell(c)[v]] = (is_high ? 1.0 : -1.0) * (is_high == (c % 2 == 0) ? 1.0 : 0.1);
    }
  }
  EXPECT_TRUE(expect_topology_of_the_engine<N>(type, cells, values));
}

TEST(EngineCells, EveryResolutionOfOctahedraAnd16CellsHasTheTopologyOfTheGeneralEngine) {
  expect_every_resolution_of_the_engine<3>(CellType::octahedron);
  expect_every_resolution_of_the_engine<4>(CellType::cell16);
}

TEST(EngineCells, CompactContoursAndRulesThatReadTheDataHaveTheTopologyOfTheGeneralEngine) {
  for (const CellType type : {CellType::pixel, CellType::quadrilateral}) expect_topology_of_the_engine<2>(type, 100, 3);
  for (const CellType type : {CellType::tetrahedron, CellType::wedge, CellType::pyramid, CellType::hexahedron,
                              CellType::voxel, CellType::octahedron})
    expect_topology_of_the_engine<3>(type, 300, 4);
  for (const CellType type :
       {CellType::simplex4, CellType::tetrahedron_prism, CellType::pyramid_prism, CellType::wedge_prism,
        CellType::hexahedron_prism, CellType::voxel_prism, CellType::cell16, CellType::octahedron_prism})
    // rare: tunnels in the only cube of a pyramid over time; spheres beside the same region as a torus in octahedra
    expect_topology_of_the_engine<4>(
        type, type == CellType::pyramid_prism || type == CellType::octahedron_prism ? 600 : 100, 5);
}

/// The corners around the faces of a wedge: the triangles, then the sides in the order of quadrilaterals_of.
const std::vector<std::vector<unsigned>> kWedgeFaces = {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};

/// The contour of a wedge in its faces, as pairs of edges. `high`: ambiguous sides whose high corners are joined.
std::set<std::set<unsigned>> segments_of_wedge(const tables::CellTable& table, unsigned signature, unsigned high) {
  std::set<std::set<unsigned>> segments;
  for (std::size_t f = 0; f < kWedgeFaces.size(); ++f) {
    const std::vector<unsigned>& ring = kWedgeFaces[f];
    const std::size_t size = ring.size();
    const auto is_high = [&](std::size_t i) { return (signature >> ring[i % size] & 1u) != 0; };
    const auto edge = [&](std::size_t i) -> unsigned {
      return detail::edge_between(table, ring[i % size], ring[(i + 1) % size]);
    };
    std::set<unsigned> crossed;
    for (std::size_t i = 0; i < size; ++i)
      if (is_high(i) != is_high(i + 1)) crossed.insert(edge(i));
    if (crossed.size() == 2) segments.insert(crossed);
    if (crossed.size() < 4) continue;
    const bool cut_off = (high >> (f - 2) & 1u) == 0;  // which corners are apart
    for (std::size_t i = 0; i < size; ++i)
      if (is_high(i) == cut_off) segments.insert({edge(i + size - 1), edge(i)});
  }
  return segments;
}

TEST(ResolvedWedges, WithSidesOfBothKindsHaveThePolygonOfTheirFaces) {
  const tables::CellTable& table = tables::cell_table(tables::CellShape::wedge, Triangulation::compact);
  const detail::ResolvedCells wedges(tables::CellShape::wedge, table, Triangulation::compact,
                                     {detail::FaceRule::By::means, true}, 0.0);
  const auto sides = detail::quadrilaterals_of(tables::CellShape::wedge);
  using Place = std::array<double, 3>;
  const auto corner = [&](unsigned v) -> Place {
    return {double(table.corners[3 * v]), double(table.corners[3 * v + 1]), double(table.corners[3 * v + 2])};
  };
  std::set<unsigned> lists;
  for (unsigned signature = 0; signature < 64; ++signature) {
    unsigned ambiguous = 0;
    for (unsigned q = 0; q < 3; ++q) ambiguous |= detail::is_ambiguous_square(signature, sides[q]) ? 1u << q : 0;
    for (unsigned high = ambiguous & (ambiguous - 1); high != 0 && high != ambiguous; high = (high - 1) & ambiguous) {
      SCOPED_TRACE(testing::Message() << "signature " << signature << " high sides " << high);
      const unsigned variant = detail::ResolvedCells::variant(signature, ambiguous, high);
      ASSERT_GT(variant, 1u);
      lists.insert(variant);
      const detail::CellContour contour = wedges.contour(variant);
      ASSERT_EQ(contour.list().added(), 1u);
      const auto segments = segments_of_wedge(table, signature, high);
      std::set<unsigned> crossed;
      Place centre{};
      const auto point = [&](unsigned e) {
        const Place a = corner(table.edges[2 * e]), b = corner(table.edges[2 * e + 1]);
        return Place{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
      };
      for (const auto& segment : segments) crossed.insert(segment.begin(), segment.end());
      for (const unsigned e : crossed)
        for (std::size_t a = 0; a < 3; ++a) centre[a] += point(e)[a] / static_cast<double>(crossed.size());
      std::uint64_t mask = 0;
      for (const unsigned e : crossed) mask |= std::uint64_t{1} << (table.corner_count + e);
      EXPECT_EQ(contour.mask(0), mask);
      // a cone over each segment once: if it were several polygons, an edge would have other segments than in the faces
      std::set<std::set<unsigned>> coned;
      std::map<unsigned, unsigned> next;
      for (unsigned i = 0; i < contour.list().simplex_count; ++i) {
        EXPECT_EQ(contour.vertex(i, 0), table.edge_count);
        const unsigned p = contour.vertex(i, 1), q = contour.vertex(i, 2);
        coned.insert({p, q});
        next[p] = q;
        const unsigned a = table.edges[2 * p], b = table.edges[2 * p + 1];
        const Place to_high = corner((signature >> a & 1u) != 0 ? a : b);
        EXPECT_GT(detail::six_volumes(std::array{centre, point(p), point(q), to_high}), 1e-9) << "triangle " << i;
      }
      EXPECT_EQ(coned, segments);
      EXPECT_EQ(contour.list().simplex_count, segments.size());
      std::size_t around = 1;
      for (unsigned e = next.begin()->second; e != next.begin()->first && around < 99; e = next.at(e)) ++around;
      EXPECT_EQ(around, segments.size());
    }
  }
  EXPECT_EQ(lists.size(), 12u);
}

}  // namespace
}  // namespace tegl
