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
#include <bit>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "base/workers.hpp"
#include "kernel/memory_output.hpp"
#include "position/critical_edges.hpp"

namespace tegl::detail {

/// Output to a contour in memory whose vertices on edges are then moved.
template <int N, class Real>
class GravitationOutput final : public MemoryOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Vertex;

  GravitationOutput(Contour<N, Real>& contour, const SampleSource<N>& samples, const Grid<N>& grid,
                    const ExtractOptions& options, std::uint64_t max_vertices)
      : MemoryOutput<N, Real>(contour, options.normals != Normals::none, max_vertices),
        samples_(samples),
        grid_(grid),
        threads_(options.work.threads),
        signs_(samples, grid.sizes(), options.work.threads) {}

  [[nodiscard]] bool reads_numbers() const noexcept override { return true; }
  void see_layer(std::size_t k, const RowShape<N>& shape, const Layer<N>& layer, bool /*lists_cubes*/) override {
    for (int a = 0; a + 1 < N; ++a) see(a, k, shape, layer.edges[a]);
  }
  void see_slab(const RowShape<N>& shape, const Slab<N>& slab, bool /*lists_cubes*/) override {
    see(N - 1, slabs_++, shape, slab.edges);
  }

  void finish(const ContourPart& all, const Caps<N, Real>* caps, const NonmanifoldCandidates& nonmanifold) override {
    for (int a = 0; a < N; ++a)
      for_each_part(runs_[a].size(), threads_, {}, [&](std::size_t from, std::size_t end) {
        for (std::size_t i = from; i < end; ++i) move_run(a, runs_[a][i]);
      });
    MemoryOutput<N, Real>::finish(all, caps, nonmanifold);
  }

 private:
  /// Vertices stay inside the double pyramid with the ends of the edge as tips, |d_1| + ... + |d_(N-1)| < distance from
  /// the nearer end. Then the corner of a tile is on the same side of all simplices around it.
  static constexpr double kInside = 0.999;

  /// The vertices on edges of a row along one axis.
  struct Run {
    Index first;
    std::size_t row;
    std::size_t bits;  ///< place in `bits_` of the edges that have vertices
  };

  void see(int axis, std::size_t k, const RowShape<N>& shape, const EdgePlane& plane) {
    for (std::size_t row = 0; row < shape.rows(); ++row) {
      if (plane.count[row] == 0) continue;
      runs_[axis].push_back({plane.first(row), k * shape.rows() + row, bits_.size()});
      const auto from = plane.bits[0].begin() + static_cast<std::ptrdiff_t>(row * shape.words());
      bits_.insert(bits_.end(), from, from + static_cast<std::ptrdiff_t>(shape.words()));
    }
  }

  void move_run(int axis, const Run& run) {
    SampleIndex<N> index = signs_.index_of(run.row);
    Index vertex = run.first;
    for (std::size_t w = 0; w < signs_.words(); ++w)
      for (Word rest = bits_[run.bits + w]; rest != 0; rest &= rest - 1, ++vertex) {
        index[0] = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
        move(axis, run.row, index, this->contour().vertices[vertex]);
      }
  }

  void move(int axis, std::size_t row, const SampleIndex<N>& index, Vertex& vertex) const {
    const std::array<std::size_t, 2> rows = {row, axis == 0 ? row : row + signs_.stride(axis)};
    const std::array<std::size_t, 2> at = {index[0], index[0] + (axis == 0 ? 1 : 0)};
    std::array<int, N> pull{};
    int all = 0;
    for (int j = 0; j < N; ++j) {
      // vertices on the border stay on it
      if (j == axis || index[j] == 0 || index[j] + 1 == signs_.sizes()[j]) continue;
      for (int e = 0; e < 2; ++e) pull[j] += is_alike(rows[e], at[e], j, 1) - is_alike(rows[e], at[e], j, -1);
      all += std::abs(pull[j]);
    }
    if (all == 0) return;
    const double reach = distance_of_nearer_end(axis, index);
    const double each = std::min(0.5 * reach, kInside * reach / all);
    for (int j = 0; j < N; ++j) {
      const Axis& steps = grid_.axes[j];
      if (pull[j] == 0) continue;
      const std::size_t from = pull[j] > 0 ? index[j] : index[j] - 1;
      const double shift = each * pull[j] * (steps[from + 1] - steps[from]);
      for (int a = 0; a < N; ++a) vertex[a] = static_cast<Real>(vertex[a] + grid_.linear[a][j] * shift);
    }
  }

  /// Whether the neighbour of a sample along axis j, before or behind, is on the sample's side. Missing neighbours
  /// count as such.
  [[nodiscard]] int is_alike(std::size_t row, std::size_t i, int j, int direction) const {
    const bool high = signs_.is_high(row, i);
    const std::size_t step = j == 0 ? 1 : signs_.stride(j);
    std::size_t& moved = j == 0 ? i : row;
    moved = direction < 0 ? moved - step : moved + step;
    return signs_.is_missing(row, i) || signs_.is_high(row, i) == high ? 1 : 0;
  }

  [[nodiscard]] double distance_of_nearer_end(int axis, const SampleIndex<N>& index) const {
    double alpha = 0;
    samples_.cell_alphas(index, 1u << axis, 1, &alpha);
    return std::min(alpha, 1.0 - alpha);
  }

  const SampleSource<N>& samples_;
  const Grid<N>& grid_;
  unsigned threads_;
  SampleSigns<N> signs_;
  std::array<std::vector<Run>, N> runs_;  ///< by axis
  std::vector<Word> bits_;
  std::size_t slabs_ = 0;
};

}  // namespace tegl::detail
