// SPDX-License-Identifier: BSD-3-Clause
//
// Drops simplices of zero content whose vertices differ, without opening a gap.
//
// If a vertex b of a flat simplex lies inside a face A of its other vertices, dividing A at b gives simplices that
// repeat b, and these are dropped. All other simplices with the face A are divided as well, each into one simplex per
// vertex of A, in which b replaces this vertex. So the (N-2)-faces match again. For triangles, b lies on the opposite
// edge. A flat tetrahedron may also be a quadrilateral with its two diagonals; it stays.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mesh/flat_simplex.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Simplices with N vertices in N-space that are divided one after the other.
template <int N, class Real>
class FlatDivision {
 public:
  using Simplex = std::array<Index, N>;
  /// A simplex and the number of the one that it is a part of.
  struct Part {
    Simplex simplex;
    Index origin;
    bool is_dropped = false;
    bool is_divided = false;
  };

  /// `parts` must repeat no vertex.
  FlatDivision(std::vector<Part>& parts, std::span<const std::array<Real, N>> vertices)
      : parts_(parts), vertices_(vertices) {
    for (std::size_t s = 0; s < parts.size(); ++s)
      if (is_flat_simplex(parts[s].simplex)) flat_.push_back(s);
    if (flat_.empty()) return;
    star_.resize(vertices.size());
    for (std::size_t s = 0; s < parts.size(); ++s)
      for (const Index v : parts[s].simplex) star_[v].push_back(s);
  }

  /// Divides and drops all that it can. Dropped parts are marked.
  void run() {
    // Each step removes an edge or a face that another vertex lies in. The limit is for rounding errors.
    std::size_t left = 64 * flat_.size() + 64;
    for (std::size_t i = 0; i < flat_.size() && left > 0; ++i, --left) {
      if (parts_[flat_[i]].is_dropped) continue;
      if (const auto face = face_with_vertex(parts_[flat_[i]].simplex)) divide(*face);
    }
  }

  /// Number of flat simplices that were dropped, and of others that were divided.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
  [[nodiscard]] std::uint64_t divided() const noexcept { return divided_; }
  /// Number of flat simplices that are left.
  [[nodiscard]] std::uint64_t left() const {
    std::vector<std::size_t> all = flat_;
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return static_cast<std::uint64_t>(
        std::count_if(all.begin(), all.end(), [&](std::size_t s) { return !parts_[s].is_dropped; }));
  }

 private:
  /// A face by the places of its vertices in a list, and the vertex inside it.
  struct Face {
    std::vector<Index> vertices;
    Index inside;
  };

  [[nodiscard]] bool is_flat_simplex(const Simplex& simplex) const {
    return is_flat<N - 1>(simplex.data(), N, vertices_.data()->data());
  }

  /// The smallest face with another vertex of the simplex inside it.
  [[nodiscard]] std::optional<Face> face_with_vertex(const Simplex& simplex) const {
    for (int size = 2; size < N; ++size)
      for (unsigned set = 0; set < (1u << N); ++set) {
        if (std::popcount(set) != size) continue;
        std::vector<Index> face;
        for (int i = 0; i < N; ++i)
          if ((set >> i & 1u) != 0) face.push_back(simplex[i]);
        for (int i = 0; i < N; ++i)
          if ((set >> i & 1u) == 0 && is_inside(face, simplex[i])) return Face{face, simplex[i]};
      }
    return std::nullopt;
  }

  /// Whether a vertex lies inside a face, up to rounding: all barycentric coordinates are positive.
  [[nodiscard]] bool is_inside(std::span<const Index> face, Index v) const {
    constexpr double kRounding = 1e-12;
    const std::size_t k = face.size() - 1;
    const auto edge = [&](Index to, std::array<double, N>& e) {
      for (int a = 0; a < N; ++a)
        e[a] = static_cast<double>(vertices_[to][a]) - static_cast<double>(vertices_[face[0]][a]);
    };
    const auto dot = [](const auto& x, const auto& y) {
      double sum = 0.0;
      for (int a = 0; a < N; ++a) sum += x[a] * y[a];
      return sum;
    };
    std::array<std::array<double, N>, N> edges;
    for (std::size_t i = 0; i < k; ++i) edge(face[i + 1], edges[i]);
    edge(v, edges[k]);
    // normal equations, by elimination; Gram's matrix needs no pivots unless the face itself is flat
    std::array<std::array<double, N + 1>, N> m;
    double longest = 0.0;
    for (std::size_t i = 0; i < k; ++i) {
      for (std::size_t j = 0; j <= k; ++j) m[i][j] = dot(edges[i], edges[j]);
      longest = std::max(longest, m[i][i]);
    }
    for (std::size_t c = 0; c < k; ++c) {
      if (m[c][c] <= kRounding * longest) return false;
      for (std::size_t r = 0; r < k; ++r) {
        if (r == c) continue;
        const double factor = m[r][c] / m[c][c];
        for (std::size_t j = c; j <= k; ++j) m[r][j] -= factor * m[c][j];
      }
    }
    double rest = 1.0;
    for (std::size_t i = 0; i < k; ++i) {
      const double share = m[i][k] / m[i][i];
      if (share <= kRounding) return false;
      rest -= share;
      for (int a = 0; a < N; ++a) edges[k][a] -= share * edges[i][a];
    }
    return rest > kRounding && dot(edges[k], edges[k]) <= kRounding * kRounding * longest;
  }

  void divide(const Face& face) {
    std::vector<std::size_t> with_face;
    for (const std::size_t s : star_[face.vertices[0]]) {
      const Simplex& simplex = parts_[s].simplex;
      const auto has = [&](Index v) { return std::find(simplex.begin(), simplex.end(), v) != simplex.end(); };
      if (!parts_[s].is_dropped && std::all_of(face.vertices.begin(), face.vertices.end(), has)) with_face.push_back(s);
    }
    for (const std::size_t s : with_face) {
      const Part part = parts_[s];
      parts_[s].is_dropped = true;
      const bool repeats = std::find(part.simplex.begin(), part.simplex.end(), face.inside) != part.simplex.end();
      if (repeats) ++dropped_;
      if (repeats) continue;
      if (!part.is_divided) ++divided_;
      for (const Index v : face.vertices) {
        Part piece = part;
        piece.is_divided = true;
        std::replace(piece.simplex.begin(), piece.simplex.end(), v, face.inside);
        if (is_flat_simplex(piece.simplex)) flat_.push_back(parts_.size());
        for (const Index w : piece.simplex) star_[w].push_back(parts_.size());
        parts_.push_back(piece);
      }
    }
  }

  std::vector<Part>& parts_;
  std::span<const std::array<Real, N>> vertices_;
  std::vector<std::vector<std::size_t>> star_;  ///< by vertex, also dropped parts
  std::vector<std::size_t> flat_;               ///< parts of zero content, in the order in which they are handled
  std::uint64_t dropped_ = 0;
  std::uint64_t divided_ = 0;
};

}  // namespace tegl::detail
