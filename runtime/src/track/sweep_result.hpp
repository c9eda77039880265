// SPDX-License-Identifier: BSD-3-Clause
//
// Result of a sweep through time: the components between two times, and the vertices where they change.
#pragma once

#include <cstdint>
#include <vector>

#include "tegl/track.hpp"

namespace tegl::detail {

/// No vertex, no arc.
inline constexpr Index kNone = ~Index{0};

/// What part of a vertex's star lies at exactly its time: nothing, a whole simplex, or (the strongest) a facet in the
/// border.
enum class Flatness : std::uint8_t { none, simplex, border };

/// A vertex where components start, end, merge or split.
struct SweepNode {
  Index vertex = 0;
  double time = 0;
  double reported = 0;  ///< `time`, or the time of more vertices if it differs by rounding only
  std::int64_t euler_change = 0;
  bool at_border = false;
  Flatness flatness = Flatness::none;
};

/// A component between two nodes.
struct SweepArc {
  Index from = kNone;
  Index to = kNone;
  // After all vertices at the time of `from`, and before all those at the time of `to`.
  std::uint64_t size_at_start = 0;
  std::uint64_t size_at_end = 0;
  std::int64_t euler_at_start = 0;
  std::int64_t euler_at_end = 0;
};

/// A vertex where the Euler characteristic of a component changes and the component persists.
struct SweepHandle {
  Index vertex = 0;
  double time = 0;
  double reported = 0;  ///< as in SweepNode
  Index arc = 0;
  bool at_border = false;
  std::int64_t euler_change = 0;
};

struct SweepSample {
  Index arc = 0;
  TrackSample sample;
};

struct SweepResult {
  std::vector<SweepNode> nodes;      ///< by time, then vertex
  std::vector<SweepArc> arcs;        ///< in the order of their start
  std::vector<SweepHandle> handles;  ///< by time, then vertex
  std::vector<SweepSample> samples;  ///< by time, then arc
  double first = 0.0, last = 0.0;    ///< times of the lowest and the highest vertex of a simplex
  double tolerance = 0.0;            ///< times that differ by at most this may be equal up to rounding
  std::vector<Index> simplex_arcs;   ///< #S, if requested; kNone for simplices that repeat a vertex
};

}  // namespace tegl::detail
