// SPDX-License-Identifier: BSD-3-Clause
//
// One bit per point, and signatures of cells from these bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "complex/cell_groups.hpp"

namespace tegl::detail {

/// Gathers the bits of the corners of cells from ... to - 1: bit v of signatures[i] is the bit of corner v of cell from
/// + i. `bits`: bit p % 32 of word p / 32.
void gather_signatures(const CellGroup& group, std::size_t from, std::size_t to, const std::uint32_t* bits,
                       std::uint16_t* signatures) noexcept;

/// Compares 32 x `words` values with the isovalue, 32 for each word: bits of `high` are set where a value is not below
/// it, bits of `missing` where a value is NaN.
void compare_values(const double* values, std::size_t words, double isovalue, std::uint32_t* high,
                    std::uint32_t* missing) noexcept;

}  // namespace tegl::detail
