// SPDX-License-Identifier: BSD-3-Clause
//
// Output of the extraction of an image that is longer by one layer along its periodic axes: merges the vertices on the
// seam into a wrapped contour.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/periods.hpp"
#include "base/workers.hpp"
#include "kernel/memory_output.hpp"
#include "periodic/seam_cells.hpp"

namespace tegl::detail {

template <int N, class Real>
class WrappedOutput final : public MemoryOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Vertex;
  using typename ContourOutput<N, Real>::Simplex;

  /// The contour has its periods already. Bit a of `axes`: axis a is periodic.
  WrappedOutput(Contour<N, Real>& contour, unsigned axes, unsigned threads, std::uint64_t max_vertices)
      : MemoryOutput<N, Real>(contour, false, max_vertices), cells_(axes), threads_(threads) {}

  [[nodiscard]] bool reads_numbers() const noexcept override { return true; }
  void see_layer(std::size_t k, const RowShape<N>& shape, const Layer<N>& layer, bool lists_cubes) override {
    cells_.add_layer(k, shape, layer, lists_cubes);
  }
  void see_slab(const RowShape<N>& shape, const Slab<N>& slab, bool lists_cubes) override {
    cells_.add_slab(shape, slab, lists_cubes);
  }

  void finish(const ContourPart& /*all*/, const Caps<N, Real>* /*caps*/,
              const NonmanifoldCandidates& nonmanifold) override {
    const Buffer<Index> number = number_merged();
    merge(number);
    if (!nonmanifold.any_missing()) return;
    std::vector<Index> candidates;
    for (const std::uint64_t v : nonmanifold.vertices()) candidates.push_back(number[v]);
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    split_nonmanifold(this->contour(), candidates, this->max_vertices());
  }

 private:
  /// For each vertex its number after merging: the vertices of a set get the number of the smallest one. Sets
  /// `dropped_`.
  [[nodiscard]] Buffer<Index> number_merged() {
    // the vertices on the seam, ascending, and their sets
    std::vector<Index> seam;
    for (const auto& [last, first] : cells_.pairs()) {
      seam.push_back(last);
      seam.push_back(first);
    }
    std::sort(seam.begin(), seam.end());
    seam.erase(std::unique(seam.begin(), seam.end()), seam.end());
    const auto place = [&](Index v) {
      return static_cast<std::size_t>(std::lower_bound(seam.begin(), seam.end(), v) - seam.begin());
    };
    BasicDisjointSets<std::size_t> sets(seam.size());
    for (const auto& [last, first] : cells_.pairs()) sets.join(place(last), place(first));
    for (std::size_t i = 0; i < seam.size(); ++i)
      if (sets.find(i) != i) dropped_.push_back(seam[i]);
    // consecutive numbers between the vertices that are dropped
    Buffer<Index> number(this->contour().vertices.size());
    for_kept([&](Index first, Index end, Index to) { std::iota(number.begin() + first, number.begin() + end, to); });
    for (std::size_t i = 0; i < seam.size(); ++i) number[seam[i]] = number[seam[sets.find(i)]];
    return number;
  }

  /// Calls work(first, end, to) for each run of vertices that are kept; `to`: the new number of `first`.
  template <class Work>
  void for_kept(const Work& work) const {
    const auto count = static_cast<Index>(this->contour().vertices.size());
    Index first = 0;
    Index shift = 0;
    for (const Index dropped : dropped_) {
      if (first < dropped) work(first, dropped, first - shift);
      first = dropped + 1;
      ++shift;
    }
    if (first < count) work(first, count, first - shift);
  }

  void merge(const Buffer<Index>& number) {
    Contour<N, Real>& contour = this->contour();
    for_kept([&](Index first, Index end, Index to) {
      if (to != first)
        std::copy(contour.vertices.begin() + first, contour.vertices.begin() + end, contour.vertices.begin() + to);
    });
    contour.vertices.resize(number.size() - dropped_.size());
    if (dropped_.empty()) return;
    const Index least = dropped_.front();  // smaller numbers do not change
    for_each_part(contour.simplices.size(), threads_, {}, [&](std::size_t from, std::size_t end) {
      for (std::size_t s = from; s < end; ++s) {
        Simplex& simplex = contour.simplices[s];
        if (*std::max_element(simplex.begin(), simplex.end()) < least) continue;
        for (Index& v : simplex) v = number[v];
      }
    });
  }

  SeamCells<N> cells_;
  unsigned threads_;
  std::vector<Index> dropped_;  ///< vertices that are merged into others, ascending
};

}  // namespace tegl::detail
