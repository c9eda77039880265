// SPDX-License-Identifier: BSD-3-Clause
//
// Outputs of the extraction of an image that is longer by one layer along its periodic axes. They merge the vertices on
// the seam into a wrapped contour, or count it.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "hwy/cache_control.h"
#include "kernel/memory_output.hpp"
#include "periodic/seam_cells.hpp"
#include "periodic/seam_numbers.hpp"

namespace tegl::detail {

/// Adds the pairs of cap vertices, which are numbered from `first` on, at equal samples of the periodic image. Bit a of
/// `axes`: axis a is periodic.
template <int N, class Real>
void pair_cap_corners(const Caps<N, Real>& caps, const RowShape<N>& shape, unsigned axes, std::uint64_t first,
                      std::vector<std::pair<Index, Index>>& pairs) {
  std::map<std::array<std::size_t, N>, Index> at;
  for (auto [index, vertex] : caps.seam_corners()) {
    for (int a = 0; a < N; ++a)
      if ((axes >> a & 1u) != 0 && index[a] + 1 == shape.size(a)) index[a] = 0;
    const auto number = static_cast<Index>(first + vertex);
    const auto [found, is_new] = at.try_emplace(index, number);
    if (!is_new) pairs.emplace_back(number, found->second);
  }
}

/// Output to a contour in memory.
template <int N, class Real>
class WrappedOutput final : public MemoryOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Vertex;
  using typename ContourOutput<N, Real>::Simplex;
  using typename ContourOutput<N, Real>::Room;

  /// The contour has its periods already. `shape`: of the longer image. Bit a of `axes`: axis a is periodic.
  /// `most_simplices`: of a tile, at most.
  WrappedOutput(Contour<N, Real>& contour, const RowShape<N>& shape, unsigned axes, std::uint64_t most_simplices,
                bool normals, std::uint64_t max_vertices)
      : MemoryOutput<N, Real>(contour, normals, max_vertices),
        shape_(shape),
        axes_(axes),
        most_simplices_(most_simplices),
        cells_(axes) {}

  Room open(const ContourPart& part) override {
    parts_.push_back(part);
    return MemoryOutput<N, Real>::open(part);
  }

  [[nodiscard]] RankReaders rank_readers() const noexcept override { return cells_.rank_readers(); }
  void see_layer(std::size_t k, const RowShape<N>& shape, const Layer<N>& layer, NumberedBy by) override {
    cells_.add_layer(k, shape, layer, by);
  }
  void see_slab(const SlabView<N>& view, NumberedBy by) override {
    cells_.add_slab(view, by);
    add_seam_rows(*view.slab);
    ++slabs_;
  }

  void finish(const ContourPart& all, const Caps<N, Real>* caps, const NonmanifoldCandidates& nonmanifold) override {
    if (caps != nullptr) {
      this->add_caps(*caps, all.end_vertex);
      pair_cap_corners(*caps, shape_, axes_, all.end_vertex, cells_.pairs());
    }
    const SeamNumbers number(cells_.pairs(), this->contour().vertices.size());
    merge(all, number);
    if (!nonmanifold.any_missing()) return;
    std::vector<Index> candidates;
    for (const std::uint64_t v : nonmanifold.vertices()) candidates.push_back(number(static_cast<Index>(v)));
    // A vertex on several seams has copies with only some of its tiles each, so none of them is a candidate by itself.
    for (const auto& pair : cells_.pairs()) candidates.push_back(number(pair.first));
    if (caps != nullptr)
      for (std::size_t i = 0; i < caps->vertices().size(); ++i)
        candidates.push_back(number(static_cast<Index>(all.end_vertex + i)));
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    split_nonmanifold(this->contour(), candidates, this->max_vertices());
  }

 private:
  /// Simplices `first` ... `end` - 1.
  struct Range {
    std::uint64_t first, end;
  };

  /// Lists the simplices of the slab's tiles that have corners in a last layer along a periodic axis.
  void add_seam_rows(const Slab<N>& slab) {
    const bool all = is_periodic(N - 1) && slabs_ + 2 == shape_.layers();
    const std::size_t last = shape_.size(0) - 2;
    for (std::size_t row = 0; row < shape_.rows(); ++row) {
      // The counts of the rows of a uniform chunk are those of a slab before.
      if (slab.chunks[chunk_of(row)].active == 0 || slab.active_count[row] == 0) continue;
      bool whole = all;
      for (int a = 1; a < N - 1; ++a)
        whole = whole || (is_periodic(a) && shape_.index_of(row)[a] + 2 == shape_.size(a));
      const bool at_end =
          is_periodic(0) && (slab.active[row * shape_.words() + last / kWordBits] >> (last % kWordBits) & 1u) != 0;
      if (!whole && !at_end) continue;
      const std::uint64_t first = slab.first_simplex(row), end = first + slab.simplices(row);
      rows_.push_back({whole ? first : end, end});
      if (!whole) rows_.back().first = std::max(first, end - std::min(end, most_simplices_));
    }
  }
  [[nodiscard]] bool is_periodic(int axis) const noexcept { return (axes_ >> axis & 1u) != 0; }

  void merge(const ContourPart& all, const SeamNumbers& number) {
    Contour<N, Real>& contour = this->contour();
    number.for_each_move([&](Index to) { hwy::Prefetch(&contour.vertices[to]); },
                         [&](Index from, Index to) {
                           contour.vertices[to] = contour.vertices[from];
                           if (!contour.normals.empty()) contour.normals[to] = contour.normals[from];
                         });
    contour.vertices.resize(number.kept());
    if (!contour.normals.empty()) contour.normals.resize(number.kept());
    // the simplices of the vertices that moved: their part's, the next ones', and caps
    const auto part = std::find_if(parts_.begin(), parts_.end(),
                                   [&](const ContourPart& each) { return each.end_vertex > number.kept(); });
    std::uint64_t tail = part == parts_.end() ? all.end_simplex : part->first_simplex;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Range& range = rows_[i];
      // Most are no longer in a near cache, and far apart.
      const Range& later = rows_[std::min(i + kAhead, rows_.size() - 1)];
      hwy::Prefetch(contour.simplices.data() + later.first);
      hwy::Prefetch(contour.simplices.data() + later.end);
      renumber_moved(number, tail, range.first);
      renumber(number, range.first, range.end);
      tail = std::max(tail, range.end);
    }
    renumber_moved(number, tail, all.end_simplex);
    renumber(number, all.end_simplex, contour.simplices.size());
  }
  void renumber(const SeamNumbers& number, std::uint64_t first, std::uint64_t end) {
    for (std::uint64_t s = first; s < end; ++s)
      for (Index& v : this->contour().simplices[s]) v = number(v);
  }
  /// As `renumber`, for simplices without merged vertices.
  void renumber_moved(const SeamNumbers& number, std::uint64_t first, std::uint64_t end) {
    const std::size_t kept = number.kept();
    for (std::uint64_t s = first; s < end; ++s)
      for (Index& v : this->contour().simplices[s])
        if (v >= kept) v = number(v);
  }

  static constexpr std::size_t kAhead = 16;  ///< ranges of simplices that are requested

  const RowShape<N>& shape_;
  unsigned axes_;
  std::uint64_t most_simplices_;
  SeamCells<N> cells_;
  std::size_t slabs_ = 0;
  std::vector<ContourPart> parts_;
  std::vector<Range> rows_;  ///< simplices of tiles at the seam, ascending and disjoint
};

/// Counts only. Vertices doubled at missing values are not counted.
template <int N, class Real>
class WrappedCount final : public ContourOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Room;
  WrappedCount(const RowShape<N>& shape, unsigned axes) : shape_(shape), axes_(axes), cells_(axes) {}

  Room open(const ContourPart& /*part*/) override { return {nullptr, nullptr}; }
  [[nodiscard]] RankReaders rank_readers() const noexcept override { return cells_.rank_readers(); }
  void see_layer(std::size_t k, const RowShape<N>& shape, const Layer<N>& layer, NumberedBy by) override {
    cells_.add_layer(k, shape, layer, by);
  }
  void see_slab(const SlabView<N>& view, NumberedBy by) override { cells_.add_slab(view, by); }
  void finish(const ContourPart& all, const Caps<N, Real>* caps, const NonmanifoldCandidates& nonmanifold) override {
    size = {all.end_vertex, all.end_simplex};
    any_missing = nonmanifold.any_missing();
    if (caps != nullptr) {
      pair_cap_corners(*caps, shape_, axes_, all.end_vertex, cells_.pairs());
      size.vertices += caps->vertices().size();
      size.simplices += caps->simplices().size();
    }
    size.vertices -= SeamNumbers(cells_.pairs(), size.vertices).dropped();
  }

  ContourSize size;
  bool any_missing = false;

 private:
  const RowShape<N>& shape_;
  unsigned axes_;
  SeamCells<N> cells_;
};

}  // namespace tegl::detail
