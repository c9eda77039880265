// SPDX-License-Identifier: BSD-3-Clause
//
// Time of contours on lattices, beside cubic samples and beside the lattice's complex: a gyroid with equally many
// samples, one thread, processor time, minimum of several runs taken in turn.
//
//     lattice_bench [SAMPLES_ALONG_AXIS] [RUNS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <vector>

#include "tegl/lattice.hpp"
#include "timing.hpp"

namespace {

using namespace tegl;

struct Case {
  const char* name;
  std::function<ExtractStats()> run;
  ExtractStats best = {};
  double seconds = std::numeric_limits<double>::infinity();
};

/// Samples of a gyroid in a box of equal volume per sample; `layer`: distance of layers in steps; 1: not staggered.
std::vector<float> gyroid(std::size_t n, double layer) {
  std::vector<float> values;
  const double step = 50.0 / static_cast<double>(n) / std::cbrt(layer);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) {
        const double half = layer < 1.0 && k % 2 == 1 ? 0.5 : 0.0;
        const double x = step * (static_cast<double>(i) + half), y = step * (static_cast<double>(j) + half);
        const double z = step * layer * static_cast<double>(k);
        values.push_back(
            static_cast<float>(std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x)));
      }
  return values;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t n = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 192;
  const int runs = argc > 2 ? std::atoi(argv[2]) : 7;
  ExtractOptions options;
  options.work.threads = 1;
  const Grid<3> grid = Grid<3>::unit({n, n, n});
  const std::vector<float> cubic = gyroid(n, 1.0);
  const std::vector<float> fcc = gyroid(n, layer_step(Lattice::fcc)), bcc = gyroid(n, layer_step(Lattice::bcc));
  const Image<float, 3> cubic_image(cubic.data(), grid), fcc_image(fcc.data(), grid), bcc_image(bcc.data(), grid);
  const Complex<3> complex = lattice_complex(fcc_image, Lattice::fcc);
  std::vector<Case> cases = {
      {"cubic", [&] { return extract_with_stats(cubic_image, 0.01, options).stats; }},
      {"fcc", [&] { return extract_lattice_with_stats(fcc_image, Lattice::fcc, 0.01, options).stats; }},
      {"bcc", [&] { return extract_lattice_with_stats(bcc_image, Lattice::bcc, 0.01, options).stats; }},
      {"fcc, complex", [&] { return extract_with_stats(complex, 0.01, options).stats; }}};
  for (int run = 0; run < runs; ++run)
    for (Case& each : cases) {
      const double start = bench::worked_seconds();
      const ExtractStats stats = each.run();
      const double seconds = bench::worked_seconds() - start;
      if (seconds >= each.seconds) continue;
      each.seconds = seconds;
      each.best = stats;
    }
  std::printf(
      "| %zu^3 samples | active cells | ms | classify, ns per sample | ns per active cell |\n|---|---|---|---|---|\n",
      n);
  const auto samples = static_cast<double>(n * n * n);
  for (const Case& each : cases)
    std::printf("| %s | %zu | %.1f | %.3f | %.1f |\n", each.name, static_cast<std::size_t>(each.best.active_tiles),
                1e3 * each.seconds, 1e9 * each.best.classify_seconds / samples,
                1e9 * each.seconds / static_cast<double>(each.best.active_tiles));
}
