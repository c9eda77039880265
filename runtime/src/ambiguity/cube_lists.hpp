// SPDX-License-Identifier: BSD-3-Clause
//
// Lists (ResolvedCubes) of the eight cubes of many tesseracts, looked up in the lanes of registers. Compiled for
// several instruction sets, the best of which is chosen at run time; all give identical results.
#pragma once

#include <cstdint>
#include <span>

#include "builder4_lookup.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

using builders::CubeListTable;

/// The cubes of a tesseract: by byte, from the lowest on, their signatures and their high squares. `second`: bit set of
/// the cubes whose second number is wanted.
struct WantedLists {
  std::uint64_t signatures, squares;
  unsigned second;
};
/// The lists of the cubes of a tesseract, and flags.
struct FoundLists {
  ResolvedCubes::Lists wanted, second;
  // Sets of cubes, as bits:
  std::uint8_t with_vertices;
  std::uint8_t with_choice;  ///< by CubeListTable::kHasChoiceOrPair
  std::uint8_t with_pairs;
};
/// `found`: as many as `faces`.
void find_lists(const CubeListTable& table, std::span<const WantedLists> faces, FoundLists* found) noexcept;

}  // namespace tegl::detail
