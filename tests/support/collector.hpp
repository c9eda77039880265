// SPDX-License-Identifier: BSD-3-Clause
//
// A sink that keeps a streamed contour in memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tegl/stream.hpp"

namespace tegl::test {

template <int N, class Real>
class Collector final : public ContourSink<N, Real> {
 public:
  using Vertex = std::array<Real, N>;
  using Simplex = std::array<std::uint64_t, N>;
  void add_vertices(std::span<const Vertex> part) override {
    vertices.insert(vertices.end(), part.begin(), part.end());
  }
  void add_normals(std::span<const Vertex> part) override {
    normals.insert(normals.end(), part.begin(), part.end());
    EXPECT_EQ(normals.size(), vertices.size()) << "normals come with their vertices";
  }
  void add_simplices(std::span<const Simplex> part) override {
    simplices.insert(simplices.end(), part.begin(), part.end());
    largest_part = std::max(largest_part, part.size());
  }
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override {
    simplices.at(simplex).at(static_cast<std::size_t>(corner)) = vertex;
    ++replaced;
  }
  std::vector<Vertex> vertices;
  std::vector<Vertex> normals;
  std::vector<Simplex> simplices;
  std::size_t largest_part = 0;
  std::size_t replaced = 0;
};

}  // namespace tegl::test
