// SPDX-License-Identifier: BSD-3-Clause
//
// Time of contours on lattices, beside cubic samples and beside the lattice's complex; or on curved grids and with
// periodic axes, beside the plain contour: a gyroid with equally many samples, one thread, processor time, several runs
// taken in turn, of lattices the minimum.
//
//     lattice_bench [SAMPLES_ALONG_AXIS] [RUNS]
//     lattice_bench curved [SAMPLES_ALONG_AXIS] [RUNS]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "tegl/curved.hpp"
#include "tegl/lattice.hpp"
#include "tegl/periodic.hpp"
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
std::vector<float> gyroid(std::size_t n, double layer, double size = 50.0) {
  std::vector<float> values;
  const double step = size / static_cast<double>(n) / std::cbrt(layer);
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

/// The coordinates of axis `axis` in an array along `axes` axes: those of the samples, moved by waves.
std::vector<double> coordinates(std::size_t n, int axis, int axes) {
  std::vector<double> values;
  const double turn = 12.0 / static_cast<double>(n);
  const std::size_t layers = axes > 2 ? n : 1;
  for (std::size_t k = 0; k < layers; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) {
        const std::array<double, 3> index = {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
        const auto a = static_cast<std::size_t>(axis);
        values.push_back(index[a] + 2.0 * std::sin(turn * index[(a + 1) % 3]));
      }
  return values;
}

/// The first value of each line of 64 bytes that the vertices of a contour on a unit grid need of an array with a value
/// per sample, in the order of the vertices.
std::vector<const double*> needed_lines(const Contour<3, double>& contour, std::size_t n,
                                        const std::vector<double>& values) {
  std::vector<const double*> lines;
  std::vector<bool> is_needed(values.size() / 8 + 1);
  for (const auto& vertex : contour.vertices) {
    std::size_t first = 0, second = 0;
    for (std::size_t a = 3; a-- > 0;) {
      first = first * n + static_cast<std::size_t>(std::floor(vertex[a]));
      second = second * n + static_cast<std::size_t>(std::ceil(vertex[a]));
    }
    for (const std::size_t at : {first, second}) {
      if (is_needed[at / 8]) continue;
      is_needed[at / 8] = true;
      lines.push_back(values.data() + at / 8 * 8);
    }
  }
  return lines;
}

/// Reads a value of each of the lines, which are requested ahead.
double read_lines(const std::vector<const double*>& lines) {
  constexpr std::size_t kAhead = 24;
  double sum = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    __builtin_prefetch(lines[std::min(i + kAhead, lines.size() - 1)]);
    sum += *lines[i];
  }
  return sum;
}

struct Grids {
  const char* name;
  std::function<std::size_t()> run;  ///< returns the number of vertices
  std::size_t vertices = 0;
  std::vector<double> seconds = {};
};

/// Contours on curved grids and with periodic axes beside the plain one.
int measure_curved(std::size_t n, int runs) {
  ExtractOptions options;
  options.work.threads = 1;
  const Grid<3> grid = Grid<3>::unit({n, n, n});
  const std::vector<float> values = gyroid(n, 1.0, 26.0);
  const Image<float, 3> image(values.data(), grid);
  const std::vector<double> x2 = coordinates(n, 0, 2), y2 = coordinates(n, 1, 2);
  const std::array<std::vector<double>, 3> of_all = {coordinates(n, 0, 3), coordinates(n, 1, 3), coordinates(n, 2, 3)};
  const std::vector<CurvedAxis> two = {{0, 0b011, x2}, {1, 0b011, y2}};
  const std::vector<CurvedAxis> three = {{0, 0b111, of_all[0]}, {1, 0b111, of_all[1]}, {2, 0b111, of_all[2]}};
  std::array<std::vector<const double*>, 3> lines;
  const Contour<3, double> plain = extract<double>(image, 0.01, options);
  for (std::size_t a = 0; a < 3; ++a) lines[a] = needed_lines(plain, n, of_all[a]);
  const auto periodic = [&](std::vector<int> axes) {
    return extract_periodic(image, sample_periods<3>(grid, axes), 0.01, options).vertices.size();
  };
  std::vector<Grids> cases = {
      {"plain", [&] { return extract(image, 0.01, options).vertices.size(); }},
      {"two coordinates in 2D arrays", [&] { return extract_curved(image, two, 0.01, options).vertices.size(); }},
      {"three coordinates in 3D arrays", [&] { return extract_curved(image, three, 0.01, options).vertices.size(); }},
      {"reading the lines of the three arrays once",
       [&] {
         double sum = 0.0;
         for (const auto& of_axis : lines) sum += read_lines(of_axis);
         return std::isfinite(sum) ? plain.vertices.size() : 0;
       }},
      {"last axis periodic", [&] { return periodic({2}); }},
      {"first axis periodic", [&] { return periodic({0}); }},
      {"all axes periodic", [&] {
         return periodic({0, 1, 2});
       }}};
  for (int run = 0; run <= runs; ++run)  // the first is a rehearsal
    for (Grids& each : cases) {
      const double start = bench::worked_seconds();
      each.vertices = each.run();
      if (run > 0) each.seconds.push_back(bench::worked_seconds() - start);
    }
  for (Grids& each : cases) std::sort(each.seconds.begin(), each.seconds.end());
  const auto median = [](const Grids& of) { return of.seconds[of.seconds.size() / 2]; };
  std::printf("| %zu^3 samples | vertices | median, ms | minimum, ms | median by the plain one | minimum by it |\n", n);
  std::printf("|---|---|---|---|---|---|\n");
  for (const Grids& each : cases)
    std::printf("| %s | %zu | %.1f | %.1f | %.2f | %.2f |\n", each.name, each.vertices, 1e3 * median(each),
                1e3 * each.seconds.front(), median(each) / median(cases.front()),
                each.seconds.front() / cases.front().seconds.front());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "curved")
    return measure_curved(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 256,
                          argc > 3 ? std::max(1, std::atoi(argv[3])) : 15);
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
