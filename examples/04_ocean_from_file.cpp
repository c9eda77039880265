// SPDX-License-Identifier: BSD-3-Clause
//
// Example 4: a measured 4D file. Reads a year of ocean temperatures (longitude, latitude, depth, month; uneven depths,
// missing values on land) and slices the 20 degC surface 0.3 of the way from one month to the next.
#include <tegl/check.hpp>
#include <tegl/extract.hpp>
#include <tegl/io.hpp>
#include <tegl/slice.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <variant>

namespace {

/// The isosurface at `temperature`, sliced at `month`. Only the two adjacent months are contoured.
tegl::Contour<3> surface_at(const tegl::AnyImage& any, double temperature, double month) {
  // The file determines the value type; `visit` passes the image with its type.
  const auto hyperplane = tegl::Hyperplane<4>::across(3, month);
  return std::visit([&](const auto& owned) { return tegl::slice_image(owned.view(), temperature, hyperplane); },
                    std::get<tegl::AnyImageN<4>>(any));
}

int run(const char* in, const char* out) {
  const auto [image, info] = tegl::read_image(in);
  const tegl::Contour<3> surface = surface_at(image, 20.0, 7.3);
  tegl::write_mesh(surface, out);

  float deepest = 0.0F;
  for (const auto& vertex : surface.vertices) deepest = std::max(deepest, vertex[2]);
  const tegl::MeshReport report = tegl::check(surface);
  std::printf("%s: %s, '%s' in %s\n", in, info.format.c_str(), info.variable.c_str(), info.value_unit.c_str());
  std::printf("%s: %zu triangles in %zu components, down to %.0f %s\n", out, surface.simplices.size(),
              static_cast<std::size_t>(report.components), static_cast<double>(deepest), surface.axis_units[2].c_str());

  // The surface ends at coasts and at the sea surface; elsewhere it is a manifold without boundary.
  const bool manifold = report.nonmanifold_simplices == 0 && report.bad_links == 0 && report.orientation_conflicts == 0;
  return manifold && deepest > 200.0F && deepest <= 500.0F ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s ocean_temperature.nc OUT.ply\n", argv[0]);
    return 2;
  }
  try {
    return run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}
