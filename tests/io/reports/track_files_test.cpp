// SPDX-License-Identifier: BSD-3-Clause
//
// Graphs of the components of measured data, compared with slices of the contour; and files of graphs.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "io_support.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/io/tracks.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;
using testing::Not;

Contour<4, double> contour_of(const std::string& path, const std::string& variable, double isovalue) {
  const ReadImageResult input = read_image(path, {.variable = variable});
  const auto& images = std::get<AnyImageN<4>>(input.image);
  return std::visit([&](const auto& owned) { return extract<double>(owned.view(), isovalue); }, images);
}

/// Expects the components and their Euler characteristics at some times to equal those of the slices.
void expect_right(const Contour<4, double>& contour, double first, double last) {
  TrackOptions options;
  options.times = even_times(first, last, 5);
  const TrackGraph graph = track(contour, options);
  EXPECT_GT(graph.events.size(), 20u);
  for (const double time : options.times) {
    std::uint64_t parts = 0;
    std::int64_t euler = 0;
    double area = 0;
    for (const TrackSegment& segment : graph.segments)
      for (const TrackSample& sample : segment.samples)
        if (sample.time == time) {
          ++parts;
          euler += segment.euler_at_start;
          area += sample.measure;
        }
    for (const TrackHandle& handle : graph.handles) {
      const TrackSegment& segment = graph.segments[handle.segment];
      if (segment.start < time && handle.time < time && time < segment.end) euler += handle.euler_change;
    }
    const Contour<3, double> cut = slice(contour, Hyperplane<4>::across(3, time));
    const MeshReport report = check(cut);
    EXPECT_EQ(parts, report.components) << "at " << time;
    EXPECT_EQ(euler, report.euler) << "at " << time;
    EXPECT_GT(area, 0.0);
  }
}

TEST(TrackFiles, TheOceansPartsAreThoseOfItsCuts) {
  expect_right(contour_of(std::string(TEGL_SOURCE_DIR) + "/examples/data/ocean_temperature.nc", "temperature", 20), 1,
               12);
}

TEST(TrackFiles, ViscousFingersPartsAreThoseOfTheirCuts) {
  const std::string path = std::string(TEGL_SHARED_DATA_DIR) + "/fourd/viscous_fingers_64x64x64x24_float.nhdr";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  expect_right(contour_of(path, "", 30), 0, 23);
}

/// A line that rises and forks, with names that need escaping in markup and JSON.
TrackGraph fork() {
  Contour<2, double> contour;
  contour.vertices = {{0, 0}, {0, 1}, {-1, 2}, {1, 3}};
  contour.simplices = {{0, 1}, {1, 2}, {1, 3}};
  contour.axis_names = {"x \"<&", "t<&"};
  contour.axis_units = {"", "\xb5s"};
  TrackOptions options;
  options.times = {0.5, 2.5};
  return track(contour, options);
}

TEST(TrackFiles, TextsHideWhatWouldBeMarkup) {
  const std::string svg = track_svg(fork(), {.title = "a < b & c"});
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
  EXPECT_THAT(svg, HasSubstr("t&lt;&amp; (?s)"));
  EXPECT_EQ(svg.find('\xb5'), std::string::npos);
  EXPECT_THAT(track_json(fork()), HasSubstr(R"("name": "x \"<&")"));
}

TEST(TrackFiles, TablesAndGraphsHaveEverything) {
  EXPECT_EQ(track_segments_csv(fork()),
            "segment,track,from,to,start,end,size_at_start,size_at_end,euler_at_start,euler_at_end,samples\n"
            "0,0,0,1,0,1,1,1,1,1,1\n"
            "1,0,1,3,1,3,1,1,1,1,1\n"
            "2,1,1,2,1,2,1,1,1,1,0\n");
  EXPECT_THAT(track_samples_csv(fork()), HasSubstr("\n0,0,0.5,1,,0,0,0\n"));
  EXPECT_THAT(track_events_csv(fork()), HasSubstr("\n1,split,1,0,1,0,0,1 2,1,0\n"));
  const std::string dot = track_dot(fork());
  for (const char* const arrow : {"e0 -> e1", "e1 -> e3", "e1 -> e2"}) EXPECT_THAT(dot, HasSubstr(arrow));
}

TEST(TrackFiles, AllTablesAreWrittenOrNone) {
  const TempDir dir;
  write_track_csv(fork(), dir / "fork");
  EXPECT_EQ(read_file(dir / "fork-events.csv"), track_events_csv(fork()));
  EXPECT_EQ(read_file(dir / "fork-segments.csv"), track_segments_csv(fork()));
  EXPECT_EQ(read_file(dir / "fork-samples.csv"), track_samples_csv(fork()));
  const auto none = dir / "none";
  expect_error(ErrorCode::WriteFailed, {"none"}, [&] { write_track_csv(fork(), none / "fork"); });
  EXPECT_FALSE(std::filesystem::exists(none));
}

TEST(TrackFiles, ThePictureShowsTheLongestTracks) {
  EXPECT_THAT(track_svg(fork()), HasSubstr("2 tracks"));
  EXPECT_THAT(track_svg(fork(), {.most_tracks = 1}), HasSubstr("the 1 longest of 2 tracks"));
  EXPECT_THAT(track_svg(TrackGraph{}), HasSubstr("0 tracks"));
  EXPECT_THAT(track_svg(fork(), {.all_tracks = 7}), HasSubstr("2 of 7 tracks"));
  EXPECT_THAT(track_svg(fork()), Not(HasSubstr("not drawn")));
  EXPECT_THAT(track_svg(fork(), {.most_tracks = 1}), HasSubstr(", with a track that is not drawn</title>"));
}

/// Three lines that merge at t = 30 and split again at t = 100. The longest-lived track is the one through both; then
/// come the two others before the merge.
TrackGraph knots() {
  Contour<2, double> contour;
  contour.vertices = {{-1, 0}, {0, 10}, {1, 20}, {0, 30}, {0, 100}, {-1, 103}, {0, 102}, {1, 101}};
  contour.simplices = {{0, 3}, {1, 3}, {2, 3}, {3, 4}, {4, 5}, {4, 6}, {4, 7}};
  return track(contour);
}

TrackGraph graph_of_the_ocean() {
  TrackOptions options;
  options.min_lifetime = 0.5;
  return track(contour_of(std::string(TEGL_SOURCE_DIR) + "/examples/data/ocean_temperature.nc", "temperature", 20),
               options);
}

/// All matches of a pattern in a text: the whole match, then its groups.
std::vector<std::vector<std::string>> all_of(const std::string& text, const char* pattern) {
  std::vector<std::vector<std::string>> result;
  const std::regex regex(pattern);
  for (std::sregex_iterator found(text.begin(), text.end(), regex); found != std::sregex_iterator(); ++found)
    result.emplace_back(found->begin(), found->end());
  return result;
}

TEST(TrackFiles, ThePictureShowsWhereTracksAreLeftOut) {
  const TrackGraph graph = knots();
  ASSERT_EQ(graph.tracks.size(), 5u);
  const std::string one = ", with a track that is not drawn", two = ", with 2 tracks that are not drawn";
  // by the number of tracks that are drawn: the ends of the titles of the merge and of the split
  const std::vector<std::pair<std::string, std::string>> expected = {{two, two}, {one, two}, {"", two}, {"", one}, {}};
  std::size_t joined = 0;
  for (std::size_t most = 1; most <= 5; ++most) {
    const std::string svg = track_svg(graph, {.most_tracks = most});
    const auto titles = all_of(svg, "<title>(merge|split) at (?:30|100), place 0([^<]*)</title>");
    ASSERT_EQ(titles.size(), 2u) << most;
    const auto& [merge, split] = expected[most - 1];
    EXPECT_EQ(titles[0][2], merge) << most;
    EXPECT_EQ(titles[1][2], split) << most;
    const std::size_t events = (merge.empty() ? 0u : 1u) + (split.empty() ? 0u : 1u);
    const auto stubs = all_of(svg, R"re(class="link away" d="M([0-9.]+) ([0-9.]+)v)re");
    EXPECT_EQ(stubs.size(), events + (events > 0 ? 1u : 0u)) << most << ", with the legend";
    // below the line that joins the tracks of the event, if several are drawn
    for (const auto& link : all_of(svg, R"re(class="link" d="M([0-9.]+) ([0-9.]+)V([0-9.]+)")re"))
      for (const auto& stub : stubs)
        if (stub[1] == link[1]) {
          EXPECT_EQ(stub[2], link[3]) << most;
          ++joined;
        }
  }
  EXPECT_GT(joined, 0u);
}

TEST(TrackFiles, LinksInThePictureCrossNoNumber) {
  const TrackGraph graph = graph_of_the_ocean();
  const std::string svg = track_svg(graph);
  const auto links = all_of(svg, R"re(class="link" d="M([0-9.]+) ([0-9.]+)V([0-9.]+)")re");
  const auto numbers = all_of(svg, R"re(<text x="([0-9.]+)" y="([0-9.]+)"( text-anchor="end")?>([0-9]+)</text></g>)re");
  EXPECT_GT(links.size(), 10u);
  ASSERT_EQ(numbers.size(), graph.tracks.size());
  for (const auto& number : numbers) {
    const double width = 6.2 * static_cast<double>(number[4].size());  // of digits of 11 pixels
    const double left = std::stod(number[1]) - (number[3].empty() ? 0.0 : width);
    const double row = std::stod(number[2]) - 4;
    EXPECT_GE(left, 0.0);
    for (const auto& link : links)
      EXPECT_FALSE(std::stod(link[1]) > left && std::stod(link[1]) < left + width && std::stod(link[2]) < row + 5 &&
                   std::stod(link[3]) > row - 5)
          << "track " << number[4] << ", link at " << link[1];
  }
}

TEST(TrackFiles, GraphvizDrawsAllEventsAndSegments) {
  if (std::system("dot -V >/dev/null 2>&1") != 0) GTEST_SKIP() << "graphviz is not here";
  const TrackGraph graph = graph_of_the_ocean();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tegl_track_dot";
  std::filesystem::create_directories(folder);
  const std::string source = (folder / "graph.dot").string(), drawing = (folder / "graph.svg").string();
  write_track(graph, source);
  ASSERT_EQ(std::system(("dot -Tsvg '" + source + "' -o '" + drawing + "'").c_str()), 0);
  std::ifstream file(drawing);
  const std::string svg{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(all_of(svg, "class=\"node\"").size(), graph.events.size());
  EXPECT_EQ(all_of(svg, "class=\"edge\"").size(), graph.segments.size());
  std::filesystem::remove_all(folder);
}

TEST(TrackFiles, RefusesOtherExtensions) {
  try {
    write_track(fork(), "graph.png");
    FAIL() << "expected UnsupportedFormat";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::UnsupportedFormat);
    EXPECT_THAT(error.what(), HasSubstr("expected .json"));
  }
}

}  // namespace
}  // namespace tegl::test
