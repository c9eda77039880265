// SPDX-License-Identifier: BSD-3-Clause
//
// Working memory of extractions besides image and contour, in per cent of the image, by counting every allocation: the
// table of bench/README.md. Measured on noise, the worst case, for images of float.
#include <cstdio>
#include <exception>
#include <string>

#include "counted_memory.hpp"
#include "fields.hpp"

namespace tegl::bench {
namespace {

template <int N>
double per_cent(const OwnedImage<float, N>& image, Triangulation triangulation, bool normals, unsigned threads) {
  ExtractOptions options;
  options.triangulation = triangulation;
  options.normals = normals ? tegl::Normals::differences : tegl::Normals::none;
  options.work.threads = threads;
  const auto bytes = static_cast<double>(test::bytes_beside(image, 0.0, options));
  return 100.0 * bytes / static_cast<double>(image.values.size() * sizeof(float));
}

template <int N>
void print_row(std::size_t samples) {
  const auto image = make_field<N>("noise", samples);
  std::printf("| %zu^%d ", samples, N);
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const bool normals : {false, true})
      std::printf("| %.1f %%, %.1f %% ", per_cent(image, triangulation, normals, 1),
                  per_cent(image, triangulation, normals, 4));
  std::printf("|\n");
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char**) {
  if (argc > 1) {
    std::printf("usage: working_memory\nmemory beside image and contour, in per cent of the image, of noise\n");
    return 0;
  }
  try {
    std::printf(
        "| image | compact, 1 and 4 threads | with normals | barycentric | with normals |\n|---|---|---|---|---|\n");
    for (const std::size_t samples : {512U, 2048U}) tegl::bench::print_row<2>(samples);
    for (const std::size_t samples : {64U, 128U, 192U}) tegl::bench::print_row<3>(samples);
    for (const std::size_t samples : {24U, 32U, 48U}) tegl::bench::print_row<4>(samples);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "working_memory: %s\n", error.what());
    return 1;
  }
}
