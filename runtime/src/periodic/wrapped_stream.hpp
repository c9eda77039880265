// SPDX-License-Identifier: BSD-3-Clause
//
// Output of a streamed extraction of an image that is longer by one layer along its periodic axes: passes each vertex
// on the seam once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kernel/stream.hpp"
#include "periodic/seam_cells.hpp"
#include "periodic/wrapped_output.hpp"
#include "tegl/tile/disjoint_sets.hpp"

namespace tegl::detail {

/// Vertices are numbered in the kernel's order without those that are equal to one before. Equal vertices across the
/// last axis are in the first and in the last part; those across other axes are in the same part.
template <int N, class Real>
class WrappedStream final : public StreamOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Vertex;
  using typename ContourOutput<N, Real>::Simplex;

  struct Options {
    bool normals = false;
    bool close = false;
    bool may_miss_samples = false;
  };
  /// `shape`: of the longer image. Bit a of `axes`: axis a is periodic.
  WrappedStream(ContourSink<N, Real>& sink, const RowShape<N>& shape, unsigned axes, std::vector<Period<N>> periods,
                const Options& options);

  [[nodiscard]] RankReaders rank_readers() const noexcept override { return cells_.rank_readers(); }
  void see_layer(std::size_t k, const RowShape<N>& shape, const Layer<N>& layer, NumberedBy by) override {
    cells_.add_layer(k, shape, layer, by);
  }
  void see_slab(const SlabView<N>& view, NumberedBy by) override {
    cells_.add_slab(view, by);
    if (slabs_++ == 0 && repeats_layer_0_) numbers_of_layer_0_.resize(view.slab->edges.chunk_first[0]);
  }
  void finish(const ContourPart& all, const Caps<N, Real>* caps, const NonmanifoldCandidates& nonmanifold) override;

 private:
  using WideSimplex = typename ContourSink<N, Real>::Simplex;
  using Base = StreamOutput<N, Real>;

  void renumber(const ContourPart& part) override;
  void keep_simplices(const ContourPart& part, const NonmanifoldCandidates& nonmanifold) override;

  /// Joins the part's equal vertices, numbered from the part's first one on. Returns for each set that is equal to a
  /// vertex of layer 0 that vertex, by the set's smallest number; empty if there is none.
  std::vector<Index> join_seam(const ContourPart& part, BasicDisjointSets<Index>& sets);
  /// Assigns numbers to the part's vertices and moves those that are passed together.
  void number_vertices(const ContourPart& part);
  /// Final number of a vertex of any part by the kernel's number; only with `close`.
  [[nodiscard]] std::uint64_t final_number(std::uint64_t v) const noexcept;
  /// The vertices of caps without those that are equal to one before; their simplices to wide_.
  void take_caps(const Caps<N, Real>& caps, const ContourPart& all);

  static constexpr Index kNone = ~Index{0};
  const RowShape<N>& shape_;
  unsigned axes_;
  Options options_;
  bool repeats_layer_0_;
  SeamCells<N> cells_;
  std::size_t slabs_ = 0;
  std::vector<std::uint64_t> numbers_, before_numbers_;  ///< by vertex of the current and the previous part
  std::vector<std::uint64_t> numbers_of_layer_0_;
  std::vector<std::uint64_t> on_seam_;  ///< numbers of the part's vertices with copies before them
  std::vector<std::pair<std::uint64_t, std::uint64_t>> merged_;  ///< with `close`: (kernel's number, final number)
  std::size_t candidates_taken_ = 0;                             ///< of the kernel's candidates
  std::vector<std::uint64_t> candidates_;                        ///< their final numbers
  std::vector<std::pair<std::uint64_t, WideSimplex>> around_layer_0_;  ///< simplices that may turn out to be needed
};

}  // namespace tegl::detail
