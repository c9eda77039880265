// SPDX-License-Identifier: BSD-3-Clause
//
// Operations on the samples in a box around each sample, given as rows.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "filter/layer_filter.hpp"

namespace tegl::detail {

/// The rows of samples in the box around a row: row r has the offsets of `r` along the axes from 1 on, axis 1 fastest,
/// each from -radius to radius. Rows start `radii[0]` samples before the sample with index 0.
template <class Real>
struct WindowRows {
  const Real* const* rows;
  std::size_t width;         ///< number of samples to compute
  bool may_miss;             ///< whether some sample may be missing
  FilterScratch<Real>* own;  ///< of the thread; `first` holds nothing that must be kept
};

template <class Real>
class WindowOperation {
 public:
  WindowOperation() = default;
  WindowOperation(const WindowOperation&) = delete;
  WindowOperation& operator=(const WindowOperation&) = delete;
  virtual ~WindowOperation() = default;
  /// Computes a row of the result. A missing sample in the middle may get any value.
  virtual void apply(const WindowRows<Real>& window, Real* out) const = 0;
};

template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const Convolution& filter);
template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const MedianFilter& filter);
template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const BilateralFilter& filter);
template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const ContextualLowPass& filter);
/// One step of the flow, of the duration filter.time.
template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const CurvatureFlow& filter);

}  // namespace tegl::detail
