// SPDX-License-Identifier: BSD-3-Clause
//
// Example 16: the surface of a mask. Linear interpolation of a mask's samples gives stair steps; relaxed positions give
// a smooth surface that separates the same samples.
#include <tegl/measure.hpp>
#include <tegl/positions.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

int main() {
  // A mask of 48 x 48 x 48 samples: a ball of radius 18.3.
  constexpr double kRadius = 18.3;
  std::vector<std::uint8_t> mask;
  for (int i = 0; i < 48 * 48 * 48; ++i)
    mask.push_back(std::hypot(i % 48 - 23.4, i / 48 % 48 - 23.7, i / 2304 - 24.1) < kRadius ? 1 : 0);
  const tegl::Image<std::uint8_t, 3> image(mask.data(), tegl::Grid<3>::unit({48, 48, 48}));

  tegl::PositionOptions positions;
  positions.rule = tegl::Positions::relaxed;
  const auto relaxed = tegl::extract_placed(image, 0.5, positions);
  const auto linear = tegl::extract(image, 0.5);

  const double kPi = 3.141592653589793, sphere = 4 * kPi * kRadius * kRadius, ball = sphere * kRadius / 3;
  const tegl::Measures<3> of_relaxed = tegl::measure(relaxed), of_linear = tegl::measure(linear);
  const auto percent = [](double value, double exact) { return 100 * (value / exact - 1); };
  std::printf("linear:  area %+.2f %%, volume %+.2f %%\n", percent(of_linear.size, sphere),
              percent(*of_linear.content, ball));
  std::printf("relaxed: area %+.2f %%, volume %+.2f %%\n", percent(of_relaxed.size, sphere),
              percent(*of_relaxed.content, ball));
  return relaxed.simplices.size() == linear.simplices.size() && std::abs(percent(of_relaxed.size, sphere)) < 2 &&
                 std::abs(percent(*of_relaxed.content, ball)) < 0.5
             ? 0
             : 1;
}
