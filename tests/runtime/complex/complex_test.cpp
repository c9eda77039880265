// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of complexes: topology on meshes of every type, accuracy, equality with grids, errors.
#include "tegl/complex.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compare.hpp"
#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "complex/complex_edges.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "meshes.hpp"
#include "tegl/intersections.hpp"
#include "tegl/measure.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr Triangulation kTriangulations[] = {Triangulation::barycentric, Triangulation::compact};

ExtractOptions options_of(Triangulation triangulation, Ambiguity ambiguity = Ambiguity::low, unsigned threads = 0) {
  ExtractOptions options;
  options.triangulation = triangulation;
  options.ambiguity = ambiguity;
  options.work.threads = threads;
  return options;
}

/// Meshes of every type and of mixed types, with moved points.
std::vector<std::pair<std::string, MeshData<3>>> meshes(std::size_t samples, double jitter = 0.15) {
  const MeshData<3> points = grid_points<3>({samples, samples, samples}, jitter);
  return {{"hexahedra", cube_mesh(points, true)},
          {"six tetrahedra", kuhn_mesh(points)},
          {"five tetrahedra", five_tetrahedra_mesh(points)},
          {"wedges", wedge_mesh(points)},
          {"pyramids", pyramid_mesh(points)},
          {"mixed", mixed_mesh(points, 5)}};
}

double ring(const std::array<double, 3>& x) {
  return 0.22 - std::hypot(std::hypot(x[0] + 0.011, x[1] - 0.013) - 0.55, x[2] + 0.017);
}

TEST(Complex, NoiseOnEveryMeshHasAClosedOrientedManifold) {
  for (const auto& [name, mesh] : meshes(21)) {
    Complex<3> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 11));
    for (const Triangulation t : kTriangulations)
      for (const Ambiguity a : {Ambiguity::low, Ambiguity::high}) {
        SCOPED_TRACE(name);
        const auto contour = extract(complex, 0.5, options_of(t, a));
        EXPECT_GT(contour.simplices.size(), 10000u);
        EXPECT_EQ(0u, expect_closed_manifold(contour).degenerate_simplices);
        EXPECT_GT(measure(contour).content.value(), 0.0);  // descends: high samples are inside
      }
  }
}

TEST(Complex, AMixedMeshOfAHundredThousandCellsHasAClosedOrientedManifold) {
  const MeshData<3> mesh = mixed_mesh(grid_points<3>({32, 32, 32}, 0.15), 3);
  Complex<3> complex = mesh.complex();
  EXPECT_GT(complex.cell_count(), 100000u);
  for (const CellType type : {CellType::tetrahedron, CellType::pyramid, CellType::wedge, CellType::hexahedron})
    EXPECT_GT(std::count(mesh.types.begin(), mesh.types.end(), type), 5000) << name_of(type);
  complex.set_values(closed_noise(mesh, 2));
  for (const Triangulation t : kTriangulations) expect_closed_manifold(extract(complex, 0.4, options_of(t)));
}

TEST(Complex, SpheresAndToriHaveTheirEulerCharacteristic) {
  for (const auto& [name, mesh] : meshes(24)) {
    SCOPED_TRACE(name);
    Complex<3> complex = mesh.complex();
    for (const Triangulation t : kTriangulations) {
      complex.set_values(values_of(mesh, test::ball<3>));
      const MeshReport sphere = expect_closed_manifold(extract(complex, 0.0, options_of(t)));
      EXPECT_EQ(1u, sphere.components);
      EXPECT_EQ(2, sphere.euler);
      complex.set_values(values_of(mesh, ring));
      const MeshReport torus = expect_closed_manifold(extract(complex, 0.0, options_of(t)));
      EXPECT_EQ(1u, torus.components);
      EXPECT_EQ(0, torus.euler);
    }
  }
}

/// Errors of area and volume of the contour of `field` in meshes of every type.
template <class Field>
std::vector<std::array<double, 2>> errors_of(std::size_t samples, const Field& field, double area, double volume) {
  std::vector<std::array<double, 2>> result;
  for (const auto& [name, mesh] : meshes(samples, 0.0)) {
    Complex<3> complex = mesh.complex();
    complex.set_values(values_of(mesh, field));
    const Measures<3> measures = measure(extract<double>(complex, 0.0));
    result.push_back({std::abs(measures.size - area), std::abs(measures.content.value() - volume)});
  }
  return result;
}

TEST(Complex, AreaAndVolumeConvergeWithOrderTwo) {
  constexpr double kPi = std::numbers::pi, kRing = 0.55, kTube = 0.22;
  const auto expect_order_two = [](const auto& coarse, const auto& fine, double refined) {
    for (std::size_t i = 0; i < coarse.size(); ++i)
      for (const std::size_t k : {0u, 1u})
        EXPECT_NEAR(2.0, std::log(coarse[i][k] / fine[i][k]) / std::log(refined), 0.35) << i << ", " << k;
  };
  const double area = 4 * kPi * 0.49, volume = 4.0 / 3.0 * kPi * 0.343;
  expect_order_two(errors_of(12, test::ball<3>, area, volume), errors_of(34, test::ball<3>, area, volume), 3.0);
  const double of_ring = 4 * kPi * kPi * kRing * kTube, in_ring = 2 * kPi * kPi * kRing * kTube * kTube;
  expect_order_two(errors_of(21, ring, of_ring, in_ring), errors_of(41, ring, of_ring, in_ring), 2.0);
}

template <int N>
void expect_contour_of_grid(const std::array<std::size_t, N>& sizes) {
  for (const bool around : {false, true}) {
    const MeshData<N> mesh = cube_mesh(grid_points<N>(sizes), around);
    Complex<N> complex = mesh.complex();
    std::vector<double> values = closed_noise(mesh, 23);
    for (double& value : values) value = std::round(16 * value) / 16;  // some points have the isovalue
    complex.set_values(values);
    const OwnedImage<double, N> image = image_of(mesh, values);
    for (const Ambiguity a : {Ambiguity::low, Ambiguity::high})
      for (const GradientDirection d : {GradientDirection::descent, GradientDirection::ascent}) {
        ExtractOptions options = options_of(Triangulation::compact, a);
        options.direction = d;
        options.epsilon = a == Ambiguity::high ? 0.1 : 0.0;
        EXPECT_TRUE(same_surface(extract(image.view(), 0.5, options), extract(complex, 0.5, options)));
      }
    const auto barycentric = options_of(Triangulation::barycentric);
    EXPECT_EQ(count(image.view(), 0.5, barycentric), count(complex, 0.5, barycentric));
  }
}

TEST(Complex, AGridsOwnCellsHaveTheGridsContour) {
  expect_contour_of_grid<2>({40, 31});
  expect_contour_of_grid<3>({17, 12, 14});
}

TEST(Complex, ResultsAreTheSameBytesWithAnyThreadsAndWithKnownEdges) {
  for (const auto& [name, mesh] : meshes(30)) {
    SCOPED_TRACE(name);
    Complex<3> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 4));
    for (const Triangulation t : kTriangulations) {
      const auto one = extract(complex, 0.5, options_of(t, Ambiguity::low, 1));
      Complex<3> known = complex;
      known.find_edges({3, {}});
      EXPECT_GT(known.edge_count(), 0u);
      EXPECT_EQ(0u, complex.edge_count());
      for (const unsigned threads : {1u, 2u, 3u})
        for (const Complex<3>* of : {&complex, &known}) {
          const auto other = extract(*of, 0.5, options_of(t, Ambiguity::low, threads));
          EXPECT_TRUE(one.vertices == other.vertices);
          EXPECT_TRUE(one.simplices == other.simplices);
        }
      EXPECT_EQ((ContourSize{one.vertices.size(), one.simplices.size()}), count(complex, 0.5, options_of(t)));
    }
  }
}

/// Cells without common points: no two have an edge in common, so that all crossed edges are distinct.
TEST(Complex, CellsWithoutCommonPointsHaveTheSameContourWithKnownEdges) {
  constexpr std::size_t kCells = 3000;
  std::vector<std::array<double, 3>> points;
  std::vector<Index> corners;
  std::vector<double> values;
  for (std::size_t c = 0; c < kCells; ++c)
    for (std::size_t v = 0; v < 4; ++v) {
      std::array<double, 3> point{static_cast<double>(2 * c), 0, 0};
      if (v > 0) point[v - 1] += 1;
      corners.push_back(static_cast<Index>(points.size()));
      points.push_back(point);
      values.push_back(v == c % 4 ? 1.0 : 0.0);
    }
  Complex<3> complex(std::move(points), CellType::tetrahedron, corners);
  complex.set_values(values);
  Complex<3> known = complex;
  known.find_edges();
  const auto one = extract(complex, 0.5), other = extract(known, 0.5);
  EXPECT_EQ(3 * kCells, one.vertices.size());
  EXPECT_TRUE(one.vertices == other.vertices);
  EXPECT_TRUE(one.simplices == other.simplices);
}

TEST(Complex, EdgesAreThoseOfAllCellsOnce) {
  for (const auto& [name, mesh] : meshes(8)) {
    Complex<3> complex = mesh.complex();
    complex.find_edges();
    std::vector<std::array<Index, 2>> edges;
    std::size_t at = 0;
    for (const CellType type : mesh.types) {
      const Index* const c = mesh.corners.data() + at;
      const auto add = [&](std::initializer_list<std::pair<int, int>> pairs) {
        for (const auto& [i, j] : pairs) edges.push_back({std::min(c[i], c[j]), std::max(c[i], c[j])});
      };
      if (type == CellType::tetrahedron) add({{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}});
      if (type == CellType::pyramid) add({{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}});
      if (type == CellType::wedge) add({{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}});
      if (type == CellType::hexahedron)
        add({{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}});
      at += corner_count(type);
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    EXPECT_EQ(edges.size(), complex.edge_count()) << name;
    EXPECT_TRUE(edges == detail::ComplexAccess::edges(complex)->ends) << name;
  }
}

TEST(Complex, TheOrderOfCornersDoesNotChangeTheSurface) {
  MeshData<3> mesh = kuhn_mesh(grid_points<3>({12, 12, 12}, 0.15));
  Complex<3> complex = mesh.complex();
  complex.set_values(closed_noise(mesh, 8));
  const auto contour = extract(complex, 0.5);
  std::mt19937_64 random(3);
  for (std::size_t c = 0; c < mesh.types.size(); ++c)
    std::shuffle(mesh.corners.begin() + 4 * c, mesh.corners.begin() + 4 * (c + 1), random);
  Complex<3> shuffled = mesh.complex();
  shuffled.set_values(complex.values());
  const auto other = extract(shuffled, 0.5);
  expect_closed_manifold(other);
  EXPECT_TRUE(contour.vertices == other.vertices);
  EXPECT_EQ(contour.simplices.size(), other.simplices.size());
  EXPECT_NEAR(measure(contour).content.value(), measure(other).content.value(),
              0.02 * measure(contour).content.value());
}

TEST(Complex, MissingValuesLeaveAManifoldWithBoundary) {
  for (const auto& [name, mesh] : meshes(16)) {
    SCOPED_TRACE(name);
    Complex<3> complex = mesh.complex();
    std::vector<double> values = closed_noise(mesh, 31);
    std::mt19937_64 random(9);
    for (double& value : values)
      if (random() % 12 == 0) value = std::numeric_limits<double>::quiet_NaN();
    complex.set_values(values);
    for (const Triangulation t : kTriangulations) {
      const auto contour = extract(complex, 0.5, options_of(t));
      EXPECT_GT(expect_oriented_manifold(contour).boundary_simplices, 100u);
      EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, options_of(t)));
    }
    complex.set_values(std::vector<double>(values.size(), std::numeric_limits<double>::quiet_NaN()));
    EXPECT_TRUE(extract(complex, 0.5).vertices.empty());
  }
}

TEST(Complex, InTwoDimensionsTrianglesAndQuadrilateralsMix) {
  MeshData<2> mesh = grid_points<2>({60, 60}, 0.2);
  std::mt19937_64 random(1);
  for_each_grid_cell<2>(mesh.sizes, [&](const std::array<std::size_t, 2>& index) {
    const auto c = [&](unsigned v) { return mesh.corner(index, v); };
    if (random() % 2 == 0) {
      mesh.add(CellType::quadrilateral, {c(0), c(1), c(3), c(2)});
    } else {
      mesh.add(CellType::triangle, {c(0), c(1), c(3)});
      mesh.add(CellType::triangle, {c(2), c(0), c(3)});
    }
  });
  Complex<2> complex = mesh.complex();
  complex.set_values(closed_noise(mesh, 6));
  for (const Ambiguity a : {Ambiguity::low, Ambiguity::high}) {
    const auto contour = extract(complex, 0.5, options_of(Triangulation::compact, a));
    EXPECT_GT(contour.simplices.size(), 3000u);
    expect_closed_manifold(contour);
  }
  complex.set_values(values_of(mesh, [](const auto& x) { return 0.7 - std::hypot(x[0], x[1]); }));
  const Measures<2> measures = measure(extract<double>(complex, 0.0));
  EXPECT_NEAR(2 * std::numbers::pi * 0.7, measures.size, 0.005);
  EXPECT_NEAR(std::numbers::pi * 0.49, measures.content.value(), 0.005);
}

TEST(Complex, InFourDimensionsSimplicesAndPrismsHaveClosedContours) {
  const MeshData<4> points = grid_points<4>({7, 7, 7, 7}, 0.1);
  for (const MeshData<4>& mesh : {kuhn_mesh(points), cube_mesh(points), cube_mesh(points, true)}) {
    Complex<4> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 3));
    for (const Ambiguity a : {Ambiguity::low, Ambiguity::high}) {
      const auto contour = extract<double>(complex, 0.5, options_of(Triangulation::barycentric, a));
      EXPECT_GT(contour.simplices.size(), 20000u);
      expect_closed_manifold(contour);
    }
  }
}

/// A projective map of a mesh on [-1, 1]^N; affine without `pull`. Faces stay flat.
template <int N>
MeshData<N> mapped(MeshData<N> mesh, double pull) {
  for (auto& x : mesh.points) {
    std::array<double, N> y;
    double weight = 1.0;
    for (int a = 0; a < N; ++a) weight += pull * (0.1 + 0.05 * a) * x[a];
    for (int a = 0; a < N; ++a) y[a] = (x[a] + 0.6 * x[(a + 1) % N] - 0.2 * x[(a + 2) % N]) / weight;
    x = y;
  }
  return mesh;
}

template <int N>
std::uint64_t intersecting_pairs(const MeshData<N>& mesh, Triangulation t, Ambiguity ambiguity) {
  Complex<N> complex = mesh.complex();
  complex.set_values(closed_noise(mesh, 17));
  const auto contour = extract<double>(complex, 0.5, options_of(t, ambiguity));
  EXPECT_GT(contour.simplices.size(), 500u);
  return find_intersections(contour).pair_count;
}

TEST(Complex, ContoursOfCellsWithFlatFacesDoNotIntersectThemselves) {
  const MeshData<3> points = grid_points<3>({9, 9, 9}, 0.0);
  const std::vector<MeshData<3>> meshes3 = {kuhn_mesh(grid_points<3>({9, 9, 9}, 0.15)),
                                            mapped(cube_mesh(points, true), 0.0), mapped(cube_mesh(points, true), 1.0),
                                            mapped(wedge_mesh(points), 1.0), mapped(pyramid_mesh(points), 1.0)};
  for (const MeshData<3>& mesh : meshes3)
    for (const Triangulation t : kTriangulations)
      for (const Ambiguity a : {Ambiguity::low, Ambiguity::high}) EXPECT_EQ(intersecting_pairs(mesh, t, a), 0u);
  const MeshData<4> points4 = grid_points<4>({5, 5, 5, 5}, 0.0);
  for (const MeshData<4>& mesh : {kuhn_mesh(grid_points<4>({5, 5, 5, 5}, 0.1)), mapped(cube_mesh(points4), 0.0)})
    for (const Ambiguity a : {Ambiguity::low, Ambiguity::high})
      EXPECT_EQ(intersecting_pairs(mesh, Triangulation::barycentric, a), 0u);
}

TEST(Complex, InFourDimensionsVolumesConvergeWithOrderTwo) {
  const double volume = std::numbers::pi * std::numbers::pi / 2 * std::pow(0.8, 4), size = 4 * volume / 0.8;
  for (const bool simplices : {false, true}) {
    std::array<double, 2> errors{}, of_size{};
    for (const std::size_t refined : {0u, 1u}) {
      const std::size_t samples = refined == 0 ? 7 : 13;
      const MeshData<4> points = grid_points<4>({samples, samples, samples, samples});
      const MeshData<4> mesh = simplices ? kuhn_mesh(points) : cube_mesh(points);
      Complex<4> complex = mesh.complex();
      complex.set_values(
          values_of(mesh, [](const auto& x) { return 0.8 - std::hypot(std::hypot(x[0], x[1]), x[2], x[3]); }));
      const auto ball = extract<double>(complex, 0.0);
      EXPECT_EQ(0, expect_closed_manifold(ball).euler);
      errors[refined] = volume - measure(ball).content.value();
      of_size[refined] = size - measure(ball).size;
    }
    EXPECT_NEAR(2.0, std::log2(errors[0] / errors[1]), 0.3);
    EXPECT_NEAR(2.0, std::log2(of_size[0] / of_size[1]), 0.3);
  }
}

TEST(Complex, AllValueTypesGiveTheSameContour) {
  const MeshData<3> mesh = kuhn_mesh(grid_points<3>({6, 6, 6}));
  std::mt19937_64 random(1);
  std::vector<std::uint8_t> bytes(mesh.points.size());
  for (auto& b : bytes) b = static_cast<std::uint8_t>(random() % 100);
  Complex<3> complex = mesh.complex();
  complex.set_values<std::uint8_t>(bytes);
  const auto first = extract(complex, 49.5);
  EXPECT_FALSE(first.simplices.empty());
  const auto expect_same = [&]<class T>(T) {
    const std::vector<T> values(bytes.begin(), bytes.end());
    complex.set_values(values);
    EXPECT_TRUE(first.vertices == extract(complex, 49.5).vertices);
  };
  expect_same(std::int8_t{}), expect_same(std::uint16_t{}), expect_same(std::int16_t{}), expect_same(std::int32_t{});
  expect_same(float{}), expect_same(double{});
}

TEST(Complex, MovedPointsMoveTheContourAndKeepItsSimplices) {
  const MeshData<3> mesh = mixed_mesh(grid_points<3>({10, 10, 10}), 2);
  Complex<3> complex = mesh.complex();
  complex.set_values(values_of(mesh, test::ball<3>));
  const auto before = extract<double>(complex, 0.0);
  auto points = mesh.points;
  for (auto& point : points) point[0] += 3.0;
  complex.set_points(points);
  const auto after = extract<double>(complex, 0.0);
  EXPECT_TRUE(before.simplices == after.simplices);
  ASSERT_EQ(before.vertices.size(), after.vertices.size());
  for (std::size_t v = 0; v < after.vertices.size(); ++v)
    EXPECT_NEAR(before.vertices[v][0] + 3.0, after.vertices[v][0], 1e-12);
}

TEST(Complex, InfiniteValuesPutVerticesAtTheFiniteEnd) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<std::array<double, 2>> points = {{0, 0}, {1, 0}, {0, 1}};
  const Index corners[] = {0, 1, 2};
  Complex<2> complex(points, CellType::triangle, corners);
  complex.set_values({kInfinity, 0.0, -kInfinity});
  const auto contour = extract<double>(complex, 0.5);
  ASSERT_EQ(2u, contour.vertices.size());
  EXPECT_EQ((std::array<double, 2>{1, 0}), contour.vertices[0]);
  EXPECT_EQ((std::array<double, 2>{0, 0.5}), contour.vertices[1]);
}

TEST(Complex, ValuesWhoseDifferenceOverflowsAreInterpolated) {
  const std::vector<std::array<double, 2>> points = {{0, 0}, {1, 0}, {0, 1}};
  const Index corners[] = {0, 1, 2};
  Complex<2> complex(points, CellType::triangle, corners);
  complex.set_values({-1.7e308, 1.7e308, -0.85e308});
  const auto contour = extract<double>(complex, 0.0);
  ASSERT_EQ(2u, contour.vertices.size());
  EXPECT_EQ((std::array<double, 2>{0.5, 0}), contour.vertices[0]);
  EXPECT_NEAR(2.0 / 3.0, contour.vertices[1][1], 1e-12);
}

TEST(Complex, VeryLargeAndVerySmallMeshesHaveTheSameSimplices) {
  const MeshData<3> mesh = mixed_mesh(grid_points<3>({9, 9, 9}, 0.15), 5);
  Complex<3> complex = mesh.complex();
  complex.set_values(closed_noise(mesh, 12));
  const auto contour = extract<double>(complex, 0.5);
  for (const double scale : {0x1p-400, 0x1p400, 0x1p1016}) {
    std::vector<std::array<double, 3>> points = mesh.points;
    for (auto& point : points)
      for (double& x : point) x *= scale;
    complex.set_points(points);
    const auto scaled = extract<double>(complex, 0.5);
    EXPECT_TRUE(contour.simplices == scaled.simplices);
    ASSERT_EQ(contour.vertices.size(), scaled.vertices.size());
    for (std::size_t v = 0; v < contour.vertices.size(); ++v)
      for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(scale * contour.vertices[v][i], scaled.vertices[v][i]);
  }
}

TEST(Complex, PointsBeyondTheRangeOfFloatNeedDouble) {
  const std::vector<std::array<double, 2>> points = {{0, 0}, {4e38, 0}, {0, 1}};
  const Index corners[] = {0, 1, 2};
  Complex<2> complex(points, CellType::triangle, corners);
  complex.set_values({1.0, 0.0, 0.0});
  expect_error(ErrorCode::InvalidArgument,
               "point 1: coordinate 0 is 4e+38; expected -3.4028235e+38 to 3.4028235e+38, the range of float vertices",
               [&] { (void)extract<float>(complex, 0.5); });
  EXPECT_EQ((std::array<double, 2>{2e38, 0}), extract<double>(complex, 0.5).vertices.at(0));
  EXPECT_EQ((ContourSize{2, 1}), count(complex, 0.5));
}

TEST(Complex, CountingReportsAllOfItsWorkAndCancels) {
  const MeshData<3> mesh = kuhn_mesh(grid_points<3>({20, 20, 20}));
  for (const bool has_missing : {false, true}) {
    Complex<3> complex = mesh.complex();
    std::vector<double> values = closed_noise(mesh, 3);
    std::mt19937_64 random(9);
    for (double& value : values)
      if (has_missing && random() % 12 == 0) value = std::numeric_limits<double>::quiet_NaN();
    complex.set_values(values);
    std::vector<double> heard;
    ExtractOptions options;
    options.work.progress = [&](double fraction) {
      heard.push_back(fraction);
      return true;
    };
    EXPECT_EQ(count(complex, 0.5), count(complex, 0.5, options));
    EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
    EXPECT_EQ(1.0, heard.back());
    EXPECT_GT(std::count_if(heard.begin(), heard.end(), [](double f) { return f > 0.5 && f < 1.0; }), 3);
    for (const double at : {0.0, 0.3, 0.55, 0.9}) {
      options.work.progress = [at](double fraction) { return fraction < at; };
      expect_error(ErrorCode::Cancelled, "cancelled", [&] { (void)count(complex, 0.5, options); });
    }
  }
}

TEST(Complex, ProgressRisesToOneAndCancels) {
  const MeshData<3> mesh = kuhn_mesh(grid_points<3>({30, 30, 30}));
  Complex<3> complex = mesh.complex();
  complex.set_values(values_of(mesh, test::ball<3>));
  std::vector<double> heard;
  ExtractOptions options;
  options.work.progress = [&](double fraction) {
    heard.push_back(fraction);
    return true;
  };
  const auto with = extract(complex, 0.0, options);
  EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
  EXPECT_EQ(1.0, heard.back());
  EXPECT_GT(heard.size(), 10u);
  EXPECT_TRUE(with.vertices == extract(complex, 0.0).vertices);
  for (const double at : {0.0, 0.3, 0.7, 0.9}) {
    options.work.progress = [at](double fraction) { return fraction < at; };
    expect_error(ErrorCode::Cancelled, "cancelled", [&] { (void)extract(complex, 0.0, options); });
    expect_error(ErrorCode::Cancelled, "cancelled", [&] { complex.find_edges(options.work); });
    EXPECT_EQ(0u, complex.edge_count());
  }
}

TEST(Complex, StatisticsCountCells) {
  const MeshData<3> mesh = kuhn_mesh(grid_points<3>({9, 9, 9}));
  Complex<3> complex = mesh.complex();
  complex.set_values(values_of(mesh, test::ball<3>));
  const auto stats = extract_with_stats(complex, 0.0).stats;
  EXPECT_EQ(6u * 512u, stats.tiles);
  std::uint64_t active = 0;
  for (std::size_t c = 0; c < mesh.types.size(); ++c) {
    int high = 0;
    for (int v = 0; v < 4; ++v) high += complex.values()[mesh.corners[4 * c + v]] >= 0.0 ? 1 : 0;
    active += high % 4 != 0 ? 1 : 0;
  }
  EXPECT_EQ(active, stats.active_tiles);
}

TEST(Complex, BadCellsAreErrorsThatNameThem) {
  const std::vector<std::array<double, 3>> points(5, {0, 0, 0});
  const auto make = [&](CellType type, std::vector<Index> corners) {
    return [=] { (void)Complex<3>(points, type, corners); };
  };
  const auto refuse = [](const std::string& part, const auto& work) {
    expect_error(ErrorCode::InvalidArgument, part, work);
  };
  refuse("cell 1: corner 2 is point 5; expected a number below 5",
         make(CellType::tetrahedron, {0, 1, 2, 3, 0, 1, 5, 2}));
  refuse("cell 0: corners 1 and 3 are both point 1", make(CellType::tetrahedron, {0, 1, 2, 1}));
  refuse("7 corners; expected a multiple of 4", make(CellType::tetrahedron, {0, 1, 2, 3, 0, 1, 2}));
  refuse("type 5 (triangle); expected a 3D cell: 10 (tetrahedron)", make(CellType::triangle, {0, 1, 2}));
  refuse("type 6 (unknown)", make(static_cast<CellType>(6), {0, 1, 2}));
  const std::vector<CellType> types = {CellType::tetrahedron, CellType::pyramid};
  const auto mixed = [&](std::vector<Index> corners) { return [=] { (void)Complex<3>(points, types, corners); }; };
  refuse("cell 1: 4 corners are left; a pyramid has 5", mixed({0, 1, 2, 3, 0, 1, 2, 3}));
  refuse("10 corners; expected 9 for these 2 cells", mixed({0, 1, 2, 3, 0, 1, 2, 3, 4, 0}));
  auto broken = points;
  broken[3][1] = std::numeric_limits<double>::infinity();
  refuse("point 3: (0, inf, 0); expected finite coordinates", [&] { (void)Complex<3>(broken, types, {}); });
  broken[3][1] = -1e308;
  refuse("point 3: (0, -1e+308, 0); expected coordinates from -2.80889", [&] { (void)Complex<3>(broken, types, {}); });
  refuse("cell type 6", [] { (void)corner_count(static_cast<CellType>(6)); });
}

TEST(Complex, MoreCellsThanCanBeNumberedAreErrors) {
  // numbers of cells are checked before any cell is read
  constexpr std::size_t kTooMany = std::size_t{1} << 32;
  const Index corner = 0;
  const CellType type = CellType::triangle;
  const std::string part = "4294967296 cells; expected at most 4294967295";
  expect_error(ErrorCode::TooLarge, part, [&] {
    (void)detail::group_cells(2, 3, CellType::triangle, std::span<const Index>(&corner, 3 * kTooMany));
  });
  expect_error(ErrorCode::TooLarge, part, [&] {
    (void)detail::group_cells(2, 3, std::span<const CellType>(&type, kTooMany), std::span<const Index>(&corner, 1));
  });
}

TEST(Complex, BadValuesAndOptionsAreErrors) {
  const std::vector<std::array<double, 3>> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Index corners[] = {0, 1, 2, 3};
  Complex<3> complex(points, CellType::tetrahedron, corners);
  EXPECT_TRUE(extract(complex, 0.0).vertices.empty()) << "values are missing at first";
  const auto refuse = [&](ErrorCode code, const std::string& part, double isovalue, auto change) {
    ExtractOptions options;
    change(options);
    expect_error(code, part, [&] { (void)extract(complex, isovalue, options); });
    expect_error(code, part, [&] { (void)count(complex, isovalue, options); });
  };
  expect_error(ErrorCode::InvalidArgument, "3 values; expected one for each of the 4 points", [&] {
    complex.set_values({1.0, 2.0, 3.0});
  });
  expect_error(ErrorCode::InvalidArgument, "0 points; expected one for each of the 4 points",
               [&] { complex.set_points({}); });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refuse(ErrorCode::InvalidIsovalue, "nan", nan, [](ExtractOptions&) {});
  refuse(ErrorCode::InvalidArgument, "epsilon 0.5", 0.0, [](ExtractOptions& o) { o.epsilon = 0.5; });
}

TEST(Complex, AnEmptyComplexHasAnEmptyContour) {
  const Complex<3> complex({}, CellType::tetrahedron, {});
  EXPECT_EQ(0u, complex.cell_count());
  EXPECT_TRUE(extract(complex, 0.0).vertices.empty());
  Complex<3> with_edges = complex;
  with_edges.find_edges();
  EXPECT_TRUE(extract(with_edges, 0.0).simplices.empty());
}

}  // namespace
}  // namespace tegl
