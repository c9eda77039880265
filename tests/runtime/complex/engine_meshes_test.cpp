// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of whole complexes, and those of the general engine, which builds each cell from its faces alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "complex/engine_cells.hpp"
#include "invariants.hpp"
#include "meshes.hpp"
#include "tegl/complex.hpp"
#include "tegl/delaunay.hpp"
#include "tegl/extract.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl {
namespace {

using namespace test;

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
  for (const Ambiguity rule : {Ambiguity::low, Ambiguity::high}) {
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

/// Euler characteristic and number of components of the contour of a whole complex, from the engine's contours of its
/// cells: the open cells, facets, faces and edges of the complex contribute one by one. Points at its border are low.
template <int N>
class TopologyByTheEngine {
 public:
  TopologyByTheEngine(const Complex<N>& complex, Ambiguity rule) : values_(complex.values()), rule_(rule) {
    for (const detail::CellGroup& group : detail::ComplexAccess::cells(complex).groups) add_cells(group);
    std::sort(polygons_.begin(), polygons_.end());
    polygons_.erase(std::unique(polygons_.begin(), polygons_.end()), polygons_.end());
    for (const auto& polygon : polygons_) euler_ -= polygon.back() / 2;  // segments between its crossed edges
    EXPECT_EQ(0, facets_ % 2) << "each facet is in two cells";
    euler_ += static_cast<std::ptrdiff_t>(parent_.size()) + facets_ / 2;
    for (const auto& [edge, parent] : parent_) components_ += edge == parent ? 1 : 0;
  }
  [[nodiscard]] std::ptrdiff_t euler() const { return euler_; }
  [[nodiscard]] std::size_t components() const { return components_; }

 private:
  void add_cells(const detail::CellGroup& group) {
    const tables::CellTable& table = detail::table_of(group.shape);
    tile::FacetBuilder engine(tile::FaceLattice(N, hull_facets<N>(table)));
    const std::vector<tile::Face>& faces = engine.lattice().faces();
    std::vector<double> values(table.corner_count);
    std::vector<tile::Choice> choices;
    for (std::size_t c = 0; c < group.size(); ++c) {
      const Index* const corners = group.cell(c);
      tile::Signature signature = 0;
      for (unsigned v = 0; v < table.corner_count; ++v) {
        values[v] = values_[corners[v]];
        if (values[v] >= 0) signature |= tile::Signature{1} << v;
      }
      if (signature == 0 || signature + 1 == tile::Signature{1} << table.corner_count) continue;
      const auto& built = engine.build(signature, resolution_of<N>(table, faces, values, rule_, choices));
      const CellPieces<N> pieces = pieces_of<N>(built, faces);
      euler_ += topology_of(pieces).first - std::accumulate(built.sigma_euler.begin(), built.sigma_euler.end(), 0);
      if (N == 4)
        for (const tile::Simplices& of_facet : built.in_face) facets_ += euler_of(of_facet);
      add_polygons(faces, signature, corners);
      join(pieces, corners);
    }
  }

  static int euler_of(const tile::Simplices& triangles) {
    CellPieces<3> pieces;
    for (const auto& triangle : triangles) {
      auto& to = pieces.simplices.emplace_back();
      std::copy_n(triangle.begin(), 3, to.begin());
    }
    return topology_of(pieces).first;
  }

  void add_polygons(const std::vector<tile::Face>& faces, tile::Signature signature, const Index* corners) {
    for (const tile::Face& face : faces) {
      if (face.dim != 2 || (face.corners & signature) == 0 || (face.corners & ~signature) == 0) continue;
      auto& polygon = polygons_.emplace_back();  // its points, and the number of its crossed edges
      polygon.fill(0);
      std::size_t count = 0;
      for (tile::Signature rest = face.corners; rest != 0; rest &= rest - 1)
        polygon[count++] = corners[std::countr_zero(rest)] + 1;
      std::sort(polygon.begin(), polygon.end() - 1);
      for (const tile::Face& edge : faces)
        if (edge.dim == 1 && (edge.corners & ~face.corners) == 0 && std::popcount(edge.corners & signature) == 1)
          ++polygon.back();
    }
  }

  /// Joins the crossed edges of each component in a cell; each component has some.
  void join(const CellPieces<N>& pieces, const Index* corners) {
    std::map<std::size_t, std::size_t> of_cell;  // a vertex of the same component
    const auto local_root = [&](std::size_t v) {
      while (of_cell.at(v) != v) v = of_cell.at(v);
      return v;
    };
    for (const auto& simplex : pieces.simplices)
      for (const std::size_t v : simplex) {
        of_cell.try_emplace(v, v);
        of_cell[local_root(v)] = local_root(simplex[0]);
      }
    std::map<std::size_t, std::uint64_t> edge_of_component;
    for (const auto& [v, parent] : of_cell) {
      const tile::Signature ends = pieces.edge_of.at(v);
      if (ends == 0) continue;
      const std::uint64_t edge =
          edge_number(corners[std::countr_zero(ends)], corners[std::countr_zero(ends & (ends - 1))]);
      parent_.try_emplace(edge, edge);
      parent_[root(edge)] = root(edge_of_component.try_emplace(local_root(v), edge).first->second);
    }
  }
  std::uint64_t root(std::uint64_t edge) {
    while (parent_.at(edge) != edge) edge = parent_[edge] = parent_.at(parent_.at(edge));
    return edge;
  }

  std::span<const double> values_;
  Ambiguity rule_;
  std::ptrdiff_t euler_ = 0, facets_ = 0;
  std::size_t components_ = 0;
  std::vector<std::array<Index, 5>> polygons_;
  std::unordered_map<std::uint64_t, std::uint64_t> parent_;  ///< by crossed edge: one of the same component
};

/// The contour by rules that join the insides of cubes. Its values are those of `complex` minus 0.5.
template <int N>
void expect_joined_as_by_the_engine(Complex<N> complex, const char* name) {
  std::vector<double> values(complex.values().begin(), complex.values().end());
  for (double& value : values) value -= 0.5;
  complex.set_values(values);
  for (const Ambiguity rule : {Ambiguity::mean, Ambiguity::saddle}) {
    const TopologyByTheEngine<N> expected(complex, rule);
    if (N == 3) {  // in 4D all closed contours have Euler characteristic 0
      const TopologyByTheEngine<N> apart(complex, rule == Ambiguity::mean ? Ambiguity::squares : Ambiguity::decider);
      EXPECT_NE(expected.euler(), apart.euler()) << name;
    }
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
      SCOPED_TRACE(testing::Message() << name << ", " << N << "D, rule " << static_cast<int>(rule) << ", triangulation "
                                      << static_cast<int>(triangulation));
      ExtractOptions options;
      options.triangulation = triangulation;
      options.ambiguity = rule;
      const MeshReport report = expect_closed_manifold(extract(complex, 0.0, options));
      EXPECT_EQ(expected.euler(), report.euler);
      EXPECT_EQ(expected.components(), report.components);
    }
  }
}

/// Noise on a mesh at four times, low at the first and the last one, with points that move.
Complex<4> moving_noise(const MeshData<3>& mesh) {
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
  return in_time<3>(mesh.complex(), times, values, moving);
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
  for (const MeshData<3>& mesh : meshes(samples_over_time))
    expect_simplices_of_the_engine<4>(moving_noise(mesh), "split cubes that move");
}

/// Meshes with cubes as cells, and over time also as facets.
void expect_cubes_joined_as_by_the_engine(std::size_t samples, std::size_t samples_over_time) {
  const auto at = [](std::size_t n) { return grid_points<3>({n, n, n}, 0.15); };
  for (const MeshData<3>& mesh : {cube_mesh(at(samples)), cube_mesh(at(samples), true), mixed_mesh(at(samples), 7)}) {
    Complex<3> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 3));
    expect_joined_as_by_the_engine<3>(std::move(complex), "cubes");
  }
  const std::size_t n = samples_over_time;
  for (const MeshData<3>& mesh : {cube_mesh(at(n), true), mixed_mesh(at(n), 7), wedge_mesh(at(n)), pyramid_mesh(at(n))})
    expect_joined_as_by_the_engine<4>(moving_noise(mesh), "cubes that move");
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

TEST(EngineCells, CubesInMeshesAreJoinedAsByTheGeneralEngine) { expect_cubes_joined_as_by_the_engine(16, 5); }

TEST(EngineCells, DelaunayMeshesHaveTheSimplicesOfTheGeneralEngine) {
  if (!has_delaunay()) GTEST_SKIP() << "no Qhull";
  expect_delaunay_of_the_engine<2>(1000, 30);
  expect_delaunay_of_the_engine<3>(700, 9);
  expect_delaunay_of_the_engine<4>(300, 5);
}

// Minutes; run by the test long_complex.
TEST(EngineCells, DISABLED_CubesInMeshesOfAHundredThousandCells) { expect_cubes_joined_as_by_the_engine(48, 33); }

TEST(EngineCells, MeshesOfAHundredThousandCells) {
  expect_split_cubes_of_the_engine(48, 33);
  if (!has_delaunay()) return;
  expect_delaunay_of_the_engine<2>(51000, 226);
  expect_delaunay_of_the_engine<3>(16000, 28);
  expect_delaunay_of_the_engine<4>(5000, 10);
}

}  // namespace
}  // namespace tegl
