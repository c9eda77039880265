// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of 4D cells that are built: compact ones, whose facets have diagonals that depend on the numbers of points,
// and barycentric ones with quadrilaterals decided from the data.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "compare.hpp"
#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "invariants.hpp"
#include "meshes.hpp"
#include "tegl/check.hpp"
#include "tegl/complex.hpp"
#include "tegl/extract.hpp"
#include "tegl/intersections.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using namespace test;

ExtractOptions compact_by(Ambiguity ambiguity, bool close = false) {
  ExtractOptions options;
  options.triangulation = Triangulation::compact;
  options.ambiguity = ambiguity;
  options.close = close;
  return options;
}

constexpr Ambiguity kBoth[] = {Ambiguity::low, Ambiguity::high};

/// The same mesh with its points in another order.
template <int N>
MeshData<N> renumbered(MeshData<N> mesh, std::vector<double>& values, std::uint64_t seed) {
  std::vector<Index> number(mesh.points.size());
  std::iota(number.begin(), number.end(), Index{0});
  std::shuffle(number.begin(), number.end(), std::mt19937_64(seed));
  auto points = mesh.points;
  auto moved = values;
  for (std::size_t p = 0; p < number.size(); ++p) {
    mesh.points[number[p]] = points[p];
    values[number[p]] = moved[p];
  }
  for (Index& corner : mesh.corners) corner = number[corner];
  return mesh;
}

/// Cells that do not touch, one for each `step`-th signature, with their corners numbered at random.
Complex<4> cells_by_signature(CellType type, unsigned step, std::uint64_t seed) {
  const detail::CellKind& kind = *detail::find_kind(type);
  const tables::CellTable& table = detail::table_of(kind.shape);
  const std::size_t corners = table.corner_count;
  std::mt19937_64 random(seed);
  std::vector<std::array<double, 4>> points;
  std::vector<double> values;
  std::vector<Index> cells;
  for (unsigned signature = 0; signature < 1u << corners; signature += step) {
    const std::vector<Index> number = add_corners<4>(kind, random, points, cells);
    values.resize(points.size());
    for (std::size_t i = 0; i < corners; ++i) {
      const std::size_t v = detail::table_corner(kind, i);
      points[number[v]][0] += 3.0 * (signature % 256);
      points[number[v]][1] += 3.0 * (signature / 256);
      const double size = 0.05 + 0.9 * static_cast<double>(random() >> 11) * 0x1p-53;
      values[number[v]] = (signature >> v & 1u) != 0 ? size : -size;
    }
  }
  Complex<4> complex(points, type, cells);
  complex.set_values(values);
  return complex;
}

/// The certificate of every signature: closed by caps, the contour is an oriented manifold with the topology of the
/// barycentric one.
TEST(Compact4d, EverySignatureOfEveryShapeHasAManifoldWithTheTopologyOfTheBarycentricOne) {
  const std::pair<CellType, unsigned> shapes[] = {{CellType::simplex4, 1},         {CellType::tetrahedron_prism, 1},
                                                  {CellType::pyramid_prism, 1},    {CellType::wedge_prism, 5},
                                                  {CellType::octahedron_prism, 7}, {CellType::cell16, 1},
                                                  {CellType::voxel_prism, 29},     {CellType::hexahedron_prism, 31}};
  for (const auto& [type, step] : shapes) {
    Complex<4> complex = cells_by_signature(type, step, 5);
    for (const Ambiguity a : kBoth) {
      SCOPED_TRACE(testing::Message() << name_of(type) << " " << static_cast<int>(a));
      ExtractOptions options = compact_by(a, true);
      const auto contour = extract<double>(complex, 0.0, options);
      const MeshReport report = expect_closed_manifold(contour);
      options.triangulation = Triangulation::barycentric;
      const auto barycentric = extract<double>(complex, 0.0, options);
      const MeshReport other = expect_closed_manifold(barycentric);
      EXPECT_EQ(other.euler, report.euler);
      EXPECT_EQ(other.components, report.components);
      EXPECT_LT(contour.simplices.size(), barycentric.simplices.size());
    }
  }
}

/// All shapes over time, and simplices.
std::vector<Complex<4>> noisy_complexes(std::size_t samples, std::uint64_t seed) {
  std::vector<Complex<4>> complexes;
  const auto points = grid_points<3>({samples, samples, samples}, 0.15);
  const std::vector<double> times = {0.0, 0.7, 1.0, 2.5};
  for (MeshData<3> mesh :
       {mixed_mesh(points, 7), kuhn_mesh(points), wedge_mesh(points), pyramid_mesh(points), cube_mesh(points, true)})
    for (const bool shuffled : {false, true}) {
      std::vector<double> values, of_step;
      MeshData<3> used = mesh;
      for (std::uint64_t k = 0; k < times.size(); ++k) {
        of_step = closed_noise(mesh, seed + k);
        if (k == 0 || k + 1 == times.size()) of_step.assign(of_step.size(), -1.0);
        if (shuffled) used = renumbered(mesh, of_step, seed);
        values.insert(values.end(), of_step.begin(), of_step.end());
      }
      complexes.push_back(in_time(used.complex(), times, values));
    }
  return complexes;
}

TEST(Compact4d, MovingMeshesOfAHundredThousandCells) {
  for (Complex<4>& complex : noisy_complexes(35, 7)) {
    EXPECT_GT(complex.cell_count(), 100000u);
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
      ExtractOptions options = compact_by(Ambiguity::low);
      options.triangulation = triangulation;
      expect_closed_manifold(extract(complex, 0.5, options));
    }
    ExtractOptions closed = compact_by(Ambiguity::high, true);
    expect_closed_manifold(extract(complex, -2.0 / 3.0, closed));
  }
}

TEST(Compact4d, NoiseOnMovingMeshesHasAClosedOrientedManifoldWhateverTheNumbersOfPoints) {
  for (Complex<4>& complex : noisy_complexes(8, 11)) {
    std::vector<std::size_t> sizes;
    for (const Ambiguity a : kBoth) {
      ExtractOptions options = compact_by(a);
      const auto contour = extract(complex, 0.5, options);
      EXPECT_GT(contour.simplices.size(), 3000u);
      expect_closed_manifold(contour);
      EXPECT_GT(measure(contour).content.value(), 0.0);
      EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, options));
      options.triangulation = Triangulation::barycentric;
      EXPECT_LT(2 * contour.simplices.size(), count(complex, 0.5, options).simplices);
    }
    ExtractOptions options = compact_by(Ambiguity::low);
    const auto before = extract(complex, 0.5, options);
    complex.find_edges();
    for (const unsigned threads : {1u, 3u}) {
      options.work.threads = threads;
      const auto after = extract(complex, 0.5, options);
      EXPECT_TRUE(before.vertices == after.vertices);
      EXPECT_TRUE(before.simplices == after.simplices);
    }
  }
}

/// Prisms given one by one have other diagonals at their ends than those of in_time, and are closed as well.
TEST(Compact4d, CellsInAnyOrderOfTheirCornersHaveAClosedContour) {
  for (MeshData<4> mesh :
       {kuhn_mesh(grid_points<4>({6, 6, 6, 6}, 0.1)), cube_mesh(grid_points<4>({6, 6, 6, 6}, 0.1))}) {
    std::vector<double> values = closed_noise(mesh, 3);
    mesh = renumbered(mesh, values, 4);
    Complex<4> complex = mesh.complex();
    complex.set_values(values);
    for (const Ambiguity a : kBoth) expect_closed_manifold(extract<double>(complex, 0.5, compact_by(a)));
  }
}

/// Moves vertices inside cells to those of another contour, which are where they are up to rounding.
void snap(const Contour<4>& to, Contour<4>& contour) {
  const auto theirs = sorted_vertices(to), ours = sorted_vertices(contour);
  std::vector<std::array<float, 4>> others;
  std::set_difference(theirs.begin(), theirs.end(), ours.begin(), ours.end(), std::back_inserter(others));
  EXPECT_LT(5 * others.size(), theirs.size());
  for (auto& vertex : contour.vertices) {
    if (std::binary_search(theirs.begin(), theirs.end(), vertex)) continue;
    for (const auto& other : others) {
      float distance = 0;
      for (std::size_t i = 0; i < 4; ++i) distance = std::max(distance, std::abs(other[i] - vertex[i]));
      if (distance > 1e-6f) continue;
      vertex = other;
      break;
    }
  }
}

TEST(Compact4d, AGridsOwnTesseractsHaveTheGridsContour) {
  const MeshData<4> mesh = cube_mesh(grid_points<4>({9, 5, 9, 5}), true);  // steps and places in cells are exact
  Complex<4> complex = mesh.complex();
  std::vector<double> values = closed_noise(mesh, 23);
  for (const bool rounded : {false, true}) {
    if (rounded)
      for (double& value : values) value = std::round(16 * value) / 16;  // some points have the isovalue
    complex.set_values(values);
    const OwnedImage<double, 4> image = image_of(mesh, values);
    for (const Ambiguity a : kBoth)
      for (const bool close : {false, true}) {
        ExtractOptions options = compact_by(a, close);
        options.direction = close ? GradientDirection::ascent : GradientDirection::descent;
        options.epsilon = rounded ? 0.1 : 0.0;
        const auto of_image = extract(image.view(), 0.5, options);
        auto of_mesh = extract(complex, 0.5, options);
        EXPECT_EQ(of_image.simplices.size(), of_mesh.simplices.size());
        snap(of_image, of_mesh);
        EXPECT_TRUE(same_surface(of_image, of_mesh)) << static_cast<int>(a) << rounded << close;
      }
  }
}

TEST(Compact4d, CutsAtStepsAreTheCompactContoursOfTheSteps) {
  const auto points = grid_points<3>({9, 9, 9}, 0.15);
  const std::vector<double> times = {0.0, 0.7, 1.0};
  for (const MeshData<3>& mesh : {mixed_mesh(points, 7), wedge_mesh(points), cube_mesh(points, true)}) {
    std::vector<double> all;
    for (std::uint64_t k = 0; k < times.size(); ++k)
      for (const double value : closed_noise(mesh, 30 + k)) all.push_back(value);
    Complex<3> step = mesh.complex();
    const Complex<4> swept = in_time(step, times, all);
    for (const Ambiguity a : kBoth) {
      const auto contour = extract(swept, 0.5, compact_by(a));
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(mesh.points.size());
      step.set_values(std::vector<double>(first, first + static_cast<std::ptrdiff_t>(mesh.points.size())));
      const auto expected = extract(step, 0.5, compact_by(a));
      EXPECT_GT(expected.simplices.size(), 300u);
      EXPECT_TRUE(same_surface(slice(contour, Hyperplane<4>::across(3, 0.7)), expected));
      expect_closed_manifold(slice(contour, Hyperplane<4>::across(3, 0.4)));
    }
  }
}

TEST(Compact4d, ContoursOfCellsWithFlatFacesDoNotIntersectThemselves) {
  const MeshData<3> points = grid_points<3>({5, 5, 5});
  const std::vector<double> times = {0.0, 0.5, 1.0, 2.0};
  for (const MeshData<3>& mesh : {kuhn_mesh(points), wedge_mesh(points), pyramid_mesh(points), cube_mesh(points)}) {
    std::vector<double> all;
    for (std::uint64_t k = 0; k < times.size(); ++k)
      for (const double value : closed_noise(mesh, 50 + k)) all.push_back(value);
    const Complex<4> swept = in_time(mesh.complex(), times, all);
    for (const Ambiguity a : kBoth) {
      const auto contour = extract<double>(swept, 0.5, compact_by(a));
      EXPECT_GT(contour.simplices.size(), 500u);
      EXPECT_EQ(0u, find_intersections(contour).pair_count);
    }
  }
}

/// Cells that do not touch, with random signatures. Half of them have uniform distances from the isovalue, half
/// log-uniform ones.
Complex<4> random_cells(CellType type, std::size_t count, std::uint64_t seed) {
  const detail::CellKind& kind = *detail::find_kind(type);
  std::mt19937_64 random(seed);
  std::vector<std::array<double, 4>> points;
  std::vector<double> values;
  std::vector<Index> cells;
  for (std::size_t c = 0; c < count; ++c) {
    const std::vector<Index> number = add_corners<4>(kind, random, points, cells);
    const bool is_uniform = random() % 2 == 0;
    for (const Index p : number) {
      points[p][0] += 4.0 * static_cast<double>(c % 64);
      points[p][1] += 4.0 * static_cast<double>(c / 64);
      const double u = static_cast<double>(random() >> 11) * 0x1p-53;
      const double size = is_uniform ? 0.001 + 0.999 * u : std::pow(10.0, -3.0 * u);
      values.push_back(random() % 2 == 0 ? size : -size);
    }
  }
  Complex<4> complex(points, type, cells);
  complex.set_values(values);
  return complex;
}

/// Prisms over octahedra with these signatures, one for each of 50 random orders of the corners.
Complex<4> octahedra_over_time(std::span<const unsigned> signatures) {
  const detail::CellKind& kind = *detail::find_kind(CellType::octahedron_prism);
  std::mt19937_64 random(8);
  std::vector<std::array<double, 4>> points;
  std::vector<double> values;
  std::vector<Index> cells;
  for (std::size_t c = 0; c < 50 * signatures.size(); ++c) {
    const std::vector<Index> number = add_corners<4>(kind, random, points, cells);
    values.resize(points.size());
    for (std::size_t v = 0; v < number.size(); ++v) {
      points[number[v]][0] += 4.0 * static_cast<double>(c % 50);
      points[number[v]][1] += 4.0 * static_cast<double>(c / 50);
      const double u = static_cast<double>(random() >> 11) * 0x1p-53;
      const double size = c % 2 == 0 ? 0.001 + 0.999 * u : std::pow(10.0, -3.0 * u);
      values[number[v]] = (signatures[c / 50] >> v & 1u) != 0 ? size : -size;
    }
  }
  Complex<4> complex(points, kind.type, cells);
  complex.set_values(values);
  return complex;
}

/// In these cells, vertex cones of two spheres intersect for some positions, or the side of a torus has more than ten
/// polygons.
TEST(Compact4d, OctahedraOverTimeDoNotIntersectThemselves) {
  const std::vector<unsigned> of_low = {370,  504,  628,  756,  882,  1260, 1323, 1827, 2567, 3213, 3591,
                                        3717, 499,  755,  892,  956,  979,  988,  995,  1004, 1231, 1807,
                                        2255, 2831, 3196, 3260, 3271, 3275, 3316, 3320, 3379, 3635, 3853,
                                        3854, 3889, 3890, 1011, 1020, 3279, 3324, 3855, 3891};
  std::vector<unsigned> of_high;
  for (const unsigned signature : of_low) of_high.push_back(~signature & 0xfffu);
  for (const Ambiguity rule : {Ambiguity::low, Ambiguity::high, Ambiguity::mean}) {
    SCOPED_TRACE(static_cast<int>(rule));
    const Complex<4> complex = octahedra_over_time(rule == Ambiguity::high ? of_high : of_low);
    ExtractOptions options = compact_by(rule);
    const auto contour = extract<double>(complex, 0.0, options);
    const auto found = find_intersections(contour);
    EXPECT_TRUE(found.is_embedded()) << found.pair_count << " pairs";
    const MeshReport report = check(contour);
    EXPECT_EQ(0u, report.nonmanifold_simplices + report.bad_links + report.orientation_conflicts);
    options.triangulation = Triangulation::barycentric;
    const MeshReport other = check(extract<double>(complex, 0.0, options));
    EXPECT_EQ(other.euler, report.euler);
    EXPECT_EQ(other.components, report.components);
  }
}

constexpr Ambiguity kFromData[] = {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider};
constexpr Triangulation kOfEach[] = {Triangulation::barycentric, Triangulation::compact};

ExtractOptions decided_by(Ambiguity rule, Triangulation triangulation = Triangulation::barycentric) {
  ExtractOptions options = compact_by(rule);
  options.triangulation = triangulation;
  return options;
}

TEST(Decided4d, NoiseOnMovingMeshesHasAClosedOrientedManifoldWhateverTheNumbersOfPoints) {
  std::vector<Complex<4>> complexes = noisy_complexes(6, 5);
  for (std::size_t i = 0; i < complexes.size(); ++i)
    for (const Ambiguity rule : kFromData) {
      std::vector<MeshReport> reports;
      for (const Triangulation triangulation : kOfEach) {
        SCOPED_TRACE(testing::Message() << "mesh " << i << " rule " << static_cast<int>(rule));
        ExtractOptions options = decided_by(rule, triangulation);
        const auto contour = extract(complexes[i], 0.5, options);
        EXPECT_GT(contour.simplices.size(), 1000u);
        reports.push_back(expect_closed_manifold(contour));
        EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complexes[i], 0.5, options));
        options.work.threads = 3;
        const auto by_threads = extract(complexes[i], 0.5, options);
        EXPECT_TRUE(contour.vertices == by_threads.vertices && contour.simplices == by_threads.simplices);
      }
      EXPECT_EQ(reports[0].euler, reports[1].euler);
      EXPECT_EQ(reports[0].components, reports[1].components);
    }
}

TEST(Decided4d, CellsInAnyOrderOfTheirCornersHaveAClosedContour) {
  MeshData<4> mesh = cube_mesh(grid_points<4>({5, 5, 5, 5}, 0.1));
  std::vector<double> values = closed_noise(mesh, 3);
  mesh = renumbered(mesh, values, 4);
  // another corner first in each cell: the order of a grid's cell, seen along other axes
  std::mt19937_64 random(6);
  for (std::size_t c = 0; c < mesh.corners.size(); c += 16) {
    std::array<unsigned, 4> axes = {0, 1, 2, 3};
    std::shuffle(axes.begin(), axes.end(), random);
    const auto flip = static_cast<unsigned>(random() % 16);
    std::array<Index, 16> turned;
    for (unsigned v = 0; v < 16; ++v) {
      unsigned from = flip;
      for (unsigned a = 0; a < 4; ++a) from ^= (v >> a & 1u) << axes[a];
      turned[v] = mesh.corners[c + from];
    }
    std::copy(turned.begin(), turned.end(), mesh.corners.begin() + static_cast<std::ptrdiff_t>(c));
  }
  Complex<4> complex = mesh.complex();
  complex.set_values(values);
  for (const Ambiguity rule : kFromData)
    for (const Triangulation triangulation : kOfEach) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(rule) << " " << static_cast<int>(triangulation));
      const auto contour = extract<double>(complex, 0.5, decided_by(rule, triangulation));
      EXPECT_GT(contour.simplices.size(), 1000u);
      expect_closed_manifold(contour);
    }
}

TEST(Decided4d, RandomCellsDoNotIntersectThemselves) {
  const std::tuple<CellType, Ambiguity, std::size_t> runs[] = {{CellType::hexahedron_prism, Ambiguity::mean, 2000},
                                                               {CellType::hexahedron_prism, Ambiguity::saddle, 3000},
                                                               {CellType::wedge_prism, Ambiguity::mean, 10000}};
  for (const auto& [type, rule, count] : runs) {
    const Complex<4> complex = random_cells(type, count, 17);
    for (const Triangulation triangulation : kOfEach) {
      SCOPED_TRACE(testing::Message() << name_of(type) << " " << static_cast<int>(rule));
      const auto found = find_intersections(extract<double>(complex, 0.0, decided_by(rule, triangulation)));
      EXPECT_TRUE(found.is_embedded()) << found.pair_count << " pairs";
      EXPECT_GT(found.simplices, 10 * count);
    }
  }
}

/// In some of these cells, spheres are beside the same region as a torus, whose filling passes them.
TEST(Decided4d, FillingsThatPassSpheresDoNotIntersectThem) {
  const Complex<4> complex = octahedra_over_time(std::array{253u, 819u, 3859u});
  for (const Ambiguity rule : kFromData) {
    std::vector<MeshReport> reports;
    for (const Triangulation triangulation : kOfEach) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(rule) << " " << static_cast<int>(triangulation));
      const auto contour = extract<double>(complex, 0.0, decided_by(rule, triangulation));
      const auto found = find_intersections(contour);
      EXPECT_TRUE(found.is_embedded()) << found.pair_count << " pairs";
      reports.push_back(check(contour));
      EXPECT_EQ(0u, reports.back().nonmanifold_simplices + reports.back().bad_links);
    }
    EXPECT_EQ(reports[0].components, reports[1].components);
    EXPECT_GT(reports[0].components, complex.cell_count());
  }
}

TEST(Decided4d, CellsWithTunnelsBetweenOppositeCornersDoNotIntersectThemselves) {
  for (const CellType type : {CellType::octahedron_prism, CellType::cell16}) {
    constexpr std::size_t kCount = 400;
    const detail::CellKind& kind = *detail::find_kind(type);
    const std::size_t all = detail::table_of(kind.shape).corner_count;
    const std::size_t of_cross = type == CellType::cell16 ? 8 : 6;  // an end of a prism
    Complex<4> complex = random_cells(type, kCount, 19);
    std::vector<double> values(complex.values().begin(), complex.values().end());
    const detail::CellGroup& group = detail::ComplexAccess::cells(complex).groups[0];
    std::mt19937_64 random(20);
    for (std::size_t c = 0; c < kCount; ++c) {
      const bool is_high = random() % 2 == 0, both_ends = random() % 2 == 0;
      for (std::size_t first = 0; first < all; first += of_cross) {
        if (first > 0 && !both_ends) continue;
        const std::size_t pair = 2 * (random() % (of_cross / 2));
        for (std::size_t v = 0; v < of_cross; ++v) {  // the pair has most of the sum
          double& value = values[group.cell(c)[first + v]];
          const bool is_lone = v == pair || v == pair + 1;
          value = (is_high == is_lone ? 1.0 : -1.0) * std::abs(value) * (is_lone ? 1.0 : 0.1);
          if (is_lone) value = std::copysign(std::max(std::abs(value), 0.5), value);
        }
      }
    }
    complex.set_values(values);
    for (const Triangulation triangulation : kOfEach) {
      SCOPED_TRACE(testing::Message() << name_of(type) << " " << static_cast<int>(triangulation));
      const auto contour = extract<double>(complex, 0.0, decided_by(Ambiguity::mean, triangulation));
      const auto apart = extract<double>(complex, 0.0, decided_by(Ambiguity::squares, triangulation));
      EXPECT_GT(contour.simplices.size(), apart.simplices.size());
      const MeshReport report = check(contour);
      EXPECT_EQ(0u, report.nonmanifold_simplices + report.bad_links + report.orientation_conflicts);
      const auto found = find_intersections(contour);
      EXPECT_TRUE(found.is_embedded()) << found.pair_count << " pairs";
    }
  }
}

/// Cells that share no facet have a contour with a boundary, which is a manifold if that of each cell is one.
TEST(Decided4d, CellsWithAnySignatureHaveAnOrientedManifold) {
  const std::pair<CellType, unsigned> shapes[] = {{CellType::pyramid_prism, 1},    {CellType::wedge_prism, 3},
                                                  {CellType::octahedron_prism, 7}, {CellType::cell16, 1},
                                                  {CellType::voxel_prism, 29},     {CellType::hexahedron_prism, 31}};
  for (const auto& [type, step] : shapes) {
    const Complex<4> complex = cells_by_signature(type, step, 5);
    for (const Ambiguity rule : kFromData)
      for (const Triangulation triangulation : kOfEach) {
        SCOPED_TRACE(testing::Message() << name_of(type) << " " << static_cast<int>(rule));
        const MeshReport report = check(extract<double>(complex, 0.0, decided_by(rule, triangulation)));
        EXPECT_EQ(0u, report.nonmanifold_simplices + report.bad_links + report.orientation_conflicts);
      }
  }
}

TEST(Decided4d, AGridsOwnTesseractsHaveTheGridsContour) {
  const MeshData<4> mesh = cube_mesh(grid_points<4>({9, 5, 5, 5}), true);
  Complex<4> complex = mesh.complex();
  const std::vector<double> values = closed_noise(mesh, 29);
  complex.set_values(values);
  const OwnedImage<double, 4> image = image_of(mesh, values);
  for (const Ambiguity rule : kFromData)
    for (const Triangulation triangulation : kOfEach) {
      SCOPED_TRACE(testing::Message() << "rule " << static_cast<int>(rule) << " " << static_cast<int>(triangulation));
      const auto of_image = extract(image.view(), 0.5, decided_by(rule, triangulation));
      auto of_mesh = extract(complex, 0.5, decided_by(rule, triangulation));
      EXPECT_GT(of_mesh.simplices.size(), 3500u);
      EXPECT_EQ(of_image.simplices.size(), of_mesh.simplices.size());
      EXPECT_EQ(of_image.vertices.size(), of_mesh.vertices.size());
      const MeshReport a = check(of_image), b = check(of_mesh);
      EXPECT_EQ(a.euler, b.euler);
      EXPECT_EQ(a.components, b.components);
      if (triangulation == Triangulation::barycentric) continue;  // images have weighted barycentres
      snap(of_image, of_mesh);
      EXPECT_TRUE(same_surface(of_image, of_mesh));
    }
}

TEST(Decided4d, CutsAtStepsAreTheContoursOfTheSteps) {
  const auto points = grid_points<3>({8, 8, 8}, 0.15);
  const std::vector<double> times = {0.0, 0.7, 1.0};
  for (const MeshData<3>& mesh :
       {mixed_mesh(points, 7), cube_mesh(points, true), wedge_mesh(points), kuhn_mesh(points)}) {
    std::vector<double> all;
    for (std::uint64_t k = 0; k < times.size(); ++k)
      for (const double value : closed_noise(mesh, 30 + k)) all.push_back(value);
    Complex<3> step = mesh.complex();
    const Complex<4> swept = in_time(step, times, all);
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(mesh.points.size());
    step.set_values(std::vector<double>(first, first + static_cast<std::ptrdiff_t>(mesh.points.size())));
    for (const Ambiguity rule : kFromData)
      for (const Triangulation triangulation : kOfEach) {
        SCOPED_TRACE(testing::Message() << "rule " << static_cast<int>(rule) << " " << static_cast<int>(triangulation));
        const ExtractOptions options = decided_by(rule, triangulation);
        const auto contour = extract(swept, 0.5, options);
        EXPECT_TRUE(same_surface(slice(contour, Hyperplane<4>::across(3, 0.7)), extract(step, 0.5, options)));
        expect_closed_manifold(slice(contour, Hyperplane<4>::across(3, 0.4)));
      }
  }
}

TEST(Decided4d, ClosedPartsOfBothSidesFillTheMesh) {
  const auto points = grid_points<3>({5, 5, 5}, 0.15);
  const MeshData<3> mesh = kuhn_mesh(points);  // over time without tori, whose filling depends on the side
  std::vector<double> all;
  std::mt19937_64 random(9);
  for (std::size_t i = 0; i < 3 * mesh.points.size(); ++i)
    all.push_back(static_cast<double>(random() >> 11) * 0x1p-53 - 0.4);
  Complex<4> swept = in_time(mesh.complex(), std::vector<double>{0.0, 0.5, 2.0}, all);
  double content = 0.0;
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> values = all;
    for (double& value : values) value *= sign;
    swept.set_values(values);
    ExtractOptions options = decided_by(Ambiguity::mean);
    options.close = true;
    const auto contour = extract<double>(swept, 0.0, options);
    expect_closed_manifold(contour);
    content += measure(contour).content.value();
  }
  EXPECT_NEAR(16.0, content, 1e-9);
}

}  // namespace
}  // namespace tegl
