// SPDX-License-Identifier: BSD-3-Clause
//
// The command tegl track: events, graphs, pictures and tables.
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A file with two merging balls.
class Track : public ProgramTest {
 protected:
  [[nodiscard]] std::string image() const { return write("balls.nrrd", nrrd_bytes(merging_balls(20, 8))); }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream file(path(name));
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
};

TEST_F(Track, ReportsEventsAsJson) {
  const RunResult run = run_tegl({"track", image(), "--iso", "0", "--samples", "10", "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const nlohmann::json json = run.json();
  EXPECT_EQ(json["image_dim"], 4);
  EXPECT_EQ(json["tracks_found"], 2);
  EXPECT_EQ(json["events_by_kind"], (nlohmann::json{{"begin", 2}, {"end", 1}, {"merge", 1}}));
  const nlohmann::json& graph = json["graph"];
  ASSERT_EQ(graph["segments"].size(), 3u);
  EXPECT_EQ(graph["first"], 0.0);
  EXPECT_EQ(graph["last"], 7.0);
  for (const auto& event : graph["events"]) {
    if (event["kind"] != "merge") continue;
    EXPECT_EQ(event["in"].size(), 2u);
    EXPECT_EQ(event["out"].size(), 1u);
    EXPECT_EQ(event["place"].size(), 3u);
    EXPECT_GT(event["time"], 0.0);
    EXPECT_LT(event["time"], 7.0);
  }
  std::size_t samples = 0;
  for (const auto& segment : graph["segments"]) samples += segment["samples"].size();
  EXPECT_GT(samples, 10u) << "ten times, two parts before the merge";
}

TEST_F(Track, CountsThatAreNoneAreNamed) {
  for (const auto& [option, value] : {std::pair{"--samples", "-2"}, {"--longest", "0"}, {"--largest", "1e3"}}) {
    const RunResult run = run_tegl({"track", image(), "--iso", "0", option, value});
    EXPECT_EQ(run.exit, 2);
    EXPECT_THAT(run.err, HasSubstr(std::string(option) + " is '" + value + "'; expected a whole number from "));
  }
  const RunResult twice = run_tegl({"track", image(), "--iso", "0", "-o", path("g.svg"), "-o", path("g.svg")});
  EXPECT_EQ(twice.exit, 2);
  EXPECT_THAT(twice.err, HasSubstr("would be written twice"));
}

TEST_F(Track, WritesGraphsPicturesTablesAndTheContour) {
  const RunResult run = run_tegl({"track", image(), "--iso", "0", "-o", path("g.json"), "-o", path("g.dot"), "-o",
                                  path("g.svg"), "-o", path("g.vtkhdf"), "--csv", path("g"), "-q"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(nlohmann::json::parse(text("g.json"))["tracks"].size(), 2u);
  EXPECT_THAT(text("g.dot"), HasSubstr("digraph tracks"));
  EXPECT_THAT(text("g.dot"), HasSubstr("label = \"merge"));
  EXPECT_THAT(text("g.svg"), HasSubstr("balls.nrrd"));
  EXPECT_THAT(text("g.svg"), HasSubstr("</svg>\n"));
  EXPECT_THAT(text("g-events.csv"), HasSubstr("event,kind,time,x,y,z,vertex,at_border,in,out,euler_change,left_out\n"));
  EXPECT_THAT(text("g-events.csv"), HasSubstr(",0 1,2,-2,0\n"));
  const std::string segments = text("g-segments.csv");
  EXPECT_EQ(std::count(segments.begin(), segments.end(), '\n'), 4);
  const std::string samples = text("g-samples.csv");
  EXPECT_GT(std::count(samples.begin(), samples.end(), '\n'), 100);
  const Mesh mesh = read_mesh(path("g.vtkhdf"));
  ASSERT_EQ(mesh.simplex_attributes.size(), 2u);
  EXPECT_EQ(mesh.simplex_attributes[0].name, "track");
  EXPECT_THAT(mesh.simplex_attributes[0].values, Contains(0.0));
  EXPECT_THAT(mesh.simplex_attributes[0].values, Contains(1.0));
}

TEST_F(Track, OfASavedContourIsTheSameGraph) {
  ASSERT_EQ(run_tegl({"contour", image(), "--iso", "0", "-o", path("c.vtkhdf"), "-q"}).exit, 0);
  ASSERT_EQ(run_tegl({"track", path("c.vtkhdf"), "-o", path("saved.json"), "-q"}).exit, 0);
  ASSERT_EQ(run_tegl({"track", image(), "--iso", "0", "-o", path("direct.json"), "-q", "--threads", "1"}).exit, 0);
  EXPECT_EQ(text("saved.json"), text("direct.json"));
}

TEST_F(Track, LeavesOutAndSelects) {
  const std::string file = image();
  const auto tracks = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"track", file, "--iso", "0", "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_tegl(arguments).json()["graph"]["tracks"].size();
  };
  EXPECT_EQ(tracks({}), 2u);
  EXPECT_EQ(tracks({"--min-lifetime", "6.9"}), 1u);
  EXPECT_EQ(tracks({"--longest", "1"}), 1u);
  EXPECT_EQ(tracks({"--largest", "1"}), 1u);
  EXPECT_EQ(tracks({"--longest", "9"}), 2u);
}

TEST_F(Track, ListsAsManyTracksAsWereRequested) {
  const auto listed = [](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"track", TEGL_SOURCE_DIR "/examples/data/ocean_temperature.nc", "--iso",
                                          "20"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::istringstream report(run_tegl(arguments).out);
    std::size_t count = 0;
    for (std::string line; std::getline(report, line);) count += line.find(" up to ") != std::string::npos ? 1 : 0;
    return count;
  };
  EXPECT_EQ(listed({}), 8u);
  EXPECT_EQ(listed({"--longest", "10"}), 10u);
  EXPECT_EQ(listed({"--largest", "3"}), 3u);
}

TEST_F(Track, SaysWhatIsWrong) {
  const std::string file = image();
  const auto fails = [&](std::vector<std::string> options, int exit, const std::string& message) {
    options.insert(options.begin(), {"track", file, "--iso", "0"});
    const RunResult run = run_tegl(options);
    EXPECT_EQ(run.exit, exit) << run.err;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  fails({"--min-lifetime", "-1"}, 2, "--min-lifetime");
  fails({"--min-lifetime", "long"}, 2, "long");
  fails({"--largest", "2", "--samples", "0"}, 2, "--samples");
  fails({"--largest", "2", "--longest", "1"}, 2, "--longest with --largest; expected one of the two");
  fails({"-o", path("g.txt")}, 6, "expected .json, .dot, .svg");
  fails({"-o", path("g.ply")}, 6, "cannot hold a 4D contour");
  fails({"-o", path("no/g.svg")}, 6, "does not exist");
  fails({"--csv", path("no/g")}, 6, "does not exist");
  fails({"-o", path("g.svg"), "-o", path("no/g.json")}, 6, "does not exist");
  EXPECT_THAT(files(), ElementsAre("balls.nrrd")) << "nothing half done";
}

}  // namespace
}  // namespace tegl::test
