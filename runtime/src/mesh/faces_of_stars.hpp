// SPDX-License-Identifier: BSD-3-Clause
//
// Counts the faces of a complex: Euler characteristic, boundary faces, and faces whose orientations do not cancel. Each
// face is counted at its smallest vertex, whose star contains all simplices around the face. So no table of faces is
// needed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/function_ref.hpp"
#include "mesh/link_above.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Counts at one vertex, or their sums over several vertices.
struct FaceCounts {
  std::int64_t euler = 0;      ///< alternating sum of the numbers of faces
  std::uint64_t boundary = 0;  ///< (N-2)-faces in exactly one simplex
  std::uint64_t open = 0;      ///< (N-2)-faces whose simplices' orientations do not cancel

  FaceCounts& operator+=(const FaceCounts& other) noexcept {
    euler += other.euler;
    boundary += other.boundary;
    open += other.open;
    return *this;
  }
};

/// One side of a face: its vertices, ascending, or all but the smallest. `orientation`: 1 if the simplex induces the
/// ascending order of the face's vertices, else -1.
template <std::size_t Size>
struct RidgeSide {
  std::array<Index, Size> vertices;
  int orientation;
  bool operator<(const RidgeSide& other) const noexcept { return vertices < other.vertices; }
};

/// Sorts numbers, and returns 1 for an even number of exchanges, else -1.
template <std::size_t Size>
int sort_signed(std::array<Index, Size>& numbers) noexcept {
  int sign = 1;
  for (std::size_t i = 1; i < Size; ++i)  // insertion sort, to count the exchanges
    for (std::size_t j = i; j > 0 && numbers[j] < numbers[j - 1]; --j) {
      std::swap(numbers[j], numbers[j - 1]);
      sign = -sign;
    }
  return sign;
}

/// The side of a simplex with the vertices from `first` except one. `sorted`: the vertices of the simplex, ascending;
/// `orientation`: 1 if this order has the simplex's orientation, else -1.
template <int N, int First = 0>
RidgeSide<N - 1 - First> side_without(const std::array<Index, N>& sorted, int omitted, int orientation,
                                      int first = First) noexcept {
  RidgeSide<N - 1 - First> side;
  side.orientation = omitted % 2 == 0 ? orientation : -orientation;
  for (int j = first, k = 0; j < N; ++j)
    if (j != omitted) side.vertices[k++] = sorted[j];
  return side;
}

/// Sorts sides of faces and counts the faces: boundary faces, and those whose orientations do not cancel, for which it
/// calls on_open(vertices). Returns the number of faces.
template <std::size_t Size, class OnOpen>
std::int64_t count_sides(std::vector<RidgeSide<Size>>& sides, FaceCounts& counts, const OnOpen& on_open) {
  std::sort(sides.begin(), sides.end());
  std::int64_t faces = 0;
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    int balance = 0;
    while (j < sides.size() && sides[j].vertices == sides[i].vertices) balance += sides[j++].orientation;
    ++faces;
    if (j - i == 1) ++counts.boundary;
    if (balance == 0) continue;
    ++counts.open;
    on_open(sides[i].vertices);
  }
  return faces;
}

/// Face counter for a complex of simplices with N vertices each. Use one per thread.
template <int N>
class FacesOfStars {
 public:
  /// An (N-2)-face: its vertices, ascending.
  using Ridge = std::array<Index, N - 1>;

  /// `rows`: #S x N, row = simplex. `with_euler`: whether to count the Euler characteristic.
  FacesOfStars(const Index* rows, std::size_t vertex_count, bool with_euler)
      : rows_(rows), with_euler_(with_euler), usual_(rows, vertex_count, with_euler) {}

  /// Counts the faces with v as their smallest vertex; `star`: the simplices around v that repeat no vertex. Calls
  /// on_open(ridge) for every (N-2)-face whose orientations do not cancel.
  template <class OnOpen>
  FaceCounts visit(Index v, std::span<const Index> star, const OnOpen& on_open) {
    if (star.empty()) return {};
    if constexpr (N == 3 || N == 4)
      if (usual_.load(v, star)) return count_usual(v, on_open);
    sides_.clear();
    edges_.clear();
    triangles_.clear();
    std::int64_t simplices = 0;
    for (const Index s : star) {
      if (load(v, rows_ + std::size_t{s} * N)) ++simplices;
    }
    FaceCounts counts;
    const std::int64_t ridges = count_sides(sides_, counts, [&](const Rest& rest) { on_open(ridge_of(v, rest)); });
    if (!with_euler_) return counts;
    counts.euler = 1;
    if constexpr (N >= 4) counts.euler -= distinct(edges_);
    if constexpr (N == 5) counts.euler += distinct(triangles_);
    if constexpr (N >= 3) counts.euler += sign(N - 2) * ridges;
    counts.euler += sign(N - 1) * simplices;
    return counts;
  }

 private:
  using Rest = std::array<Index, N - 2>;  // the vertices of a ridge except the smallest

  static constexpr std::int64_t sign(int dimension) { return dimension % 2 == 0 ? 1 : -1; }

  static Ridge ridge_of(Index v, const Rest& rest) noexcept {
    Ridge ridge;
    ridge[0] = v;
    std::copy(rest.begin(), rest.end(), ridge.begin() + 1);
    return ridge;
  }

  /// In place of LinkAbove in other dimensions.
  struct NoLink {
    NoLink(const Index*, std::size_t, bool) {}
  };

  template <class OnOpen>
  FaceCounts count_usual(Index v, const OnOpen& on_open) {
    FaceCounts counts;
    counts.open = counts.boundary = usual_.visit_open([&](const Rest& rest) { on_open(ridge_of(v, rest)); });
    if (!with_euler_) return counts;
    const auto ridges = static_cast<std::int64_t>(usual_.ridges());
    counts.euler = 1 + sign(N - 2) * ridges + sign(N - 1) * static_cast<std::int64_t>(usual_.simplices());
    if constexpr (N == 4) counts.euler -= static_cast<std::int64_t>(usual_.edges());
    return counts;
  }

  template <class Key>
  static std::int64_t distinct(std::vector<Key>& keys) {
    std::sort(keys.begin(), keys.end());
    return std::unique(keys.begin(), keys.end()) - keys.begin();
  }

  /// Lists the faces of a simplex whose smallest vertex is v. Returns whether v is the smallest vertex of the simplex
  /// itself.
  bool load(Index v, const Index* row) {
    std::array<Index, N> sorted;
    std::copy_n(row, N, sorted.begin());
    const int orientation = sort_signed(sorted);
    const auto at = static_cast<int>(std::find(sorted.begin(), sorted.end(), v) - sorted.begin());
    for (int omitted = at == 0 ? 1 : 0; at <= 1 && omitted < (at == 0 ? N : 1); ++omitted)
      sides_.push_back(side_without<N, 1>(sorted, omitted, orientation, at + 1));
    if (!with_euler_) return at == 0;
    if constexpr (N >= 4) edges_.insert(edges_.end(), sorted.begin() + at + 1, sorted.end());
    if constexpr (N == 5)
      for (int i = at + 1; i < N; ++i)
        for (int j = i + 1; j < N; ++j) triangles_.push_back({sorted[i], sorted[j]});
    return at == 0;
  }

  const Index* rows_;
  bool with_euler_;
  std::conditional_t<N == 3 || N == 4, LinkAbove<N == 3 ? 3 : 4>, NoLink> usual_;
  std::vector<RidgeSide<N - 2>> sides_;
  std::vector<Index> edges_;
  std::vector<std::array<Index, 2>> triangles_;
};

/// Vertices or simplices per block: large enough to amortize the cost of a block, small enough to occupy all threads.
inline constexpr std::size_t kBlock = 4096;

/// Counts the faces of a complex by the label of their vertices (without labels: one label for all). Calls
/// on_open(block, ridge) for each (N-2)-face whose orientations do not cancel. Blocks run in parallel; the calls of one
/// block are sequential.
template <int N>
std::vector<FaceCounts> count_faces(
    std::span<const Index> rows, const Stars& stars, std::span<const Index> labels, std::size_t label_count,
    bool with_euler, unsigned threads, const Progress& progress,
    FunctionRef<void(std::size_t block, const typename FacesOfStars<N>::Ridge& ridge)> on_open);

}  // namespace tegl::detail
