// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of a tetrahedral mesh, once per line of the standard input: the other side of mesh_contours.py, which takes
// turns with it.
//
//     mesh_contours MESH THREADS < COMMANDS
//
// MESH: the numbers of points P and cells C as 64-bit integers, 3 P doubles, 4 C 32-bit integers, P floats. Commands:
// `plain` extracts at 0 without known edges, `known` with known edges, `edges` finds the edges of a new complex. Each
// answers with a line: milliseconds, vertices, simplices.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tegl/complex.hpp"

namespace {

template <class T>
std::vector<T> read(std::ifstream& in, std::size_t count) {
  std::vector<T> result(count);
  in.read(reinterpret_cast<char*>(result.data()), static_cast<std::streamsize>(count * sizeof(T)));
  return result;
}

/// Processor time of this program with one thread, which other programs on the machine hardly influence; else time.
double now(unsigned threads) {
  std::timespec time{};
  clock_gettime(threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

int main(int argc, char** argv) {
  std::ifstream in(argc > 2 ? argv[1] : "", std::ios::binary);
  if (!in) {
    std::cerr << "mesh_contours: expected a mesh that mesh_contours.py wrote, and a number of threads\n";
    return 2;
  }
  const auto sizes = read<std::uint64_t>(in, 2);
  auto points = read<std::array<double, 3>>(in, sizes[0]);
  const auto corners = read<tegl::Index>(in, 4 * sizes[1]);
  const auto values = read<float>(in, sizes[0]);
  tegl::Complex<3> plain(std::move(points), tegl::CellType::tetrahedron, corners);
  plain.set_values<float>(values);
  tegl::Complex<3> known = plain;
  tegl::ExtractOptions options;
  options.work.threads = static_cast<unsigned>(std::atoi(argv[2]));
  known.find_edges(options.work);
  for (std::string command; std::getline(std::cin, command);) {
    tegl::Contour<3> contour;
    std::optional<tegl::Complex<3>> fresh;
    if (command == "edges") fresh = plain;
    const double start = now(options.work.threads);
    if (command == "edges")
      fresh->find_edges(options.work);
    else
      contour = tegl::extract(command == "known" ? known : plain, 0.0, options);
    const double time = now(options.work.threads) - start;
    std::cout << time << ' ' << contour.vertices.size() << ' ' << contour.simplices.size() << std::endl;
  }
  return 0;
}
