// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction, from a source of samples to a contour. Private: tests and benchmarks use it to pass
// their own tables or limits.
#pragma once

#include <cstdint>
#include <memory>

#include "image/extract_source.hpp"
#include "kernel/contour_output.hpp"
#include "kernel/extract_count.hpp"
#include "kernel/table_set.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// An extraction that goes on batch by batch, when it is told to: so several go through the same layers side by side.
template <int N, class Real>
class SteppedExtraction {
 public:
  virtual ~SteppedExtraction() = default;
  SteppedExtraction(const SteppedExtraction&) = delete;
  SteppedExtraction& operator=(const SteppedExtraction&) = delete;

  /// Makes the samples of the next batch ready, and tells the progress; false: all batches are done. By the thread that
  /// made the extraction.
  [[nodiscard]] virtual bool prepare_batch() = 0;
  /// Puts the contour of this batch into the output; with the last one, all that comes in the end. By any thread.
  virtual void extract_batch() = 0;

  /// One batch after the other.
  void run() {
    while (prepare_batch()) extract_batch();
  }
  [[nodiscard]] const ExtractStats& stats() const noexcept { return stats_; }
  static std::uint64_t tiles_of(const Grid<N>& grid) noexcept {
    std::uint64_t tiles = 1;
    for (const Axis& axis : grid.axes) tiles *= axis.size() - 1;
    return tiles;
  }

 protected:
  explicit SteppedExtraction(const Grid<N>& grid) { stats_.tiles = tiles_of(grid); }
  ExtractStats stats_;
};

/// The extraction of `source` over `grid` into `output`, to be run; null for an image without tiles. All arguments must
/// outlive it.
template <int N, class Real>
std::unique_ptr<SteppedExtraction<N, Real>> make_extraction(SampleSource<N>& source, const Grid<N>& grid,
                                                            const TableSet<N>& tables, const ExtractOptions& options,
                                                            const ExtractPlan& plan, ContourOutput<N, Real>& output);

/// The contour of `source` over `grid`, put into `output`. An image without tiles leaves it alone.
template <int N, class Real>
ExtractStats extract_to(SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                        const ExtractOptions& options, const ExtractPlan& plan, ContourOutput<N, Real>& output);

/// The contour of `source` over `grid`. `stats` may be null.
template <int N, class Real>
Contour<N, Real> extract_source(SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                                const ExtractOptions& options, ExtractStats* stats, const ExtractPlan& plan = {});

}  // namespace tegl::detail
