// SPDX-License-Identifier: BSD-3-Clause
//
// Longitudes that repeat the first ones, those of regions, and places on them, by the program as in a shell.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

std::string file_bytes(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Longitudes : public ProgramTest {
 protected:
  [[nodiscard]] RunResult contour(const std::string& file, const std::vector<std::string>& options) const {
    std::vector<std::string> arguments = {"contour", file, "--iso", "0", "-o", path("spot.vtkhdf")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_tegl(arguments);
  }
  void expect_refused(const std::string& file, const std::vector<std::string>& options,
                      const std::string& message) const {
    const RunResult run = contour(file, options);
    EXPECT_NE(run.exit, 0);
    EXPECT_THAT(run.err, HasSubstr(message));
  }
  /// Writes a spot around 180 degrees on a straight grid of 36 columns, of which `repeated` ones follow again.
  [[nodiscard]] std::string write_globe(std::size_t repeated, float added = 0, double first = -175.0,
                                        double step = 10.0) const {
    OwnedImage<float, 2> image;
    image.grid = Grid<2>::unit({36 + repeated, 17});
    image.grid.axes[0] = Axis::uniform(36 + repeated, first, step);
    image.grid.axes[1] = Axis::uniform(17, -80.0, 10.0);
    image.grid.axes[0].name = "lon";
    image.grid.axes[0].unit = "degrees_east";
    for (std::size_t j = 0; j < 17; ++j)
      for (std::size_t i = 0; i < 36 + repeated; ++i) {
        const double away = 180.0 - std::abs(std::remainder(image.grid.axes[0][i % 36], 360.0));
        image.values.push_back(static_cast<float>(40.0 - std::hypot(away, image.grid.axes[1][j])));
        if (i >= 36 && j == 2) image.values[image.values.size() - 1] += added;
      }
    write_image(image.view(), path("globe.nc"));
    return path("globe.nc");
  }
};

TEST_F(Longitudes, SamplesThatRepeatTheFirstOnesAreLeftOut) {
  ASSERT_EQ(contour(write_globe(0), {"--periodic", "lon"}).exit, 0);
  const std::string expected = file_bytes(path("spot.vtkhdf"));
  const std::string one = "the last sample along lon repeats the first one, so it is left out";
  const std::string two = "the last 2 samples along lon repeat the first ones, so they are left out";
  for (const std::size_t repeated : {1, 2}) {
    const std::string file = write_globe(repeated);
    for (const char* const axis : {"lon", "x=360", "auto"}) {
      const RunResult run = contour(file, {"--periodic", axis});
      EXPECT_EQ(run.exit, 0) << run.err;
      EXPECT_THAT(run.err, HasSubstr(repeated == 1 ? one : two));
      EXPECT_EQ(file_bytes(path("spot.vtkhdf")), expected) << axis;
    }
    EXPECT_THAT(contour(file, {}).err, HasSubstr("--periodic auto continues it across"));
    const RunResult facets =
        run_tegl({"contour", file, "--iso", "0", "--periodic", "lon", "--facets", "-o", path("facets.vtu"), "--json"});
    EXPECT_EQ(facets.exit, 0) << facets.err;
    EXPECT_EQ(facets.json()["boundary_facets"], 0);
    expect_refused(file, {"--periodic", "lon", "--stream"}, "expected it without --stream, which leaves them out");
    expect_refused(file, {"--periodic", "x=350"}, "is 350; expected more than");
  }
}

TEST_F(Longitudes, SamplesWithOtherValuesThanTheFirstOnesAreNotLeftOut) {
  const std::string file = write_globe(1, 0.5F);
  expect_refused(
      file, {"--periodic", "lon"},
      "the last sample along axis 0 (lon) is at the longitudes of the first, 360 degrees further, but with "
      "other values: -19.707973 at the sample (36, 2), -20.207973 at the sample (0, 2); expected equal values");
  const RunResult run = contour(file, {"--periodic", "auto"});
  EXPECT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("so no axis is periodic: the last sample along lon is at the longitudes of the first, "
                                 "360 degrees further; --periodic lon leaves out the last one"));
}

TEST_F(Longitudes, CurvedGridsMayRepeatTheFirstSamples) {
  for (const bool is_turned : {false, true}) {
    const std::string file = path("globe.nc");
    write_curved_globe(file, "TLONG", is_turned);
    ASSERT_EQ(contour(file, {"--periodic", "TLONG"}).exit, 0);
    const std::string expected = file_bytes(path("spot.vtkhdf"));
    for (const std::size_t repeated : {1, 2}) {
      write_curved_globe(file, "TLONG", is_turned, repeated);
      for (const char* const axis : {"i", "TLONG", "longitude", "auto"}) {
        const RunResult run = contour(file, {"--periodic", axis});
        EXPECT_EQ(run.exit, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr(repeated == 1 ? "so it is left out" : "so they are left out"));
        EXPECT_EQ(file_bytes(path("spot.vtkhdf")), expected) << axis << " " << is_turned;
      }
    }
  }
}

TEST_F(Longitudes, OfARegionAreErrorsInBothOrdersOfDimensions) {
  const std::string file = path("region.nc");
  for (const bool is_turned : {false, true}) {
    write_curved_globe(file, "TLONG", is_turned, 0, 12);
    for (const char* const axis : {"TLONG", "lon", "i"}) {
      SCOPED_TRACE(std::string(axis) + (is_turned ? " turned" : ""));
      expect_refused(file, {"--periodic", axis}, "(i), a curved axis, span 110, in the mean of all rows");
    }
  }
}

TEST_F(Longitudes, AttributesOnLatticesLeaveOutTheSameSamples) {
  const std::string file = write_globe(1), other = path("other.nc");
  std::filesystem::copy_file(file, other);
  for (const std::size_t repeated : {1, 2}) {
    const std::string image = write_globe(repeated);  // the attribute has one repeated column
    const RunResult run = contour(image, {"--periodic", "lon", "--lattice", "triangular", "--attribute", other});
    ASSERT_EQ(run.exit, 0) << run.err;
    const Mesh mesh = read_mesh(path("spot.vtkhdf"));
    ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
    for (const double value : mesh.vertex_attributes[0].values) EXPECT_NEAR(value, 0.0, 1e-4);
  }
}

TEST_F(Longitudes, AttributesMayRepeatSamplesAndBeginElsewhere) {
  for (const auto& [first, step] : {std::pair{-175.0, 10.0}, std::pair{5.0, 10.0}, std::pair{185.0, -10.0}})
    for (const std::size_t repeated : {0, 1, 2}) {
      SCOPED_TRACE(std::to_string(first) + " " + std::to_string(step) + " " + std::to_string(repeated));
      const std::string other = path("other.nc");
      std::filesystem::copy_file(write_globe(repeated, 0, first, step), other,
                                 std::filesystem::copy_options::overwrite_existing);
      const RunResult run = contour(write_globe(0), {"--periodic", "lon", "--attribute", other});
      ASSERT_EQ(run.exit, 0) << run.err;
      const Mesh mesh = read_mesh(path("spot.vtkhdf"));
      ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
      ASSERT_FALSE(mesh.vertex_attributes[0].values.empty());
      for (const double value : mesh.vertex_attributes[0].values) EXPECT_NEAR(value, 0.0, 1e-4);  // NaN is not near
    }
}

TEST_F(Longitudes, InfoMentionsRepeatedSamples) {
  const auto info = [&](const std::string& file) { return run_tegl({"info", file}).out; };
  const auto json = [&](const std::string& file) { return run_tegl({"info", file, "--json"}).json(); };
  const auto repeated = [](const char* axis, bool are_equal) {
    return nlohmann::json::array(
        {nlohmann::json::object({{"axis", axis}, {"samples", 2}, {"equal_values", are_equal}})});
  };
  std::string file = write_globe(0);
  EXPECT_EQ(info(file).find("repeat"), std::string::npos);
  EXPECT_EQ(json(file)["repeated"], nlohmann::json::array());
  file = write_globe(1);
  EXPECT_THAT(info(file), HasSubstr("the last sample along lon repeats the first one: --periodic lon leaves it out"));
  EXPECT_THAT(info(file), HasSubstr("lon spans 360 degrees: --periodic auto continues"));
  write_curved_globe(file, "TLONG", false, 2);
  EXPECT_THAT(info(file), HasSubstr("the last 2 samples along i repeat the first ones: --periodic i leaves them out"));
  EXPECT_EQ(json(file)["repeated"], repeated("i", true));
  EXPECT_EQ(json(file)["periodic"], nlohmann::json::array({"i"}));
  file = write_globe(2, 0.5F);
  EXPECT_THAT(info(file), HasSubstr("the last 2 samples along lon are at the longitudes of the first, 360 degrees "
                                    "further, with other values"));
  EXPECT_EQ(json(file)["repeated"], repeated("lon", false));
  EXPECT_EQ(json(file)["periodic"], nlohmann::json::array());
}

TEST_F(Longitudes, PeriodsOfThemAreGivenInBothOrdersOfDimensions) {
  const std::string file = path("globe.nc");
  for (const bool is_turned : {false, true}) {
    write_curved_globe(file, "TLONG", is_turned);
    ASSERT_EQ(contour(file, {"--periodic", "TLONG"}).exit, 0);
    const std::string expected = file_bytes(path("spot.vtkhdf"));
    for (const char* const given : {"TLONG=360", "longitude=360", "i=360"}) {
      const RunResult run = contour(file, {"--periodic", given});
      EXPECT_EQ(run.exit, 0) << run.err;
      EXPECT_EQ(file_bytes(path("spot.vtkhdf")), expected) << given << " " << is_turned;
    }
  }
}

TEST_F(Longitudes, SlicesAndMeasuresTakePlacesATurnAway) {
  OwnedImage<float, 3> image;
  image.grid = Grid<3>::unit({9, 9, 36});
  image.grid.axes[2] = Axis::uniform(36, 0.0, 10.0);
  image.grid.axes[2].name = "lon";
  image.grid.axes[2].unit = "degrees_east";
  for (int k = 0; k < 36; ++k)
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 9; ++i)
        image.values.push_back(static_cast<float>(3.3 + 0.01 * std::abs(k - 7) - std::hypot(i - 4, j - 4)));
  const std::string file = path("rod.nc"), saved = path("rod.vtkhdf");
  write_image(image.view(), file);
  ASSERT_EQ(run_tegl({"contour", file, "--iso", "0", "-o", saved}).exit, 0);
  for (const std::vector<std::string>& input :
       {std::vector<std::string>{saved}, {file, "--iso", "0"}, {file, "--iso", "0", "--periodic", "lon"}}) {
    std::vector<std::string> arguments = {"measure"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), {"--at", "lon=75,435,-285", "--json"});
    const RunResult run = run_tegl(arguments);
    ASSERT_EQ(run.exit, 0) << run.err;
    const nlohmann::json cuts = run.json()["cuts"];
    EXPECT_GT(cuts[0]["size"].get<double>(), 20.0);
    for (const std::size_t i : {1U, 2U}) EXPECT_EQ(cuts[i]["size"], cuts[0]["size"]);
    EXPECT_EQ(cuts[1]["value"], 435);
  }
  EXPECT_THAT(run_tegl({"measure", file, "--iso", "0", "--at", "lon=355"}).err, HasSubstr("lies outside of the image"));
}

}  // namespace
}  // namespace tegl::test
