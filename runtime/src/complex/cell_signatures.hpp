// SPDX-License-Identifier: BSD-3-Clause
//
// Signatures of cells from one bit per point.
#pragma once

#include <cstddef>
#include <cstdint>

#include "complex/cell_groups.hpp"

namespace tegl::detail {

/// Gathers the bits of the corners of cells from ... to - 1: bit v of signatures[i] is the bit of corner v of cell from
/// + i. `bits`: bit p % 32 of word p / 32.
void gather_signatures(const CellGroup& group, std::size_t from, std::size_t to, const std::uint32_t* bits,
                       std::uint16_t* signatures) noexcept;

}  // namespace tegl::detail
