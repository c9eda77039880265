// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of a mesh of tetrahedra or polyhedra, once per line of the standard input: the other side of
// mesh_contours.py, which takes turns with it.
//
//     mesh_contours MESH THREADS < COMMANDS
//
// MESH: the numbers of points P, cells C and F as 64-bit integers, 3 P doubles, 4 C 32-bit integers, P floats.
// Polyhedra (F > 0) have F integers instead of 4 C: of each cell the number of faces, of each face the number of
// corners and the corners. Commands: `plain` extracts at 0 without known edges, `known` with known edges, `edges` finds
// the edges of a new complex. Each answers with a line: milliseconds, vertices, simplices.
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

/// Polyhedra from the numbers of a file.
tegl::CellLists polyhedra_of(const std::vector<tegl::Index>& numbers) {
  tegl::CellLists lists;
  for (std::size_t at = 0; at < numbers.size();) {
    for (tegl::Index faces = numbers[at++]; faces > 0; --faces) {
      for (tegl::Index corners = numbers[at++]; corners > 0; --corners) lists.face_corners.push_back(numbers[at++]);
      lists.face_ends.push_back(lists.face_corners.size());
    }
    lists.types.push_back(tegl::CellType::polyhedron);
    lists.ends.push_back(0);
    lists.face_lists_ends.push_back(lists.face_ends.size());
  }
  return lists;
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
  const auto sizes = read<std::uint64_t>(in, 3);
  auto points = read<std::array<double, 3>>(in, sizes[0]);
  const auto corners = read<tegl::Index>(in, sizes[2] > 0 ? sizes[2] : 4 * sizes[1]);
  const auto values = read<float>(in, sizes[0]);
  tegl::Complex<3> plain = sizes[2] > 0 ? tegl::Complex<3>(std::move(points), polyhedra_of(corners))
                                        : tegl::Complex<3>(std::move(points), tegl::CellType::tetrahedron, corners);
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
