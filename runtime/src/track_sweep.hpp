// SPDX-License-Identifier: BSD-3-Clause
//
// The sweep of a level over a simplicial complex: which components the level set has, and at which vertices that
// changes. What comes out is the Reeb graph with every event that lasts no time (see tegl/track.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "tegl/track.hpp"

namespace tegl::detail {

inline constexpr Index kNone = ~Index{0};
/// The part of the whole progress after which the sweep is done.
inline constexpr double kSwept = 0.95;

/// What lies at the very time of a vertex, of what is around it: a simplex, or more than that a facet in the border.
enum class Flatness : std::uint8_t { none, simplex, border };

/// A vertex where components start, end, merge or split.
struct SweepNode {
  Index vertex = 0;
  double time = 0;
  std::int64_t euler_change = 0;
  bool at_border = false;
  Flatness flatness = Flatness::none;
};

/// A component between two nodes.
struct SweepArc {
  Index from = kNone;
  Index to = kNone;
  // Just after all vertices of the time of `from`, and just before those of the time of `to`.
  std::uint64_t size_at_start = 0;
  std::uint64_t size_at_end = 0;
  std::int64_t euler_at_start = 0;
  std::int64_t euler_at_end = 0;
};

/// A vertex where a component changes its Euler characteristic and remains one.
struct SweepHandle {
  Index vertex = 0;
  double time = 0;
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
  std::vector<Index> simplex_arcs;   ///< #S, if asked for; kNone for simplices that repeat a vertex
};

/// Tells the progress up to kSwept. Instantiated for what `track` is. The options are sound, the contour's numbers finite and in range.
template <int N, class Real>
SweepResult sweep(const Contour<N, Real>& contour, const TrackOptions& options);

}  // namespace tegl::detail
