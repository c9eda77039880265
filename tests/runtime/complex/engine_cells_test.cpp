// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of cells and of whole complexes, and those of the general engine, which builds each cell from its faces
// alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "invariants.hpp"
#include "meshes.hpp"
#include "tegl/complex.hpp"
#include "tegl/delaunay.hpp"
#include "tegl/extract.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr Ambiguity kFixed[] = {Ambiguity::low, Ambiguity::high};

/// The facets of a shape's convex hull as sets of corners, found by trying all hyperplanes through corners.
template <int N>
std::vector<tile::Signature> hull_facets(const tables::CellTable& table) {
  using Vector = Eigen::Matrix<double, N, 1>;
  const auto corner = [&](unsigned v) {
    return Vector(Eigen::Map<const Eigen::Matrix<std::int8_t, N, 1>>(table.corners + N * v).template cast<double>());
  };
  std::set<tile::Signature> facets;
  for (unsigned chosen = 0; chosen < 1u << table.corner_count; ++chosen) {
    if (std::popcount(chosen) != N) continue;
    const auto first = static_cast<unsigned>(std::countr_zero(chosen));
    Eigen::Matrix<double, N - 1, N> across;
    int row = 0;
    for (unsigned rest = chosen & (chosen - 1); rest != 0; rest &= rest - 1)
      across.row(row++) = corner(static_cast<unsigned>(std::countr_zero(rest))) - corner(first);
    const Eigen::FullPivLU<Eigen::Matrix<double, N - 1, N>> lu(across);
    if (lu.rank() < N - 1) continue;
    const Vector normal = lu.kernel().col(0).normalized();
    tile::Signature on = 0;
    bool above = false, below = false;
    for (unsigned v = 0; v < table.corner_count; ++v) {
      const double height = normal.dot(corner(v) - corner(first));
      if (std::abs(height) < 1e-9) on |= tile::Signature{1} << v;
      above = above || height > 1e-9;
      below = below || height < -1e-9;
    }
    if (!(above && below)) facets.insert(on);
  }
  return {facets.begin(), facets.end()};
}

/// The contour of a cell: simplices by any numbers of their vertices, and for each number the edge (as a set of two
/// corners) that the vertex is on, or 0.
template <int N>
struct CellPieces {
  std::vector<std::array<std::size_t, N>> simplices = {};
  std::map<std::size_t, tile::Signature> edge_of = {};

  /// The simplices by the edges of their vertices, ascending; the last number is 1 for an odd order of the vertices, if
  /// all are on edges. `flip`: 1 for the other orientation.
  [[nodiscard]] std::multiset<std::array<tile::Signature, N + 1>> by_edges(unsigned flip) const {
    std::multiset<std::array<tile::Signature, N + 1>> result;
    for (const auto& simplex : simplices) {
      std::array<tile::Signature, N + 1> edges{};
      unsigned inversions = flip;
      for (int i = 0; i < N; ++i) {
        edges[i] = edge_of.at(simplex[i]);
        for (int j = 0; j < i; ++j) inversions += edges[j] > edges[i] ? 1 : 0;
      }
      std::sort(edges.begin(), edges.end() - 1);
      edges[N] = edges[0] == 0 ? 0 : inversions % 2;
      result.insert(edges);
    }
    return result;
  }
  /// The boundary's simplices by the edges of their vertices, ascending, and the Euler characteristic.
  [[nodiscard]] std::pair<std::multiset<std::vector<tile::Signature>>, int> boundary_and_euler() const {
    std::map<std::vector<std::size_t>, int> faces;
    for (const auto& simplex : simplices)
      for (unsigned subset = 1; subset < 1u << N; ++subset) {
        std::vector<std::size_t> face;
        for (unsigned i = 0; i < N; ++i)
          if ((subset >> i & 1u) != 0) face.push_back(simplex[i]);
        std::sort(face.begin(), face.end());
        ++faces[face];
      }
    std::pair<std::multiset<std::vector<tile::Signature>>, int> result;
    for (const auto& [face, times] : faces) {
      result.second += face.size() % 2 == 1 ? 1 : -1;
      if (face.size() != N - 1 || times != 1) continue;
      std::vector<tile::Signature> edges;
      for (const std::size_t v : face) edges.push_back(edge_of.at(v));
      std::sort(edges.begin(), edges.end());
      result.first.insert(edges);
    }
    return result;
  }
};

/// The contour of a cell by the general engine.
template <int N>
CellPieces<N> pieces_of(const tile::TileFacets& built, const std::vector<tile::Face>& faces) {
  CellPieces<N> pieces;
  for (std::size_t v = 0; v < built.vertices.size(); ++v)
    pieces.edge_of[v] = built.vertices[v].kind == tile::VertexKind::edge ? faces[built.vertices[v].face].corners : 0;
  for (const tile::Facet& facet : built.facets)
    for (const auto& simplex : facet.simplices) {
      pieces.simplices.emplace_back();
      std::copy_n(simplex.begin(), N, pieces.simplices.back().begin());
    }
  return pieces;
}

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
std::vector<CellPieces<N>> pieces_of(const Contour<N, double>& contour, const tables::CellTable& table,
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
    const auto of_cell = pieces_of<N>(extract<double>(cells.complex, 0.0, options), table, faces, count);
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

/// Euler characteristic and number of connected components.
template <int N>
std::pair<int, std::size_t> topology_of(const CellPieces<N>& pieces) {
  std::map<std::size_t, std::size_t> parent;
  const auto root = [&](std::size_t v) {
    while (parent.at(v) != v) v = parent.at(v);
    return v;
  };
  for (const auto& simplex : pieces.simplices)
    for (const std::size_t v : simplex) {
      parent.try_emplace(v, v);
      parent[root(v)] = root(simplex[0]);
    }
  const auto is_root = [](const auto& each) { return each.first == each.second; };
  std::set<std::vector<std::size_t>> faces;
  for (const auto& simplex : pieces.simplices)
    for (unsigned subset = 1; subset < 1u << N; ++subset) {
      std::vector<std::size_t> face;
      for (unsigned i = 0; i < N; ++i)
        if ((subset >> i & 1u) != 0) face.push_back(simplex[i]);
      std::sort(face.begin(), face.end());
      faces.insert(std::move(face));
    }
  int euler = 0;
  for (const auto& face : faces) euler += face.size() % 2 == 1 ? 1 : -1;
  return {euler, static_cast<std::size_t>(std::count_if(parent.begin(), parent.end(), is_root))};
}

/// The resolution of a cell by `squares` or `decider`: ambiguous quadrilaterals by the mean of their corners or by the
/// value at their saddle, larger faces separate.
std::vector<tile::Choice> choices_of(const std::vector<tile::Face>& faces, const std::vector<double>& values,
                                     Ambiguity rule) {
  std::vector<tile::Choice> choices(faces.size(), tile::Choice::separate);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].dim != 2 || std::popcount(faces[f].corners) != 4) continue;
    double sum = 0, high = 1, low = 1;
    tile::Signature above = 0;
    for (std::size_t v = 0; v < values.size(); ++v) {
      if ((faces[f].corners >> v & 1u) == 0) continue;
      sum += values[v];
      (values[v] >= 0 ? high : low) *= values[v];
      if (values[v] >= 0) above |= tile::Signature{1} << v;
    }
    const bool is_edge =
        std::any_of(faces.begin(), faces.end(), [&](const auto& e) { return e.dim == 1 && e.corners == above; });
    if (std::popcount(above) != 2 || is_edge) continue;
    const bool is_high = rule == Ambiguity::squares ? sum >= 0 : high >= low;
    choices[f] = is_high ? tile::Choice::high : tile::Choice::low;
  }
  return choices;
}

/// Compact contours and those by rules from the data have other simplices than the engine's, and the same topology.
template <int N>
void expect_topology_of_the_engine(CellType type, std::size_t count, std::uint64_t seed) {
  const detail::CellKind& kind = *detail::find_kind(type);
  const tables::CellTable& table = detail::table_of(kind.shape);
  RandomCells<N> cells(kind, count, seed);
  // distances from the isovalue of their own, by point; the signs stay
  std::mt19937_64 random(seed);
  std::vector<double> values(cells.complex.values().begin(), cells.complex.values().end());
  for (double& value : values) value *= 0.05 + 0.95 * static_cast<double>(random() >> 11) * 0x1p-53;
  cells.complex.set_values(values);
  std::vector<std::vector<double>> of_cell(count);
  const detail::CellGroups& groups = detail::ComplexAccess::cells(cells.complex);
  ASSERT_EQ(1u, groups.groups.size());
  for (std::size_t c = 0; c < count; ++c)
    for (std::size_t v = 0; v < table.corner_count; ++v) of_cell[c].push_back(values[groups.groups[0].cell(c)[v]]);
  tile::FacetBuilder engine(tile::FaceLattice(N, hull_facets<N>(table)));
  const std::vector<tile::Face>& faces = engine.lattice().faces();
  for (const Ambiguity rule : {Ambiguity::low, Ambiguity::high, Ambiguity::squares, Ambiguity::decider})
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
      SCOPED_TRACE(testing::Message() << name_of(type) << " " << static_cast<int>(rule) << " "
                                      << static_cast<int>(triangulation));
      ExtractOptions options;
      options.triangulation = triangulation;
      options.ambiguity = rule;
      const auto contour = extract<double>(cells.complex, 0.0, options);
      std::vector<CellPieces<N>> pieces(count);
      for (const auto& simplex : contour.simplices) {
        const double x = contour.vertices[simplex[0]][0];
        auto& of = pieces[static_cast<std::size_t>((x + 2) / RandomCells<N>::kApart)].simplices.emplace_back();
        std::copy(simplex.begin(), simplex.end(), of.begin());
      }
      for (std::size_t c = 0; c < count; ++c) {
        const bool is_fixed = rule == Ambiguity::low || rule == Ambiguity::high;
        const auto choices = is_fixed ? std::vector<tile::Choice>() : choices_of(faces, of_cell[c], rule);
        const auto alternative = rule == Ambiguity::high ? tile::Alternative::high : tile::Alternative::low;
        const auto& built = engine.build(cells.signatures[c], {.choices = choices, .alternative = alternative});
        EXPECT_EQ(topology_of(pieces_of<N>(built, faces)), topology_of(pieces[c]))
            << "signature " << cells.signatures[c] << ", cell " << c;
      }
    }
}

TEST(EngineCells, CompactContoursAndRulesForQuadrilateralsHaveTheTopologyOfTheGeneralEngine) {
  for (const CellType type : {CellType::pixel, CellType::quadrilateral}) expect_topology_of_the_engine<2>(type, 100, 3);
  for (const CellType type : {CellType::tetrahedron, CellType::wedge, CellType::pyramid, CellType::hexahedron})
    expect_topology_of_the_engine<3>(type, 200, 4);
  for (const CellType type : {CellType::simplex4, CellType::tetrahedron_prism, CellType::pyramid_prism,
                              CellType::wedge_prism, CellType::cell16, CellType::octahedron_prism})
    expect_topology_of_the_engine<4>(type, 100, 5);
}

/// A simplex of a complex by the edges that its vertices are on, ascending; 0 for other vertices.
template <int N>
using EdgesOfSimplex = std::array<std::uint64_t, N>;

std::uint64_t edge_number(Index p, Index q) { return (std::uint64_t{std::min(p, q)} << 32 | std::max(p, q)) + 1; }

/// The simplices of all cells by the engine, but of those in which a side is copied, which depends on the corners'
/// numbers. `copied`: number of these cells.
template <int N>
std::vector<EdgesOfSimplex<N>> simplices_by_the_engine(const Complex<N>& complex, Ambiguity rule, std::size_t& copied) {
  const auto alternative = rule == Ambiguity::low ? tile::Alternative::low : tile::Alternative::high;
  std::vector<EdgesOfSimplex<N>> simplices;
  for (const detail::CellGroup& group : detail::ComplexAccess::cells(complex).groups) {
    const tables::CellTable& table = detail::table_of(group.shape);
    tile::FacetBuilder engine(tile::FaceLattice(N, hull_facets<N>(table)));
    std::map<tile::Signature, std::pair<bool, CellPieces<N>>> known;
    for (std::size_t c = 0; c < group.size(); ++c) {
      tile::Signature signature = 0;
      for (unsigned v = 0; v < table.corner_count; ++v)
        if (complex.values()[group.cell(c)[v]] >= 0) signature |= tile::Signature{1} << v;
      const auto [at, is_new] = known.try_emplace(signature);
      auto& [is_copied, pieces] = at->second;
      if (is_new) {
        const tile::TileFacets& built = engine.build(signature, {.choices = {}, .alternative = alternative});
        is_copied = std::any_of(built.facets.begin(), built.facets.end(),
                                [](const tile::Facet& facet) { return facet.filling == tile::Filling::side; });
        pieces = pieces_of<N>(built, engine.lattice().faces());
      }
      copied += is_copied ? 1 : 0;
      if (is_copied) continue;
      for (const auto& simplex : pieces.simplices) {
        EdgesOfSimplex<N>& edges = simplices.emplace_back();
        for (int i = 0; i < N; ++i) {
          const tile::Signature ends = pieces.edge_of.at(simplex[i]);
          if (ends == 0) continue;
          const auto p = static_cast<unsigned>(std::countr_zero(ends));
          const auto q = static_cast<unsigned>(std::countr_zero(ends & (ends - 1)));
          edges[i] = edge_number(group.cell(c)[p], group.cell(c)[q]);
        }
        std::sort(edges.begin(), edges.end());
      }
    }
  }
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

/// The simplices of a contour whose vertices on edges are midpoints.
template <int N>
std::vector<EdgesOfSimplex<N>> simplices_of(const Contour<N, double>& contour, const Complex<N>& complex) {
  std::map<std::array<double, N>, std::uint64_t> edge_at;
  for (const detail::CellGroup& group : detail::ComplexAccess::cells(complex).groups) {
    const tables::CellTable& table = detail::table_of(group.shape);
    for (std::size_t c = 0; c < group.size(); ++c)
      for (unsigned e = 0; e < table.edge_count; ++e) {
        const Index p = group.cell(c)[table.edges[2 * e]], q = group.cell(c)[table.edges[2 * e + 1]];
        if ((complex.values()[p] >= 0) == (complex.values()[q] >= 0)) continue;
        std::array<double, N> middle;
        for (std::size_t a = 0; a < N; ++a) middle[a] = (complex.points()[p][a] + complex.points()[q][a]) / 2;
        edge_at[middle] = edge_number(p, q);
      }
  }
  std::vector<EdgesOfSimplex<N>> simplices;
  for (const auto& simplex : contour.simplices) {
    EdgesOfSimplex<N>& edges = simplices.emplace_back();
    for (int i = 0; i < N; ++i)
      if (const auto at = edge_at.find(contour.vertices[simplex[i]]); at != edge_at.end()) edges[i] = at->second;
    std::sort(edges.begin(), edges.end());
  }
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

/// `complex` has values; their signs about 0.5 are used, as 1 and -1. Its coordinates are rounded to 2^-20.
template <int N>
void expect_simplices_of_the_engine(Complex<N> complex, const char* name) {
  std::vector<double> values;
  for (const double value : complex.values()) values.push_back(value >= 0.5 ? 1.0 : -1.0);
  complex.set_values(values);
  for (const Ambiguity rule : kFixed) {
    SCOPED_TRACE(testing::Message() << name << ", " << N << "D, rule " << static_cast<int>(rule));
    ExtractOptions options;
    options.triangulation = Triangulation::barycentric;
    options.ambiguity = rule;
    const auto contour = extract<double>(complex, 0.0, options);
    expect_closed_manifold(contour);
    const auto found = simplices_of<N>(contour, complex);
    std::size_t copied = 0;
    const auto expected = simplices_by_the_engine<N>(complex, rule, copied);
    EXPECT_GT(4 * expected.size(), complex.cell_count());
    EXPECT_LT(20 * copied, complex.cell_count());
    EXPECT_TRUE(copied == 0 ? expected == found
                            : std::includes(found.begin(), found.end(), expected.begin(), expected.end()))
        << expected.size() << " simplices by the engine, " << found.size() << " in the contour, " << copied
        << " cells with copies";
  }
}

template <int N>
void round_points(std::vector<std::array<double, N>>& points) {
  for (auto& point : points)
    for (double& x : point) x = std::round(x * 0x1p20) * 0x1p-20;
}

/// Meshes of split cubes, of about `samples`^3 points, and these over time.
void expect_split_cubes_of_the_engine(std::size_t samples, std::size_t samples_over_time) {
  const auto at = [](std::size_t n) { return grid_points<3>({n, n, n}, 0.15); };
  const auto meshes = [&](std::size_t n) {
    return std::vector<MeshData<3>>{mixed_mesh(at(n), 7), wedge_mesh(at(n)), pyramid_mesh(at(n)), kuhn_mesh(at(n))};
  };
  for (MeshData<3>& mesh : meshes(samples)) {
    round_points<3>(mesh.points);
    Complex<3> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 3));
    expect_simplices_of_the_engine<3>(std::move(complex), "split cubes");
  }
  for (MeshData<3>& mesh : meshes(samples_over_time)) {
    const std::vector<double> times = {0.0, 0.75, 1.0, 2.5};
    std::vector<double> values;
    std::vector<std::array<double, 3>> moving;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const auto of_step = closed_noise(mesh, 5 + k);
      for (const double value : of_step) values.push_back(k == 0 || k + 1 == times.size() ? 0.0 : value);
      for (auto point : mesh.points) {
        point[0] += 0.25 * static_cast<double>(k) * point[1];
        moving.push_back(point);
      }
    }
    round_points<3>(moving);
    expect_simplices_of_the_engine<4>(in_time<3>(mesh.complex(), times, values, moving), "split cubes that move");
  }
}

/// Noise on random points in a box, or on those of a grid, low at the sides.
template <int N>
void expect_delaunay_of_the_engine(std::size_t random_points, std::size_t grid_size) {
  std::mt19937_64 random(21);
  const auto uniform = [&] { return 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0; };
  for (const bool is_grid : {false, true}) {
    std::vector<std::array<double, N>> points;
    if (is_grid) {
      std::array<std::size_t, N> sizes;
      sizes.fill(grid_size);
      points = grid_points<N>(sizes).points;
    } else {
      points.resize(random_points);
      for (auto& point : points)
        for (double& x : point) x = uniform();
    }
    round_points<N>(points);
    std::vector<double> values;
    for (const auto& point : points) {
      const bool is_inside = std::all_of(point.begin(), point.end(), [](double x) { return std::abs(x) < 0.7; });
      values.push_back(is_inside ? 0.5 + 0.5 * uniform() : 0.0);
    }
    Complex<N> complex = delaunay<N>(points);
    complex.set_values(values);
    expect_simplices_of_the_engine<N>(std::move(complex), is_grid ? "Delaunay, grid" : "Delaunay, random");
  }
}

TEST(EngineCells, MeshesOfSplitCubesHaveTheSimplicesOfTheGeneralEngine) { expect_split_cubes_of_the_engine(9, 5); }

TEST(EngineCells, DelaunayMeshesHaveTheSimplicesOfTheGeneralEngine) {
  if (!has_delaunay()) GTEST_SKIP() << "no Qhull";
  expect_delaunay_of_the_engine<2>(1000, 30);
  expect_delaunay_of_the_engine<3>(700, 9);
  expect_delaunay_of_the_engine<4>(300, 5);
}

// Minutes; run by the test long_complex.
TEST(EngineCells, DISABLED_MeshesOfAHundredThousandCells) {
  expect_split_cubes_of_the_engine(48, 33);
  if (!has_delaunay()) return;
  expect_delaunay_of_the_engine<2>(51000, 226);
  expect_delaunay_of_the_engine<3>(16000, 28);
  expect_delaunay_of_the_engine<4>(5000, 10);
}

}  // namespace
}  // namespace tegl
