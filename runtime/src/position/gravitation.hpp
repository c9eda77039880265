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
#include <cstdlib>
#include <utility>
#include <vector>

#include "image/vertex_moves.hpp"
#include "position/critical_edges.hpp"
#include "position/placed_source.hpp"

namespace tegl::detail {

/// Linear positions, and how gravitation moves the vertices there.
template <int N>
class Gravitation final : public PositionsOnEdges<N> {
 public:
  Gravitation(const SampleSource<N>& samples, const Grid<N>& grid, unsigned threads)
      : samples_(samples), signs_(samples, grid.sizes(), threads), linear_(grid.linear), mapped_(grid.has_world_map()) {
    for (int a = 0; a < N; ++a)
      for (std::size_t i = 0; i + 1 < grid.axes[a].size(); ++i)
        steps_[a].push_back(grid.axes[a][i + 1] - grid.axes[a][i]);
    for (int a = 0; a < N; ++a) steps_[a].push_back(0.0);  // of the last sample, which nothing pulls outwards
  }

  void find(const LayerEdges<N>& edges, double* out) const noexcept override {
    samples_.edge_alphas(edges.k, edges.axis, edges.edges, out);
  }
  /// As VertexMoves. The rows of `edges.edges` are not read.
  void find_moves(const LayerEdges<N>& edges, const double* alphas, std::array<double, N>* out) const noexcept {
    const auto along = [&]<int A>(std::integral_constant<int, A>) {
      if (edges.axis != A) return false;
      if (signs_.any_missing())
        find_moves_along<A, true>(edges, alphas, out);
      else
        find_moves_along<A, false>(edges, alphas, out);
      return true;
    };
    [&]<int... A>(std::integer_sequence<int, A...>) {
      static_cast<void>((along(std::integral_constant<int, A>()) || ...));
    }
    (std::make_integer_sequence<int, N>());
  }

 private:
  /// Vertices stay inside the double pyramid with the ends of the edge as tips, |d_1| + ... + |d_(N-1)| < distance from
  /// the nearer end. Then the corner of a tile is on the same side of all simplices around it.
  static constexpr double kInside = 0.999;
  using Pulls = std::array<int, N>;
  /// By the sum of all pulls: the move for a pull of 1, as a share of the distance from the nearer end.
  static constexpr auto kShares = [] {
    std::array<double, 2 * N - 1> shares{};
    for (std::size_t all = 0; all < shares.size(); ++all)
      shares[all] = all < 2 ? 0.5 : kInside / static_cast<double>(all);
    return shares;
  }();

  template <int AxisOfEdges, bool AnyMissing>
  void find_moves_along(const LayerEdges<N>& edges, const double* alphas, std::array<double, N>* out) const noexcept {
    Beside beside{};
    std::array<const double*, N> steps;
    for (int j = 0; j < N; ++j) steps[j] = steps_[j].data();
    for (std::size_t i = 0; i < edges.edges.count; ++i) {
      if (i == 0 || edges.row[i] != edges.row[i - 1]) enter_row(edges, i, beside);
      const std::size_t at = edges.edges.at[i];
      Pulls pulls{};
      if constexpr (AnyMissing)
        find_pulls_by_sample(beside, at, pulls);
      else
        find_pulls<AxisOfEdges>(beside, at, pulls);
      int all = 0;
      for (const int pull : pulls) all += std::abs(pull);
      const double each = std::min(alphas[i], 1.0 - alphas[i]) * kShares[static_cast<std::size_t>(all)];
      for (int j = 0; j < N; ++j) {  // without branches, which would be mispredicted
        const std::size_t to = j == 0 ? at : beside.index[j];
        out[i][j] = j == AxisOfEdges ? 0.0 : each * pulls[j] * steps[j][to - (pulls[j] < 0 ? 1 : 0)];
      }
      if (mapped_) out[i] = mapped(out[i]);
    }
  }

  /// The rows around the edges of a row.
  struct Beside {
    int axis = 0;
    SampleIndex<N> index{};                ///< of the first sample of the row
    std::array<std::size_t, 2> rows{};     ///< the rows of both ends
    std::array<const Word*, 2> high{};     ///< bits of the high samples of both
    std::array<std::ptrdiff_t, N> step{};  ///< by axis > 0: words to the next row; 0: along the edges, or at the border
    std::size_t inner = 0;                 ///< samples of a row without those at its ends
  };
  void enter_row(const LayerEdges<N>& edges, std::size_t i, Beside& beside) const noexcept {
    beside.axis = edges.axis;
    beside.index = edges.start(i);
    const std::size_t row = edges.row_of_all(i);
    beside.rows = {row, edges.axis == 0 ? row : row + signs_.stride(edges.axis)};
    beside.high = {signs_.high(beside.rows[0]), signs_.high(beside.rows[1])};
    beside.inner = signs_.sizes()[0] - 2;
    // vertices on the border stay on it
    for (int j = 1; j < N; ++j) {
      const bool inside = j != edges.axis && beside.index[j] > 0 && beside.index[j] + 1 < signs_.sizes()[j];
      beside.step[j] = inside ? signs_.high(signs_.stride(j)) - signs_.high(0) : 0;
    }
  }
  [[nodiscard]] bool pulls_along_row(const Beside& beside, std::size_t at) const noexcept {
    return beside.axis != 0 && at - 1 < beside.inner;
  }

  template <int AxisOfEdges>
  void find_pulls(const Beside& beside, std::size_t at, Pulls& pulls) const noexcept {
    const auto bit = [](const Word* bits, std::size_t i) {
      return static_cast<int>(bits[i / kWordBits] >> (i % kWordBits) & 1u);
    };
    const std::size_t end = AxisOfEdges == 0 ? at + 1 : at;
    const auto [lower, upper] = beside.high;
    const int sign = 2 * bit(lower, at) - 1;  // the sums are for a high lower end
    if (AxisOfEdges != 0 && pulls_along_row(beside, at))
      pulls[0] = sign * (bit(lower, at + 1) - bit(lower, at - 1) - bit(upper, at + 1) + bit(upper, at - 1));
    for (int j = 1; j < N; ++j) {
      if (j == AxisOfEdges) continue;
      const std::ptrdiff_t step = beside.step[j];  // 0 on the border, where the sum is 0, too
      pulls[j] =
          sign * (bit(lower + step, at) - bit(lower - step, at) - bit(upper + step, end) + bit(upper - step, end));
    }
  }
  /// The same beside missing samples, which count as samples on the side of the end.
  void find_pulls_by_sample(const Beside& beside, std::size_t at, Pulls& pulls) const noexcept {
    const bool high = signs_.is_high(beside.rows[0], at);
    for (int j = 0; j < N; ++j) {
      if (j == 0 ? !pulls_along_row(beside, at) : beside.step[j] == 0) continue;
      const std::size_t rows = j == 0 ? 0 : signs_.stride(j), along = j == 0 ? 1 : 0;
      for (std::size_t end = 0; end < 2; ++end) {
        const std::size_t row = beside.rows[end], place = beside.axis == 0 ? at + end : at;
        const auto is_alike = [&](std::size_t r, std::size_t i) {
          return signs_.is_missing(r, i) || signs_.is_high(r, i) == (high != (end == 1)) ? 1 : 0;
        };
        pulls[j] += is_alike(row + rows, place + along) - is_alike(row - rows, place - along);
      }
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

  void find_moves(std::size_t k, int axis, const EdgesInRows& edges, const double* alphas,
                  std::array<double, N>* out) const noexcept override {
    gravitation_.find_moves({this->rows(), k, axis, edges.rows, edges}, alphas, out);
  }

 private:
  const Gravitation<N>& gravitation_;
};

}  // namespace tegl::detail
