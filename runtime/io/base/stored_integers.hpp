// SPDX-License-Identifier: BSD-3-Clause
//
// Stored integers as the samples of an image, with the map to their values.
#pragma once

#include <optional>

#include "base/value_array.hpp"
#include "tegl/io/images.hpp"

namespace tegl::io_detail {

/// The scaling of integers of the type of `values`; nullopt if an image cannot have them in place of their values: see
/// ReadImageOptions::keep_stored. `slope`, `intercept`: finite, the slope not 0.
std::optional<ValueScaling> integer_scaling(const ValueArray& values, double slope, double intercept);

/// Each integer i as least + greatest - i, whose order is the reverse.
ValueArray in_reverse_order(ValueArray&& values);

}  // namespace tegl::io_detail
