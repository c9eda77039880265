// SPDX-License-Identifier: BSD-3-Clause
//
// The faces around a vertex that are in one simplex only, and the lower and upper link of a vertex. Both are found with
// words of 64 bits for sets of vertices of the link, which is fast for nearly all vertices.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/link_numbers.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Finds the (N-2)-faces that are in one simplex only. Each simplex lists its vertices in ascending order. Use one
/// object per thread. N = 2 to 5; for N = 5 always by sorting.
template <int N>
class SingleFaces {
 public:
  using Simplex = std::array<Index, N>;

  SingleFaces(std::span<const Simplex> simplices, std::size_t vertex_count)
      : simplices_(simplices), numbers_(vertex_count) {
    once_.fill(0);
    twice_.fill(0);
  }

  /// Calls on_single(simplex, omitted) for each face with v as its smallest vertex that is in one simplex only. The
  /// face has the simplex's vertices except the one at position `omitted`. `star`: the simplices around v that repeat
  /// no vertex.
  template <class OnSingle>
  void visit(Index v, std::span<const Index> star, const OnSingle& on_single) {
    if constexpr (N == 2) {
      if (star.size() == 1) on_single(star[0], simplices_[star[0]][0] == v ? 1 : 0);
    } else if constexpr (N == 5) {
      sort_faces(v, star, on_single);
    } else if (is_counted(v, star)) {
      for (unsigned a = 0; a < numbers_.size(); ++a)
        for (Set rest = once_[a] & ~twice_[a]; rest != 0; rest &= rest - 1)
          find(face_of(v, a, static_cast<unsigned>(std::countr_zero(rest))), star, on_single);
    } else {
      sort_faces(v, star, on_single);
    }
  }

 private:
  using Set = LinkNumbers::Set;
  using Face = std::array<Index, N - 1>;  ///< ascending

  static Face face_without(const Simplex& simplex, int omitted) {
    Face face;
    for (int i = 0, k = 0; i < N; ++i)
      if (i != omitted) face[k++] = simplex[i];
    return face;
  }

  /// N = 3: face (v, a) is bit 0 of `once_[a]`; N = 4: face (v, a, b) is bit b of `once_[a]`.
  [[nodiscard]] Face face_of(Index v, unsigned a, unsigned b) const {
    Face face;
    face[0] = v;
    face[1] = numbers_.vertex(a);
    if constexpr (N == 4) face[2] = numbers_.vertex(b);
    return face;
  }

  void add(unsigned a, Set b) {
    twice_[a] |= once_[a] & b;
    once_[a] |= b;
  }

  /// False if there are too many vertices.
  bool is_counted(Index v, std::span<const Index> star) {
    for (unsigned a = 0; a < numbers_.size(); ++a) once_[a] = twice_[a] = 0;
    LinkNumbers::Numbering number_of(numbers_, v);
    for (const Index s : star) {
      if (number_of.size() > LinkNumbers::kMost - N) break;
      const Simplex simplex = simplices_[s];
      const bool is_first = simplex[0] == v;
      if (!is_first && simplex[1] != v) continue;  // each of its faces has a smaller vertex
      const int first = is_first ? 1 : 2;
      std::array<unsigned, N> number;
      for (int i = first; i < N; ++i) number[i] = number_of(simplex[i]);
      if constexpr (N == 3) {
        for (int i = first; i < N; ++i) add(number[i], 1);
      } else {
        for (int i = first; i < N; ++i)
          for (int j = i + 1; j < N; ++j) add(number[i], LinkNumbers::one(number[j]));
      }
    }
    numbers_.keep(number_of);
    return numbers_.size() <= LinkNumbers::kMost - N;
  }

  template <class OnSingle>
  void find(const Face& face, std::span<const Index> star, const OnSingle& on_single) const {
    for (const Index s : star)
      for (int omitted = 0; omitted < N; ++omitted)
        if (face_without(simplices_[s], omitted) == face) return on_single(s, omitted);
  }

  struct FaceOf {
    Face face;
    Index simplex;
    int omitted;
  };
  template <class OnSingle>
  void sort_faces(Index v, std::span<const Index> star, const OnSingle& on_single) {
    faces_.clear();
    for (const Index s : star)
      for (int omitted = 0; omitted < N; ++omitted) {
        const Face face = face_without(simplices_[s], omitted);
        if (face[0] == v) faces_.push_back({face, s, omitted});
      }
    std::sort(faces_.begin(), faces_.end(), [](const FaceOf& a, const FaceOf& b) { return a.face < b.face; });
    for (std::size_t i = 0, j = 0; i < faces_.size(); i = j) {
      while (j < faces_.size() && faces_[j].face == faces_[i].face) ++j;
      if (j - i == 1) on_single(faces_[i].simplex, faces_[i].omitted);
    }
  }

  std::span<const Simplex> simplices_;
  LinkNumbers numbers_;
  std::array<Set, LinkNumbers::kMost> once_, twice_;  ///< faces in a simplex, in two or more
  std::vector<FaceOf> faces_;
};

/// Tests the lower and the upper link of vertices. Each simplex lists its vertices in ascending order. Use one object
/// per thread.
template <int N>
class LinkSides {
 public:
  LinkSides(std::span<const std::array<Index, N>> simplices, std::size_t vertex_count)
      : simplices_(simplices), numbers_(vertex_count) {
    beside_.fill(0);
  }

  /// Whether the vertices of the link below v are connected by edges of the link among them, and those above v, too. No
  /// if there are none, or if the link has more than 60 vertices. `star`: the simplices around v that repeat no vertex.
  [[nodiscard]] bool are_connected(Index v, std::span<const Index> star) {
    for (unsigned a = 0; a < numbers_.size(); ++a) beside_[a] = 0;
    LinkNumbers::Numbering number_of(numbers_, v);
    number_of(v);  // 0; its bit is in no set
    Set below = 0, above = 0;
    Set* const beside = beside_.data();
    for (const Index s : star) {
      if (number_of.size() > LinkNumbers::kMost - N) break;
      const std::array<Index, N> simplex = simplices_[s];
      Set lower = 0, upper = 0;
      std::array<unsigned, N> number;
      for (int i = 0; i < N; ++i) {
        const Index u = simplex[i];
        number[i] = number_of(u);
        const Set one = LinkNumbers::one(number[i]);
        lower |= u < v ? one : 0;
        upper |= u > v ? one : 0;
      }
      for (int i = 0; i < N; ++i) beside[number[i]] |= simplex[i] < v ? lower : upper;
      below |= lower;
      above |= upper;
    }
    numbers_.keep(number_of);
    below_ = below;
    above_ = above;
    return numbers_.size() <= LinkNumbers::kMost - N && is_connected(below) && is_connected(above);
  }

  /// After `are_connected` found that they are: the Euler characteristic of the link above v minus that of the link
  /// below it. N = 3, 4.
  [[nodiscard]] std::int64_t euler_change(Index v, std::span<const Index> star) {
    std::int64_t change = euler_of_graph(above_) - euler_of_graph(below_);
    if constexpr (N == 4) {
      above_triangles_.clear();
      below_triangles_.clear();
      for (const Index s : star) {
        const std::array<Index, N>& simplex = simplices_[s];
        if (simplex.front() == v) above_triangles_.push_back(simplex);
        if (simplex.back() == v) below_triangles_.push_back(simplex);
      }
      change += distinct(above_triangles_) - distinct(below_triangles_);
    }
    return change;
  }

 private:
  using Set = LinkNumbers::Set;

  /// Vertices minus edges.
  [[nodiscard]] std::int64_t euler_of_graph(Set all) const {
    std::int64_t ends = 0;  // of edges, and each vertex with itself
    for (Set rest = all; rest != 0; rest &= rest - 1)
      ends += std::popcount(beside_[static_cast<unsigned>(std::countr_zero(rest))]);
    const std::int64_t vertices = std::popcount(all);
    return vertices - (ends - vertices) / 2;
  }

  static std::int64_t distinct(std::vector<std::array<Index, N>>& simplices) {
    std::sort(simplices.begin(), simplices.end());
    return std::unique(simplices.begin(), simplices.end()) - simplices.begin();
  }

  [[nodiscard]] bool is_connected(Set all) const {
    Set reached = all & (~all + 1), open = reached;  // the first one
    while (open != 0) {
      const Set beside = beside_[static_cast<unsigned>(std::countr_zero(open))] & ~reached;
      open &= open - 1;
      reached |= beside;
      open |= beside;
    }
    return all != 0 && reached == all;
  }

  std::span<const std::array<Index, N>> simplices_;
  LinkNumbers numbers_;
  std::array<Set, LinkNumbers::kMost> beside_;  ///< by number: vertices on the same side in a common simplex
  Set below_ = 0, above_ = 0;                   ///< vertices of the link
  std::vector<std::array<Index, N>> above_triangles_, below_triangles_;  ///< simplices with v as an end
};

}  // namespace tegl::detail
