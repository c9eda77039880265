// SPDX-License-Identifier: BSD-3-Clause
//
// The graph of a contour's parts as files: for programs, for tables, for graphviz, and as a picture. Part of tegl::io.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "tegl/track.hpp"

namespace tegl {

/// All of the graph but simplex_segments, as JSON; docs/tracking.md lists the keys. Contents of open parts are null.
std::string track_json(const TrackGraph& graph);

/// As a directed graph in the language of graphviz: a node for each event, an arrow for each segment.
std::string track_dot(const TrackGraph& graph);

/// Tables with a line of names, fields separated by commas, lists in a field by blanks: a row for each event, for each
/// segment, and for each sample of each segment. Empty where there is no number.
std::string track_events_csv(const TrackGraph& graph);
/// See track_events_csv.
std::string track_segments_csv(const TrackGraph& graph);
/// See track_events_csv.
std::string track_samples_csv(const TrackGraph& graph);

/// What the picture of a graph looks like.
struct TrackPicture {
  std::string title = {};        ///< may be empty
  double width = 960;            ///< in pixels
  std::size_t most_tracks = 60;  ///< those that live longest are shown; of equal ones the first
};

/// A picture (SVG): time from left to right, a line for each track, as thick as the square root of the part's measure
/// where there are samples; what merges and splits is connected, and events are marked. Readable on light and on dark
/// grounds.
std::string track_svg(const TrackGraph& graph, const TrackPicture& picture = {});

/// Writes by extension: .json, .dot (or .gv) and .svg; whole or not at all. Errors: UnsupportedFormat (the extension),
/// WriteFailed.
void write_track(const TrackGraph& graph, const std::filesystem::path& path, const TrackPicture& picture = {});

/// Whether `write_track` knows the extension.
bool is_track_file(const std::filesystem::path& path);

/// Writes `stem`-events.csv, `stem`-segments.csv and `stem`-samples.csv. Errors: WriteFailed.
void write_track_csv(const TrackGraph& graph, const std::filesystem::path& stem);

}  // namespace tegl
