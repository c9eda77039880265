// SPDX-License-Identifier: BSD-3-Clause
//
// Draws a track graph as SVG: time from left to right, one row per track.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tegl/io/tracks.hpp"

namespace tegl {
namespace {

constexpr Index kNone = TrackGraph::kNoSegment;

/// Medium lightness, for contrast with light and dark backgrounds; distinguishable with most colour vision
/// deficiencies.
constexpr std::array kColours{"#3d85c6", "#d9822b", "#2e9e76", "#c25b9a", "#8c6bb1", "#a3872b", "#c95a4c", "#5f8a99"};

constexpr const char* kStyle =
    "<style>\n"
    "text { font-family: sans-serif; font-size: 11px; fill: #444 }\n"
    ".title { font-size: 15px; fill: #222 }\n"
    ".grid { stroke: #888; stroke-opacity: 0.25 }\n"
    ".link { stroke: #777; stroke-width: 1.5; fill: none }\n"
    ".away { stroke-dasharray: 2 2 }\n"
    ".mark { stroke: #333; fill: none }\n"
    ".full { fill: #333; stroke: #333; stroke-width: 1.3 }\n"
    ".open { fill: #fff; stroke: #333; stroke-width: 1.3 }\n"
    "@media (prefers-color-scheme: dark) {\n"
    "text { fill: #bbb } .title { fill: #ddd } .link { stroke: #999 }\n"
    ".mark { stroke: #ddd } .full { fill: #ddd; stroke: #ddd } .open { fill: #111; stroke: #ddd }\n"
    "}\n"
    "</style>\n";

/// Text for XML: removes control characters and escapes markup. Non-ASCII bytes are kept if the whole text is UTF-8,
/// else replaced.
std::string escaped(std::string_view text) {
  const bool is_utf8 = [&] {
    int expected = 0;
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if ((expected > 0) != ((byte & 0xc0u) == 0x80u)) return false;
      expected = expected > 0 ? expected - 1 : byte >= 0xf0u ? 3 : byte >= 0xe0u ? 2 : byte >= 0xc0u ? 1 : 0;
    }
    return expected == 0;
  }();
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (byte < 0x20 || (byte >= 0x80 && !is_utf8))
      result += '?';
    else
      result += c;
  }
  return result;
}

/// Restricts the graph to its longest-lived tracks.
TrackGraph longest(const TrackGraph& graph, std::size_t most) {
  std::vector<std::size_t> order(graph.tracks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto life = [&](std::size_t t) { return graph.tracks[t].end - graph.tracks[t].start; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return life(a) > life(b); });
  std::vector<bool> keep(graph.tracks.size(), false);
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i) keep[order[i]] = true;
  return select_tracks(graph, keep);
}

/// Assigns rows to tracks, with connected tracks close together: a track that splits off is below its origin, one that
/// merges is above its target, and shorter-lived ones are closer, so they do not cross the others.
class Rows {
 public:
  explicit Rows(const TrackGraph& graph)
      : graph_(graph), above_(graph.tracks.size()), below_(graph.tracks.size()), rows_(graph.tracks.size()) {
    // attach each track to the one that it splits off from or merges into, without cycles
    std::vector<Index> hosts(graph.tracks.size(), kNone);
    for (Index t = 0; t < hosts.size(); ++t) {
      const TrackEvent& start = graph.events[graph.segments[graph.tracks[t].segments.front()].from];
      const TrackEvent& end = graph.events[graph.segments[graph.tracks[t].segments.back()].to];
      const Index origin = through(start);
      const Index goal = through(end);
      if (origin != kNone && !leads_to(hosts, origin, t))
        below_[hosts[t] = origin].push_back(t);
      else if (goal != kNone && !leads_to(hosts, goal, t))
        above_[hosts[t] = goal].push_back(t);
    }
    // place tracks that are not attached, with all that are attached to them
    for (Index t = 0; t < hosts.size(); ++t)
      if (hosts[t] == kNone) place(t);
  }
  [[nodiscard]] std::size_t operator[](Index track) const { return rows_[track]; }

  /// The track that continues through an event; kNone if there is none.
  [[nodiscard]] Index through(const TrackEvent& event) const {
    for (const Index a : event.in)
      for (const Index b : event.out)
        if (graph_.segments[a].track == graph_.segments[b].track) return graph_.segments[a].track;
    return kNone;
  }

 private:
  static bool leads_to(const std::vector<Index>& hosts, Index from, Index to) {
    for (; from != kNone; from = hosts[from])
      if (from == to) return true;
    return false;
  }

  /// Places a track and all tracks attached to it, without recursion, because chains may be long.
  void place(Index root) {
    std::vector<std::pair<Index, bool>> stack{{root, false}};
    while (!stack.empty()) {
      const auto [t, expanded] = stack.back();
      stack.pop_back();
      if (expanded) {
        rows_[t] = next_++;
        continue;
      }
      auto& below = below_[t];
      auto& above = above_[t];
      std::stable_sort(below.begin(), below.end(),
                       [&](Index a, Index b) { return graph_.tracks[a].start < graph_.tracks[b].start; });
      std::stable_sort(above.begin(), above.end(),
                       [&](Index a, Index b) { return graph_.tracks[a].end < graph_.tracks[b].end; });
      for (const Index child : below) stack.emplace_back(child, false);  // pushed in reverse order of placement
      stack.emplace_back(t, true);
      for (const Index child : above) stack.emplace_back(child, false);
    }
  }

  const TrackGraph& graph_;
  std::vector<std::vector<Index>> above_;
  std::vector<std::vector<Index>> below_;
  std::vector<std::size_t> rows_;
  std::size_t next_ = 0;
};

/// A mark centred at (x, y).
std::string mark(TrackEventKind kind, double x, double y) {
  const auto path = [&](const char* style, std::string_view shape) {
    return fmt::format("<path class=\"{}\" transform=\"translate({:.2f} {:.2f})\" d=\"{}\"/>", style, x, y, shape);
  };
  switch (kind) {
    case TrackEventKind::begin:
    case TrackEventKind::end:
      return path("full", "M-.7-6h1.4v12h-1.4z");
    case TrackEventKind::birth:
      return fmt::format("<circle class=\"full\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3.5\"/>", x, y);
    case TrackEventKind::death:
      return fmt::format("<circle class=\"open\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3.5\"/>", x, y);
    case TrackEventKind::enter:
      return path("full", "M-3.5-4.5l7 4.5l-7 4.5z");
    case TrackEventKind::leave:
      return path("open", "M-3.5-4.5l7 4.5l-7 4.5z");
    case TrackEventKind::merge:
      return path("full", "M-4.5 0l4.5-4.5l4.5 4.5l-4.5 4.5z");
    case TrackEventKind::split:
      return path("open", "M-4.5 0l4.5-4.5l4.5 4.5l-4.5 4.5z");
    case TrackEventKind::exchange:
      return path("full", "M-3.5-3.5h7v7h-7z");
  }
  return {};
}

std::string handle_mark(double x, double y) {
  return fmt::format("<path class=\"mark\" d=\"M{:.2f} {:.2f}l6 6m0-6l-6 6\"/>", x - 3, y - 3);
}

/// A round tick distance that gives at most `count` ticks over the range.
double tick_step(double range, double count) {
  if (!(range > 0)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(range / count)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (range / (power * factor) <= count) return power * factor;
  return 10 * power;
}

class Drawing {
 public:
  Drawing(const TrackGraph& all, const TrackPicture& picture)
      : picture_(picture), all_(all.tracks.size()), graph_(longest(all, picture.most_tracks)), rows_(graph_) {
    row_height_ = std::clamp(720.0 / static_cast<double>(std::max<std::size_t>(graph_.tracks.size(), 1)), 13.0, 32.0);
    bottom_ = kTop + row_height_ * static_cast<double>(std::max<std::size_t>(graph_.tracks.size(), 1));
    for (const TrackSegment& segment : graph_.segments)
      for (const TrackSample& sample : segment.samples) largest_ = std::max(largest_, sample.measure);
    for (const TrackEvent& event : graph_.events)
      if (const std::vector<double> rows = rows_of(event); rows.front() < rows.back())
        links_.push_back({x(event.time), rows.front(), rows.back()});
  }

  std::string draw() {
    const double height = bottom_ + 74;
    text_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\" "
        "role=\"img\">\n{2}",
        picture_.width, height, kStyle);
    draw_titles();
    draw_axis();
    for (Index t = 0; t < graph_.tracks.size(); ++t) draw_track(t);
    for (const Link& link : links_)
      text_ += fmt::format("<path class=\"link\" d=\"M{:.2f} {:.2f}V{:.2f}\"/>\n", link.at, link.top, link.bottom);
    for (const TrackHandle& handle : graph_.handles)
      text_ += handle_mark(x(handle.time), y(graph_.segments[handle.segment].track)) + "\n";
    for (const TrackEvent& event : graph_.events) draw_event(event);
    draw_legend();
    return text_ + "</svg>\n";
  }

 private:
  /// The vertical line that connects the tracks of an event.
  struct Link {
    double at, top, bottom;
  };

  static constexpr double kLeft = 46;
  static constexpr double kRight = 22;
  static constexpr double kTop = 62;

  [[nodiscard]] double x(double time) const {
    const double range = graph_.last - graph_.first;
    const double share = range > 0 ? (time - graph_.first) / range : 0.5;
    return kLeft + share * (picture_.width - kLeft - kRight);
  }
  [[nodiscard]] double y(Index track) const { return kTop + row_height_ * (static_cast<double>(rows_[track]) + 0.5); }
  [[nodiscard]] double half_thickness(double measure) const {
    return std::max(1.0, largest_ > 0 ? 0.42 * row_height_ * std::sqrt(measure / largest_) : 1.5);
  }
  [[nodiscard]] std::string time_name() const {
    const auto last = static_cast<std::size_t>(std::max(graph_.space_dim - 1, 0));
    const std::string name = graph_.axis_names[last].empty() ? "t" : graph_.axis_names[last];
    return escaped(graph_.axis_units[last].empty() ? name : fmt::format("{} ({})", name, graph_.axis_units[last]));
  }

  void draw_titles() {
    const std::string title = escaped(picture_.title.empty() ? "Components over time" : picture_.title);
    text_ += fmt::format("<title>{0}</title>\n<text class=\"title\" x=\"{1}\" y=\"22\">{0}</text>\n", title, kLeft);
    const std::size_t drawn = graph_.tracks.size(), all = std::max(all_, picture_.all_tracks);
    std::string what = drawn == all  ? fmt::format("{} track{}", all, all == 1 ? "" : "s")
                       : all_ == all ? fmt::format("the {} longest of {} tracks", drawn, all)
                                     : fmt::format("{} of {} tracks", drawn, all);
    constexpr std::array kMeasures{"number of points", "length", "area", "volume"};
    if (largest_ > 0 && graph_.space_dim >= 2)
      what += fmt::format("; width proportional to the square root of the {}",
                          kMeasures[static_cast<std::size_t>(graph_.space_dim - 2)]);
    text_ += fmt::format("<text x=\"{}\" y=\"40\">{}</text>\n", kLeft, what);
  }

  void draw_axis() {
    const double step = tick_step(graph_.last - graph_.first, 10);
    for (double k = std::ceil(graph_.first / step - 1e-9); k * step <= graph_.last + 1e-9 * step; ++k) {
      const double at = x(k * step);
      text_ += fmt::format(
          "<path class=\"grid\" d=\"M{0:.2f} {1:.2f}V{2:.2f}\"/><text x=\"{0:.2f}\" y=\"{3:.2f}\" "
          "text-anchor=\"middle\">{4:.6g}</text>\n",
          at, kTop - 6, bottom_ + 4, bottom_ + 17, k == 0 ? 0.0 : k * step);
    }
    text_ += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"middle\">{}</text>\n",
                         0.5 * (kLeft + picture_.width - kRight), bottom_ + 33, time_name());
  }

  void draw_track(Index t) {
    const Track& track = graph_.tracks[t];
    text_ += fmt::format("<g fill=\"{}\"><title>track {}: {:.6g} to {:.6g}</title>\n",
                         kColours[track.number % kColours.size()], track.number, track.start, track.end);
    double measure = 0;  // a segment without samples has the measure of the previous one
    for (const Index s : track.segments) measure = draw_segment(graph_.segments[s], y(t), measure);
    text_ += number_of(t) + "</g>\n";
  }

  /// The label of a track in its row: before its start, or after its end if links leave room closer to that.
  [[nodiscard]] std::string number_of(Index t) const {
    const Track& track = graph_.tracks[t];
    const std::string number = std::to_string(track.number);
    const double width = 6.5 * static_cast<double>(number.size());
    const double before = free_of_links(x(track.start) - 8 - width, width, y(t), -1);
    const double behind = free_of_links(x(track.end) + 8, width, y(t), 1);
    const double way_before = before < 2 ? picture_.width : x(track.start) - 8 - width - before;
    const double way_behind = behind + width > picture_.width - 2 ? picture_.width : behind - x(track.end) - 8;
    const bool comes_first = way_before <= way_behind;
    return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\"{}>{}</text>", comes_first ? before + width : behind, y(t) + 4,
                       comes_first ? " text-anchor=\"end\"" : "", number);
  }

  /// The left end of a text of width `width` in a row: starting at `left`, moved to the left (step < 0) or right until
  /// no link crosses the text.
  [[nodiscard]] double free_of_links(double left, double width, double row, int step) const {
    const auto crosses = [&](const Link& link) {
      return link.top < row + 6 && link.bottom > row - 6 && link.at > left - 2 && link.at < left + width + 2;
    };
    // Terminates, because each link is passed at most once.
    for (auto link = links_.begin(); (link = std::find_if(links_.begin(), links_.end(), crosses)) != links_.end();)
      left = step < 0 ? link->at - 2.5 - width : link->at + 2.5;
    return left;
  }

  /// Draws a band around the row: along the samples and back. Returns the measure at its end.
  double draw_segment(const TrackSegment& segment, double middle, double before) {
    std::vector<std::pair<double, double>> outline;
    const double first = segment.samples.empty() ? before : segment.samples.front().measure;
    const double last = segment.samples.empty() ? before : segment.samples.back().measure;
    outline.emplace_back(x(segment.start), half_thickness(first));
    for (const TrackSample& sample : segment.samples)
      outline.emplace_back(x(sample.time), half_thickness(sample.measure));
    outline.emplace_back(x(segment.end), half_thickness(last));
    std::string path;
    for (const auto& [at, half] : outline)
      path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? 'M' : 'L', at, middle - half);
    std::reverse(outline.begin(), outline.end());
    for (const auto& [at, half] : outline) path += fmt::format("L{:.2f} {:.2f}", at, middle + half);
    text_ += fmt::format("<path d=\"{}z\"/>\n", path);
    return last;
  }

  /// The rows of an event's segments, from top to bottom.
  [[nodiscard]] std::vector<double> rows_of(const TrackEvent& event) const {
    std::vector<double> rows;
    for (const auto* list : {&event.in, &event.out})
      for (const Index s : *list) rows.push_back(y(graph_.segments[s].track));
    std::sort(rows.begin(), rows.end());
    return rows;
  }

  /// A dotted line below a mark, or below the link of an event, for tracks that are not drawn.
  [[nodiscard]] std::string stub(double x, double y) const {
    return fmt::format("<path class=\"link away\" d=\"M{:.2f} {:.2f}v{:.2f}\"/>", x, y,
                       std::min(0.8 * row_height_, 14.0));
  }

  void draw_event(const TrackEvent& event) {
    const Index main = rows_.through(event);
    const std::vector<double> rows = rows_of(event);
    const double row = main == kNone ? rows.front() : y(main);
    std::string place;
    for (int a = 0; a + 1 < graph_.space_dim; ++a) place += fmt::format("{}{:.6g}", a == 0 ? "" : ", ", event.place[a]);
    const std::string left_out = event.left_out == 0 ? ""
                                 : event.left_out == 1
                                     ? ", with a track that is not drawn"
                                     : fmt::format(", with {} tracks that are not drawn", event.left_out);
    text_ += fmt::format("<g><title>{} at {:.6g}, place {}{}</title>{}{}</g>\n", name_of(event.kind), event.time, place,
                         left_out, event.left_out == 0 ? "" : stub(x(event.time), rows.back()),
                         mark(event.kind, x(event.time), row));
  }

  /// Draws a legend of the marks that occur.
  void draw_legend() {
    double at = kLeft;
    const double row = bottom_ + 56;
    const auto entry = [&](const std::string& symbol, std::string_view name) {
      text_ += fmt::format("{}<text x=\"{:.2f}\" y=\"{:.2f}\">{}</text>\n", symbol, at + 9, row + 4, name);
      at += 26 + 6.2 * static_cast<double>(name.size());
    };
    for (int k = 0; k <= static_cast<int>(TrackEventKind::exchange); ++k) {
      const auto kind = static_cast<TrackEventKind>(k);
      if (std::any_of(graph_.events.begin(), graph_.events.end(),
                      [&](const auto& event) { return event.kind == kind; }))
        entry(mark(kind, at, row), name_of(kind));
    }
    if (!graph_.handles.empty()) entry(handle_mark(at, row), "handle opens or closes");
    if (std::any_of(graph_.events.begin(), graph_.events.end(), [](const auto& event) { return event.left_out > 0; }))
      entry(stub(at, row - 7), "to tracks that are not drawn");
  }

  const TrackPicture& picture_;
  std::size_t all_;
  TrackGraph graph_;
  Rows rows_;
  double row_height_ = 0;
  double bottom_ = 0;
  double largest_ = 0;
  std::vector<Link> links_;
  std::string text_;
};

}  // namespace

std::string track_svg(const TrackGraph& graph, const TrackPicture& picture) { return Drawing(graph, picture).draw(); }

}  // namespace tegl
