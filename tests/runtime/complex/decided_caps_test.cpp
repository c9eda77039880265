// SPDX-License-Identifier: BSD-3-Clause
//
// Caps of 4D contours whose ambiguous faces are decided from the data: closed manifolds, with the volume of the closed
// contours of 3D meshes, and equal to the caps of images.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "compare.hpp"
#include "complex/complex_cases.hpp"
#include "invariants.hpp"
#include "meshes.hpp"
#include "regions/decided_regions.hpp"
#include "regions/oriented_tetrahedra.hpp"
#include "tegl/check.hpp"
#include "tegl/complex.hpp"
#include "tegl/extract.hpp"
#include "tegl/lattice.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"
#include "tegl/tile/diagonal_edges.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr std::array kDecided = {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider};
constexpr std::array kKinds = {Triangulation::barycentric, Triangulation::compact};

ExtractOptions closed_by(Ambiguity rule, Triangulation triangulation) {
  ExtractOptions options;
  options.ambiguity = rule;
  options.triangulation = triangulation;
  options.close = true;
  return options;
}

std::vector<double> any_values(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> values(count);
  for (double& value : values) value = static_cast<double>(random() >> 11) * 0x1p-53;
  return values;
}

struct NamedComplex {
  std::string name;
  Complex<4> complex;
};

/// The same mesh with its points in another order.
MeshData<3> shuffled(MeshData<3> mesh) {
  std::vector<Index> number(mesh.points.size());
  std::iota(number.begin(), number.end(), Index{0});
  std::shuffle(number.begin(), number.end(), std::mt19937_64(4));
  const auto places = mesh.points;
  for (std::size_t p = 0; p < number.size(); ++p) mesh.points[number[p]] = places[p];
  for (Index& corner : mesh.corners) corner = number[corner];
  return mesh;
}

/// Meshes over three times, with their points in any order.
std::vector<NamedComplex> complexes() {
  const auto points = grid_points<3>({5, 5, 5});
  std::vector<NamedComplex> all;
  const auto add = [&](const std::string& name, MeshData<3> mesh) {
    mesh = shuffled(std::move(mesh));
    const std::vector<double> times = {0.0, 0.5, 2.0};
    all.push_back({name, in_time(mesh.complex(), times, any_values(times.size() * mesh.points.size(), 7))});
  };
  add("hexahedra", cube_mesh(points));
  add("wedges", wedge_mesh(points));
  add("pyramids", pyramid_mesh(points));
  add("tetrahedra", kuhn_mesh(points));
  add("mixed", mixed_mesh(points, 5));
  return all;
}

TEST(DecidedCaps, ContoursOfNoiseAreClosedManifoldsWhateverTheNumbersOfPoints) {
  for (auto& [name, complex] : complexes())
    for (const Ambiguity rule : kDecided) {
      std::vector<MeshReport> reports;
      for (const Triangulation triangulation : kKinds) {
        SCOPED_TRACE(testing::Message() << name << " " << static_cast<int>(rule));
        ExtractOptions options = closed_by(rule, triangulation);
        const auto contour = extract<double>(complex, 0.5, options);
        EXPECT_GT(contour.simplices.size(), 1000u);
        reports.push_back(expect_closed_manifold(contour));
        EXPECT_EQ(0u, reports.back().degenerate_simplices);
        EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, options));
        options.work.threads = 3;
        const auto by_threads = extract<double>(complex, 0.5, options);
        EXPECT_TRUE(contour.vertices == by_threads.vertices && contour.simplices == by_threads.simplices);
      }
      EXPECT_EQ(reports[0].components, reports[1].components);
    }
}

/// The sum of the volumes of the tetrahedra at a time.
double volume_at(const Contour<4, double>& contour, double time) {
  double sum = 0.0;
  for (const auto& simplex : contour.simplices) {
    std::array<std::array<double, 3>, 4> at;
    bool is_at = true;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& vertex = contour.vertices[simplex[k]];
      is_at = is_at && vertex[3] == time;
      at[k] = {vertex[0], vertex[1], vertex[2]};
    }
    if (is_at) sum += std::abs(detail::six_volumes(at)) / 6.0;
  }
  return sum;
}

/// Caps at the first time are the high part of the mesh at that time: without overlaps and gaps, they have the content
/// of the step's contour, which is closed by triangles.
TEST(DecidedCaps, AtTheFirstTimeHaveTheContentOfTheClosedContourOfTheStep) {
  const auto points = grid_points<3>({6, 6, 6});
  for (const MeshData<3>& mesh : {cube_mesh(points, true), shuffled(cube_mesh(points)), shuffled(wedge_mesh(points)),
                                  shuffled(pyramid_mesh(points)), shuffled(mixed_mesh(points, 5))}) {
    const std::vector<double> values = any_values(2 * mesh.points.size(), 17);
    Complex<3> step = mesh.complex();
    const Complex<4> swept = in_time(step, std::vector<double>{0.0, 1.0}, values);
    step.set_values(
        std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(mesh.points.size())));
    for (const Ambiguity rule : kDecided)
      for (const Triangulation triangulation : kKinds) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(rule) << " " << static_cast<int>(triangulation));
        const ExtractOptions options = closed_by(rule, triangulation);
        const double content = measure(extract<double>(step, 0.5, options)).content.value();
        // compact contours of shuffled points have some divisions that are not proved
        const bool is_proved = triangulation == Triangulation::barycentric || mesh.points[0] == points.points[0];
        EXPECT_NEAR(content, volume_at(extract<double>(swept, 0.5, options), 0.0), is_proved ? 1e-9 : 0.01 * content);
      }
  }
}

/// Caps in border faces that are not plane have the same triangles in a mesh and in its cells over time.
TEST(DecidedCaps, CutsAtStepsAreTheClosedContoursOfTheSteps) {
  const auto points = grid_points<3>({5, 5, 5}, 0.15);
  const std::vector<double> times = {0.0, 0.5, 2.0};
  for (const MeshData<3>& mesh : {shuffled(cube_mesh(points)), shuffled(wedge_mesh(points)),
                                  shuffled(pyramid_mesh(points)), shuffled(mixed_mesh(points, 5))}) {
    const std::size_t count = mesh.points.size();
    const std::vector<double> values = any_values(times.size() * count, 31), moves = any_values(values.size(), 32);
    std::vector<std::array<double, 3>> places;
    for (std::size_t i = 0; i < values.size(); ++i) {
      places.push_back(mesh.points[i % count]);
      places.back()[i % 3] += 0.05 * moves[i];
    }
    const Complex<4> swept = in_time<3>(mesh.complex(), times, values, places);
    for (const Ambiguity rule : kAllRules)
      for (const Triangulation triangulation : kKinds) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(rule) << " " << static_cast<int>(triangulation));
        const ExtractOptions options = closed_by(rule, triangulation);
        const auto contour = extract<double>(swept, 0.5, options);
        for (std::size_t k = 0; k < times.size(); ++k) {
          const auto from = static_cast<std::ptrdiff_t>(k * count), to = from + static_cast<std::ptrdiff_t>(count);
          Complex<3> step = mesh.complex();
          step.set_points({places.begin() + from, places.begin() + to});
          step.set_values({values.begin() + from, values.begin() + to});
          const auto closed = extract<double>(step, 0.5, options);
          EXPECT_GT(closed.simplices.size(), 100u);
          EXPECT_TRUE(same_surface(closed, slice(contour, Hyperplane<4>::across(3, times[k])))) << times[k];
        }
      }
  }
}

TEST(DecidedCaps, AGridsOwnTesseractsHaveTheImagesCaps) {
  const MeshData<4> mesh = cube_mesh(grid_points<4>({7, 5, 5, 5}), true);
  Complex<4> complex = mesh.complex();
  const std::vector<double> values = any_values(mesh.points.size(), 29);
  complex.set_values(values);
  const OwnedImage<double, 4> image = image_of(mesh, values);
  for (const Ambiguity rule : kDecided)
    for (const Triangulation triangulation : kKinds) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(rule) << " " << static_cast<int>(triangulation));
      const ExtractOptions options = closed_by(rule, triangulation);
      const auto of_image = extract(image.view(), 0.5, options);
      auto of_mesh = extract(complex, 0.5, options);
      EXPECT_EQ(of_image.simplices.size(), of_mesh.simplices.size());
      EXPECT_EQ(of_image.vertices.size(), of_mesh.vertices.size());
      if (triangulation == Triangulation::barycentric) continue;  // images have weighted barycentres
      snap(of_image, of_mesh);
      EXPECT_TRUE(same_surface(of_image, of_mesh));
    }
}

/// Lattices over time: octahedra with tunnels, and prisms over them.
TEST(DecidedCaps, LatticesHaveClosedManifolds) {
  for (const Lattice lattice : {Lattice::fcc_in_time, Lattice::d4}) {
    const OwnedImage<double, 4> image{Grid<4>::unit({5, 5, 5, 4}), Values<double>(any_values(500, 3))};
    for (const Ambiguity rule : kDecided)
      for (const Triangulation triangulation : kKinds) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(rule) << " " << static_cast<int>(triangulation));
        expect_closed_manifold(extract_lattice<double>(image.view(), lattice, 0.5, closed_by(rule, triangulation)));
      }
  }
}

using detail::CubeContour;
using detail::CubeFrame;
using detail::RegionDivision;
using detail::RegionTriangles;
using detail::ShapeVertices;

/// The high parts of a polygon as fans: from the corner between two others, else from the one with the smallest number.
/// `ring`: corners around it. `high`, `points`: by corner.
void add_fans(tables::CellShape shape, const std::vector<unsigned>& ring, unsigned high, bool joins,
              const std::array<Index, 8>& points, RegionTriangles& sides) {
  const std::size_t size = ring.size();
  const auto is_high = [&](std::size_t i) { return (high >> ring[i % size] & 1u) != 0; };
  const auto on_edge = [&](std::size_t i) {
    const auto& table = detail::table_of(shape);
    return static_cast<std::uint8_t>(ShapeVertices::kFirstEdge +
                                     detail::edge_between(table, ring[i % size], ring[(i + 1) % size]));
  };
  std::vector<std::vector<std::uint8_t>> parts;
  std::size_t start = 0;
  while (start < size && (is_high(start) || !is_high(start + 1))) ++start;
  if (start == size && !is_high(0)) return;
  if (start == size) parts.emplace_back();
  for (std::size_t i = start % size, end = i + size; i < end; ++i) {
    if (is_high(i)) parts.back().push_back(static_cast<std::uint8_t>(ring[i % size]));
    if (is_high(i) == is_high(i + 1)) continue;
    if (!is_high(i) && (parts.empty() || !joins)) parts.emplace_back();
    parts.back().push_back(on_edge(i));
  }
  for (auto& part : parts) {
    const auto number = [&](std::uint8_t v) { return v < 8 ? points[v] : ~Index{0}; };
    std::vector<std::uint8_t> corners;
    for (const std::uint8_t v : part)
      if (v < 8) corners.push_back(v);
    auto first = std::min_element(part.begin(), part.end(), [&](auto a, auto b) { return number(a) < number(b); });
    if (corners.size() == 3) first = std::find(part.begin(), part.end(), corners[1]);
    std::rotate(part.begin(), first, part.end());
    for (std::size_t i = 2; i < part.size(); ++i) sides.push_back({part[0], part[i - 1], part[i]});
  }
}

/// Whether the tetrahedra of a division have these sides and as many triangles of the contour, and no other ones.
bool has_boundary(const RegionDivision& division, const RegionTriangles& sides, std::size_t of_contour) {
  std::map<detail::RegionTriangle, int> count;
  for (const auto& t : division.tetrahedra)
    for (unsigned k = 0; k < 4; ++k) ++count[detail::sorted(detail::face_of(t, k))];
  const bool has_sides = std::all_of(sides.begin(), sides.end(), [&](const auto& t) {
    const auto found = count.find(detail::sorted(t));
    return found != count.end() && found->second == 1;
  });
  const auto single = std::count_if(count.begin(), count.end(), [](const auto& face) { return face.second == 1; });
  const bool is_simple = std::all_of(count.begin(), count.end(), [](const auto& face) { return face.second <= 2; });
  return has_sides && is_simple && static_cast<std::size_t>(single) == sides.size() + of_contour;
}

/// Lists of the resolved cube in all frames that numbers of points give: the regions, tunnels included, have the
/// diagonals of the faces, and are proved if the points are numbered along the axes.
TEST(DecidedCaps, DivisionsOfAllCubesHaveTheDiagonalsInTheirFaces) {
  std::mt19937_64 random(5);
  unsigned tunnels = 0, proved = 0, all = 0;
  for (const builders::CubeList& list : detail::ResolvedCubes::instance().lists())
    for (int run = 0; run < 12; ++run) {
      std::array<Index, 8> points;
      std::iota(points.begin(), points.end(), Index{0});
      if (run > 0) std::shuffle(points.begin(), points.end(), random);
      const unsigned number = run % 4 == 1 ? 0 : CubeFrame::number_of(points.data());
      const CubeFrame frame = CubeFrame::of_number(number);
      unsigned high = 0, joined = 0;
      for (unsigned v = 0; v < 8; ++v) high |= (list.signature >> v & 1u) << frame.corner(v);
      for (unsigned q = 0; q < 6; ++q) joined |= (list.high_squares >> q & 1u) << frame.square(q);
      RegionTriangles sides;
      for (unsigned q = 0; q < 6; ++q) {
        const auto& [a, b, c, d] = detail::kSquareCorners[q];
        add_fans(tables::CellShape::hexahedron, {a, b, d, c}, high, (joined >> q & 1u) != 0, points, sides);
      }
      for (const Triangulation triangulation : kKinds) {
        const CubeContour contour(number, high, joined, static_cast<tile::Choice>(list.choice));
        const RegionDivision division = detail::divide_cube(contour, triangulation, sides);
        const auto triangles = detail::ResolvedCubes::instance(triangulation).triangles_of(contour.list);
        EXPECT_TRUE(has_boundary(division, sides, triangles.size() / 3)) << contour.list;
        EXPECT_TRUE(division.is_proved || run > 0) << contour.list;
        tunnels += detail::has_tunnel(contour.list) ? 1 : 0;
        proved += division.is_proved ? 1 : 0;
        ++all;
      }
    }
  EXPECT_GT(tunnels, 5000u);
  EXPECT_GT(proved, 3 * (all / 4));
}

/// The division around a tunnel in an octahedron is positive, and has the content of its boundary, wherever the points
/// are on their edges.
TEST(DecidedCaps, OctahedraWithTunnelsAreDividedIntoPositiveTetrahedra) {
  const tables::CellTable& table = detail::table_of(tables::CellShape::octahedron);
  std::mt19937_64 random(6);
  for (unsigned pair = 0; pair < 3; ++pair)
    for (const bool is_high : {false, true})
      for (int run = 0; run < 20; ++run) {
        std::array<Index, 8> points;
        std::iota(points.begin(), points.end(), Index{0});
        std::shuffle(points.begin(), points.end(), random);
        const unsigned high = is_high ? 3u << 2 * pair : 63u & ~(3u << 2 * pair);
        detail::ShapePlaces places(table);
        for (unsigned e = 0; e < table.edge_count; ++e)
          places.set_alpha(e, 0.01 + 0.98 * static_cast<double>(random() >> 11) * 0x1p-53);
        RegionTriangles sides;
        for (unsigned a = 0; a < 2; ++a)
          for (unsigned b = 2; b < 4; ++b)
            for (unsigned c = 4; c < 6; ++c) {  // seen from outside
              const bool turns = (a + b + c) % 2 != 0;
              add_fans(tables::CellShape::octahedron, {a, turns ? c : b, turns ? b : c}, high, false, points, sides);
            }
        const auto around = detail::corners_around(pair);
        for (unsigned i = 0; i < 4; ++i) {
          std::vector<std::uint8_t> quadrilateral;
          for (const unsigned v : {around[i], around[(i + 1) % 4]})
            for (const unsigned end : {2 * pair, 2 * pair + 1})
              quadrilateral.push_back(
                  static_cast<std::uint8_t>(ShapeVertices::kFirstEdge + detail::edge_between(table, end, v)));
          places.set_centre(ShapeVertices::kFirstCentre + i, quadrilateral);
        }
        const RegionDivision division = detail::divide_around_tunnel(pair, is_high, sides);
        EXPECT_TRUE(division.is_proved && has_boundary(division, sides, 16));
        const double sign = detail::six_volumes(places.places(division.tetrahedra[0])) < 0 ? -1.0 : 1.0;
        for (const auto& t : division.tetrahedra) EXPECT_GT(sign * detail::six_volumes(places.places(t)), 0.0);
      }
}

}  // namespace
}  // namespace tegl
