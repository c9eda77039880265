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
    const std::int64_t ridges = count_ridges(v, counts, on_open);
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
  /// One side of a ridge. `orientation`: 1 if the simplex induces the ascending order of the ridge's vertices, else -1.
  struct Side {
    Rest rest;
    int orientation;
    bool operator<(const Side& other) const noexcept { return rest < other.rest; }
  };

  static constexpr std::int64_t sign(int dimension) { return dimension % 2 == 0 ? 1 : -1; }

  /// In place of LinkAbove in other dimensions.
  struct NoLink {
    NoLink(const Index*, std::size_t, bool) {}
  };

  template <class OnOpen>
  FaceCounts count_usual(Index v, const OnOpen& on_open) {
    FaceCounts counts;
    counts.open = counts.boundary = usual_.visit_open([&](const Rest& rest) {
      Ridge ridge;
      ridge[0] = v;
      std::copy(rest.begin(), rest.end(), ridge.begin() + 1);
      on_open(ridge);
    });
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
    int orientation = 1;
    for (int i = 1; i < N; ++i)  // insertion sort, to count the exchanges
      for (int j = i; j > 0 && sorted[j] < sorted[j - 1]; --j) {
        std::swap(sorted[j], sorted[j - 1]);
        orientation = -orientation;
      }
    const auto at = static_cast<int>(std::find(sorted.begin(), sorted.end(), v) - sorted.begin());
    for (int omitted = at == 0 ? 1 : 0; at <= 1 && omitted < (at == 0 ? N : 1); ++omitted) {
      Side side;
      side.orientation = omitted % 2 == 0 ? orientation : -orientation;
      for (int j = at + 1, k = 0; j < N; ++j)
        if (j != omitted) side.rest[k++] = sorted[j];
      sides_.push_back(side);
    }
    if (!with_euler_) return at == 0;
    if constexpr (N >= 4) edges_.insert(edges_.end(), sorted.begin() + at + 1, sorted.end());
    if constexpr (N == 5)
      for (int i = at + 1; i < N; ++i)
        for (int j = i + 1; j < N; ++j) triangles_.push_back({sorted[i], sorted[j]});
    return at == 0;
  }

  template <class OnOpen>
  std::int64_t count_ridges(Index v, FaceCounts& counts, const OnOpen& on_open) {
    std::sort(sides_.begin(), sides_.end());
    std::int64_t ridges = 0;
    for (std::size_t i = 0, j = 0; i < sides_.size(); i = j) {
      int balance = 0;
      while (j < sides_.size() && sides_[j].rest == sides_[i].rest) balance += sides_[j++].orientation;
      ++ridges;
      if (j - i == 1) ++counts.boundary;
      if (balance == 0) continue;
      ++counts.open;
      Ridge ridge;
      ridge[0] = v;
      std::copy(sides_[i].rest.begin(), sides_[i].rest.end(), ridge.begin() + 1);
      on_open(ridge);
    }
    return ridges;
  }

  const Index* rows_;
  bool with_euler_;
  std::conditional_t<N == 3 || N == 4, LinkAbove<N == 3 ? 3 : 4>, NoLink> usual_;
  std::vector<Side> sides_;
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
