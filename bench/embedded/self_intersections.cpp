// SPDX-License-Identifier: BSD-3-Clause
//
// self_intersections: pairs of intersecting triangles in contours of random fields, by way to resolve ambiguities and
// by triangulation, as found by CGAL, with their causes. Writes CSV.
//
//     self_intersections [FIELDS]
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "support/random_fields.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "usage.hpp"

namespace {

using namespace tegl;
using namespace tegl::test;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Surface = Contour<3, double>;

/// Pairs of intersecting triangles, by number.
std::vector<std::array<std::size_t, 2>> intersecting_pairs(const Surface& contour) {
  Mesh mesh;
  for (const auto& v : contour.vertices) mesh.add_vertex(Kernel::Point_3(v[0], v[1], v[2]));
  for (const auto& s : contour.simplices)
    mesh.add_face(Mesh::Vertex_index(s[0]), Mesh::Vertex_index(s[1]), Mesh::Vertex_index(s[2]));
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(found));
  std::vector<std::array<std::size_t, 2>> result;
  for (const auto& [a, b] : found) result.push_back({std::size_t(a), std::size_t(b)});
  return result;
}

std::array<int, 3> tile_of(const Surface& contour, std::size_t triangle) {
  std::array<int, 3> tile{};
  for (int a = 0; a < 3; ++a) {
    double sum = 0;
    for (const Index v : contour.simplices[triangle]) sum += contour.vertices[v][a];
    tile[a] = static_cast<int>(std::floor(sum / 3));
  }
  return tile;
}

/// The piece of the contour that contains a triangle within its tile: its Euler characteristic and its triangles.
std::pair<int, std::set<std::size_t>> piece_of(const Surface& contour, std::size_t triangle) {
  std::vector<std::size_t> in_tile;
  for (std::size_t t = 0; t < contour.simplices.size(); ++t)
    if (tile_of(contour, t) == tile_of(contour, triangle)) in_tile.push_back(t);
  std::set<std::size_t> piece{triangle};
  std::set<Index> vertices(contour.simplices[triangle].begin(), contour.simplices[triangle].end());
  for (std::size_t before = 0; before != piece.size();) {
    before = piece.size();
    for (const std::size_t t : in_tile) {
      const auto& s = contour.simplices[t];
      if (!vertices.count(s[0]) && !vertices.count(s[1]) && !vertices.count(s[2])) continue;
      piece.insert(t);
      vertices.insert(s.begin(), s.end());
    }
  }
  std::set<std::array<Index, 2>> edges;
  for (const std::size_t t : piece)
    for (int i = 0; i < 3; ++i) {
      const Index v = contour.simplices[t][i], w = contour.simplices[t][(i + 1) % 3];
      edges.insert({std::min(v, w), std::max(v, w)});
    }
  return {static_cast<int>(vertices.size() + piece.size()) - static_cast<int>(edges.size()), piece};
}

/// True if a vertex of the triangles does not lie on an edge of the grid.
bool has_own_vertex(const Surface& contour, const std::set<std::size_t>& piece) {
  for (const std::size_t t : piece)
    for (const Index v : contour.simplices[t]) {
      const auto& at = contour.vertices[v];
      if (std::count_if(at.begin(), at.end(), [](double x) { return x != std::floor(x); }) > 1) return true;
    }
  return false;
}

std::string cause(const Surface& contour, const std::array<std::size_t, 2>& pair) {
  if (tile_of(contour, pair[0]) != tile_of(contour, pair[1])) return "two tiles";
  const auto [euler, piece] = piece_of(contour, pair[0]);
  if (piece.count(pair[1]))
    return euler == 1 ? "within a polygon"
                      : "within a tunnel" + std::string(has_own_vertex(contour, piece) ? " with own vertices" : "");
  return euler == 1 && piece_of(contour, pair[1]).first == 1 ? "two polygons of a tile" : "a polygon and a tunnel";
}

void measure(std::size_t count, Ambiguity ambiguity, Triangulation triangulation, const std::string& name) {
  std::mt19937_64 bits(2012);
  std::size_t pairs = 0, fields = 0, triangles = 0;
  std::map<std::string, std::size_t> causes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto field = random_field<3>(bits, 5, 1 << 23, true);
    ExtractOptions options;
    options.ambiguity = ambiguity;
    options.triangulation = triangulation;
    options.work.threads = 1;
    const auto image = image_of<float>(field);
    const Surface contour = extract<double>(image.view(), 0.0, options);
    const auto found = intersecting_pairs(contour);
    triangles += contour.simplices.size();
    pairs += found.size();
    fields += !found.empty();
    for (const auto& pair : found) ++causes[cause(contour, pair)];
  }
  std::printf("%s,%zu,%zu,%zu,%zu,", name.c_str(), count, triangles, fields, pairs);
  for (const auto& [what, number] : causes) std::printf(" %s: %zu;", what.c_str(), number);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (tegl::bench::tells_usage(argc, argv,
                               "self_intersections [FIELDS]: triangles of contours of noise that intersect, as CSV"))
    return 0;
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 2000;
  std::printf("way,fields,triangles,fields with pairs,pairs,causes\n");
  for (const auto& [triangulation, suffix] :
       {std::pair{Triangulation::compact, "compact"}, std::pair{Triangulation::barycentric, "barycentric"}}) {
    measure(count, Ambiguity::low, triangulation, std::string("low ") + suffix);
    measure(count, Ambiguity::high, triangulation, std::string("high ") + suffix);
    measure(count, Ambiguity::mean, triangulation, std::string("mean ") + suffix);
    measure(count, Ambiguity::saddle, triangulation, std::string("saddle ") + suffix);
    measure(count, Ambiguity::squares, triangulation, std::string("squares ") + suffix);
    measure(count, Ambiguity::decider, triangulation, std::string("decider ") + suffix);
  }
}
