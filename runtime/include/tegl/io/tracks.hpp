// SPDX-License-Identifier: BSD-3-Clause
//
// Output of track graphs: JSON, CSV tables, graphviz and SVG. Part of tegl::io.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "tegl/track.hpp"

namespace tegl {

/// The graph as JSON, without simplex_segments; docs/tracking.md lists the keys. Contents of open parts are null.
[[nodiscard]] std::string track_json(const TrackGraph& graph);

/// The graph in graphviz's DOT language: a node for each event, an arrow for each segment.
[[nodiscard]] std::string track_dot(const TrackGraph& graph);

/// CSV tables with a header line: comma-separated fields, lists inside a field separated by blanks. One row for each
/// event; empty fields for missing numbers.
[[nodiscard]] std::string track_events_csv(const TrackGraph& graph);
/// One row for each segment; format as track_events_csv.
[[nodiscard]] std::string track_segments_csv(const TrackGraph& graph);
/// One row for each sample of each segment; format as track_events_csv.
[[nodiscard]] std::string track_samples_csv(const TrackGraph& graph);

/// Options of the picture.
struct TrackPicture {
  std::string title = {};        ///< may be empty
  double width = 960;            ///< in pixels
  std::size_t most_tracks = 60;  ///< maximum number of tracks: the longest-lived; of equal lifetimes the first
  std::size_t all_tracks = 0;    ///< number of tracks before `select_tracks`, for the title; 0: those of the graph
};

/// The graph as an SVG picture: time from left to right, a line for each track. Line width is proportional to the
/// square root of the component's measure if there are samples. Merging and splitting tracks are connected, and events
/// are marked. Readable on light and dark backgrounds.
[[nodiscard]] std::string track_svg(const TrackGraph& graph, const TrackPicture& picture = {});

/// Writes a file by extension: .json, .dot (or .gv) or .svg. The file appears complete or not at all. Errors:
/// UnsupportedFormat (the extension), WriteFailed.
void write_track(const TrackGraph& graph, const std::filesystem::path& path, const TrackPicture& picture = {});

/// Whether `write_track` supports the extension.
[[nodiscard]] bool is_track_file(const std::filesystem::path& path);

/// Writes `stem`-events.csv, `stem`-segments.csv and `stem`-samples.csv. Errors: WriteFailed.
void write_track_csv(const TrackGraph& graph, const std::filesystem::path& stem);

}  // namespace tegl
