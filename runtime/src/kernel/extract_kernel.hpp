// SPDX-License-Identifier: BSD-3-Clause
//
// Entry points of the contour extraction from a sample source. Private: tests and benchmarks use them to pass their own
// tables or limits.
#pragma once

#include <cstdint>
#include <memory>

#include "image/sample_source.hpp"
#include "kernel/contour_output.hpp"
#include "kernel/extract_count.hpp"
#include "kernel/table_set.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// An extraction in explicit steps, one batch of slabs per step. Several extractions can advance together over the same
/// layers.
template <int N, class Real>
class SteppedExtraction {
 public:
  virtual ~SteppedExtraction() = default;
  SteppedExtraction(const SteppedExtraction&) = delete;
  SteppedExtraction& operator=(const SteppedExtraction&) = delete;

  /// Prepares the samples of the next batch and reports progress. Returns false if all batches are done. Must be called
  /// by the thread that constructed the extraction.
  [[nodiscard]] virtual bool prepare_batch() = 0;
  /// Writes this batch's contour to the output; the last batch also finishes the output. May be called by any thread.
  virtual void extract_batch() = 0;

  /// Extracts all batches in order.
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

/// Creates the extraction of `source` over `grid` into `output` without running it. Returns null if the image has no
/// tiles. All arguments must outlive the extraction.
template <int N, class Real>
std::unique_ptr<SteppedExtraction<N, Real>> make_extraction(SampleSource<N>& source, const Grid<N>& grid,
                                                            const TableSet<N>& tables, const ExtractOptions& options,
                                                            const ExtractPlan& plan, ContourOutput<N, Real>& output);

/// Extracts the contour of `source` over `grid` into `output`. If the image has no tiles, `output` is not touched.
template <int N, class Real>
ExtractStats extract_to(SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                        const ExtractOptions& options, const ExtractPlan& plan, ContourOutput<N, Real>& output);

/// Extracts the contour of `source` over `grid` into memory.
template <int N, class Real>
Extraction<N, Real> extract_source(SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                                   const ExtractOptions& options, const ExtractPlan& plan = {});

}  // namespace tegl::detail
