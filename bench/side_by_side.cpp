// SPDX-License-Identifier: BSD-3-Clause
//
// The functions of side_by_side.hpp for tegl, and the fields.
#include "side_by_side.hpp"

#include <stdexcept>
#include <string>

#include "bandwidth.hpp"
#include "fields.hpp"
#include "run.hpp"
#include "side_measure.hpp"

namespace tegl::bench {
namespace {

template <int N>
void run_tegl(const float* data, std::size_t samples, double isovalue, int threads, int normals, SideResult& result) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  const Image<float, N> image(data, Grid<N>::unit(sizes));
  const ExtractOptions options = with_normals(with_threads(ExtractOptions{}, threads), normals != 0);
  const auto [contour, stats] = measured(result, [&] { return extract_with_stats(image, isovalue, options); });
  result.vertices = contour.vertices.size();
  result.simplices = contour.simplices.size();
  result.active_tiles = stats.active_tiles;
  result.stage_seconds[0] = stats.classify_seconds;
  result.stage_seconds[1] = stats.find_seconds;
  result.stage_seconds[2] = stats.generate_seconds;
  result.stage_seconds[3] = stats.close_seconds;
  set_output_bytes(result, {contour.vertices.size() * sizeof(contour.vertices[0]),
                            contour.normals.size() * sizeof(contour.vertices[0]),
                            contour.simplices.size() * sizeof(contour.simplices[0])});
}

}  // namespace

std::string& last_error() {
  thread_local std::string text;
  return text;
}

}  // namespace tegl::bench

using namespace tegl::bench;

const char* side_error() { return last_error().c_str(); }

int side_memory_rates(int threads, double* read, double* fresh_write) {
  return guarded([&] {
    constexpr std::size_t kBytes = std::size_t{512} << 20U;
    *read = read_rate(kBytes, threads);
    *fresh_write = fresh_write_rate(kBytes, threads, true);
  });
}

int side_field(const char* name, int dim, std::size_t samples, float* out) {
  return guarded([&] {
    if (dim == 2) return fill_field<2>(name, samples, out);
    if (dim == 3) return fill_field<3>(name, samples, out);
    if (dim == 4) return fill_field<4>(name, samples, out);
    throw std::runtime_error("dimension " + std::to_string(dim) + "; expected 2, 3 or 4");
  });
}

int side_tegl(int dim, const float* data, std::size_t samples, double isovalue, int threads, int normals,
              SideResult* result) {
  return guarded([&] {
    if (dim == 2) return run_tegl<2>(data, samples, isovalue, threads, normals, *result);
    if (dim == 3) return run_tegl<3>(data, samples, isovalue, threads, normals, *result);
    if (dim == 4) return run_tegl<4>(data, samples, isovalue, threads, normals, *result);
    throw std::runtime_error("dimension " + std::to_string(dim) + "; expected 2, 3 or 4");
  });
}
