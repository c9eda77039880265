// SPDX-License-Identifier: BSD-3-Clause
//
// Tests whether one contour covers a whole simplex of another, and bounds its distance: the simplices of a
// contour in the prism over the simplex, grouped by their heights.
//
// Principle. Let a chain of oriented simplices cross a prism (a convex base times a range of heights) without reaching
// its two ends, and let the boundary of the chain lie outside the prism. Then the chain covers every point of the base
// the same number of times, counted with signs: the degree of its projection is constant, because the base is
// connected. If that number is not zero at one point, every line along the prism meets the chain between the ends. So
// gaps, folds and flat pieces need no comparison of sizes, and the only error is rounding.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "mesh/simplex_shapes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Coordinate frame of a hyperplane: D = N - 1 coordinates in it, and the height above it as the last one.
template <int N>
class Frame {
 public:
  static constexpr int D = N - 1;

  /// `unit_normal` becomes the last vector of an orthonormal basis, by the reflection that maps an axis to it.
  Frame(const PointN<N>& unit_normal, const PointN<N>& at) : origin_(at) {
    int longest = 0;
    for (int a = 1; a < N; ++a)
      if (std::abs(unit_normal[a]) > std::abs(unit_normal[longest])) longest = a;
    PointN<N> mirror = unit_normal;
    mirror[longest] += unit_normal[longest] > 0.0 ? 1.0 : -1.0;
    const double square = dot(mirror, mirror);
    for (int a = 0, k = 0; a < N; ++a) {
      if (a == longest) continue;
      for (int b = 0; b < N; ++b) basis_[k][b] = (a == b ? 1.0 : 0.0) - 2.0 * mirror[a] * mirror[b] / square;
      ++k;
    }
    basis_[D] = unit_normal;
  }
  [[nodiscard]] const PointN<N>& normal() const noexcept { return basis_[D]; }
  [[nodiscard]] PointN<N> to_frame(const PointN<N>& p) const {
    const PointN<N> way = minus(p, origin_);
    PointN<N> result;
    for (int k = 0; k < N; ++k) result[k] = dot(way, basis_[k]);
    return result;
  }
  /// The corners of a simplex in the frame, by axis: a row of N corners for each of the N coordinates.
  [[nodiscard]] CornersN<N> to_frame_by_axis(const CornersN<N>& corners) const {
    CornersN<N> way;
    for (int a = 0; a < N; ++a)
      for (int i = 0; i < N; ++i) way[a][i] = corners[i][a] - origin_[a];
    CornersN<N> result;
    for (int k = 0; k < N; ++k) {
      for (int i = 0; i < N; ++i) result[k][i] = way[0][i] * basis_[k][0];
      for (int a = 1; a < N; ++a)
        for (int i = 0; i < N; ++i) result[k][i] += way[a][i] * basis_[k][a];
    }
    return result;
  }
  [[nodiscard]] PointN<N> to_space(const PointN<N>& x) const {
    PointN<N> result = origin_;
    for (int k = 0; k < N; ++k)
      for (int a = 0; a < N; ++a) result[a] += x[k] * basis_[k][a];
    return result;
  }

 private:
  std::array<PointN<N>, N> basis_;
  PointN<N> origin_;
};

/// The frame coordinates of a point without its height.
template <int N>
PointN<N - 1> flat(const PointN<N>& x) {
  PointN<N - 1> result;
  std::copy(x.begin(), x.end() - 1, result.begin());
  return result;
}

/// The prism of all lines through a simplex along the normal of a frame, as an intersection of half-spaces. They
/// contain the whole simplex despite rounding.
template <int N>
class Prism {
 public:
  static constexpr int D = N - 1;
  static constexpr int kMostSides = N + 2 * D;

  /// `part`: the simplex in the frame; `edge`: the length of its longest edge.
  Prism(const CornersN<N>& part, double edge) : edge_(edge) {
    double cube = 1.0;
    for (int k = 0; k < D; ++k) cube *= edge;
    std::array<PointN<D>, N> at;
    for (int i = 0; i < N; ++i) at[i] = flat<N>(part[i]);
    // one side per face; the slope of the simplex from its heights
    bool thin = false;
    for (int omitted = 0; omitted < N; ++omitted) {
      std::array<PointN<D>, D> face;
      for (int i = 0, k = 0; i < N; ++i)
        if (i != omitted) face[k++] = at[i];
      PointN<D> normal = normal_of<D>(face);
      const double size = norm(normal);
      const double content = dot(normal, minus(at[omitted], face[0]));  // D! times the measure of the simplex
      thin = thin || !(std::abs(content) > kThin * cube);
      if (!(size > kThin * kThin * cube / edge)) continue;
      for (double& x : normal) x /= content < 0.0 ? -size : size;
      add_side(normal, at);
      if (thin) continue;
      const double height = std::abs(content) / size;
      for (int k = 0; k < D; ++k) slope_[k] += part[omitted][D] * normal[k] / height;
    }
    // thin: the sides of its bounding box as well
    if (thin) {
      slope_ = {};
      for (int k = 0; k < D; ++k)
        for (const double sign : {1.0, -1.0}) {
          PointN<D> normal{};
          normal[k] = sign;
          add_side(normal, at);
        }
    }
    // range of heights
    level_ = part[0][D] - dot(slope_, at[0]);
    low_ = high_ = 0.0;
    for (const PointN<N>& corner : part) {
      low_ = std::min(low_, height(corner));
      high_ = std::max(high_, height(corner));
    }
    thin_ = thin;
  }

  [[nodiscard]] int sides() const noexcept { return count_; }
  [[nodiscard]] double inside(int side, const PointN<N>& x) const {
    double sum = -offsets_[side];
    for (int k = 0; k < D; ++k) sum += normals_[side][k] * x[k];
    return sum;
  }
  /// Bit i: corner i of a simplex, by axis, is beyond the side.
  [[nodiscard]] unsigned corners_beyond(int side, const CornersN<N>& at) const {
    PointN<N> sum;
    for (int i = 0; i < N; ++i) sum[i] = at[0][i] * normals_[side][0] - offsets_[side];
    for (int k = 1; k < D; ++k)
      for (int i = 0; i < N; ++i) sum[i] += at[k][i] * normals_[side][k];
    unsigned bits = 0;
    for (int i = 0; i < N; ++i) bits |= static_cast<unsigned>(sum[i] < 0.0) << i;
    return bits;
  }
  /// Heights of the corners of a simplex, by axis.
  [[nodiscard]] PointN<N> heights(const CornersN<N>& at) const {
    PointN<N> sum;
    for (int i = 0; i < N; ++i) sum[i] = at[D][i] - level_;
    for (int k = 0; k < D; ++k)
      for (int i = 0; i < N; ++i) sum[i] -= at[k][i] * slope_[k];
    return sum;
  }
  /// Height of a point above the simplex (for a thin simplex, above a level through it).
  [[nodiscard]] double height(const PointN<N>& x) const {
    double sum = x[D] - level_;
    for (int k = 0; k < D; ++k) sum -= slope_[k] * x[k];
    return sum;
  }
  /// Range of heights of the simplex itself: 0; if it is thin, a range that contains 0.
  [[nodiscard]] double low() const noexcept { return low_; }
  [[nodiscard]] double high() const noexcept { return high_; }
  /// Whether the projection of the simplex is almost degenerate. Then the prism contains more than the simplex.
  [[nodiscard]] bool thin() const noexcept { return thin_; }
  /// The projection of x along the normal onto the simplex, if it is not thin.
  [[nodiscard]] PointN<N> at_level(PointN<N> x) const {
    x[D] -= height(x);
    return x;
  }
  [[nodiscard]] double edge() const noexcept { return edge_; }
  /// Bound of the rounding errors of places in the prism.
  [[nodiscard]] double rounding() const noexcept { return kRounding * edge_; }

 private:
  /// Relative to the D-th power of the longest edge.
  static constexpr double kThin = 1e-3;
  /// Relative to the longest edge. Places relative to a corner have errors of about 1e-16.
  static constexpr double kRounding = 1e-14;

  void add_side(const PointN<D>& normal, const std::array<PointN<D>, N>& at) {
    double least = dot(normal, at[0]);
    for (int i = 1; i < N; ++i) least = std::min(least, dot(normal, at[i]));
    normals_[count_] = normal;
    offsets_[count_++] = least - kRounding * edge_;
  }

  std::array<PointN<D>, kMostSides> normals_;
  std::array<double, kMostSides> offsets_;
  int count_ = 0;
  PointN<D> slope_{};
  double level_ = 0.0, low_ = 0.0, high_ = 0.0;
  double edge_;
  bool thin_ = false;
};

/// The part of a simplex inside a prism. It is a simple convex polytope (each corner in D of its facets, or treated
/// so), because each corner that a cut creates lies on one edge. So two corners share an edge if they share D - 1
/// facets. Facet bits: bit i is the facet of the simplex opposite to corner i; bit N + k is side k of the prism.
template <int N>
class ClippedSimplex {
 public:
  static constexpr int D = N - 1;

  /// Loads the whole simplex. Returns false if all of it is outside one side of the prism.
  bool load(const CornersN<N>& simplex, const Prism<N>& prism) {
    cutting_ = 0;
    for (int side = 0; side < prism.sides(); ++side) {
      int beyond = 0;
      for (int i = 0; i < N; ++i) beyond += prism.inside(side, simplex[i]) < 0.0;
      if (beyond == N) return false;
      if (beyond > 0) cutting_ |= 1u << side;
    }
    count_ = N;
    for (int i = 0; i < N; ++i) corners_[i] = {simplex[i], ((1u << N) - 1) & ~(1u << i)};
    return true;
  }

  /// Cuts the loaded simplex by the prism. Returns false if nothing is left.
  bool clip(const Prism<N>& prism) {
    for (unsigned rest = cutting_; rest != 0; rest &= rest - 1)
      if (!clip_by_side(prism, std::countr_zero(rest))) return false;
    return true;
  }

  /// Bit i: facet i of the simplex meets the clipped simplex.
  [[nodiscard]] unsigned facets() const {
    unsigned all = 0;
    for (int i = 0; i < count_; ++i) all |= corners_[i].facets;
    return all & ((1u << N) - 1);
  }
  /// Minimum and maximum height; before `cut`, of the corners of the simplex.
  [[nodiscard]] std::pair<double, double> heights(const Prism<N>& prism) const {
    std::pair<double, double> range = {prism.height(corners_[0].at), 0.0};
    range.second = range.first;
    for (int i = 1; i < count_; ++i) {
      const double height = prism.height(corners_[i].at);
      range.first = std::min(range.first, height);
      range.second = std::max(range.second, height);
    }
    return range;
  }
  /// The corner with the largest absolute height.
  [[nodiscard]] const PointN<N>& farthest(const Prism<N>& prism) const {
    const auto last = corners_.begin() + count_;
    return std::max_element(corners_.begin(), last,
                            [&](const Corner& a, const Corner& b) {
                              return std::abs(prism.height(a.at)) < std::abs(prism.height(b.at));
                            })
        ->at;
  }

 private:
  struct Corner {
    PointN<N> at;
    std::uint32_t facets;
  };
  /// A simple polytope of dimension 3 with F facets has 2 F - 4 corners and 3 F - 6 edges. The bound is their sum,
  /// which includes the corners that a cut adds.
  static constexpr int kMostCorners = 5 * (N + Prism<N>::kMostSides) - 10;

  /// Whether two corners have D - 1 facets in common.
  static bool share_an_edge(std::uint32_t common) noexcept {
    if constexpr (D == 1) return true;
    if constexpr (D == 2) return common != 0;
    return (common & (common - 1)) != 0;
  }

  bool clip_by_side(const Prism<N>& prism, int side) {
    std::array<double, kMostCorners> inside;
    const int before = count_;
    for (int i = 0; i < before; ++i) inside[i] = prism.inside(side, corners_[i].at);
    int end = before;
    for (int i = 0; i < before; ++i) {
      if (!(inside[i] >= 0.0)) continue;
      for (int j = 0; j < before; ++j) {
        if (inside[j] >= 0.0) continue;
        const std::uint32_t common = corners_[i].facets & corners_[j].facets;
        if (!share_an_edge(common)) continue;
        if (end == kMostCorners)
          return true;  // only by rounding; without the cut the clipped simplex is still a superset
        corners_[end++] = {between(corners_[i].at, corners_[j].at, inside[i] / (inside[i] - inside[j])),
                           common | 1u << (N + side)};
      }
    }
    count_ = 0;
    for (int i = 0; i < end; ++i)
      if (i >= before || inside[i] >= 0.0) corners_[count_++] = corners_[i];
    return count_ > 0;
  }

  std::array<Corner, kMostCorners> corners_;
  int count_ = 0;
  unsigned cutting_ = 0;  ///< sides with corners of the simplex outside
};

/// Minimum and maximum height above a part at which the lines of its prism meet the hyperplane of a simplex, with a
/// margin for rounding. All heights if the hyperplane is too steep or the simplex too flat.
template <int N>
std::pair<double, double> heights_of_plane(const CornersN<N>& simplex, const CornersN<N>& part, const Prism<N>& prism) {
  constexpr int D = N - 1;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::pair<double, double> range = {-kInfinity, kInfinity};
  if (prism.thin()) return range;
  const PointN<N> normal = normal_of<N>(simplex);
  double size = prism.edge();
  for (int i = 1; i < N; ++i)
    for (int a = 0; a < N; ++a) size = std::max(size, std::abs(simplex[i][a] - simplex[0][a]));
  double error = 1e-14 * size / std::abs(normal[D]);  // error of the normal's direction times a length
  for (int k = 0; k < D; ++k) error *= size;
  if (!(error < 1e-6 * prism.edge())) return range;
  range = {kInfinity, -kInfinity};
  for (const PointN<N>& corner : part) {
    const double height = -dot(normal, minus(corner, simplex[0])) / normal[D];
    range.first = std::min(range.first, height - error);
    range.second = std::max(range.second, height + error);
  }
  return range;
}

/// Whether a simplex, projected along the normal of the frame, covers x: 1 or -1 by its orientation, 0 if not. Empty if
/// x is too near to its outline to decide.
template <int N>
std::optional<int> covers(const CornersN<N>& simplex, const PointN<N - 1>& x) {
  constexpr int D = N - 1;
  // outside of the bounding box?
  std::array<PointN<D>, N> way;
  double longest = 0.0;
  for (int k = 0; k < D; ++k) {
    bool above = false, below = false;
    for (int i = 0; i < N; ++i) {
      way[i][k] = simplex[i][k] - x[k];
      longest = std::max(longest, std::abs(way[i][k]));
      above = above || way[i][k] >= 0.0;
      below = below || way[i][k] <= 0.0;
    }
    if (!above || !below) return 0;
  }
  // signs of the barycentric coordinates
  double enough = 1e-13;
  for (int k = 0; k < D; ++k) enough *= longest;
  int positive = 0, negative = 0;
  for (int omitted = 0; omitted < N; ++omitted) {
    // Determinant of the other corners.
    double content = 0.0;
    if constexpr (D == 1) {
      content = way[1 - omitted][0];
    } else {
      std::array<PointN<D>, D> face;
      for (int i = 0, k = 0; i < N; ++i)
        if (i != omitted) face[k++] = way[i];
      content = dot(normal_of<D>(face), face[0]);
    }
    if (omitted % 2 != 0) content = -content;
    positive += content > enough;
    negative += content < -enough;
  }
  if (positive > 0 && negative > 0) return 0;
  if (positive == N) return 1;
  if (negative == N) return -1;
  return std::nullopt;
}

/// Whether simplices cover a point of the part with a nonzero degree (orientations counted with signs).
/// `corners_of(k)`: simplex k of `count` in the frame.
template <int N, class CornersOf>
bool covers_a_point(std::size_t count, const CornersOf& corners_of, const CornersN<N>& part) {
  for (int attempt = 0; attempt < 4; ++attempt) {
    // Asymmetric weights avoid points on outlines.
    PointN<N> x{};
    double sum = 0.0;
    for (int i = 0; i < N; ++i) {
      const double weight = 1.0 + 0.37 * ((i * (attempt + 1) + attempt) % N) + 0.11 * i;
      sum += weight;
      for (int a = 0; a < N; ++a) x[a] += weight * part[i][a];
    }
    for (double& coordinate : x) coordinate /= sum;
    int times = 0;
    bool sure = true;
    for (std::size_t k = 0; k < count && sure; ++k) {
      const std::optional<int> side = covers<N>(corners_of(k), flat<N>(x));
      sure = side.has_value();
      times += side.value_or(0);
    }
    if (sure) return times != 0;
  }
  return false;
}

}  // namespace tegl::detail
