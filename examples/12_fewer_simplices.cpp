// SPDX-License-Identifier: BSD-3-Clause
//
// Example 12: simplification with a bounded error. A sphere keeps only as many triangles as its error bound of a
// twentieth of a grid step requires; the result comes with a proved bound.
#include <tegl/check.hpp>
#include <tegl/deviation.hpp>
#include <tegl/extract.hpp>
#include <tegl/simplify.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  constexpr std::size_t kSize = 40;
  std::vector<float> values;
  for (std::size_t i = 0; i < kSize * kSize * kSize; ++i)
    values.push_back(static_cast<float>(15.0 - std::hypot(static_cast<double>(i % kSize) - 19.5,
                                                          static_cast<double>(i / kSize % kSize) - 19.5,
                                                          static_cast<double>(i / (kSize * kSize)) - 19.5)));
  const tegl::Image<float, 3> image(values.data(), tegl::Grid<3>::unit({kSize, kSize, kSize}));
  const auto contour = tegl::extract<double>(image, 0.0);

  tegl::SimplifyOptions<3> options;
  options.max_error = 0.05;  // maximum distance between the contours, in both directions
  const auto [small, stats] = tegl::simplify(contour, options);
  std::printf("%llu -> %llu triangles, error at most %.4f\n", static_cast<unsigned long long>(stats.simplices_before),
              static_cast<unsigned long long>(stats.simplices_after), *stats.error());

  // The same kind of bounds for any two contours, in one direction: from points of the original to the result.
  const tegl::Deviation far = tegl::deviation(contour, small);
  std::printf("between %.4f and %.4f\n", far.least, far.bound);

  const tegl::MeshReport report = tegl::check(small);
  const bool right = report.euler == 2 && report.boundary_simplices == 0 && report.bad_links == 0 &&
                     small.simplices.size() < contour.simplices.size() / 4 && *stats.error() <= 0.05 &&
                     far.least <= far.bound && far.bound <= 0.05;
  return right ? 0 : 1;
}
