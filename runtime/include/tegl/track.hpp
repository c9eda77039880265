// SPDX-License-Identifier: BSD-3-Clause
//
// Tracks the components of a moving contour: where they appear, merge, split and vanish. Events are those of the
// space-time contour itself; nothing is matched between time steps.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/incidence.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Kinds of events, by the number of parts before and after them. A part is a connected component of a cut.
enum class TrackEventKind {
  begin,     ///< 0 -> n: already present at the first time
  birth,     ///< 0 -> n, not at the boundary
  enter,     ///< 0 -> n, at the contour's boundary: an image border or missing values
  end,       ///< n -> 0: still present at the last time
  death,     ///< n -> 0, not at the boundary
  leave,     ///< n -> 0, at the contour's boundary
  merge,     ///< n -> 1
  split,     ///< 1 -> n
  exchange,  ///< n -> m, both more than 1
};

/// The name of a kind, as in the enumeration: "merge". A 0 character follows it.
[[nodiscard]] std::string_view name_of(TrackEventKind kind) noexcept;

/// An event: parts appear, merge, split or vanish.
struct TrackEvent {
  TrackEventKind kind = TrackEventKind::birth;  ///< what happens
  /// Last coordinate of `vertex`, or the one that most vertices have among those that differ from it by rounding only,
  /// such as the time of a layer of the image.
  double time = 0;
  std::array<double, 4> place{};  ///< other coordinates of `vertex`; space_dim - 1 of them
  Index vertex = 0;               ///< vertex of the contour where it happens
  bool at_border = false;         ///< whether `vertex` lies in the contour's boundary
  std::vector<Index> in = {};     ///< segments that end here, ascending
  std::vector<Index> out = {};    ///< segments that start here, ascending
  std::int64_t euler_change = 0;  ///< change of the Euler characteristic of the cut through these parts
  Index left_out = 0;             ///< number of tracks of the event that `select_tracks` has left out
};

/// A change of one part's topology without a change of the number of parts: a handle opens or closes (by -2 or 2, in
/// 4D), or the part meets the image border.
struct TrackHandle {
  double time = 0;                ///< as in TrackEvent
  std::array<double, 4> place{};  ///< other coordinates of `vertex`
  Index vertex = 0;               ///< vertex of the contour where it happens
  bool at_border = false;         ///< whether `vertex` lies in the contour's boundary
  Index segment = 0;              ///< the part that changes
  std::int64_t euler_change = 0;  ///< change of that part's Euler characteristic
};

/// Measures of a part at one time. The part consists of triangles in 3-space (N = 4), segments in the plane (N = 3), or
/// points on a line (N = 2).
struct TrackSample {
  double time = 0;     ///< the value of the last coordinate
  double measure = 0;  ///< area; N = 5: volume; N = 3: length; N = 2: number of points
  /// Enclosed volume (N = 5: 4-volume; N = 3: area), negative for a cavity. NaN if the part is open, for instance at
  /// the image border, and for N = 2.
  double content = std::numeric_limits<double>::quiet_NaN();
  std::array<double, 4> centroid{};  ///< of the surface, weighted by area
  std::array<double, 4> lower{};     ///< minimum corner of the bounding box
  std::array<double, 4> upper{};     ///< maximum corner of the bounding box
};

/// A part between two events: an arc of the Reeb graph.
struct TrackSegment {
  Index from = 0;                   ///< number of the event at its start
  Index to = 0;                     ///< number of the event at its end
  double start = 0;                 ///< time of `from`
  double end = 0;                   ///< time of `to`
  Index track = 0;                  ///< the track that contains it
  std::uint64_t size_at_start = 0;  ///< simplices of the contour that the part crosses just after `start`
  std::uint64_t size_at_end = 0;    ///< the same just before `end`
  std::int64_t euler_at_start = 0;  ///< Euler characteristic just after `start`; 2 if closed without handles, in 4D
  std::int64_t euler_at_end = 0;    ///< the same just before `end`; it differs by handle events
  std::vector<TrackSample> samples = {};  ///< at the TrackOptions::times inside it, ascending
};

/// A sequence of segments: at merges and splits it continues with the largest part.
struct Track {
  Index number = 0;                  ///< its number in the full graph; `select_tracks` keeps it
  std::vector<Index> segments = {};  ///< in order of time
  double start = 0;                  ///< time of its first event
  double end = 0;                    ///< time of its last event
};

/// The Reeb graph of the last coordinate on a contour.
struct TrackGraph {
  int space_dim = 0;                           ///< N
  std::array<std::string, 5> axis_names = {};  ///< of the contour
  std::array<std::string, 5> axis_units = {};  ///< of the contour
  double first = 0;                            ///< time at which the data begin
  double last = 0;                             ///< time at which the data end
  std::vector<TrackEvent> events = {};         ///< by time, then vertex
  std::vector<TrackSegment> segments = {};     ///< by start, then the vertex there
  std::vector<Track> tracks = {};              ///< by start, then the vertex there
  std::vector<TrackHandle> handles = {};       ///< by time, then vertex
  /// #S, if requested: the segment that each simplex of the contour belongs to when it first appears. kNoSegment for
  /// simplices that are never cut (flat in time) and those of filtered parts.
  std::vector<Index> simplex_segments = {};

  static constexpr Index kNoSegment = std::numeric_limits<Index>::max();  ///< no segment
};

/// Options of `track`.
struct TrackOptions {
  /// Minimum lifetime: branches that live shorter are removed, if they go from birth to merge, from split to death,
  /// from birth to death, or from a split to the merge of the same two parts. With 0, only branches that last no longer
  /// than the rounding error are removed (4 units in the last place of the largest time).
  double min_lifetime = 0;
  /// Times at which parts are measured, ascending. Rounded to Real, as in `slice`.
  std::vector<double> times = {};
  /// Times at which the data begin and end; by default the minimum and maximum last coordinate of the contour.
  std::optional<double> first = {};
  std::optional<double> last = {};  ///< see `first`
  /// Whether to list topology changes between events (TrackGraph::handles).
  bool handles = true;
  /// Whether to fill TrackGraph::simplex_segments.
  bool label_simplices = false;
  /// Threads of the parallel phases, and progress.
  WorkOptions work = {};
};

/// The midpoints of `count` equal intervals of [first, last].
[[nodiscard]] std::vector<double> even_times(double first, double last, std::size_t count);

/// Follows the parts (connected components) of the cuts {last coordinate = t} of a contour for increasing t. N = 4:
/// parts of moving surfaces; N = 3: parts of moving lines; N = 5: parts of 4D contours over a parameter or a scale.
///
/// The result is exactly the Reeb graph of the last coordinate t on the contour. Between two events, each segment is
/// one component of the slice at t for every t; events are vertices of the contour, at their own t. A vertex can
/// be an event only if the lower or the upper part of its link is not connected. Vertices of equal t are processed in
/// order of their numbers. Segments of zero duration are merged into one event, which may then have several parts
/// before and after it; its vertex is the lowest one. Boundary vertices get no special treatment; the contour need not
/// be a manifold.
///
/// A birth at `first` is a `begin`, and a death at `last` an `end`, if the contour's boundary is flat at that time, or,
/// if the options give these times, if a simplex is flat there (as in the caps of a closed contour). A part that
/// touches that time only in a point is born or dies there.
///
/// A track continues from the largest part before an event to the largest part after it, by size_at_end and
/// size_at_start.
///
/// min_lifetime: the shortest removable branch is removed first, then the next, until none is shorter; the parts at
/// both of its ends continue. Loops of more than two branches stay. Handles are not filtered.
///
/// Measures are computed in double from the cut of each simplex.
///
/// Errors: InvalidArgument (a coordinate, time or option that is not finite; times that do not ascend; a negative
/// min_lifetime; a vertex number out of range), Cancelled. An empty contour gives an empty graph. Thread-safe. Cost:
/// O(#V + #S), plus a search for each vertex above which a part may split: from all sides at once, until all
/// sides except the largest are complete or found to be connected; plus the cuts at `times`. Memory (N = 4): 57 bytes
/// per simplex, 4 more with `times`, and 54 per vertex, plus 8 per vertex for each thread.
///
/// Based on: G. Reeb, Sur les points singuliers d'une forme de Pfaff complètement intégrable, 1946; S. Parsa, A
/// deterministic O(m log m) time algorithm for the Reeb graph, 2012 (a sweep that maintains the components of the cut);
/// M. Liversage, thesis, 1994, §10.2.9 to §10.2.11 (uses of cuts at any time).
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] TrackGraph track(const Contour<N, Real>& contour, const TrackOptions& options = {});
/// The same, in less time, with the contour's incidence. Errors: also InvalidArgument if it is another contour's.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] TrackGraph track(const Contour<N, Real>& contour, const Incidence<N>& incidence,
                               const TrackOptions& options = {});

/// The graph of the tracks with `keep[track]` only, in the same order; `Track::number` keeps their original numbers.
/// Events keep their kind, their change and the segments that remain, and count the tracks left out, in earlier
/// selections too; events without segments are dropped. Errors: InvalidArgument (the length of `keep`).
[[nodiscard]] TrackGraph select_tracks(const TrackGraph& graph, const std::vector<bool>& keep);

}  // namespace tegl
