// SPDX-License-Identifier: BSD-3-Clause
//
// tegl track: tracks the parts of a moving contour.
#include "tegl/track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <numeric>
#include <optional>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "base/units.hpp"
#include "input/contour_input.hpp"
#include "io/base/text.hpp"
#include "io/meshes/meshes.hpp"
#include "io/reports/tracks.hpp"
#include "output/output.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kTrackExamples =
    "Examples:\n"
    "  tegl track ocean.nc --iso 20 -o ocean.svg\n"
    "  tegl contour heart.nii.gz --iso 400 -o heart.vtkhdf\n"
    "  tegl track heart.vtkhdf --min-lifetime 0.5 -o heart.json -o heart.dot --csv heart\n"
    "  tegl track heart.vtkhdf --largest 5 -o heart.svg -o by_track.vtkhdf\n"
    "Each component of the moving surface is tracked from birth to death, through merges and splits, at their\n"
    "exact times between the steps. 'begin' and 'end' are at the first and last step of the data, 'enter' and 'leave'\n"
    "at the image's other borders and at missing values.";

/// Adds attributes with the track and the segment in which each simplex first appears; -1: none.
template <int N>
void add_labels(Contour<N, double>& contour, const TrackGraph& graph) {
  Attribute tracks{"track", "", 1, {}};
  Attribute segments{"segment", "", 1, {}};
  for (const Index s : graph.simplex_segments) {
    const bool none = s == TrackGraph::kNoSegment;
    tracks.values.push_back(none ? -1.0 : static_cast<double>(graph.tracks[graph.segments[s].track].number));
    segments.values.push_back(none ? -1.0 : static_cast<double>(s));
  }
  for (Attribute* const labels : {&tracks, &segments}) {
    std::erase_if(contour.simplex_attributes, [&](const Attribute& old) { return old.name == labels->name; });
    contour.simplex_attributes.push_back(std::move(*labels));
  }
}

/// The maximum measure of a track over its samples.
double largest_measure(const TrackGraph& graph, const Track& track) {
  double largest = 0;
  for (const Index s : track.segments)
    for (const TrackSample& sample : graph.segments[s].samples) largest = std::max(largest, sample.measure);
  return largest;
}

/// The tracks by decreasing key; equal ones keep their order.
template <class Key>
std::vector<std::size_t> falling(const TrackGraph& graph, const Key& key) {
  std::vector<double> keys;
  for (const Track& track : graph.tracks) keys.push_back(key(track));
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] > keys[b]; });
  return order;
}

double lifetime(const Track& track) { return track.end - track.start; }

/// The number of events of each kind that occurs, in the order of the kinds.
std::vector<std::pair<std::string, std::size_t>> kinds_of(const TrackGraph& graph) {
  std::vector<std::pair<std::string, std::size_t>> counts;
  for (int k = 0; k <= static_cast<int>(TrackEventKind::exchange); ++k) {
    const auto kind = static_cast<TrackEventKind>(k);
    const auto count = std::count_if(graph.events.begin(), graph.events.end(),
                                     [&](const TrackEvent& event) { return event.kind == kind; });
    if (count > 0) counts.emplace_back(name_of(kind), static_cast<std::size_t>(count));
  }
  return counts;
}

class TrackCommand final : public ContourInputCommand {
 public:
  explicit TrackCommand(CLI::App& program)
      : ContourInputCommand(program, "track",
                            "Track the components of a moving contour: births, merges, splits, deaths") {
    app()
        .add_option("-o,--output", outputs_,
                    "the graph as .json or .dot, its picture as .svg, or the contour with the track of each simplex "
                    "as .vtkhdf, .ply or .glb; may be given several times")
        ->type_name("FILE");
    app()
        .add_option("--csv", csv_, "tables: NAME-events.csv, NAME-segments.csv and NAME-samples.csv")
        ->type_name("NAME");
    app()
        .add_option(
            "--min-lifetime", min_lifetime_,
            "remove branches with a shorter lifetime, in the unit of the last axis; components that split and merge "
            "again are removed only if none of them splits in between")
        ->type_name("NUMBER");
    app()
        .add_option("--samples", samples_,
                    "number of times at which components are measured, evenly spaced over the whole time")
        ->check(whole_number(0, 1000000))
        ->type_name("COUNT")
        ->capture_default_str();
    CLI::Option* const longest =
        app()
            .add_option("--longest", longest_, "only this many tracks, those with the longest lifetime")
            ->check(whole_number(1))
            ->type_name("COUNT");
    app()
        .add_option("--largest", largest_, "only this many tracks, those with the largest size")
        ->check(whole_number(1))
        ->type_name("COUNT")
        ->excludes(longest);
    compress_.add_to(app());
    app().footer(kTrackExamples);
  }

  ExitCode run(const Streams& streams) override {
    TrackOptions options;
    options.min_lifetime = parse_finite("--min-lifetime", min_lifetime_);
    require_options(options);
    // read
    ProgressBar bar(streams.err, wants_progress());
    ContourInput input = read_contour(bar);
    std::tie(options.first, options.last) = input.ends;
    for (const std::string& output : outputs_)
      if (!is_track_file(output)) require_output_holds(output, input.space_dim() - 1);
    // track
    Stopwatch watch;
    TrackGraph graph = std::visit([&](const auto& contour) { return follow(contour, options, bar); }, input.contour);
    const std::size_t all = graph.tracks.size();
    graph = selected(std::move(graph));
    const double track_seconds = watch.lap();
    // write
    write(input, graph, all, bar);
    const double write_seconds = watch.lap();
    // report
    bar.clear();
    if (json())
      streams.out.write(dump(document(input, graph, all, track_seconds, write_seconds)));
    else if (!quiet())
      streams.out.write(report(streams.out, input, graph, all, track_seconds, write_seconds));
    return ExitCode::Ok;
  }

 private:
  void require_options(const TrackOptions& options) const {
    if (options.min_lifetime < 0) {
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--min-lifetime is {}; expected 0 or more", options.min_lifetime));
    }
    if (largest_ && samples_ == 0)
      throw Error(ErrorCode::InvalidArgument, "--largest needs measured sizes; expected --samples above 0");
    compress_.require_file(
        !std::all_of(outputs_.begin(), outputs_.end(), [](const auto& output) { return is_track_file(output); }));
    for (const std::string& output : outputs_) {
      if (is_track_file(output))
        require_text_output(output, files());
      else if (find_mesh_file_format(output) != nullptr)
        require_mesh_output(output);
      else
        throw Error(ErrorCode::WriteFailed,
                    fmt::format("{}: the extension is not known; expected .json, .dot, .svg, or a contour's: {}",
                                output, kContourFiles));
    }
    if (!csv_.empty())
      for (const Csv& table : kTables) require_text_output(csv_ + table.ending, files());
    require_different_outputs(written_files());
  }

  /// Checks the output of the contour with the track of each simplex.
  void require_mesh_output(const std::string& output) const {
    require_output(output, files());
    require_output_keeps(output, normals(), true);
    compress_.require_known(output);
  }

  template <int N>
  TrackGraph follow(const Contour<N, double>& contour, TrackOptions options, ProgressBar& bar) const {
    double first = std::numeric_limits<double>::infinity();
    double last = -first;
    for (const auto& simplex : contour.simplices)
      for (const Index v : simplex) {
        first = std::min(first, contour.vertices[v][N - 1]);
        last = std::max(last, contour.vertices[v][N - 1]);
      }
    first = options.first.value_or(first);
    last = options.last.value_or(last);
    if (first < last) options.times = even_times(first, last, samples_);
    options.label_simplices =
        std::any_of(outputs_.begin(), outputs_.end(), [](const auto& output) { return !is_track_file(output); });
    options.work = {threads(), bar.stage("track")};
    return track(contour, options);
  }

  [[nodiscard]] TrackGraph selected(TrackGraph graph) const {
    if (!longest_ && !largest_) return graph;
    const std::size_t wanted = longest_ ? *longest_ : *largest_;
    const std::vector<std::size_t> order =
        longest_ ? falling(graph, lifetime)
                 : falling(graph, [&](const Track& track) { return largest_measure(graph, track); });
    std::vector<bool> keep(graph.tracks.size(), false);
    for (std::size_t i = 0; i < std::min(wanted, order.size()); ++i) keep[order[i]] = true;
    return select_tracks(graph, keep);
  }

  /// `all`: the number of tracks before a choice.
  void write(ContourInput& input, const TrackGraph& graph, std::size_t all, ProgressBar& bar) {
    // graph files, and contours with labels
    WrittenFiles written;
    for (const std::string& output : outputs_) {
      const Progress writing = bar.stage("write");
      const auto write_labelled = [&](auto& contour) {
        add_labels(contour, graph);
        const MeshView mesh = mesh_of(contour, input);
        written.write(output, [&](const PendingPath& file) {
          write_mesh(mesh, file, {.work = {.progress = writing}, .compression = compress_.compression()});
        });
        const LostVertices lost = lost_vertices(mesh, output);
        remark(lost.remark(output));
        lost_ += lost;
      };
      if (is_track_file(output))
        written.write(output, [&](const PendingPath& file) {
          write_track(graph, file, {.title = title(input), .all_tracks = all});
        });
      else
        std::visit(write_labelled, input.contour);
    }
    // tables
    if (!csv_.empty())
      for (const Csv& table : kTables)
        written.write(csv_ + table.ending, [&](const PendingPath& file) { write_text(table.text(graph), file); });
    written.keep();
  }

  static std::string title(const ContourInput& input) {
    std::string text = std::filesystem::path(input.file.names.front()).filename().string();
    if (input.isovalue)
      text += fmt::format(", {} = {}", input.variable.empty() ? "isovalue" : input.variable, number(*input.isovalue));
    return text;
  }

  [[nodiscard]] std::vector<std::string> written_files() const {
    std::vector<std::string> files = outputs_;
    if (!csv_.empty())
      for (const Csv& table : kTables) files.push_back(csv_ + table.ending);
    return files;
  }

  [[nodiscard]] Json document(const ContourInput& input, const TrackGraph& graph, std::size_t all, double track_seconds,
                              double write_seconds) const {
    Json json;
    add_input_keys(json, input);
    json["outputs"] = written_files();
    json["vertices_together"] = lost_.count();
    json["tracks_found"] = all;
    Json& kinds = json["events_by_kind"] = Json::object();
    for (const auto& [kind, count] : kinds_of(graph)) kinds[kind] = count;
    json["graph"] = Json::parse(track_json(graph));
    json["seconds"] = {{"contour", input.seconds.total()},
                       {"track", track_seconds},
                       {"write", write_seconds},
                       {"total", input.seconds.total() + track_seconds + write_seconds}};
    return json;
  }

  [[nodiscard]] std::string report(const Console& console, const ContourInput& input, const TrackGraph& graph,
                                   std::size_t all, double track_seconds, double write_seconds) const {
    const std::string axis = input.axis_name(input.space_dim() - 1);
    std::string text = fmt::format("{}\n{}", console.bold(fmt::format("Components along {}", axis)), input_text(input));
    text += report_line("tracks", graph.tracks.size() == all
                                      ? grouped(all)
                                      : fmt::format("{} of {}", grouped(graph.tracks.size()), grouped(all)));
    std::string events;
    for (const auto& [kind, count] : kinds_of(graph))
      events += fmt::format("{}{} {}", events.empty() ? "" : ", ", grouped(count), kind);
    text += report_line("events", events.empty() ? "none" : events);
    if (!graph.handles.empty())
      text += report_line("handles", fmt::format("{} open or close", grouped(graph.handles.size())));
    text += longest_text(graph, input);
    text += report_line("seconds", fmt::format("contour {:.3f} + track {:.3f} + write {:.3f}", input.seconds.total(),
                                               track_seconds, write_seconds));
    for (const std::string& output : written_files()) text += report_line("output", output);
    if (lost_.count() > 0) text += report_line("in the file", console.red(lost_.text()));
    return text;
  }

  /// A line for each of the longest-lived tracks.
  [[nodiscard]] std::string longest_text(const TrackGraph& graph, const ContourInput& input) const {
    constexpr std::size_t kMost = 8;  // unless a number of tracks was requested
    const std::size_t most = longest_ || largest_ ? graph.tracks.size() : kMost;
    const int last = input.space_dim() - 1;
    const std::string axis = input.axis_name(last);
    std::vector<std::string> units;
    for (int a = 0; a < last; ++a) units.push_back(input.axis_unit(a));
    const std::optional<std::string> unit = measure_unit(units, last - 1);
    bool any_measure = false;
    const std::vector<std::size_t> order = falling(graph, lifetime);
    constexpr std::array kMeasures{"points", "length", "area", "volume"};
    std::string text;
    for (std::size_t i = 0; i < std::min(most, order.size()); ++i) {
      const Track& track = graph.tracks[order[i]];
      const TrackEvent& start = graph.events[graph.segments[track.segments.front()].from];
      const TrackEvent& end = graph.events[graph.segments[track.segments.back()].to];
      std::string line = fmt::format("{}: {} at {} = {}, {} at {}", track.number, name_of(start.kind), axis,
                                     number(track.start), name_of(end.kind), number(track.end));
      if (const double largest = largest_measure(graph, track); largest > 0) {
        line += fmt::format(", {} up to {}", kMeasures[static_cast<std::size_t>(last - 1)],
                            last > 1 ? with_unit(number(largest), unit) : number(largest));
        any_measure = last > 1;
      }
      text += report_line(i == 0 ? "longest" : "", line);
    }
    if (any_measure && !unit)
      text += report_line(
          "", fmt::format("({}s mix axes of different units)", kMeasures[static_cast<std::size_t>(last - 1)]));
    return text;
  }

  struct Csv {
    const char* ending;
    std::string (*text)(const TrackGraph&);
  };
  static constexpr std::array kTables{Csv{"-events.csv", &track_events_csv}, Csv{"-segments.csv", &track_segments_csv},
                                      Csv{"-samples.csv", &track_samples_csv}};

  std::vector<std::string> outputs_;
  std::string csv_;
  std::string min_lifetime_ = "0";
  std::size_t samples_ = 100;
  CompressOption compress_;
  std::optional<std::size_t> longest_;
  std::optional<std::size_t> largest_;
  LostVertices lost_;  ///< vertices that coincide in the files
};

}  // namespace

std::unique_ptr<Command> make_track_command(CLI::App& program) { return std::make_unique<TrackCommand>(program); }

}  // namespace tegl::cli
