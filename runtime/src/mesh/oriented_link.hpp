// SPDX-License-Identifier: BSD-3-Clause
//
// Links of vertices of triangles, if they are small, oriented, and circles or arcs: nearly all links of a contour.
// Other links are left to the caller.
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
  std::uint64_t boundary = 0;  ///< edges in one triangle
};

/// A link is a graph, whose edges are oriented: arrows. Use one object per thread.
class OrientedLink {
 public:
  /// `rows`: #S x 3, row = triangle.
  OrientedLink(const Index* rows, std::size_t vertex_count) : rows_(rows), numbers_(vertex_count) {
    out_.fill(0);
    in_.fill(0);
    arrows_from_.fill(0);
  }

  /// Whether the link of v is a circle or an arc, has at most about 60 vertices, and its orientations agree. Then sets
  /// the faces. False if any of this does not hold; the link may still be a circle or an arc. `star`: the triangles
  /// around v, which repeat no vertex.
  [[nodiscard]] bool settle(Index v, std::span<const Index> star, FacesAbove& faces) {
    if (star.size() > 2 * kMost || !load(v, star) || !is_one_walk(star.size())) return false;
    faces = faces_;
    return true;
  }

 private:
  static constexpr unsigned kMost = LinkNumbers::kMost;
  using Set = LinkNumbers::Set;
  using Small = std::uint16_t;  ///< a number below 64; bytes would be assumed to alias everything

  /// The link's edges, oriented so that v followed by their vertices is the triangle of the complex. False if there are
  /// too many vertices, or two triangles induce the same orientation on a common edge.
  bool load(Index v, std::span<const Index> star) {
    for (unsigned a = 0; a < numbers_.size(); ++a) {
      out_[a] = in_[a] = 0;
      arrows_from_[a] = 0;
    }
    LinkNumbers::Numbering number(numbers_, v);
    Set repeated = 0;
    for (std::size_t i = 0; i < star.size() && number.size() < kMost - 2; ++i) {
      const OthersOfSimplex<3> others(rows_ + std::size_t{star[i]} * 3, v);
      const unsigned from = number(others[0]), to = number(others[1]);
      repeated |= out_[from] & LinkNumbers::one(to);
      out_[from] |= LinkNumbers::one(to);
      in_[to] |= LinkNumbers::one(from);
      ++arrows_from_[from];
    }
    numbers_.keep(number);
    faces_ = {};
    if (repeated != 0 || number.size() >= kMost - 2) return false;
    for (unsigned a = 0; a < numbers_.size(); ++a) {
      is_above_[a] = numbers_.vertex(a) > v;
      faces_.edges += is_above_[a];
    }
    return true;
  }

  /// Whether the arrows form one closed or open walk through all vertices.
  [[nodiscard]] bool is_one_walk(std::size_t arrows) {
    unsigned first = 0, starts = 0;
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

  const Index* rows_;
  LinkNumbers numbers_;
  FacesAbove faces_;
  std::array<Small, kMost> is_above_;     ///< whether its number in the complex is greater than the centre's
  std::array<Small, kMost> arrows_from_;  ///< how many
  std::array<Set, kMost> out_, in_;       ///< arrows from and to each vertex
};

}  // namespace tegl::detail
