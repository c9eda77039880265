// SPDX-License-Identifier: BSD-3-Clause
//
// Example 14: meshes. A tetrahedral mesh with a value at each point has a closed surface; with values at several times
// it has a hypersurface, whose slice at a time step is the surface of that step.
#include <tegl/check.hpp>
#include <tegl/complex.hpp>
#include <tegl/slice.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

constexpr tegl::Index kSide = 21;  // points along each axis

std::vector<std::array<double, 3>> make_points() {
  std::vector<std::array<double, 3>> points;
  for (tegl::Index p = 0; p < kSide * kSide * kSide; ++p)
    points.push_back({0.1 * (p % kSide) - 1, 0.1 * (p / kSide % kSide) - 1, 0.1 * (p / (kSide * kSide)) - 1});
  return points;
}

/// Six tetrahedra in each cube of eight points.
std::vector<tegl::Index> make_tetrahedra() {
  const std::array<std::array<tegl::Index, 3>, 6> paths = {
      {{1, 3, 7}, {1, 5, 7}, {2, 3, 7}, {2, 6, 7}, {4, 5, 7}, {4, 6, 7}}};  // from corner 0 along edges to corner 7
  std::vector<tegl::Index> corners;
  for (tegl::Index k = 0; k + 1 < kSide; ++k)
    for (tegl::Index j = 0; j + 1 < kSide; ++j)
      for (tegl::Index i = 0; i + 1 < kSide; ++i) {
        const auto at = [=](tegl::Index v) {
          return (i + (v & 1)) + kSide * ((j + (v >> 1 & 1)) + kSide * (k + (v >> 2)));
        };
        for (const auto& path : paths) corners.insert(corners.end(), {at(0), at(path[0]), at(path[1]), at(path[2])});
      }
  return corners;
}

/// A ball that moves along the x axis.
std::vector<double> ball_at(double x, const std::vector<std::array<double, 3>>& points) {
  std::vector<double> values;
  for (const auto& p : points) values.push_back(0.45 - std::hypot(p[0] - x, p[1], p[2]));
  return values;
}

}  // namespace

int main() {
  const std::vector<std::array<double, 3>> points = make_points();
  const std::vector<tegl::Index> tetrahedra = make_tetrahedra();

  // The cells are numbers of points, in VTK's order of corners.
  tegl::Complex<3> mesh(points, tegl::CellType::tetrahedron, tetrahedra);
  mesh.set_values(ball_at(0.0, points));
  const tegl::Contour<3> surface = tegl::extract(mesh, 0.0);
  const tegl::MeshReport report = tegl::check(surface);
  std::printf("%zu triangles, Euler characteristic %lld\n", surface.simplices.size(),
              static_cast<long long>(report.euler));

  // Several isovalues, or values at several times: the edges are found once.
  mesh.find_edges();
  const tegl::Contour<3> inner = tegl::extract(mesh, 0.2);

  // Values at three times: a hypersurface in space and time.
  const std::vector<double> times = {0.0, 1.0, 2.0};
  std::vector<double> values;
  for (const double t : times)
    for (const double value : ball_at(0.2 * t, points)) values.push_back(value);
  const tegl::Complex<4> moving = tegl::in_time(mesh, times, values);
  const tegl::Contour<4> hypersurface = tegl::extract(moving, 0.0);
  const tegl::Contour<3> between = tegl::slice(hypersurface, tegl::Hyperplane<4>::across(3, 0.5));
  const tegl::MeshReport cut = tegl::check(between);
  std::printf("%zu triangles at t = 0.5, Euler characteristic %lld\n", between.simplices.size(),
              static_cast<long long>(cut.euler));

  const auto is_sphere = [](const tegl::MeshReport& r) {
    return r.euler == 2 && r.boundary_simplices == 0 && r.bad_links == 0 && r.orientation_conflicts == 0;
  };
  return is_sphere(report) && is_sphere(cut) && is_sphere(tegl::check(inner)) ? 0 : 1;
}
