// SPDX-License-Identifier: BSD-3-Clause
//
// The cells that the literature on marching cubes distinguishes, and degenerate ones: small integers, isovalue 0 (a
// value of 0 is high), and the topology of the contour of the trilinear (or bilinear) interpolant.
//
// Cases are numbered as in E. V. Chernyaev, Marching Cubes 33: construction of topologically correct isosurfaces, 1995.
// Tests also exchange the signs of a cell and apply rotations and reflections.
#pragma once

#include <array>
#include <cstddef>

namespace tegl::test {

/// Corner v has coordinate v >> a & 1 on axis a.
template <std::size_t kCorners>
struct NamedCell {
  const char* name;
  std::array<int, kCorners> values;
  int components;  ///< components of the contour
  int euler;       ///< its Euler characteristic: 1 for each disc, 0 for a tunnel
  /// True if 0 is neither the value of a corner nor of a saddle in a face or in the cell. Then exchanging the signs
  /// does not change the contour.
  bool regular;
};

inline constexpr std::array<NamedCell<4>, 9> kNamedSquares = {{
    {"one corner", {1, -1, -1, -2}, 1, 1, true},
    {"an edge", {1, 2, -1, -3}, 1, 1, true},
    {"saddle below", {1, -2, -2, 3}, 2, 2, true},
    {"saddle above", {1, -1, -2, 3}, 2, 2, true},
    {"saddle at the isovalue", {1, -2, -2, 4}, 2, 2, false},
    {"line through two corners", {0, 1, -1, 0}, 1, 1, false},
    {"corner at the isovalue", {0, -1, -1, -1}, 1, 1, false},
    {"two corners across at the isovalue", {0, -1, -1, 0}, 2, 2, false},
    {"constant", {0, 0, 0, 0}, 0, 0, false},
}};

inline constexpr std::array<NamedCell<8>, 66> kNamedCubes = {{
    // Cases and sub-cases.
    {"1", {1, -1, -1, -1, -1, -1, -1, -1}, 1, 1, true},
    {"2", {1, 1, -1, -1, -1, -1, -1, -1}, 1, 1, true},
    {"3.1", {-1, 1, 1, -2, -1, -1, -1, -1}, 2, 2, true},
    {"3.2", {-1, 1, 2, -1, -1, -1, -1, -1}, 1, 1, true},
    {"4.1.1", {-1, -1, -1, 1, 1, -1, -1, -1}, 2, 2, true},
    {"4.1.2", {-1, -1, -1, 3, 4, -1, -1, -1}, 1, 0, true},
    {"5", {1, 1, 1, -1, -1, -1, -1, -1}, 1, 1, true},
    {"6.1.1", {1, -2, -1, 1, 2, -1, -1, -1}, 2, 2, true},
    {"6.1.2", {1, -2, -2, 3, 4, -1, -1, -1}, 1, 0, true},
    {"6.2", {2, -1, -1, 1, 1, -1, -1, -1}, 1, 1, true},
    {"7.1", {-2, 1, 1, -1, 1, -1, -1, -1}, 3, 3, true},
    {"7.2", {-2, 3, 1, -1, 1, -2, -1, -1}, 2, 2, true},
    {"7.3", {-1, 1, 1, -2, 2, -1, -1, -1}, 1, 1, true},
    {"7.4.1", {-1, 1, 2, -1, 2, -1, -1, -1}, 2, 2, true},
    {"7.4.2", {-3, 2, 2, -1, 2, -1, -1, -1}, 1, 0, true},
    {"8", {1, 1, 2, 1, -1, -1, -1, -1}, 1, 1, true},
    {"9", {1, 1, 1, -1, 1, -1, -1, -1}, 1, 1, true},
    {"10.1.1", {-1, -1, 1, 1, 1, 1, -2, -2}, 2, 2, true},
    {"10.1.1, faces joined", {-1, -1, 1, 2, 2, 1, -1, -1}, 2, 2, true},
    {"10.1.2", {-2, -2, 1, 4, 3, 1, -2, -3}, 1, 0, true},
    {"10.1.2, faces joined", {-1, -4, 2, 3, 2, 2, -3, -1}, 1, 0, true},
    {"10.2", {-1, -1, 1, 1, 2, 1, -1, -2}, 1, 1, true},
    {"11", {1, 1, -1, 1, 2, -1, -1, -1}, 1, 1, true},
    {"12.1.1", {-2, 1, 1, 1, 1, -1, -1, -1}, 2, 2, true},
    {"12.1.1, faces joined", {-1, 1, 1, 1, 2, -1, -1, -1}, 2, 2, true},
    {"12.1.2", {-3, 1, 1, 3, 2, -1, -1, -1}, 1, 0, true},
    {"12.1.2, faces joined", {-2, 1, 1, 1, 3, -1, -1, -3}, 1, 0, true},
    {"12.2", {-1, 1, 2, 1, 1, -2, -1, -1}, 1, 1, true},
    {"13.1", {1, -2, -1, 1, -2, 1, 1, -2}, 4, 4, true},
    {"13.1, faces joined", {2, -1, -1, 1, -1, 2, 2, -1}, 4, 4, true},
    {"13.2", {1, -3, -1, 2, -2, 1, 1, -1}, 3, 3, true},
    {"13.2, faces joined", {2, -1, -1, 3, -1, 1, 1, -2}, 3, 3, true},
    {"13.3", {1, -2, -2, 1, -2, 1, 3, -1}, 2, 2, true},
    {"13.3, faces joined", {2, -1, -3, 2, -1, 2, 1, -1}, 2, 2, true},
    {"13.4", {1, -1, -2, 1, -1, 2, 1, -1}, 1, 1, true},
    {"13.5.1", {2, -1, -2, 2, -2, 2, 1, -2}, 3, 3, true},
    {"13.5.2, tunnel of high", {3, -1, -3, 4, -3, 4, 2, -3}, 2, 1, true},
    {"13.5.2, tunnel of low", {3, -2, -4, 3, -3, 3, 1, -4}, 2, 1, true},
    {"14", {1, -2, 1, 1, 1, -1, -1, -1}, 1, 1, true},
    // The saddle of a face is exactly at the isovalue: joined.
    {"3, saddle", {-1, 1, 1, -1, -1, -1, -1, -1}, 1, 1, false},
    {"6, saddle", {1, -1, -1, 1, 1, -1, -1, -1}, 1, 1, false},
    {"7, three saddles", {-1, 1, 1, -1, 1, -1, -1, -1}, 1, 0, false},
    {"10, two saddles", {-1, -1, 1, 1, 1, 1, -1, -1}, 2, 2, false},
    {"12, two saddles", {-1, 1, 1, 1, 1, -1, -1, -1}, 2, 2, false},
    {"13, all saddles: three planes", {1, -1, -1, 1, -1, 1, 1, -1}, 4, 4, false},
    {"two planes that cross", {1, -1, -1, 1, 1, -1, -1, 1}, 2, 2, false},
    // The body saddle is exactly at the isovalue: it joins high parts, not low ones.
    {"4, body saddle: a double cone", {-1, -1, -1, 3, 3, -1, -1, -1}, 1, 0, false},
    {"6, body saddle", {1, -2, -2, 3, 3, -1, -1, -1}, 1, 0, false},
    {"7, body saddle", {-1, 2, 1, -1, 2, -3, -1, -3}, 2, 2, false},
    {"10, body saddle", {-2, -2, 3, 1, 1, 3, -2, -2}, 1, 0, false},
    {"12, body saddle", {-4, 1, 1, 2, 3, -1, -1, -1}, 1, 0, false},
    {"13, body saddle of high", {4, -3, -3, 2, -3, 2, 2, -1}, 2, 1, false},
    {"13, body saddle of low", {3, -4, -2, 3, -2, 3, 1, -2}, 3, 3, false},
    // Values equal to the isovalue.
    {"constant", {0, 0, 0, 0, 0, 0, 0, 0}, 0, 0, false},
    {"corner, others low", {0, -1, -1, -1, -1, -1, -1, -1}, 1, 1, false},
    {"corner, others high", {0, 1, 1, 1, 1, 1, 1, 1}, 0, 0, false},
    {"edge, others low", {0, 0, -1, -1, -1, -1, -1, -1}, 1, 1, false},
    {"plane in a face, others low", {0, 0, 0, 0, -1, -1, -1, -1}, 1, 1, false},
    {"plane in a face, others high", {0, 0, 0, 0, 1, 1, 1, 1}, 0, 0, false},
    {"two corners across a face, others low", {-1, 0, 0, -1, -1, -1, -1, -1}, 2, 2, false},
    {"two corners across the cube, others low", {-1, -1, -1, 0, 0, -1, -1, -1}, 2, 2, false},
    {"every other corner, others low", {0, -1, -1, 0, -1, 0, 0, -1}, 4, 4, false},
    {"plane through two edges", {0, 1, -1, 0, 0, 1, -1, 0}, 1, 1, false},
    {"plane through three corners", {-1, 0, 0, 1, 0, 1, 1, 2}, 1, 1, false},
    {"plane through a corner", {0, -1, -1, -2, -1, -2, -2, -3}, 1, 1, false},
    {"corner and three saddles", {0, 1, 1, -1, 1, -1, -1, 1}, 3, 3, false},
}};

}  // namespace tegl::test
