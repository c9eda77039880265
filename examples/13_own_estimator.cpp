// SPDX-License-Identifier: BSD-3-Clause
//
// Example 13: a custom estimator. Two fields, of one body and of two bodies, have the same high and low samples on a
// grid, and `mean` and `saddle` resolve both equally (their values differ by a constant): after J. Wilhelms and A. Van
// Gelder, Topological considerations in isosurface generation, 1990. Both are cubic, and a cubic estimate of the value
// at a face's centre, from the samples around it, distinguishes them.
//
//     13_own_estimator [FOLDER]     writes six surfaces there, for examples/render_estimators.py
#include <tegl/check.hpp>
#include <tegl/extract.hpp>
#include <tegl/io.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace {

/// An oval and a sheet along the diagonal of x and y. They are connected near the origin if `level` is above 0.
double field(double x, double y, double z, double level) {
  constexpr double kNeck = 3.0;
  const double along = (x + y) / std::sqrt(2.0) + kNeck, across = (x - y) / std::sqrt(2.0);
  return along * along * along - 3 * kNeck * kNeck * along + 2 * kNeck * kNeck * kNeck + level -
         4.25 * across * across - 7 * z * z;
}

/// The value at the centre of a face, by cubic interpolation along each of its axes from two samples on either side.
double middle(const tegl::AmbiguousFace& face) {
  constexpr std::array<double, 4> kWeights{-1.0 / 16, 9.0 / 16, 9.0 / 16, -1.0 / 16};
  double sum = 0;
  for (unsigned place = 0; place < 1u << (2 * face.dim()); ++place) {
    std::array<std::ptrdiff_t, 5> steps{};
    double weight = 1;
    for (unsigned a = 0, rest = place; a < unsigned(face.image_dim()); ++a) {
      if ((face.axes() >> a & 1u) == 0) continue;
      steps[a] = std::ptrdiff_t(rest % 4) - 1;
      weight *= kWeights[rest % 4];
      rest /= 4;
    }
    sum += weight * face.sample({steps.data(), std::size_t(face.image_dim())});
  }
  return sum;
}

tegl::tile::Choice cubic(const tegl::AmbiguousFace& face) {
  return middle(face) >= face.isovalue() ? tegl::tile::Choice::high : tegl::tile::Choice::low;
}

/// The contour at 0, on a grid with `fineness` steps per unit.
tegl::Contour<3, double> surface(double level, int fineness, const tegl::ExtractOptions& options) {
  const std::array<std::size_t, 3> sizes{std::size_t(13 * fineness + 1), std::size_t(13 * fineness + 1),
                                         std::size_t(12 * fineness + 1)};
  tegl::Grid<3> grid;
  const std::array<double, 3> first{-9.5, -9.5, -6};
  for (int a = 0; a < 3; ++a) grid.axes[a] = tegl::Axis::uniform(sizes[a], first[a], 1.0 / fineness);
  std::vector<double> values;
  for (std::size_t z = 0; z < sizes[2]; ++z)
    for (std::size_t y = 0; y < sizes[1]; ++y)
      for (std::size_t x = 0; x < sizes[0]; ++x)
        values.push_back(field(grid.axes[0][x], grid.axes[1][y], grid.axes[2][z], level));
  return tegl::extract<double>(tegl::Image<double, 3>(values.data(), grid), 0.0, options);
}

}  // namespace

int main(int argc, char** argv) {
  tegl::ExtractOptions mean, saddle, own;
  mean.ambiguity = tegl::Ambiguity::mean;
  saddle.ambiguity = tegl::Ambiguity::saddle;
  own.ambiguity = tegl::Ambiguity::custom;
  own.estimator.choose = cubic;
  own.estimator.reach = 1;  // samples beside the face

  struct Way {
    const char* name;
    int fineness;
    const tegl::ExtractOptions& options;
    std::array<std::uint64_t, 2> expected;
  };
  const std::array<Way, 4> ways{
      {{"fine", 8, mean, {1, 2}}, {"mean", 1, mean, {1, 1}}, {"saddle", 1, saddle, {1, 1}}, {"cubic", 1, own, {1, 2}}}};
  bool as_expected = true;
  for (const Way& way : ways)
    for (const int second : {0, 1}) {
      const auto contour = surface(second ? -1.0 : 1.0, way.fineness, way.options);
      const tegl::MeshReport report = tegl::check(contour);
      std::printf("%-6s %s field: %d component(s)\n", way.name, second ? "second" : "first", int(report.components));
      as_expected = as_expected && report.components == way.expected[second] && report.bad_links == 0;
      if (argc > 1)
        tegl::write_mesh(contour,
                         std::filesystem::path(argv[1]) / (std::string(way.name) + (second ? "_2.ply" : "_1.ply")));
    }
  return as_expected ? 0 : 1;
}
