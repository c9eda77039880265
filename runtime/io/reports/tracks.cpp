// SPDX-License-Identifier: BSD-3-Clause
//
// Formats track graphs as JSON, DOT and CSV, and writes them to files.
#include "reports/tracks.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/pending_path.hpp"
#include "base/text.hpp"
#include "tegl/error.hpp"
#include "tegl/io/tracks.hpp"

namespace tegl {
namespace {

using Json = nlohmann::ordered_json;

Json coordinates(const TrackGraph& graph, const std::array<double, 4>& place) {
  return std::vector<double>(place.begin(), place.begin() + (graph.space_dim - 1));
}

Index number_of(const TrackGraph& graph, const TrackSegment& segment) { return graph.tracks[segment.track].number; }

Json axes_json(const TrackGraph& graph) {
  Json axes = Json::array();
  for (int a = 0; a < graph.space_dim; ++a)
    axes.push_back({{"name", graph.axis_names[a]}, {"unit", graph.axis_units[a]}});
  return axes;
}

Json event_json(const TrackGraph& graph, std::size_t number) {
  const TrackEvent& event = graph.events[number];
  return {{"event", number},
          {"kind", name_of(event.kind)},
          {"time", event.time},
          {"place", coordinates(graph, event.place)},
          {"vertex", event.vertex},
          {"at_border", event.at_border},
          {"in", event.in},
          {"out", event.out},
          {"euler_change", event.euler_change},
          {"left_out", event.left_out}};
}

Json sample_json(const TrackGraph& graph, const TrackSample& sample) {
  return {{"time", sample.time},
          {"measure", sample.measure},
          {"content", sample.content},  // null for NaN
          {"centroid", coordinates(graph, sample.centroid)},
          {"lower", coordinates(graph, sample.lower)},
          {"upper", coordinates(graph, sample.upper)}};
}

Json segment_json(const TrackGraph& graph, std::size_t number) {
  const TrackSegment& segment = graph.segments[number];
  Json samples = Json::array();
  for (const TrackSample& sample : segment.samples) samples.push_back(sample_json(graph, sample));
  return {{"segment", number},
          {"track", number_of(graph, segment)},
          {"from", segment.from},
          {"to", segment.to},
          {"start", segment.start},
          {"end", segment.end},
          {"size_at_start", segment.size_at_start},
          {"size_at_end", segment.size_at_end},
          {"euler_at_start", segment.euler_at_start},
          {"euler_at_end", segment.euler_at_end},
          {"samples", std::move(samples)}};
}

Json handle_json(const TrackGraph& graph, const TrackHandle& handle) {
  return {{"time", handle.time},       {"place", coordinates(graph, handle.place)},
          {"vertex", handle.vertex},   {"at_border", handle.at_border},
          {"segment", handle.segment}, {"euler_change", handle.euler_change}};
}

/// A colour of medium lightness for each track; hues of consecutive tracks differ by the golden angle.
std::string track_colour(Index track) {
  return fmt::format("{:.3f} 0.650 0.750", std::fmod(0.58 + 0.61803398875 * track, 1.0));
}

std::string axis_columns(const TrackGraph& graph, const std::string& prefix) {
  constexpr std::array kNames{"x", "y", "z", "t"};
  std::string text;
  for (int a = 0; a + 1 < graph.space_dim; ++a) text += fmt::format(",{}{}", prefix, kNames[a]);
  return text;
}

std::string axis_fields(const TrackGraph& graph, const std::array<double, 4>& place) {
  std::string text;
  for (int a = 0; a + 1 < graph.space_dim; ++a) text += fmt::format(",{}", place[a]);
  return text;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// Throws UnsupportedFormat unless write_track supports the extension.
void require_track_file(const std::filesystem::path& path) {
  if (!is_track_file(path))
    throw Error(ErrorCode::UnsupportedFormat,
                fmt::format("{}: the extension is '{}'; expected .json, .dot, .gv or .svg", path.string(),
                            path.extension().string()));
}

}  // namespace

std::string track_json(const TrackGraph& graph) {
  Json json;
  json["space_dim"] = graph.space_dim;
  json["axes"] = axes_json(graph);
  json["first"] = graph.first;
  json["last"] = graph.last;
  for (const char* const list : {"events", "segments", "tracks", "handles"}) json[list] = Json::array();
  for (std::size_t e = 0; e < graph.events.size(); ++e) json["events"].push_back(event_json(graph, e));
  for (std::size_t s = 0; s < graph.segments.size(); ++s) json["segments"].push_back(segment_json(graph, s));
  for (const Track& track : graph.tracks) {
    json["tracks"].push_back(
        {{"track", track.number}, {"start", track.start}, {"end", track.end}, {"segments", track.segments}});
  }
  for (const TrackHandle& handle : graph.handles) json["handles"].push_back(handle_json(graph, handle));
  // Axis names come from files and may be invalid UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string track_dot(const TrackGraph& graph) {
  std::string text =
      "digraph tracks {\n  rankdir = LR;\n  node [fontname = \"sans-serif\", fontsize = 10, height = 0.3];\n"
      "  edge [fontname = \"sans-serif\", fontsize = 10, penwidth = 2];\n";
  for (std::size_t e = 0; e < graph.events.size(); ++e) {
    const TrackEvent& event = graph.events[e];
    const char* const shape = event.in.empty() || event.out.empty() ? "ellipse" : "box";
    text += fmt::format("  e{} [shape = {}, label = \"{}\\n{:.6g}\"];\n", e, shape, name_of(event.kind), event.time);
  }
  for (std::size_t s = 0; s < graph.segments.size(); ++s) {
    const TrackSegment& segment = graph.segments[s];
    text += fmt::format("  e{} -> e{} [label = \"{}\", color = \"{}\"];\n", segment.from, segment.to,
                        number_of(graph, segment), track_colour(number_of(graph, segment)));
  }
  return text + "}\n";
}

std::string track_events_csv(const TrackGraph& graph) {
  std::string text =
      fmt::format("event,kind,time{},vertex,at_border,in,out,euler_change,left_out\n", axis_columns(graph, ""));
  for (std::size_t e = 0; e < graph.events.size(); ++e) {
    const TrackEvent& event = graph.events[e];
    text += fmt::format("{},{},{}{},{},{},{},{},{},{}\n", e, name_of(event.kind), event.time,
                        axis_fields(graph, event.place), event.vertex, event.at_border ? 1 : 0,
                        fmt::join(event.in, " "), fmt::join(event.out, " "), event.euler_change, event.left_out);
  }
  return text;
}

std::string track_segments_csv(const TrackGraph& graph) {
  std::string text = "segment,track,from,to,start,end,size_at_start,size_at_end,euler_at_start,euler_at_end,samples\n";
  for (std::size_t s = 0; s < graph.segments.size(); ++s) {
    const TrackSegment& segment = graph.segments[s];
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", s, number_of(graph, segment), segment.from, segment.to,
                        segment.start, segment.end, segment.size_at_start, segment.size_at_end, segment.euler_at_start,
                        segment.euler_at_end, segment.samples.size());
  }
  return text;
}

std::string track_samples_csv(const TrackGraph& graph) {
  std::string text = fmt::format("segment,track,time,measure,content{}{}{}\n", axis_columns(graph, "centroid_"),
                                 axis_columns(graph, "lower_"), axis_columns(graph, "upper_"));
  for (std::size_t s = 0; s < graph.segments.size(); ++s)
    for (const TrackSample& sample : graph.segments[s].samples) {
      const std::string content = std::isnan(sample.content) ? "" : fmt::format("{}", sample.content);
      text += fmt::format("{},{},{},{},{}{}{}{}\n", s, number_of(graph, graph.segments[s]), sample.time, sample.measure,
                          content, axis_fields(graph, sample.centroid), axis_fields(graph, sample.lower),
                          axis_fields(graph, sample.upper));
    }
  return text;
}

bool is_track_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".json" || extension == ".dot" || extension == ".gv" || extension == ".svg";
}

void write_track(const TrackGraph& graph, const PendingPath& file, const TrackPicture& picture) {
  require_track_file(file.target());
  const std::string extension = lower_extension(file.target());
  write_text(extension == ".json"  ? track_json(graph)
             : extension == ".svg" ? track_svg(graph, picture)
                                   : track_dot(graph),
             file);
}

void write_track(const TrackGraph& graph, const std::filesystem::path& path, const TrackPicture& picture) {
  require_track_file(path);
  write_complete_file(path, [&](const PendingPath& file) { write_track(graph, file, picture); });
}

void write_track_csv(const TrackGraph& graph, const std::filesystem::path& stem) {
  const auto named = [&](const char* table) { return std::filesystem::path(stem.string() + table); };
  PendingPath events(named("-events.csv"));
  PendingPath segments(named("-segments.csv"));
  PendingPath samples(named("-samples.csv"));
  write_text(track_events_csv(graph), events);
  write_text(track_segments_csv(graph), segments);
  write_text(track_samples_csv(graph), samples);
  events.commit();
  segments.commit();
  samples.commit();
}

}  // namespace tegl
