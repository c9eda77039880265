// SPDX-License-Identifier: BSD-3-Clause
//
// Uses the installed file formats: consumer_io IMAGE OUT writes the contour of a 4D image at 20, sliced at t = 7.3.
#include <cstdio>

#include "tegl/io.hpp"
#include "tegl/slice.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: consumer_io IMAGE OUT\n");
    return 2;
  }
  try {
    const tegl::ReadImageResult file = tegl::read_image(argv[1]);
    const auto& image = std::get<tegl::OwnedImage<float, 4>>(std::get<tegl::AnyImageN<4>>(file.image));
    const auto cut = tegl::slice_image(image.view(), 20.0, tegl::Hyperplane<4>::across(3, 7.3));
    tegl::write_mesh(cut, argv[2]);
    std::printf("%s: %zu triangles\n", argv[2], cut.simplices.size());
    return cut.simplices.empty() ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer_io: %s\n", error.what());
    return 1;
  }
}
