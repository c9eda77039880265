// SPDX-License-Identifier: BSD-3-Clause
//
// The experiment of the FCC paper: contours of a volume on the face-centred cubic lattice at many isovalues, with an
// interval tree of its cells, without it, and by rows of bits. Reads uint16 samples, writes a table for
// scripts/fcc_figures.
//
//     fcc_intervals FILE I J K STEP [ISOVALUES] [RUNS]
//
// STEP: distance of layers in steps along the other axes. Prints the milliseconds to build the tree, its bytes and the
// number of cells; then for each isovalue: active cells, milliseconds to search the tree, in all with the tree, in all
// without, and by rows of bits. One thread, processor time, minimum of the runs.
//
// Based on: T. Takahashi, I. Ide, Y. Mekada, H. Murase, T. Yonekura, A speedup method for isosurfacing volumetric data
// sampled with a face-centered cubic lattice, 2005, section 4.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "tegl/cell_index.hpp"
#include "tegl/lattice.hpp"
#include "timing.hpp"

int main(int argc, char** argv) {
  using namespace tegl;
  if (argc < 6) return std::fprintf(stderr, "usage: fcc_intervals FILE I J K STEP [ISOVALUES] [RUNS]\n"), 2;
  std::array<std::size_t, 3> sizes;
  for (std::size_t a = 0; a < 3; ++a) sizes[a] = std::strtoul(argv[2 + a], nullptr, 10);
  const int isovalues = argc > 6 ? std::atoi(argv[6]) : 24, runs = argc > 7 ? std::atoi(argv[7]) : 3;
  std::vector<std::uint16_t> values(sizes[0] * sizes[1] * sizes[2]);
  std::ifstream file(argv[1], std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(2 * values.size())))
    return std::fprintf(stderr, "fcc_intervals: %s: fewer than %zu samples\n", argv[1], values.size()), 2;
  Grid<3> grid = Grid<3>::unit(sizes);
  grid.axes[2] = Axis::uniform(sizes[2], 0.0, std::atof(argv[5]));
  const Image<std::uint16_t, 3> image(values.data(), grid);

  const Complex<3> complex = lattice_complex(image, Lattice::fcc);
  const double start = bench::worked_seconds();
  const CellIndex index(complex);
  std::printf("%.1f %zu %zu\n", 1e3 * (bench::worked_seconds() - start), index.bytes(), complex.cell_count());
  const auto milliseconds = [&](const auto& work) { return 1e3 * bench::least_seconds(work, runs); };
  ExtractOptions options;
  options.work.threads = 1;
  std::size_t sum = 0;  // of sizes, so that no call is left out
  for (int i = 1; i <= isovalues; ++i) {
    const double isovalue = 65535.0 * i / (isovalues + 1) + 0.5;
    const std::size_t active = extract_with_stats(complex, index, isovalue, options).stats.active_tiles;
    const double search = milliseconds([&] { sum += index.find(isovalue).size(); });
    const double with = milliseconds([&] { sum += extract(complex, index, isovalue, options).simplices.size(); });
    const double without = milliseconds([&] { sum += extract(complex, isovalue, options).simplices.size(); });
    const double rows =
        milliseconds([&] { sum += extract_lattice(image, Lattice::fcc, isovalue, options).simplices.size(); });
    std::printf("%.1f %zu %.3f %.3f %.3f %.3f\n", isovalue, active, search, with, without, rows);
    std::fflush(stdout);
  }
  return sum == 0 ? 1 : 0;
}
