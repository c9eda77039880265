// SPDX-License-Identifier: BSD-3-Clause
//
// tegl view, except for the rendering of its pages in a browser (tests/viewer).
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

#include "sample_files.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class View : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    file_ = write("balls.nii", nifti_bytes(merging_balls(18, 5), {1, 1, 1, 2}));
    if (run_tegl({"view", file_, "--iso", "0", "-o", path("probe.html"), "-q"}).err.find("no viewer") !=
        std::string::npos)
      GTEST_SKIP() << "this build has no viewer";
  }
  [[nodiscard]] const std::string& file() const { return file_; }
  /// The scene description in the page.
  [[nodiscard]] static nlohmann::json scene(const std::string& page) {
    const std::string text = content(page);
    const std::string start = "<script type=\"application/json\" id=\"scene\">";
    const std::size_t from = text.find(start) + start.size();
    return nlohmann::json::parse(text.substr(from, text.find("</script>", from) - from));
  }
  /// Two balls of different size in 3D.
  std::string two_balls() {
    const auto balls = [](const std::vector<double>& x) {
      return std::max(4.25 - std::hypot(x[0] - 9.0, x[1] - 9.5, x[2] - 9.5),
                      6.25 - std::hypot(x[0] - 29.0, x[1] - 9.5, x[2] - 9.5));
    };
    return write("two.nrrd", nrrd_bytes(sample({40, 20, 20}, balls)));
  }

 private:
  std::string file_;
};

TEST_F(View, WritesOnePageThatRefersToNothingElse) {
  const RunResult run = run_tegl({"view", file(), "--iso", "0", "-o", path("page.html"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["files"].size(), 1);
  EXPECT_EQ(run.json()["files"][0]["image_dim"], 4);
  const std::string page = content(path("page.html"));
  EXPECT_EQ(run.json()["bytes"], page.size());
  EXPECT_THAT(page.substr(0, 500), HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("three.js authors"));  // required by the licence
  EXPECT_FALSE(std::regex_search(page.substr(0, page.find("id=\"scene\"")), std::regex("(src|href)=\"(?!data:,)")));
}

TEST_F(View, TellsUnitsSizesAndEvents) {
  ASSERT_EQ(run_tegl({"view", file(), "--iso", "0", "-o", path("page.html"), "--title", "a < b", "-q"}).exit, 0);
  EXPECT_THAT(content(path("page.html")), HasSubstr("<title>a &lt; b</title>"));
  const nlohmann::json page = scene(path("page.html"));
  EXPECT_EQ(page["title"], "a < b");
  const nlohmann::json& layer = page["layers"][0];
  EXPECT_EQ(layer["axes"][3]["unit"], "s");
  EXPECT_EQ(layer["axes"][0]["unit"], "mm");
  EXPECT_EQ(layer["axes"][3]["highest"], 8.0);
  EXPECT_EQ(layer["arrays"]["simplices"]["rows"], layer["simplices"]);
  const auto& events = layer["graph"]["events"];
  EXPECT_EQ(std::count_if(events.begin(), events.end(), [](const auto& event) { return event["kind"] == "merge"; }), 1);
}

TEST_F(View, IsTheSameByteByByteWithAnyNumberOfThreads) {
  for (const char* const threads : {"1", "3"})
    ASSERT_EQ(
        run_tegl({"view", file(), "--iso", "0", "-o", path(std::string(threads) + ".html"), "--threads", threads, "-q"})
            .exit,
        0);
  EXPECT_EQ(content(path("1.html")), content(path("3.html")));
}

TEST_F(View, ShowsTwoAndThreeDimensionsAndSeveralFiles) {
  const std::string two = two_balls();
  EXPECT_EQ(run_tegl({"view", file(), two, "--iso", "0", "-o", path("both.html"), "-q"}).exit, 0);
  const nlohmann::json both = scene(path("both.html"));
  EXPECT_EQ(both["layers"].size(), 2);
  EXPECT_EQ(both["layers"][1]["components"], 2);
  const std::string flat = write("flat.nrrd", nrrd_bytes(ball({12, 12}, 4)));
  EXPECT_EQ(run_tegl({"view", flat, "--iso", "0", "-o", path("flat.html"), "-q"}).exit, 0);
  const RunResult mixed = run_tegl({"view", two, flat, "--iso", "0", "-o", path("mixed.html")});
  EXPECT_EQ(mixed.exit, 4);
  EXPECT_THAT(mixed.err, HasSubstr("flat.nrrd: a contour in 2D on a page with one in 3D"));
  EXPECT_THAT(files(), Not(testing::Contains("mixed.html")));
}

TEST_F(View, LeavesOutTheSmallerComponentsBeyondTheLimitAndSaysSo) {
  const std::string two = two_balls();
  const RunResult all = run_tegl({"view", two, "--iso", "0", "-o", path("all.html"), "--json"});
  const auto count = all.json()["files"][0]["simplices"].get<int>();
  const std::string limit = std::to_string(count - 1);
  const RunResult less = run_tegl({"view", two, "--iso", "0", "-o", path("less.html"), "--limit", limit, "--json"});
  ASSERT_EQ(less.exit, 0) << less.err;
  EXPECT_EQ(less.json()["files"][0]["components"], 2);
  EXPECT_EQ(less.json()["files"][0]["components_shown"], 1);
  EXPECT_GT(less.json()["files"][0]["simplices_shown"], count / 2);  // the larger one
  EXPECT_EQ(scene(path("less.html"))["layers"][0]["of_simplices"], count);
  const RunResult told = run_tegl({"view", two, "--iso", "0", "-o", path("less.html"), "--limit", limit});
  EXPECT_THAT(told.out, HasSubstr("the largest of 2 components"));
  const RunResult quiet = run_tegl({"view", two, "--iso", "0", "-o", path("less.html"), "--limit", limit, "-q"});
  EXPECT_THAT(quiet.err, HasSubstr("the page shows the largest of 2 components"));
  const RunResult none = run_tegl({"view", two, "--iso", "0", "-o", path("none.html"), "--limit", "10"});
  EXPECT_EQ(none.exit, 4);
  EXPECT_THAT(none.err, HasSubstr("two.nrrd: the largest component has"));
  EXPECT_THAT(none.err, HasSubstr("expected at most 10"));
}

TEST_F(View, AxesPointWhereTheFileOrTheOptionSays) {
  const std::vector<double> places = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  using Attributes = std::vector<NetcdfAttribute>;
  const auto file_with = [&](const std::string& upright, const Attributes& attributes) {
    write_netcdf(path("a.nc"), {"lon", "lat", upright}, {places, places, places}, {{"heat", ball({10, 10, 10}, 3)}},
                 attributes);
    return path("a.nc");
  };
  const auto downs = [&](const std::string& input, std::vector<std::string> options) {
    const bool is_image = input.ends_with(".nc");
    options.insert(options.begin(), {"view", input, "-o", path("page.html"), "-q"});
    if (is_image) options.insert(options.end(), {"--iso", "0"});
    const RunResult run = run_tegl(options);
    EXPECT_EQ(run.exit, 0) << run.err;
    const nlohmann::json layer = scene(path("page.html"))["layers"][0];
    EXPECT_EQ(layer["unit"], is_image ? "degC" : "");
    nlohmann::json result = nlohmann::json::array();
    for (const auto& axis : layer["axes"]) result.push_back(axis["down"]);
    return result;
  };
  const auto are = [](const char* json) { return nlohmann::json::parse(json); };
  EXPECT_EQ(downs(file_with("level", {}), {}), are("[null, null, null]"));
  EXPECT_EQ(downs(file_with("level", {{2, "positive", "down"}}), {}), are("[null, null, true]"));
  EXPECT_EQ(downs(file_with("level", {{2, "units", "hPa"}}), {}), are("[null, null, true]"));
  EXPECT_EQ(downs(file_with("sea_DEPTH", {}), {}), are("[null, null, true]"));
  EXPECT_EQ(downs(file_with("depth", {{2, "positive", "up"}}), {}), are("[null, null, false]"));
  EXPECT_EQ(downs(path("a.nc"), {"--down", "z"}), are("[false, false, true]"));
  EXPECT_EQ(downs(path("a.nc"), {"--down", "Depth"}), are("[false, false, true]"));
  EXPECT_EQ(downs(path("a.nc"), {"--down", "lat"}), are("[false, true, false]"));
  EXPECT_EQ(downs(file_with("level", {{2, "positive", "down"}}), {"--down", "none"}), are("[false, false, false]"));
  // Saved contours contain axis names only.
  ASSERT_EQ(run_tegl({"contour", path("a.nc"), "--iso", "0", "-o", path("a.ply"), "-q"}).exit, 0);
  EXPECT_EQ(downs(path("a.ply"), {}), are("[null, null, null]"));
  EXPECT_EQ(downs(path("a.ply"), {"--down", "level"}), are("[false, false, true]"));
  const RunResult wrong = run_tegl({"view", path("a.nc"), "--iso", "0", "-o", path("wrong.html"), "--down", "t"});
  EXPECT_EQ(wrong.exit, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--down t names no axis in space; expected lon, lat, level or none"));
  EXPECT_THAT(files(), Not(testing::Contains("wrong.html")));
}

TEST_F(View, WorldsAreThoseOfTheFileOrTheOption) {
  const auto world = [&](const std::string& input, std::vector<std::string> options) {
    options.insert(options.begin(), {"view", input, "-o", path("page.html"), "-q"});
    if (input.ends_with(".nrrd")) options.insert(options.end(), {"--iso", "0"});
    const RunResult run = run_tegl(options);
    EXPECT_EQ(run.exit, 0) << run.err;
    return scene(path("page.html"))["layers"][0]["world"];
  };
  const auto write = [&](const std::string& name, const std::string& space) {
    std::ofstream file(path(name));
    file << "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 3 3\nencoding: ascii\n" << space << "\n";
    for (int i = 0; i < 27; ++i) file << (i == 13 ? 1 : -1) << ' ';
    return path(name);
  };
  const std::string placed = "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace units: \"mm\" \"mm\" \"mm\"\n";
  const std::string known = write("known.nrrd", "space: left-posterior-superior\n" + placed);
  const std::string unknown = write("unknown.nrrd", "space dimension: 3\n" + placed);
  EXPECT_EQ(world(known, {}), "LPS");
  EXPECT_EQ(world(known, {"--world", "none"}), nullptr);
  EXPECT_EQ(world(unknown, {}), nullptr);
  EXPECT_EQ(world(unknown, {"--world", "ras"}), "RAS");
  // Saved contours do not contain it.
  ASSERT_EQ(run_tegl({"contour", known, "--iso", "0", "-o", path("known.ply"), "-q"}).exit, 0);
  EXPECT_EQ(world(path("known.ply"), {}), nullptr);
  EXPECT_EQ(world(path("known.ply"), {"--world", "LPI"}), "LPI");
  for (const std::string wrong : {"SAR", "RA", "RAX", ""}) {
    const RunResult run = run_tegl({"view", known, "--iso", "0", "-o", path("wrong.html"), "--world", wrong});
    EXPECT_EQ(run.exit, 2) << wrong;
    EXPECT_THAT(run.err, HasSubstr("expected R or L, A or P, S or I, as in RAS or LPS, or none"));
  }
  EXPECT_THAT(files(), Not(testing::Contains("wrong.html")));
}

TEST_F(View, OfACurvedGridHasItsCoordinatesLikeTheSavedContour) {
  const std::string model = TEGL_SOURCE_DIR "/tests/io/seeds/netcdf_curved.nc";
  const auto page_of = [&](const std::vector<std::string>& input) {
    std::vector<std::string> arguments = {"view", "-o", path("page.html"), "--json"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return std::pair{run.json()["files"][0], scene(path("page.html"))["layers"][0]};
  };
  // a circle of radius 1.5 around 179.5 degrees east, 37 degrees north, not the indices 0 to 6
  const auto [report, layer] = page_of({model, "--iso", "1.5"});
  EXPECT_EQ(report["folded_cells"], 0);
  EXPECT_EQ(layer["axes"][0]["name"], "lon");
  EXPECT_EQ(layer["axes"][1]["unit"], "degrees_north");
  EXPECT_NEAR(layer["axes"][0]["lowest"].get<double>(), 178, 0.15);
  EXPECT_NEAR(layer["axes"][1]["highest"].get<double>(), 38.5, 0.15);
  ASSERT_EQ(run_tegl({"contour", model, "--iso", "1.5", "-o", path("o.vtkhdf"), "-q"}).exit, 0);
  const nlohmann::json saved = page_of({path("o.vtkhdf")}).second;
  for (const char* const key : {"axes", "center", "vertices", "simplices", "components", "arrays"})
    EXPECT_EQ(layer[key], saved[key]) << key;
  // by the indices
  const nlohmann::json indices = page_of({model, "--iso", "1.5", "--index-grid"}).second;
  EXPECT_EQ(indices["simplices"], layer["simplices"]);
  EXPECT_LE(indices["axes"][0]["highest"], 6);
}

TEST_F(View, OfAPeriodicTimeTheTracksEndAtBothEnds) {
  const RunResult run = run_tegl({"view", file(), "--iso", "0", "--periodic", "t", "-o", path("page.html"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the time is periodic: the contour is unrolled"));
  ASSERT_EQ(run_tegl({"view", file(), "--iso", "0", "-o", path("plain.html"), "-q"}).exit, 0);
  const auto last_event = [&](const std::string& page) {
    const nlohmann::json of_page = scene(path(page));
    double last = 0;
    for (const nlohmann::json& event : of_page.at("layers").at(0).at("graph").at("events"))
      last = std::max(last, event.at("time").get<double>());
    return last;
  };
  EXPECT_NEAR(last_event("page.html"), last_event("plain.html") + 2, 1e-9);  // one more step, of 2 s
  // another axis: the time is as it is
  EXPECT_THAT(run_tegl({"view", file(), "--iso", "0", "--periodic", "x", "-o", path("page.html")}).err,
              Not(HasSubstr("the time is periodic")));
}

TEST_F(View, RefusesWhatItCannotDoAndLeavesNothing) {
  const auto view = [&](const std::string& input, const std::string& output) {
    return run_tegl({"view", input, "--iso", "0", "-o", output});
  };
  EXPECT_EQ(view(path("missing.nii"), path("a.html")).exit, 3);
  const RunResult extension = view(file(), path("a.png"));
  EXPECT_EQ(extension.exit, 6);
  EXPECT_THAT(extension.err, HasSubstr("the extension '.png' is not known; expected .html"));
  EXPECT_EQ(view(file(), path("no/folder.html")).exit, 6);
  EXPECT_EQ(view(file(), "/dev/full/page.html").exit, 6);
  EXPECT_EQ(run_tegl({"view", file(), "--iso", "1000", "-o", path("a.html")}).exit, 5);
  EXPECT_EQ(run_tegl({"view", file(), "-o", path("a.html")}).exit, 2);
  const std::string still = write("ball.nrrd", nrrd_bytes(ball({8, 8, 8}, 2.2)));
  const RunResult tracks = run_tegl({"view", still, "--iso", "0", "--tracks", "5", "-o", path("a.html")});
  EXPECT_EQ(tracks.exit, 2);
  EXPECT_THAT(tracks.err, HasSubstr("--tracks 5 with a contour in 3D; expected it with one in 4D"));
  // Messages about the second file contain its name.
  const std::string flat = write("zero.nrrd", nrrd_bytes(sample({4, 4, 4}, [](const auto&) { return 5.0; })));
  const RunResult second = run_tegl({"view", file(), flat, "--iso", "0", "-o", path("a.html")});
  EXPECT_EQ(second.exit, 5);
  EXPECT_THAT(second.err, HasSubstr("zero.nrrd: all values are 5"));
  EXPECT_THAT(files(), ElementsAre("ball.nrrd", "balls.nii", "probe.html", "zero.nrrd"));
}

}  // namespace
}  // namespace tegl::test
