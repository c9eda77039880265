// SPDX-License-Identifier: BSD-3-Clause
//
// Graph of trees of tiles: trees by number, and links between them.
#pragma once

#include <cstdint>
#include <vector>

#include "search/padded_ranges.hpp"

namespace tegl::detail {

/// A link: two trees have neighbouring tiles that are both active at levels first ... end - 1.
struct SeedLink {
  std::uint32_t a, b;  ///< trees
  std::uint32_t first, end;
  bool operator==(const SeedLink&) const = default;
};

/// Trees by number, in the scan order of their roots. A level is an interval between two consecutive range ends: the
/// same tiles are active in all of it.
struct SeedGraph {
  std::vector<Place> roots;
  std::vector<std::uint32_t> first, end;  ///< the root is active at levels first ... end - 1
  std::uint32_t levels = 0;
  bool too_much_work = false;   ///< see SeedGraphOptions::most_work
  std::vector<SeedLink> links;  ///< a < b, ascending by a, b, first; links of one pair neither overlap nor touch
  std::uint64_t constant_tiles = 0;
  std::uint64_t groups = 0;
};

/// Sorts links and merges the links of a pair that overlap or touch.
void merge_links(std::vector<SeedLink>& links);

/// Throws Cancelled if the callback returns false.
void report_progress(const Progress& progress, double fraction);

}  // namespace tegl::detail
