// SPDX-License-Identifier: BSD-3-Clause
//
// Uses the core from outside: the contour of a ball in 4D, its cut at a time between two steps, and their
// invariants. Returns 0 only if these are as they must be.
#include <cstdio>
#include <vector>

#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"

int main() {
  constexpr std::size_t kSize = 12;
  std::vector<float> values;
  for (std::size_t t = 0; t < kSize; ++t)
    for (std::size_t z = 0; z < kSize; ++z)
      for (std::size_t y = 0; y < kSize; ++y)
        for (std::size_t x = 0; x < kSize; ++x) {
          float value = 20.0F;
          for (const std::size_t c : {x, y, z, t})
            value -= (static_cast<float>(c) - 5.5F) * (static_cast<float>(c) - 5.5F);
          values.push_back(value);
        }
  const tegl::Image<float, 4> image(values.data(), tegl::Grid<4>::unit({kSize, kSize, kSize, kSize}));
  const auto contour = tegl::extract(image, 0.0);
  const tegl::MeshReport whole = tegl::check(contour);
  const tegl::MeshReport cut = tegl::check(tegl::slice(contour, 5.3));
  std::printf("4D: %zu tetrahedra, Euler characteristic %lld; cut: %zu triangles, Euler characteristic %lld\n",
              static_cast<std::size_t>(whole.simplices), static_cast<long long>(whole.euler),
              static_cast<std::size_t>(cut.simplices), static_cast<long long>(cut.euler));
  const bool sound = whole.components == 1 && whole.boundary_simplices == 0 && whole.euler == 0 &&
                     cut.components == 1 && cut.boundary_simplices == 0 && cut.euler == 2;
  return sound ? 0 : 1;
}
