// SPDX-License-Identifier: BSD-3-Clause
//
// What becomes of the parts of a moving contour: where they are born, merge, split and die, read off the contour in
// space and time itself, not guessed from one time step to the next.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"

namespace tegl {

/// What happens at an event, by the numbers of parts before and after it.
enum class TrackEventKind {
  begin,     ///< 0 -> n: the part is there when the data begin
  birth,     ///< 0 -> n
  enter,     ///< 0 -> n, at the contour's border: at a side of the image, or beside missing values
  end,       ///< n -> 0: the part is still there when the data end
  death,     ///< n -> 0
  leave,     ///< n -> 0, at the contour's border
  merge,     ///< n -> 1
  split,     ///< 1 -> n
  exchange,  ///< n -> m, both more than one
};

/// The kind's name as above: "merge".
const char* event_name(TrackEventKind kind) noexcept;

/// Parts appear, meet, part or vanish.
struct TrackEvent {
  TrackEventKind kind = TrackEventKind::birth;  ///< what happens
  double time = 0;                              ///< the vertex's last coordinate
  std::array<double, 3> place{};                ///< the vertex's coordinates but the last; space_dim - 1 of them
  Index vertex = 0;                             ///< of the contour: where it happens
  bool at_border = false;                       ///< whether that vertex lies in the contour's border
  std::vector<Index> in = {};                   ///< the segments that end here, ascending
  std::vector<Index> out = {};                  ///< the segments that start here, ascending
  std::int64_t euler_change = 0;  ///< by how much the Euler characteristic of the cut through them changes
};

/// The shape of a part changes while the number of parts does not: a handle opens or closes (by -2 or 2, in 4D), or the
/// part meets the image's border.
struct TrackHandle {
  double time = 0;                ///< the vertex's last coordinate
  std::array<double, 3> place{};  ///< its other coordinates
  Index vertex = 0;               ///< of the contour: where it happens
  bool at_border = false;         ///< whether that vertex lies in the contour's border
  Index segment = 0;              ///< the part whose shape changes
  std::int64_t euler_change = 0;  ///< of that part
};

/// A part at one time. N = 4: of triangles in 3-space; N = 3: of segments in the plane; N = 2: points on a line.
struct TrackSample {
  double time = 0;     ///< the value of the last coordinate
  double measure = 0;  ///< area; N = 3: length; N = 2: number of points
  /// Volume (N = 3: area) that the part encloses, negative around a cavity; NaN where the part is open, as where it
  /// ends at the image's border, and for N = 2.
  double content = std::numeric_limits<double>::quiet_NaN();
  std::array<double, 3> centroid{};  ///< of the surface, by area
  std::array<double, 3> lower{};     ///< the corners of the box around it
  std::array<double, 3> upper{};     ///< likewise
};

/// One part from one event to the next: an arc of the graph.
struct TrackSegment {
  Index from = 0;                   ///< event
  Index to = 0;                     ///< event
  double start = 0;                 ///< time of `from`
  double end = 0;                   ///< time of `to`
  Index track = 0;                  ///< the track that it is a piece of
  std::uint64_t size_at_start = 0;  ///< simplices of the contour that the part consists of just after `start`
  std::uint64_t size_at_end = 0;    ///< just before `end`
  std::int64_t euler_at_start = 0;  ///< Euler characteristic just after `start`; closed, without handles, in 4D: 2
  std::int64_t euler_at_end = 0;    ///< just before `end`; the difference are the handles on the way
  std::vector<TrackSample> samples = {};  ///< at those of TrackOptions::times that lie in it, ascending
};

/// A part that goes on, as the largest one, through merges and splits.
struct Track {
  Index number = 0;                  ///< in the graph as it was found; `select_tracks` leaves it as it is
  std::vector<Index> segments = {};  ///< one after the other
  double start = 0;                  ///< time of its first event
  double end = 0;                    ///< time of its last one
};

/// The Reeb graph of the last coordinate on a contour.
struct TrackGraph {
  int space_dim = 0;                           ///< N
  std::array<std::string, 4> axis_names = {};  ///< the contour's
  std::array<std::string, 4> axis_units = {};  ///< likewise
  double first = 0;                            ///< when the data begin
  double last = 0;                             ///< and end
  std::vector<TrackEvent> events = {};         ///< by time, then vertex
  std::vector<TrackSegment> segments = {};     ///< by start, then the vertex there
  std::vector<Track> tracks = {};              ///< by start, then the vertex there
  std::vector<TrackHandle> handles = {};       ///< by time, then vertex
  /// #S, if asked for: the segment that each of the contour's simplices is in when it first appears; kNoSegment for
  /// those that are never cut (flat in time) and those of parts that were filtered out.
  std::vector<Index> simplex_segments = {};

  static constexpr Index kNoSegment = std::numeric_limits<Index>::max();  ///< no segment
};

/// What is followed, and what of it is shown.
struct TrackOptions {
  /// Parts that live shorter than this, from birth to merge, from split to death, from birth to death or from a split
  /// to the merge of the same two, are left out. 0: all are shown but those that last no longer than rounding may let
  /// them (4 units in the last place of the largest time).
  double min_lifetime = 0;
  /// When to measure the parts, ascending. Rounded to Real, as `slice` does.
  std::vector<double> times = {};
  /// When the data begin and end; by default the least and the greatest last coordinate of the contour.
  std::optional<double> first = {};
  std::optional<double> last = {};  ///< see `first`
  /// Whether to list the changes of shape between events too.
  bool handles = true;
  /// Whether to fill TrackGraph::simplex_segments.
  bool label_simplices = false;
  /// How many threads work where several can; 0: all that the machine has. The result is the same, byte by byte.
  unsigned threads = 0;
  Progress progress = {};  ///< see Progress
};

/// `count` times at even distances in the middle of as many parts of [first, last].
std::vector<double> even_times(double first, double last, std::size_t count);

/// Follows the parts (connected components) of the cuts {last coordinate = t} of a contour while t grows. N = 4: the
/// parts of moving surfaces; N = 3: of moving lines.
///
/// The result is the Reeb graph of the last coordinate t on the contour, exactly: between two events, each segment is
/// one component of `slice(contour, t)` for every t, and events are vertices of the contour, at their own t. A vertex
/// can be an event only if the part of its link below it, or that above it, is not in one piece. Vertices of equal t
/// count as one after the other by their numbers; what lasts no time by that is joined to one event, which so may have
/// several parts before and after it. It is shown at its lowest vertex. Vertices of the contour's border are no
/// different; the graph is that of the contour as it is, whether it is a manifold or not.
///
/// `begin` and `end` are births at `first` and deaths at `last` where the contour's border lies flat in that time, or,
/// if the option says when the data begin and end, where a simplex does (as in the caps of a closed contour); a part
/// that touches that time in a point alone is born or dies there.
///
/// A track goes on from the largest part before an event to the largest after it, by size_at_end and size_at_start.
///
/// min_lifetime. The shortest such branch is taken out first, then the next, until none is shorter; what was at both
/// its ends goes on. Loops of more than two branches stay. Handles are not filtered.
///
/// Measures are those of the pieces that each simplex is cut to, in doubles.
///
/// Errors: InvalidArgument (a coordinate, time or option that is not finite; times that do not ascend; a negative
/// min_lifetime; a vertex number out of range), Cancelled. An empty contour gives an empty graph. No state,
/// so thread-safe.
/// Cost: O(#V log #V + #S) and, for each vertex above which a part may fall apart, a search from all sides of it
/// at once that ends when all but the largest piece are known or found to be connected; then the cuts at `times`.
/// Memory: 25 bytes a simplex, 4 more with `times`, and 24 a vertex (N = 4).
///
/// Based on: G. Reeb, Sur les points singuliers d'une forme de Pfaff complètement intégrable, 1946; S. Parsa, A
/// deterministic O(m log m) time algorithm for the Reeb graph, 2012 (the sweep over cuts whose components are
/// maintained). M. Liversage's thesis, 1994, §10.2.9 to §10.2.11: what a cut at any time is good for.
template <int N, class Real>
requires DimensionBetween<N, 2, 4> TrackGraph track(const Contour<N, Real>& contour, const TrackOptions& options = {});

/// The graph with these tracks alone, `keep[track]`, in the same order; `Track::number` tells which they were. Events
/// keep those of their segments that are left, their kind and their change, and are dropped when none is left. Errors:
/// InvalidArgument (the length of `keep`).
TrackGraph select_tracks(const TrackGraph& graph, const std::vector<bool>& keep);

}  // namespace tegl
