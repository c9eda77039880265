// SPDX-License-Identifier: BSD-3-Clause
//
// Search for positions of the points on a tile's edges at which simplices intersect: for pairs of simplices that are
// not proved to be apart. Integers only, from a seed: the same positions and results on all machines.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "filling/vertex_places.hpp"

namespace tegl::gen {

/// The positions that a search tries for one contour.
struct SearchPlan {
  std::uint64_t seed = 1;          ///< mixed with the contour's signature
  std::uint32_t uniform = 2048;    ///< random positions, uniform on each edge
  std::uint32_t near_ends = 2048;  ///< random distances from a random end: uniform logarithm, 2^-21 to 1/2 of an edge
  std::uint32_t descents = 64;     ///< random starts from which points are moved so that a pair comes nearer
  std::uint32_t steps = 192;       ///< moves of one point tried in each descent

  /// All positions: these and the one in the middle of all edges.
  [[nodiscard]] std::uint64_t positions() const noexcept {
    return 1 + uniform + near_ends + std::uint64_t{descents} * (steps + 1);
  }
};

/// Searches for one contour. Random positions and the ends of descents are tested for all pairs, the steps of a descent
/// for its pair only: the one that misses least at its start (SimplexMeeting::miss).
class PositionSearch {
 public:
  PositionSearch(const FaceContours& faces, const TileContour& contour, std::span<const SimplexPair> pairs);
  /// The same for another cell, with corners at integers.
  PositionSearch(const Tile& tile, std::unique_ptr<ContourPlaces> places, std::span<const SimplexPair> pairs);

  /// Positions by edge, from the first end, in units of 2^-28, at which a pair meets; nothing if none was found.
  [[nodiscard]] std::optional<std::vector<std::int64_t>> find(const SearchPlan& plan, Signature signature);

 private:
  class Random;
  void draw(Random& random, bool near_ends);
  [[nodiscard]] bool any_meets();
  [[nodiscard]] bool descend(Random& random, std::uint32_t steps);
  [[nodiscard]] double miss_of(std::size_t pair);

  std::unique_ptr<ContourPlaces> vertices_;
  std::vector<SimplexMeeting> pairs_;
  std::vector<std::vector<std::uint8_t>> edges_of_pair_;
  std::vector<std::int64_t> at_;
  std::vector<GridPoint> places_;
};

}  // namespace tegl::gen
