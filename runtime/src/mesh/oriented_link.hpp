// SPDX-License-Identifier: BSD-3-Clause
//
// Links of vertices of triangles and tetrahedra, if they are small, oriented, and circles, arcs, spheres or discs:
// nearly all links of a contour. Other links are left to the caller.
//
// D = 3: triangles that are connected across edges, each edge in one or two of them, form a connected surface some of
// whose points may be identified. The Euler characteristic of a connected surface is 2 for a sphere, 1 for a disc, and
// less for any other surface without or with a border; each identification of two points subtracts 1. So if it is 2
// without a border, or 1 with one, the triangles are a sphere or a disc, and no points are identified.
//
// Based on: H. Seifert and W. Threlfall, Lehrbuch der Topologie, 1934, § 38 (a connected surface without a border is a
// sphere iff its Euler characteristic is 2; with a border it is a disc iff it is 1).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/link_numbers.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Faces of a complex that contain a vertex as their smallest one.
struct FacesAbove {
  std::uint64_t edges = 0;
  std::uint64_t ridges = 0;    ///< (D-1)-faces
  std::uint64_t boundary = 0;  ///< those in one simplex
};

/// D = 2: a link is a graph; D = 3: a surface. Use one object per thread.
template <int D>
class OrientedLink {
  static_assert(D == 2 || D == 3);

 public:
  /// `rows`: #S x (D + 1), row = simplex.
  OrientedLink(const Index* rows, std::size_t vertex_count) : rows_(rows), numbers_(vertex_count) {
    out_.fill(0);
    in_.fill(0);
    arrows_from_.fill(0);
  }

  /// Whether the link of v is a sphere or ball of D - 1 dimensions, has at most about 60 vertices, and its orientations
  /// agree. Then sets the faces. False if any of this does not hold; the link may still be a sphere or ball. `star`:
  /// the simplices around v, which repeat no vertex.
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
  static constexpr unsigned kMost = LinkNumbers::kMost;
  using Set = LinkNumbers::Set;
  using Small = std::uint16_t;  ///< a number below 64; bytes would be assumed to alias everything

  static constexpr Set one(unsigned i) noexcept { return LinkNumbers::one(i); }

  /// The link's simplices, oriented so that v followed by their vertices is the simplex of the complex. False if there
  /// are too many vertices, or two simplices induce the same orientation on a common face.
  bool load(Index v, std::span<const Index> star) {
    for (unsigned a = 0; a < numbers_.size(); ++a) {
      out_[a] = in_[a] = 0;
      arrows_from_[a] = 0;
    }
    faces_ = {};
    Loading state(*this, v);
    for (std::size_t i = 0; i < star.size() && state.number.size() < kMost - D && state.parts < kMost; ++i)
      state.add(rows_ + std::size_t{star[i]} * (D + 1), static_cast<unsigned>(i));
    numbers_.keep(state.number);
    if (state.repeated != 0 || state.number.size() >= kMost - D || state.parts >= kMost) return false;
    paired_ = state.paired;
    parts_ = state.parts;
    faces_ = state.faces;
    for (unsigned a = 0; a < numbers_.size(); ++a) {
      is_above_[a] = numbers_.vertex(a) > v;
      faces_.edges += is_above_[a];
    }
    return true;
  }

  /// A link while it is loaded. A local variable, whose members the compiler keeps in registers.
  struct Loading {
    Index v;
    LinkNumbers::Numbering number;
    OrientedLink& link;
    std::size_t paired = 0;
    unsigned parts = 0;  ///< D = 3: triangles that have no edge in common with one before them
    FacesAbove faces;
    Set repeated = 0;  ///< not empty if two simplices have the same arrow

    Loading(OrientedLink& of, Index centre) : v(centre), number(of.numbers_, centre), link(of) {}

    /// `order`: of the simplex in the star.
    void add(const Index* row, unsigned order) {
      const OthersOfSimplex<D + 1> others(row, v);
      std::array<unsigned, D> piece, is_above;
      for (unsigned i = 0; i < D; ++i) {
        piece[i] = number(others[i]);
        is_above[i] = others[i] > v ? 1 : 0;
      }
      if constexpr (D == 3) join_neighbours(piece, order);
      for (unsigned i = 0; i < (D == 2 ? 1 : D); ++i) {
        const unsigned next = i + 1 == D ? 0 : i + 1;
        const unsigned from = piece[i], to = piece[next];
        if constexpr (D == 3)
          count_side(static_cast<unsigned>(link.in_[from] >> to & 1), is_above[i] & is_above[next]);
        else
          ++link.arrows_from_[from];
        repeated |= link.out_[from] & one(to);
        link.out_[from] |= one(to);
        link.in_[to] |= one(from);
      }
    }
    /// D = 3: gives a triangle the least part of the triangles that share an edge with it, else a new part, and notes
    /// that these parts are connected. Without a branch: it depends irregularly on the link which edges are shared.
    void join_neighbours(const std::array<unsigned, D>& piece, unsigned order) {
      std::array<unsigned, D> beside;  // the parts across the edges; kMost if there is none
      unsigned part = kMost;
      for (unsigned i = 0; i < D; ++i) {
        const unsigned from = piece[i], to = piece[i + 1 == D ? 0 : i + 1];
        const bool is_shared = (link.in_[from] >> to & 1) != 0;
        beside[i] = is_shared ? link.part_[link.triangle_[to * kMost + from]] : kMost;
        part = beside[i] < part ? beside[i] : part;
      }
      const bool is_new = part == kMost;
      part = is_new ? parts : part;
      link.joined_[part] = is_new ? 0 : link.joined_[part];
      parts += is_new ? 1 : 0;
      link.part_[order] = static_cast<Small>(part);
      for (unsigned i = 0; i < D; ++i) {
        link.joined_[part] |= beside[i] < kMost ? one(beside[i] & (kMost - 1)) : 0;
        link.joined_[beside[i]] |= one(part);
        link.triangle_[piece[i] * kMost + piece[i + 1 == D ? 0 : i + 1]] = static_cast<Small>(order);
      }
    }
    /// D = 3: counts a side of a triangle, and its edge when it is met first.
    void count_side(unsigned is_second, unsigned above) {
      paired += is_second;
      faces.ridges += above & ~is_second;
      faces.boundary += above & ~is_second;
      faces.boundary -= above & is_second;
    }
  };

  /// D = 2: whether the arrows form one closed or open walk through all vertices.
  [[nodiscard]] bool is_one_walk(std::size_t arrows) {
    unsigned first = 0, starts = 0;
    faces_.ridges = faces_.edges;
    for (unsigned a = 0; a < numbers_.size(); ++a) {
      if (arrows_from_[a] > 1 || (in_[a] & (in_[a] - 1)) != 0) return false;
      faces_.boundary += is_above_[a] && (out_[a] == 0 || in_[a] == 0) ? 1 : 0;
      if (in_[a] != 0) continue;
      first = a;
      ++starts;
    }
    if (starts > 1 || numbers_.size() != arrows + starts) return false;
    unsigned met = 1;
    for (unsigned a = first; out_[a] != 0; ++met) {
      a = static_cast<unsigned>(std::countr_zero(out_[a]));
      if (a == first) break;
    }
    return met == numbers_.size();
  }

  /// D = 3: whether the triangles form a sphere or a disc.
  [[nodiscard]] bool is_sphere_or_disc(std::size_t triangles) const {
    const std::size_t edges = 3 * triangles - paired_;
    const bool is_closed = 2 * edges == 3 * triangles;
    if (numbers_.size() + triangles != edges + (is_closed ? 2 : 1)) return false;
    return is_connected();
  }

  /// D = 3: whether all triangles are connected across edges.
  [[nodiscard]] bool is_connected() const {
    Set reached = 1, open = 1;
    while (open != 0) {
      const auto part = static_cast<unsigned>(std::countr_zero(open));
      open &= open - 1;
      const Set beside = joined_[part] & ~reached;
      reached |= beside;
      open |= beside;
    }
    return reached == ~Set{0} >> (kMost - parts_);
  }

  const Index* rows_;
  LinkNumbers numbers_;
  std::size_t paired_ = 0;  ///< D = 3: sides of triangles that are sides of others, too, divided by 2
  FacesAbove faces_;
  std::array<Small, kMost> is_above_;     ///< whether its number in the complex is greater than the centre's
  std::array<Small, kMost> arrows_from_;  ///< D = 2: how many
  /// Arrows from and to each vertex. D = 2: an arrow is a simplex of the link; D = 3: a side of a triangle.
  std::array<Set, kMost> out_, in_;
  // D = 3
  unsigned parts_ = 0;
  std::array<Small, std::size_t{kMost} * kMost> triangle_{};  ///< by arrow: its triangle's place in the star
  std::array<Small, 2 * kMost> part_{};                       ///< by triangle: its part
  std::array<Set, kMost + 1> joined_{};                       ///< by part: parts connected with it
};

}  // namespace tegl::detail
