// SPDX-License-Identifier: BSD-3-Clause
//
// Search for surfaces in a cube, bounded by polygons on its boundary.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cubes/cube_frame.hpp"

namespace tegl::gen {

/// Finds the connected surface of genus 0 with the given boundary and the shortest inner edges, for points at the
/// midpoints of edges. No inner edge joins two points of one square.
class SurfaceSearch {
 public:
  using Point = std::array<double, 3>;
  static constexpr double kAny = std::numeric_limits<double>::infinity();

  /// `own`: positions of own vertices, from the cube's centre in halves of an edge. Every surface has all of them.
  SurfaceSearch(const CubeFrame& frame, const std::vector<CubePolygon>& boundary, std::span<const Point> own);

  /// Whether a triangle may be added to others. May be left empty: any.
  std::function<bool(const CubeTriangle&, const CubeTriangles&)> may_add;
  /// Whether a complete surface is admissible.
  std::function<bool(const CubeTriangles&)> accepts;

  /// Cost: sum of the squared lengths of the inner edges. Nothing if no admissible surface costs less than `bound`.
  std::optional<CubeTriangles> run(double bound = kAny);
  [[nodiscard]] double cost() const { return best_cost_; }  ///< of the surface that run() returned

 private:
  static constexpr std::size_t kMost = 16;  ///< edges and own vertices

  [[nodiscard]] double length(std::size_t a, std::size_t b) const;
  [[nodiscard]] bool possible(std::size_t from, std::size_t to) const;
  bool put(std::size_t from, std::size_t to, double& cost);
  void take_back(std::size_t from, std::size_t to, bool closed);
  [[nodiscard]] unsigned completions(std::size_t a, std::size_t b) const;
  void advance(double cost);
  [[nodiscard]] bool connected() const;

  std::array<Point, kMost> position_{};
  std::array<unsigned, kMost> squares_of_{};
  std::vector<std::uint8_t> vertices_;
  std::size_t triangles_ = 0;
  bool open_[kMost][kMost] = {};  ///< directed edges that still need a triangle
  bool used_[kMost][kMost] = {};
  CubeTriangles filling_;
  std::optional<CubeTriangles> best_;
  double best_cost_ = kAny;
};

}  // namespace tegl::gen
