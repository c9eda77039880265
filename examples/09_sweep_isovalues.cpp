// SPDX-License-Identifier: BSD-3-Clause
//
// Example 9: contours at many isovalues. An index is built once; each contour then takes time in proportion to its own
// size instead of the image's.
#include <tegl/active_tiles.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

int main() {
  // A few bumps in an otherwise empty volume.
  constexpr std::size_t kSize = 96;
  std::vector<std::uint8_t> values(kSize * kSize * kSize);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = static_cast<double>(i % kSize), y = static_cast<double>(i / kSize % kSize);
    const double z = static_cast<double>(i / (kSize * kSize));
    double sum = 0;
    for (const double at : {20.0, 45.0, 75.0})
      sum += 120 * std::exp(-(std::pow(x - at, 2) + std::pow(y - 48, 2) + std::pow(z - at, 2)) / 60);
    values[i] = static_cast<std::uint8_t>(sum);
  }
  const tegl::Image<std::uint8_t, 3> image(values.data(), tegl::Grid<3>::unit({kSize, kSize, kSize}));

  // [sweep]
  const auto index = tegl::build_active_tiles(image, tegl::ActiveMethod::span_space);
  for (double isovalue = 10.5; isovalue < 120; isovalue += 10) {
    const std::vector<tegl::TileNumber> tiles = index->find(isovalue);  // or only which tiles it passes
    const tegl::Contour<3> contour = tegl::extract(image, isovalue, *index);
    std::printf("at %5.1f: %zu tiles, %zu triangles\n", isovalue, tiles.size(), contour.simplices.size());
  }
  // [/sweep]

  // The contour equals the one without an index, byte by byte.
  const auto with = tegl::extract(image, 60.0, *index);
  const auto without = tegl::extract(image, 60.0);
  return with.vertices == without.vertices && with.simplices == without.simplices ? 0 : 1;
}
