// SPDX-License-Identifier: BSD-3-Clause
//
// The C++ snippets of docs/builders.md, between [name] and [/name]: a contour made cell by cell with the emitted
// builder of the cube is closed.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "builder3.hpp"
#include "builder5.hpp"

namespace {

using Point = std::array<float, 3>;

// [position]
/// Position of a vertex of the contour in the unit cube.
Point position(const tegl::builders::CubeContour& contour, unsigned vertex, const std::array<float, 8>& values,
               float isovalue) {
  if (vertex < 12) {  // the point on an edge: along axis e / 4 from the edge's lower corner
    const unsigned axis = vertex / 4, below = (1u << axis) - 1;
    const unsigned from = (vertex % 4 & below) | (vertex % 4 & ~below) << 1, to = from | 1u << axis;
    Point point = {float(from & 1u), float(from >> 1 & 1u), float(from >> 2)};
    point[axis] = (isovalue - values[from]) / (values[to] - values[from]);
    return point;
  }
  const unsigned mask = contour.masks[vertex - 12];
  Point mean = {};
  float count = 0;
  for (unsigned bit = 0; bit < 20; ++bit) {
    if ((mask >> bit & 1u) == 0) continue;
    const Point point = bit < 8 ? Point{float(bit & 1u), float(bit >> 1 & 1u), float(bit >> 2)}
                                : position(contour, bit - 8, values, isovalue);
    for (unsigned i = 0; i < 3; ++i) mean[i] += point[i];
    ++count;
  }
  const bool has_corner = (mask & 0xffu) != 0;
  for (float& x : mean) x = has_corner ? (x / count + 0.5f) / 2 : x / count;
  return mean;
}
// [/position]

// [cell]
/// The contour in a cell with these values at its corners, x fastest. The asymptotic decider resolves its squares.
tegl::builders::CubeContour contour_of_cell(const std::array<float, 8>& values, float isovalue) {
  unsigned signature = 0, high_squares = 0;
  for (unsigned v = 0; v < 8; ++v)
    if (values[v] >= isovalue) signature |= 1u << v;
  for (unsigned q = 0; q < 6; ++q) {
    const unsigned axis = q / 2, first = (q % 2) << axis;  // lowest corner of square q
    const unsigned u = axis == 0 ? 2 : 1, v = axis == 2 ? 2 : 4;
    const float a = values[first] - isovalue, b = values[first + u] - isovalue;
    const float c = values[first + v] - isovalue, d = values[first + u + v] - isovalue;
    if (a >= 0 ? a * d >= b * c : b * c >= a * d) high_squares |= 1u << q;  // ignored if it is not ambiguous
  }
  tegl::builders::CubeContour contour;
  tegl::builders::build_cube(signature, high_squares, tegl::builders::Choice::separate, contour);
  return contour;
}
// [/cell]

// [five]
/// Number of 4-simplices in a 5D cell whose high corners are the bits of `signature`, with all faces separate.
std::size_t simplices_of_cell(std::uint32_t signature) {
  thread_local tegl::builders::FiveCubeBuilder builder;
  tegl::builders::FiveKey key;
  key.signature = signature;
  return builder.build(key).simplices.size();
}
// [/five]

TEST(CellExample, OneHighCornerOfA5DCellIsCutOffByOneSimplex) {
  EXPECT_EQ(simplices_of_cell(1), 1u);
  EXPECT_EQ(simplices_of_cell(0), 0u);
}

TEST(BuilderPage, CellsOfNoiseMakeAClosedContour) {
  constexpr int kSize = 9;
  constexpr float kIsovalue = 0.25f;
  std::mt19937 random(3);
  std::array<float, kSize * kSize * kSize> samples;
  for (int i = 0; i < kSize * kSize * kSize; ++i) {
    const int x = i % kSize, y = i / kSize % kSize, z = i / kSize / kSize;
    const bool inside = x > 0 && y > 0 && z > 0 && x + 1 < kSize && y + 1 < kSize && z + 1 < kSize;
    samples[static_cast<std::size_t>(i)] = inside ? static_cast<float>(random() % 21) - 10 : -1;
  }
  std::map<std::pair<Point, Point>, int> sides;
  int ambiguous = 0;
  for (int z = 0; z + 1 < kSize; ++z)
    for (int y = 0; y + 1 < kSize; ++y)
      for (int x = 0; x + 1 < kSize; ++x) {
        std::array<float, 8> values;
        unsigned signature = 0;
        for (int v = 0; v < 8; ++v) {
          const int at = ((z + (v >> 2)) * kSize + y + (v >> 1 & 1)) * kSize + x + (v & 1);
          values[static_cast<std::size_t>(v)] = samples[static_cast<std::size_t>(at)];
          if (values[static_cast<std::size_t>(v)] >= kIsovalue) signature |= 1u << v;
        }
        ambiguous += tegl::builders::ambiguous_squares(signature) != 0 ? 1 : 0;
        const auto contour = contour_of_cell(values, kIsovalue);
        for (unsigned t = 0; t < contour.triangles; ++t)
          for (unsigned i = 0; i < 3; ++i) {
            Point from = position(contour, contour.vertices[t][i], values, kIsovalue);
            Point to = position(contour, contour.vertices[t][(i + 1) % 3], values, kIsovalue);
            for (Point* point : {&from, &to})
              for (std::size_t j = 0; j < 3; ++j) (*point)[j] += static_cast<float>(j == 0 ? x : j == 1 ? y : z);
            ++sides[{from, to}];
            --sides[{to, from}];
          }
      }
  EXPECT_GT(ambiguous, 100);
  for (const auto& [side, count] : sides) ASSERT_EQ(count, 0) << side.first[0];
}

// [tunnel]
TEST(BuilderPage, TwoOppositeCornersAreTwoTrianglesOrATunnel) {
  tegl::builders::CubeContour contour;
  const unsigned signature = 1u << 0 | 1u << 7;
  tegl::builders::build_cube(signature, 0, tegl::builders::Choice::separate, contour);
  EXPECT_EQ(contour.facets, 2);
  EXPECT_EQ(contour.triangles, 2);
  tegl::builders::build_cube(signature, 0, tegl::builders::Choice::high, contour);
  EXPECT_EQ(contour.facets, 1);
  EXPECT_EQ(contour.triangles, 12);
}
// [/tunnel]

}  // namespace
