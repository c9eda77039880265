// SPDX-License-Identifier: BSD-3-Clause
//
// A tile table in the form that the inner loops of the extraction read, and the active tiles of a row.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tegl/table_contract.hpp"

namespace tegl::detail {

/// Limit on the samples of a row whose active tiles are listed by 16-bit positions.
inline constexpr std::size_t kMostListed = std::size_t{1} << 16;

using tables::RowTable;
using tables::Variant;

/// The active tiles of a row, in order.
struct RowTiles {
  const std::uint16_t* signatures = nullptr;  ///< or keys (cube_key.hpp)
  const std::uint16_t* at = nullptr;          ///< positions along the row, modulo 2^16
  std::uint32_t count = 0;
};

}  // namespace tegl::detail
