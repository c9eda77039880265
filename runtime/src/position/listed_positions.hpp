// SPDX-License-Identifier: BSD-3-Clause
//
// Rules that find the positions of all critical edges before the extraction.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "position/critical_edges.hpp"
#include "position/placed_source.hpp"
#include "tegl/error.hpp"
#include "tegl/positions.hpp"

namespace tegl::detail {

/// A list of the critical edges of samples in memory, with a position for each.
template <int N, class Place>
class ListedPositions : public PositionsOnEdges<N> {
 public:
  void find(const LayerEdges<N>& edges, double* out) const noexcept override {
    std::size_t last_row = ~std::size_t{0};
    typename CriticalEdges<N>::Number number = 0;
    for (std::size_t i = 0; i < edges.edges.count; ++i) {
      const std::size_t row = edges.row_of_all(i);
      // edges of the same row come in order, except that those of a cell may be in any order
      number = row == last_row && edges.edges.at[i] > edges.edges.at[i - 1]
                   ? edges_.number_after(number, edges.edges.at[i])
                   : edges_.number(edges.axis, row, edges.edges.at[i]);
      last_row = row;
      out[i] = places_[number];
    }
  }

 protected:
  /// Lists the edges. The signs are not kept.
  ListedPositions(const SampleSigns<N>& signs, unsigned threads) : edges_(signs, threads) {}
  ~ListedPositions() = default;

  CriticalEdges<N> edges_;
  Buffer<Place> places_;  ///< by number of the edge; set by the rule
};

/// A function of the caller for many edges at once, which the calling thread calls for one block after the other.
template <int N>
class BlockPositions final : public ListedPositions<N, double> {
 public:
  /// Throws the function's exceptions, InvalidArgument if it returns NaN, and Cancelled.
  BlockPositions(const SampleSource<N>& samples, const Grid<N>& grid, const PositionOptions& positions,
                 const WorkOptions& work)
      : BlockPositions(SampleSigns<N>(samples, grid.sizes(), work.threads), samples, positions, work) {}

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 16;  // edges

  BlockPositions(const SampleSigns<N>& signs, const SampleSource<N>& samples, const PositionOptions& positions,
                 const WorkOptions& work)
      : ListedPositions<N, double>(signs, work.threads),
        samples_(samples),
        isovalue_(samples.isovalue()),
        evaluate_(positions.custom_of_many),
        progress_(work.progress) {
    this->places_.resize(this->edges_.count());
    for (int axis = 0; axis < N; ++axis)
      for (std::size_t row = 0; row < signs.rows(); ++row) add_row(axis, row, signs.index_of(row));
    evaluate_block();
  }

  void add_row(int axis, std::size_t row, SampleIndex<N> index) {
    const auto end = this->edges_.first_in_row(axis, row + 1);
    for (auto number = this->edges_.first_in_row(axis, row); number < end; ++number) {
      SampleIndex<N> at = index;
      at[0] = this->edges_.at(number);
      from_.push_back(samples_.value(at));
      at[axis] += 1;
      to_.push_back(samples_.value(at));
      if (from_.size() == kBlock) evaluate_block();
    }
  }

  void evaluate_block() {
    const std::size_t count = from_.size(), all = this->places_.size();
    if (count == 0) return;
    tell(progress_, static_cast<double>(done_) / static_cast<double>(all));
    const std::span<double> places(this->places_.data() + done_, count);
    call_apart([&] { evaluate_(from_, to_, isovalue_, places); });
    for (std::size_t i = 0; i < count; ++i)
      if (std::isnan(places[i])) throw Error(ErrorCode::InvalidArgument, nan_position(from_[i], to_[i], isovalue_));
    done_ += count;
    from_.clear();
    to_.clear();
  }

  const SampleSource<N>& samples_;
  double isovalue_;
  const decltype(PositionOptions::custom_of_many)& evaluate_;
  const Progress& progress_;
  std::size_t done_ = 0;  ///< edges with a position
  std::vector<double> from_, to_;
};

}  // namespace tegl::detail
