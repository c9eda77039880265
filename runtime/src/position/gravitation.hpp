// SPDX-License-Identifier: BSD-3-Clause
//
// Gravitation: moves vertices on edges across their edges, by the sides of the samples beside both ends.
//
// Based on: M. Liversage, thesis, 1994, section 9.2.6. On an edge with the high end H and the low end L, and for each
// direction j across it: G = [b high] - [a high] + [d low] - [c low], for the neighbours a, b of H and c, d of L before
// and behind them along j. The vertex moves by G / 2 times its distance from the nearer end, as a share of the edge.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "image/vertex_moves.hpp"
#include "position/critical_edges.hpp"
#include "position/placed_source.hpp"
#include "position/pulls.hpp"

namespace tegl::detail {

/// Linear positions, and how gravitation moves the vertices there.
template <int N>
class Gravitation final : public PositionsOnEdges<N> {
 public:
  Gravitation(const SampleSource<N>& samples, const Grid<N>& grid, unsigned threads)
      : samples_(samples), signs_(samples, grid.sizes(), threads), linear_(grid.linear), mapped_(grid.has_world_map()) {
    for (int a = 0; a < N; ++a) {
      for (std::size_t i = 0; i + 1 < grid.axes[a].size(); ++i)
        steps_[a].push_back(grid.axes[a][i + 1] - grid.axes[a][i]);
      for (const double step : steps_[a]) equal_steps_ = equal_steps_ && step == steps_[a].front();
    }
    for (int a = 0; a < N; ++a) steps_[a].push_back(0.0);  // of the last sample, which nothing pulls outwards
  }

  void find(const LayerEdges<N>& edges, double* out) const noexcept override {
    samples_.edge_alphas(edges.k, edges.axis, edges.edges, out);
  }
  /// As VertexMoves. The rows of `edges.edges` are not read.
  template <class Real>
  void move(const LayerEdges<N>& edges, const double* alphas, std::array<Real, N>* vertices) const noexcept {
    const auto along = [&]<int A>(std::integral_constant<int, A>) {
      if (edges.axis != A) return false;
      std::array<std::uint16_t, LayerEdges<N>::kMost> numbers;
      if (signs_.any_missing())
        find_pulls<A, true>(edges, numbers.data());
      else
        find_pulls<A, false>(edges, numbers.data());
      if (mapped_)
        move_along<A, true, false>(edges, numbers.data(), alphas, vertices);
      else if (equal_steps_)
        move_along<A, false, true>(edges, numbers.data(), alphas, vertices);
      else
        move_along<A, false, false>(edges, numbers.data(), alphas, vertices);
      return true;
    };
    [&]<int... A>(std::integer_sequence<int, A...>) {
      static_cast<void>((along(std::integral_constant<int, A>()) || ...));
    }
    (std::make_integer_sequence<int, N>());
  }

 private:
  using Numbers = PullNumbers<N>;
  static constexpr std::size_t kDirections = Numbers::kDirections;
  static_assert(Numbers::kCount <= 1u << 16);
  /// Vertices stay inside the double pyramid with the ends of the edge as tips, |d_1| + ... + |d_(N-1)| < distance from
  /// the nearer end. Then the corner of a tile is on the same side of all simplices around it.
  static constexpr double kInside = 0.999;
  /// The moves by directions across an edge.
  struct Move {
    std::array<double, kDirections> share;           ///< of the distance from the nearer end
    std::array<std::ptrdiff_t, kDirections> before;  ///< -1: towards the sample before; else 0
  };
  static constexpr auto kMoves = [] {
    std::array<Move, Numbers::kCount> moves{};
    for (std::size_t number = 0; number < moves.size(); ++number) {
      int all = 0;
      for (std::size_t j = 0; j < kDirections; ++j) {
        const int pull = Numbers::pull(number, j);
        all += pull < 0 ? -pull : pull;
        moves[number].before[j] = pull < 0 ? -1 : 0;
      }
      const double each = all < 2 ? 0.5 : kInside / static_cast<double>(all);
      for (std::size_t j = 0; j < kDirections; ++j) moves[number].share[j] = each * Numbers::pull(number, j);
    }
    return moves;
  }();

  template <int A, bool AnyMissing>
  void find_pulls(const LayerEdges<N>& edges, std::uint16_t* numbers) const noexcept {
    const PullsInLayer<N, A> pulls(signs_, edges.rows, edges.k);
    for (std::size_t i = 0; i < edges.edges.count; ++i)
      numbers[i] = static_cast<std::uint16_t>(
          pulls.template number<AnyMissing>(static_cast<std::size_t>(edges.row[i]), edges.edges.at[i]));
  }

  template <int A, bool Mapped, bool EqualSteps, class Real>
  void move_along(const LayerEdges<N>& edges, const std::uint16_t* numbers, const double* alphas,
                  std::array<Real, N>* vertices) const noexcept {
    std::array<const double*, N> steps;
    std::array<double, N> step{};
    for (int j = 0; j < N; ++j) {
      steps[j] = steps_[j].data();
      step[j] = steps[j][0];
    }
    for (std::size_t i = 0; i < edges.edges.count; ++i) {
      const Move& move = kMoves[numbers[i]];
      const double nearer = std::min(alphas[i], 1.0 - alphas[i]);
      std::array<double, N> by{};
      for (int j = 0; j < N; ++j) {
        if (j == A) continue;
        const int direction = j < A ? j : j - 1;
        if constexpr (!EqualSteps) {
          const std::size_t at = j == 0       ? edges.edges.at[i]
                                 : j == N - 1 ? edges.k
                                              : edges.rows.start(static_cast<std::size_t>(edges.row[i]))[j];
          step[j] = (steps[j] + at)[move.before[direction]];
        }
        by[j] = nearer * move.share[direction] * step[j];
      }
      if constexpr (Mapped) by = mapped(by);
      std::array<Real, N>& vertex = vertices[i];
      for (int j = 0; j < N; ++j)
        if (Mapped || j != A) vertex[j] = static_cast<Real>(vertex[j] + by[j]);
    }
  }
  [[nodiscard]] std::array<double, N> mapped(const std::array<double, N>& move) const noexcept {
    std::array<double, N> result{};
    for (int a = 0; a < N; ++a)
      for (int b = 0; b < N; ++b) result[a] += linear_[a][b] * move[b];
    return result;
  }

  const SampleSource<N>& samples_;
  SampleSigns<N> signs_;
  std::array<std::vector<double>, N> steps_;  ///< by axis and sample: to the next one; 0 for the last
  bool equal_steps_ = true;                   ///< all steps of each axis are equal
  Matrix<N> linear_;
  bool mapped_;
};

/// A source whose contour has vertices moved by gravitation.
template <int N>
class GravitationSource final : public PlacedSource<N>, public VertexMoves<N> {
 public:
  /// As PlacedSource.
  GravitationSource(SampleSource<N>& samples, const LayerRows<N>& rows, const Axis& last_axis,
                    const Gravitation<N>& gravitation, double epsilon)
      : PlacedSource<N>(samples, rows, last_axis, gravitation, epsilon), gravitation_(gravitation) {}

  void move(std::size_t k, int axis, const EdgesInRows& edges, const double* alphas,
            std::array<float, N>* vertices) const noexcept override {
    gravitation_.move({this->rows(), k, axis, edges.rows, edges}, alphas, vertices);
  }
  void move(std::size_t k, int axis, const EdgesInRows& edges, const double* alphas,
            std::array<double, N>* vertices) const noexcept override {
    gravitation_.move({this->rows(), k, axis, edges.rows, edges}, alphas, vertices);
  }

 private:
  const Gravitation<N>& gravitation_;
};

}  // namespace tegl::detail
