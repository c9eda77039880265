// SPDX-License-Identifier: BSD-3-Clause
//
// measure_convergence: relative errors of sizes and contents of contours with known ones, by the number of tiles along
// an axis, as CSV. bench/convergence plots them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "support/fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/measure.hpp"
#include "usage.hpp"

namespace {

using tegl::test::Ball;

void print(const char* name, std::size_t tiles, double size_error, double content_error) {
  std::printf("%s,%zu,%.6e,%.6e\n", name, tiles, std::abs(size_error), std::abs(content_error));
}

template <int N, class Field>
void measure_field(const char* name, const Field& field, double half_width, double content,
                   const std::vector<std::size_t>& tiles) {
  for (const std::size_t count : tiles) {
    const auto image = tegl::test::sample_field<double>(tegl::test::centred_grid<N>(count + 1, half_width), field);
    const tegl::Measures<N> found = tegl::measure(tegl::extract<double>(image.view(), 0.0));
    print(name, count, found.size / field.surface() - 1, found.content.value() / content - 1);
  }
}

/// The maximum errors of area and volume over 50 times between the samples.
void measure_expanding_ball(const std::vector<std::size_t>& tiles) {
  const auto radius = [](double t) { return 0.5 + 0.2 * t + 0.1 * t * t; };
  const auto field = [&](const tegl::test::Point<4>& x) { return radius(x[3]) - std::hypot(x[0], x[1], x[2]); };
  std::vector<double> at;
  for (int i = 0; i < 50; ++i) at.push_back(-0.99 + 0.04 * i);
  for (const std::size_t count : tiles) {
    const auto image = tegl::test::sample_field<double>(tegl::test::centred_grid<4>(count + 1, 1.0), field);
    double size_error = 0;
    double content_error = 0;
    for (const tegl::CutMeasures& cut : tegl::measure_cuts(tegl::extract<double>(image.view(), 0.0), at)) {
      const Ball<3> exact{{}, radius(cut.at)};
      size_error = std::max(size_error, std::abs(cut.size / exact.surface() - 1));
      content_error = std::max(content_error, std::abs(cut.content.value() / exact.content() - 1));
    }
    print("slices of an expanding ball", count, size_error, content_error);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (tegl::bench::tells_usage(argc, argv, "measure_convergence: errors of contours by the number of tiles, as CSV"))
    return 0;
  std::printf("field,tiles,size,content\n");
  const tegl::test::RingTube<3> torus;
  const tegl::test::TorusTube torus4;
  measure_field<2>("circle", Ball<2>{{0.013, 0.007}, 0.75}, 1.0, Ball<2>{{}, 0.75}.content(),
                   {16, 32, 64, 128, 256, 512});
  measure_field<3>("sphere", Ball<3>{{0.013, 0.007, 0.02}, 0.75}, 1.0, Ball<3>{{}, 0.75}.content(),
                   {16, 32, 64, 128, 256});
  measure_field<4>("3-sphere", Ball<4>{{0.013, 0.007, 0.02, 0.03}, 0.75}, 1.0, Ball<4>{{}, 0.75}.content(),
                   {8, 16, 32, 64});
  measure_field<3>("torus", torus, 1.6, torus.content(), {16, 32, 64, 128, 256});
  measure_field<4>("3-torus", torus4, 1.7, torus4.surface() * torus4.tube / 2, {16, 32, 64});
  measure_expanding_ball({8, 16, 32, 64});
  return 0;
}
