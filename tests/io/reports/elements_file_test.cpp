// SPDX-License-Identifier: BSD-3-Clause
//
// Files of elements: text and HDF5 hold the same numbers in the requested order and with the requested signs, and a
// failed write leaves no file.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "errors.hpp"
#include "tegl/io.hpp"
#include "tegl/io/elements.hpp"

namespace tegl::test {
namespace {

namespace fs = std::filesystem;

class ElementsFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("tegl_elements_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] bool is_empty() const { return fs::is_empty(folder_); }

 private:
  fs::path folder_;
};

Elements<4> two_elements() {
  Elements<4> elements;
  elements.centroids = {{1.25, 2, 3, 0.1}, {4, 5, 6, 7}};
  elements.normals = {{0.5, -1, 0, 1.0 / 3.0}, {1e-300, 1e300, 2, -3}};
  elements.measures = {1.5, 1e300};
  elements.counts = {1, 7};
  elements.axis_names = {"x", "y", "", "tau time"};
  elements.axis_units = {"fm", "fm", "fm", "s"};
  elements.attributes.push_back({"T", "GeV", 1, {0.15, std::numeric_limits<double>::quiet_NaN()}});
  elements.attributes.push_back({"u/v", "", 2, {1, 2, 3, 4}});
  return elements;
}

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST_F(ElementsFile, OfTextHasTheTimeFirstThenTheNormalThenAttributes) {
  write_elements(two_elements(), path("e.dat"));
  const std::vector<std::string> expected = {
      "0.1 1.25 2 3 0.3333333333333333 0.5 -1 0 0.15 1 2",
      "7 4 5 6 -3 1e-300 1e+300 2 nan 3 4",
  };
  EXPECT_EQ(lines_of(path("e.dat")), expected);
}

TEST_F(ElementsFile, OfTextHasItsAxesAsTheyAreAndNamesThemWhereAsked) {
  ElementFileOptions options;
  options.axes = ElementAxes::as_is;
  options.header = true;
  write_elements(two_elements(), path("e.TXT"), options);
  const auto lines = lines_of(path("e.TXT"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "# x y z tau_time dsigma_x dsigma_y dsigma_z dsigma_tau_time T u/v_0 u/v_1");
  EXPECT_EQ(lines[1], "1.25 2 3 0.1 0.5 -1 0 0.3333333333333333 0.15 1 2");
}

TEST_F(ElementsFile, ContravariantComponentsTurnAllSignsButThatOfTheTime) {
  ElementFileOptions options;
  options.components = ElementComponents::contravariant;
  write_elements(two_elements(), path("e.dat"), options);
  EXPECT_EQ(lines_of(path("e.dat"))[0], "0.1 1.25 2 3 0.3333333333333333 -0.5 1 0 0.15 1 2");
}

/// A dataset of numbers, as rows of columns.
std::vector<double> read_table(const std::string& path, const std::string& name, std::size_t rows,
                               std::size_t columns) {
  OpenLayersResult opened = open_layers(path, {.variable = name});
  auto& layers = *std::get<std::unique_ptr<LayerReader<double, 2>>>(std::get<AnyLayersN<2>>(opened.layers));
  EXPECT_EQ(layers.grid().axes[0].size(), columns);
  EXPECT_EQ(layers.grid().axes[1].size(), rows);
  std::vector<double> values(rows * columns);
  for (std::size_t k = 0; k < rows; ++k) layers.read(k, values.data() + k * columns);
  return values;
}

TEST_F(ElementsFile, OfHdf5HasTheSameNumbers) {
  for (const bool time_first : {true, false}) {
    ElementFileOptions options;
    options.axes = time_first ? ElementAxes::time_first : ElementAxes::as_is;
    write_elements(two_elements(), path("e.h5"), options);
    const std::vector<double> centroids = read_table(path("e.h5"), "centroid", 2, 4);
    const std::vector<double> normals = read_table(path("e.h5"), "dsigma", 2, 4);
    const std::vector<double> velocity = read_table(path("e.h5"), "attributes/u_v", 2, 2);
    EXPECT_EQ(centroids, time_first ? (std::vector<double>{0.1, 1.25, 2, 3, 7, 4, 5, 6})
                                    : (std::vector<double>{1.25, 2, 3, 0.1, 4, 5, 6, 7}));
    EXPECT_EQ(normals, time_first ? (std::vector<double>{1.0 / 3.0, 0.5, -1, 0, -3, 1e-300, 1e300, 2})
                                  : (std::vector<double>{0.5, -1, 0, 1.0 / 3.0, 1e-300, 1e300, 2, -3}));
    EXPECT_EQ(velocity, (std::vector<double>{1, 2, 3, 4}));
  }
}

TEST_F(ElementsFile, OfHdf5IsTheSameEveryTimeAndSaysUnits) {
  const auto bytes = [&](const std::string& name) {
    write_elements(two_elements(), path(name));
    std::ifstream file(path(name), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  };
  const std::string first = bytes("a.h5");
  EXPECT_EQ(first, bytes("b.h5"));
  for (const char* text : {"tegl elements 1", "tau_time\nx\ny\nz", "covariant", "descent", "s\nfm\nfm\nfm", "GeV",
                           "fm fm fm\nfm fm s\nfm fm s\nfm fm s"})
    EXPECT_NE(first.find(text), std::string::npos) << text;
}

TEST_F(ElementsFile, OfManyElementsIsWrittenWhole) {
  Elements<3> elements;
  constexpr std::size_t kMany = 150000;  // more than one block
  for (std::size_t e = 0; e < kMany; ++e) {
    const auto x = static_cast<double>(e);
    elements.centroids.push_back({x, x + 0.5, -x});
    elements.normals.push_back({1, x, 2});
    elements.measures.push_back(x);
    elements.counts.push_back(1);
  }
  write_elements(elements, path("e.dat"));
  write_elements(elements, path("e.h5"));
  const auto lines = lines_of(path("e.dat"));
  ASSERT_EQ(lines.size(), kMany);
  EXPECT_EQ(lines[100000], "-100000 100000 100000.5 2 1 100000");
  const std::vector<double> normals = read_table(path("e.h5"), "dsigma", kMany, 3);
  for (std::size_t e = 0; e < kMany; ++e) ASSERT_EQ(normals[3 * e + 2], static_cast<double>(e));
}

TEST_F(ElementsFile, OfNoElementsIsValid) {
  write_elements(Elements<3>(), path("e.dat"));
  write_elements(Elements<3>(), path("e.h5"));
  EXPECT_TRUE(lines_of(path("e.dat")).empty());
  EXPECT_GT(fs::file_size(path("e.h5")), 0u);
}

TEST_F(ElementsFile, LeavesNothingOfWhatCannotBeWritten) {
  expect_error(ErrorCode::UnsupportedFormat, "expected .dat", [&] { write_elements(two_elements(), path("e.csv")); });
  ElementFileOptions stop;
  stop.work.progress = [](double fraction) { return fraction < 0.5; };
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { write_elements(two_elements(), path("e.dat"), stop); });
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { write_elements(two_elements(), path("e.h5"), stop); });
  expect_error(ErrorCode::WriteFailed, "no/such/folder",
               [&] { write_elements(two_elements(), path("no/such/folder/e.dat")); });
  expect_error(ErrorCode::WriteFailed, "no/such/folder",
               [&] { write_elements(two_elements(), path("no/such/folder/e.h5")); });
  EXPECT_TRUE(is_empty());
}

}  // namespace
}  // namespace tegl::test
