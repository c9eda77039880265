// SPDX-License-Identifier: BSD-3-Clause
//
// Links of vertices of triangles and tetrahedra, if they are small, oriented, and circles, arcs, spheres or discs: nearly
// all links of a contour. Vertices of a link get numbers below 64, and sets of them are words of 64 bits; nothing is
// sorted. Other links are left to the caller.
//
// Based on: H. Seifert and W. Threlfall, Lehrbuch der Topologie, 1934, § 38 (a connected surface without a border is a
// sphere iff its Euler characteristic is 2; with a border it is a disc iff it is 1).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Faces of a complex that contain a vertex as their smallest one.
struct FacesAbove {
  std::uint64_t edges = 0;
  std::uint64_t ridges = 0;    ///< (D-1)-faces
  std::uint64_t boundary = 0;  ///< those in one simplex
};

/// D = 2: a link is a graph; D = 3: a surface. Use one object per thread; it takes 8 bytes per vertex.
template <int D>
class OrientedLink {
  static_assert(D == 2 || D == 3);

 public:
  /// `rows`: #S x (D + 1), row = simplex.
  OrientedLink(const Index* rows, std::size_t vertex_count) : rows_(rows), met_(vertex_count) {}

  /// Whether the link of v is a sphere or ball of D - 1 dimensions, has at most 64 vertices, and its orientations agree.
  /// Then sets the faces. False if any of this does not hold; the link may still be a sphere or ball. `star`: the
  /// simplices around v, which repeat no vertex.
  [[nodiscard]] bool settle(Index v, std::span<const Index> star, FacesAbove& faces) {
    if (star.size() > 2 * kMost || !load(v, star)) return false;
    if constexpr (D == 2) {
      if (!is_one_walk(star.size())) return false;
    } else {
      if (!is_sphere_or_disc(star.size())) return false;
    }
    faces = faces_;
    return true;
  }

 private:
  static constexpr unsigned kMost = 64;
  using Set = std::uint64_t;    ///< of numbers of the link's vertices
  using Small = std::uint16_t;  ///< a number below 64; bytes would be assumed to alias everything

  /// The number of a vertex in the link in which it was met last.
  struct Met {
    Index link_of = std::numeric_limits<Index>::max();
    Index number = 0;
  };

  static constexpr Set one(unsigned i) noexcept { return Set{1} << i; }

  /// The number of a vertex in the link of v; kMost if there are too many.
  unsigned number_of(Index v, Index vertex) {
    Met& met = met_[vertex];
    if (met.link_of != v) {
      if (count_ == kMost) return kMost;
      met = {v, count_};
      out_[count_] = in_[count_] = 0;
      arrows_from_[count_] = 0;
      is_above_[count_] = vertex > v;
      faces_.edges += vertex > v ? 1 : 0;
      ++count_;
    }
    return met.number;
  }

  /// The link's simplices, oriented so that v followed by their vertices is the simplex of the complex. False if there
  /// are too many vertices, or two simplices induce the same orientation on a common face.
  bool load(Index v, std::span<const Index> star) {
    count_ = 0;
    paired_ = 0;
    faces_ = {};
    for (const Index s : star) {
      const Index* const row = rows_ + std::size_t{s} * (D + 1);
      std::array<unsigned, D> piece;
      bool is_odd = false;  // v at an odd place: exchange two others
      for (int i = 0, k = 0; i <= D; ++i) {
        if (row[i] == v) {
          is_odd = (i & 1) != 0;
          continue;
        }
        piece[k] = number_of(v, row[i]);
        if (piece[k++] == kMost) return false;
      }
      if (is_odd) std::swap(piece[D - 2], piece[D - 1]);
      for (int i = 0; i < (D == 2 ? 1 : D); ++i) {
        const unsigned from = piece[i], to = piece[(i + 1) % D];
        if ((out_[from] & one(to)) != 0) return false;
        out_[from] |= one(to);
        in_[to] |= one(from);
        ++arrows_from_[from];
        if constexpr (D == 3) {
          next_[from * kMost + to] = static_cast<Small>(piece[(i + 2) % D]);
          add_side(from, to);
        }
      }
    }
    return true;
  }

  /// D = 3: counts a side of a triangle, and its edge when it is met first.
  void add_side(unsigned from, unsigned to) {
    const unsigned is_second = static_cast<unsigned>(in_[from] >> to & 1);
    const unsigned is_above = static_cast<unsigned>(is_above_[from] & is_above_[to]);
    paired_ += is_second;
    faces_.ridges += is_above & ~is_second;
    faces_.boundary += is_above & ~is_second;
    faces_.boundary -= is_above & is_second;
  }

  /// D = 2: whether the arrows form one closed or open walk through all vertices.
  [[nodiscard]] bool is_one_walk(std::size_t arrows) {
    unsigned first = 0, starts = 0;
    faces_.ridges = faces_.edges;
    for (unsigned a = 0; a < count_; ++a) {
      if (arrows_from_[a] > 1 || (in_[a] & (in_[a] - 1)) != 0) return false;
      faces_.boundary += is_above_[a] && (out_[a] == 0 || in_[a] == 0) ? 1 : 0;
      if (in_[a] != 0) continue;
      first = a;
      ++starts;
    }
    if (starts > 1 || count_ != arrows + starts) return false;
    unsigned met = 1;
    for (unsigned a = first; out_[a] != 0; ++met) {
      a = static_cast<unsigned>(std::countr_zero(out_[a]));
      if (a == first) break;
    }
    return met == count_;
  }

  /// D = 3: whether the triangles form a sphere or a disc.
  [[nodiscard]] bool is_sphere_or_disc(std::size_t triangles) const {
    const std::size_t edges = 3 * triangles - paired_;
    const bool is_closed = 2 * edges == 3 * triangles;
    if (count_ + triangles != edges + (is_closed ? 2 : 1)) return false;
    for (unsigned a = 0; a < count_; ++a)
      if (!has_one_fan(a)) return false;
    return is_connected();
  }

  /// D = 3: whether one fan contains all triangles around a vertex.
  [[nodiscard]] bool has_one_fan(unsigned a) const {
    const Set out = out_[a], starts = out & ~in_[a];
    if ((starts & (starts - 1)) != 0) return false;
    const auto start = static_cast<unsigned>(std::countr_zero(starts != 0 ? starts : out));
    unsigned met = 0;
    unsigned b = start;
    do {
      b = next_[a * kMost + b];
      ++met;
    } while (b != start && (out & one(b)) != 0);
    return met == arrows_from_[a];
  }

  [[nodiscard]] bool is_connected() const {
    Set reached = 1, open = 1;
    while (open != 0) {
      const auto a = static_cast<unsigned>(std::countr_zero(open));
      open &= open - 1;
      const Set beside = (out_[a] | in_[a]) & ~reached;
      reached |= beside;
      open |= beside;
    }
    return reached == ~Set{0} >> (kMost - count_);
  }

  const Index* rows_;
  std::vector<Met> met_;  ///< by vertex
  unsigned count_ = 0;    ///< vertices of the link
  std::size_t paired_ = 0;  ///< D = 3: sides of triangles that are sides of others, too, divided by 2
  FacesAbove faces_;
  std::array<Small, kMost> is_above_;     ///< whether its number in the complex is greater than the centre's
  std::array<Small, kMost> arrows_from_;  ///< how many
  /// Arrows from and to each vertex. D = 2: an arrow is a simplex of the link; D = 3: a side of a triangle.
  std::array<Set, kMost> out_, in_;
  std::array<Small, std::size_t{kMost} * kMost> next_;  ///< D = 3: the third vertex of the triangle of an arrow
};

}  // namespace tegl::detail
