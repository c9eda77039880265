// SPDX-License-Identifier: BSD-3-Clause
//
// Coordinates in arrays of two dimensions that are no places, or that no convention names.
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "images/netcdf_files.hpp"
#include "io_support.hpp"
#include "tegl/curved.hpp"

namespace tegl::test {
namespace {

using Attributes = std::vector<std::pair<std::string, std::string>>;

/// Two coordinates in arrays of 3 x 4, and values along the same dimensions.
struct Plane {
  std::vector<double> first, second;
  Attributes of_first, of_second;
  bool has_axes = false;  ///< whether the dimensions have coordinate variables

  void write(const fs::path& path) const {
    NcWriter file(path);
    const int y = file.dimension("row", 3), x = file.dimension("column", 4);
    const int a = file.variable("a", NC_DOUBLE, {y, x}), b = file.variable("b", NC_DOUBLE, {y, x});
    const int v = file.variable("v", NC_FLOAT, {y, x});
    const int rows = has_axes ? file.variable("row", NC_DOUBLE, {y}) : -1;
    const int columns = has_axes ? file.variable("column", NC_DOUBLE, {x}) : -1;
    for (const auto& [name, text] : of_first) file.text(a, name, text);
    for (const auto& [name, text] : of_second) file.text(b, name, text);
    file.text(v, "coordinates", "a b");
    file.end();
    file.values(a, first);
    file.values(b, second);
    file.values(v, counting<double>(12, 0));
    if (has_axes) file.values(rows, {0, 1, 2});
    if (has_axes) file.values(columns, {0, 1, 2, 3});
  }
};

/// The coordinates of a curved axis, however they are stored.
std::vector<double> coordinates_of(const CurvedAxis& axis) {
  std::vector<double> coordinates(axis.size());
  for (std::size_t i = 0; i < axis.size(); ++i) coordinates[i] = axis[i];
  return coordinates;
}

/// A plane with x and y in hundreds of metres, turned a little.
Plane projected() {
  Plane plane;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i) {
      plane.first.push_back(100.0 * i + 10 * j);
      plane.second.push_back(100.0 * j - 10 * i);
    }
  return plane;
}

TEST(NetCdfCoordinates, ThatAreTooLargeAreUnknownPlaces) {
  const TempDir dir;
  for (const double wrong : {1e20, -9999.0}) {
    Plane plane;
    for (int k = 0; k < 12; ++k) {
      plane.first.push_back(178 + k % 4);
      plane.second.push_back(10 + k / 4);
    }
    plane.of_first = {{"units", "degrees_east"}};
    plane.of_second = {{"units", "degrees_north"}};
    plane.first[6] = plane.second[11] = plane.second[3] = wrong;
    plane.write(dir / "a.nc");
    const ReadImageResult read = read_image(dir / "a.nc");
    ASSERT_EQ(read.info.curved.size(), 2U);
    const std::vector<double> longitudes = coordinates_of(read.info.curved[0]);
    for (std::size_t k = 0; k < 12; ++k) {
      if (k == 6)
        EXPECT_TRUE(std::isnan(longitudes[k]));
      else
        EXPECT_EQ(longitudes[k], 178.0 + static_cast<double>(k % 4)) << k;
    }
    const auto& image = std::get<OwnedImage<float, 2>>(std::get<AnyImageN<2>>(read.image));
    for (const std::size_t k : {3U, 6U, 11U}) EXPECT_TRUE(std::isnan(image.values[k])) << k;
    EXPECT_EQ(image.values[5], 5);
    const std::string number = wrong > 0 ? "1e+20" : "-9999";
    EXPECT_THAT(read.info.remarks,
                testing::ElementsAre(
                    "the coordinate 'a' is " + number + " at (2, 1); expected -720 to 720: such places are unknown",
                    "the coordinate 'b' is " + number +
                        " at (3, 0), and too large at 1 more; expected -90 to 90: such places are "
                        "unknown"));
  }
}

TEST(NetCdfCoordinates, OfThePolesMayBeRounded) {
  const TempDir dir;
  const double rounded = 90.00000763;  // as a float
  Plane plane;
  for (int k = 0; k < 12; ++k) {
    plane.first.push_back(k % 4);
    plane.second.push_back(k < 4 ? -rounded : k < 8 ? 0 : rounded);
  }
  plane.of_first = {{"units", "degrees_east"}};
  plane.of_second = {{"units", "degrees_north"}};
  plane.write(dir / "a.nc");
  const ReadImageResult read = read_image(dir / "a.nc");
  ASSERT_EQ(read.info.curved.size(), 2U);
  EXPECT_EQ(coordinates_of(read.info.curved[1]), plane.second);
  EXPECT_THAT(read.info.remarks, testing::IsEmpty());
  {
    NcWriter file(dir / "b.nc");
    const int y = file.dimension("lat", 3), x = file.dimension("lon", 2);
    const int v = file.variable("v", NC_FLOAT, {y, x}), lat = file.variable("lat", NC_DOUBLE, {y});
    file.text(lat, "units", "degrees_north");
    file.end();
    file.values(v, counting<double>(6, 0));
    file.values(lat, {-rounded, 0, rounded});
  }
  const ReadImageResult straight = read_image(dir / "b.nc");
  const auto& image = std::get<OwnedImage<float, 2>>(std::get<AnyImageN<2>>(straight.image));
  EXPECT_EQ(image.grid.axes[1][2], rounded);
}

TEST(NetCdfCoordinates, OfAxesThatAreTooLargeAreErrors) {
  const TempDir dir;
  {
    NcWriter file(dir / "a.nc");
    const int y = file.dimension("lat", 2), x = file.dimension("lon", 3);
    const int v = file.variable("v", NC_FLOAT, {y, x}), lon = file.variable("lon", NC_DOUBLE, {x});
    file.text(lon, "units", "degrees_east");
    file.end();
    file.values(v, counting<double>(6, 0));
    file.values(lon, {10, 20, 1e20});
  }
  expect_error(ErrorCode::MalformedFile, {"a.nc", "'lon'", "number 2 is 1e+20", "-720 to 720"},
               [&] { (void)read_image(dir / "a.nc"); });
}

TEST(NetCdfCoordinates, LongitudesOfAnAxisAreContinuedAcrossTheirJump) {
  const TempDir dir;
  const auto write = [&](const std::vector<double>& longitudes, const std::string& unit) {
    NcWriter file(dir / "a.nc");
    const int y = file.dimension("y", 2), x = file.dimension("lon", static_cast<std::size_t>(longitudes.size()));
    const int lon = file.variable("lon", NC_DOUBLE, {x}), v = file.variable("v", NC_FLOAT, {y, x});
    file.text(lon, "units", unit);
    file.end();
    file.values(lon, longitudes);
    file.values(v, counting<double>(2 * longitudes.size(), 0));
  };
  const auto axis = [&] {
    const ReadImageResult image = read_image(dir / "a.nc");
    const Axis& read = std::get<OwnedImage<float, 2>>(std::get<AnyImageN<2>>(image.image)).grid.axes[0];
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < read.size(); ++i) coordinates.push_back(read[i]);
    return coordinates;
  };
  write({0, 90, 179, -170, -90}, "degrees_east");
  EXPECT_THAT(axis(), testing::ElementsAre(0, 90, 179, 190, 270));
  write({-90, -170, 179, 90}, "degree_E");
  EXPECT_THAT(axis(), testing::ElementsAre(-90, -170, -181, -270));
  write({350, 0, 10}, "degrees_east");
  EXPECT_THAT(axis(), testing::ElementsAre(350, 360, 370));
  write({0, 200, 300}, "degrees_east");  // ascend: remain, though the first step is more than half a turn
  EXPECT_THAT(axis(), testing::ElementsAre(0, 200, 300));
  write({0, 90, 179, -170, -90}, "m");
  expect_error(ErrorCode::InvalidGrid, {"a.nc", "'lon'", "179 and -170", "ascending"},
               [&] { (void)read_image(dir / "a.nc"); });
  write({340, 350, 0, 10, 5}, "degrees_east");  // also with its turns it descends at its end
  expect_error(ErrorCode::InvalidGrid, {"a.nc", "'lon'", "350 and 0"}, [&] { (void)read_image(dir / "a.nc"); });
}

TEST(NetCdfCoordinates, OfAProjectedPlaneAreCurvedAxesIfAttributesSaySo) {
  const TempDir dir;
  Plane plane = projected();
  for (const auto& [x, y] :
       {std::pair(Attributes{{"standard_name", "projection_x_coordinate"}, {"units", "m"}},
                  Attributes{{"standard_name", "projection_y_coordinate"}, {"units", "m"}}),
        std::pair(Attributes{{"axis", "X"}, {"units", "m"}}, Attributes{{"axis", "Y"}, {"units", "m"}})}) {
    plane.of_first = x;
    plane.of_second = y;
    plane.write(dir / "a.nc");
    const ReadImageResult read = read_image(dir / "a.nc");
    ASSERT_EQ(read.info.curved.size(), 2U);
    EXPECT_EQ(coordinates_of(read.info.curved[0]), plane.first);
    EXPECT_EQ(read.info.curved[0].unit, "m");
    EXPECT_EQ(read.info.curved[1].axis, 1);
    EXPECT_EQ(coordinates_of(read.info.curved[1]), plane.second);
    EXPECT_THAT(read.info.remarks, testing::IsEmpty());
  }
}

TEST(NetCdfCoordinates, OfUnknownMeaningAreARemark) {
  const TempDir dir;
  Plane plane = projected();
  plane.of_first = plane.of_second = {{"units", "m"}};
  plane.write(dir / "a.nc");
  const ReadImageResult read = read_image(dir / "a.nc");
  EXPECT_THAT(read.info.curved, testing::IsEmpty());
  EXPECT_THAT(read.info.remarks,
              testing::ElementsAre(testing::AllOf(testing::HasSubstr("the coordinates 'a', 'b' are not used"),
                                                  testing::HasSubstr("projection_x_coordinate"))));
  // axes with coordinates of their own need no others
  plane.has_axes = true;
  plane.write(dir / "b.nc");
  EXPECT_THAT(read_image(dir / "b.nc").info.remarks, testing::IsEmpty());
}

// ---- longitudes across 180 degrees ----------------------------------------------------------------------------------

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Longitudes of 36 x 6 samples from 100 eastwards, in -180 to 180, that are unknown on land.
struct Globe {
  static constexpr std::size_t kColumns = 36, kRows = 6;
  using Land = std::function<bool(std::size_t row, std::size_t column)>;

  explicit Globe(const Land& is_land) {
    for (std::size_t s = 0; s < kColumns * kRows; ++s) {
      const bool is_unknown = is_land(s / kColumns, s % kColumns);
      const double x = 100.0 + 10.0 * static_cast<double>(s % kColumns);
      continued.push_back(is_unknown ? kUnknown : x);
      stored.push_back(is_unknown ? kUnknown : x >= 180 ? x - 360 : x);
    }
  }

  std::vector<double> stored, continued;
};

/// Expects the longitudes to differ from the right ones by the same multiple of 360 everywhere: 0 at the first one.
void expect_continued(const std::vector<double>& longitudes, const Globe& globe, std::string_view where) {
  ASSERT_EQ(longitudes.size(), globe.continued.size());
  double turn = kUnknown;
  for (std::size_t s = 0; s < longitudes.size(); ++s) {
    ASSERT_EQ(std::isnan(longitudes[s]), std::isnan(globe.stored[s])) << where << ", sample " << s;
    if (std::isnan(longitudes[s])) continue;
    if (std::isnan(turn)) turn = globe.stored[s] - globe.continued[s];
    ASSERT_EQ(longitudes[s], globe.continued[s] + turn) << where << ", sample " << s;
  }
}

const std::vector<std::pair<std::string, Globe::Land>>& lands() {
  static const std::vector<std::pair<std::string, Globe::Land>> all = {
      {"none", [](auto, auto) { return false; }},
      {"the first sample", [](auto row, auto column) { return row == 0 && column == 0; }},
      {"the start of a row", [](auto row, auto column) { return row == 1 && column == 0; }},
      {"the first column", [](auto, auto column) { return column == 0; }},
      {"most of a row", [](auto row, auto column) { return row == 2 && column >= 3 && column < 28; }},
      {"most of two rows", [](auto row, auto column) { return row / 2 == 1 && column >= 3 && column < 28; }},
      {"the end of a row", [](auto row, auto column) { return row == 3 && column >= 30; }},
      {"a row", [](auto row, auto) { return row == 2; }},
      {"the first row", [](auto row, auto) { return row == 0; }},
      {"a corner", [](auto row, auto column) { return row < 2 && column < 12 - 2 * row; }},
      {"a band of columns", [](auto, auto column) { return column >= 20 && column < 25; }},
      {"all but a lake and the last columns",
       [](auto row, auto column) { return column < 20 && !(row >= 3 && column >= 8 && column < 10); }},
      {"stairs", [](auto row, auto column) { return column > 5 * row && column < 36 - 5 * row && row % 2 == 0; }},
      {"every second sample", [](auto row, auto column) { return (row + column) % 2 == 0; }}};
  return all;
}

TEST(NetCdfCoordinates, LongitudesAreContinuedAroundLand) {
  for (const auto& [where, is_land] : lands()) {
    const Globe globe(is_land);
    std::vector<double> longitudes = globe.stored;
    continue_longitudes(longitudes, std::array<std::size_t, 2>{Globe::kColumns, Globe::kRows});
    expect_continued(longitudes, globe, where);
    const std::vector<double> once = longitudes;
    continue_longitudes(longitudes, std::array<std::size_t, 4>{1, Globe::kColumns, 1, Globe::kRows});
    for (std::size_t s = 0; s < once.size(); ++s)
      ASSERT_TRUE(longitudes[s] == once[s] || std::isnan(once[s])) << where << ": a second call changes nothing";
    // two rows of each of three layers
    longitudes = globe.stored;
    continue_longitudes(longitudes, std::array<std::size_t, 3>{Globe::kColumns, 2, 3});
    expect_continued(longitudes, globe, where);
  }
}

TEST(NetCdfCoordinates, LongitudesThatAreNoPlacesRemain) {
  std::vector<double> longitudes = {1e20, 170, -180, -9999, std::numeric_limits<double>::infinity(), 175, -175, -170};
  continue_longitudes(longitudes, std::array<std::size_t, 2>{4, 2});
  EXPECT_EQ(longitudes,
            (std::vector<double>{1e20, 170, 180, -9999, std::numeric_limits<double>::infinity(), 175, 185, 190}));
  std::vector<double> opposite = {0, 180, 90, 270};  // as across a pole: both ways are equally long
  continue_longitudes(opposite, std::array<std::size_t, 2>{2, 2});
  EXPECT_EQ(opposite, (std::vector<double>{0, 180, 90, 270}));
  std::vector<double> unknown(8, kUnknown), none;
  continue_longitudes(unknown, std::array<std::size_t, 2>{4, 2});
  for (const double x : unknown) EXPECT_TRUE(std::isnan(x));
  continue_longitudes(none, std::array<std::size_t, 2>{0, 2});
  expect_error(ErrorCode::InvalidArgument, {"8 longitudes", "expected 6", "3 x 2"}, [&] {
    continue_longitudes(longitudes, std::array<std::size_t, 2>{3, 2});
  });
}

TEST(NetCdfCoordinates, LongitudesOfFilesAreContinuedAroundLand) {
  const TempDir dir;
  for (const auto& [where, is_land] : lands()) {
    const Globe globe(is_land);
    {
      NcWriter file(dir / "a.nc");
      const int y = file.dimension("row", Globe::kRows), x = file.dimension("column", Globe::kColumns);
      const int lon = file.variable("lon", NC_DOUBLE, {y, x}), lat = file.variable("lat", NC_DOUBLE, {y, x});
      const int v = file.variable("v", NC_FLOAT, {y, x});
      file.text(lon, "units", "degrees_east");
      file.text(lat, "units", "degrees_north");
      file.text(v, "coordinates", "lon lat");
      file.end();
      std::vector<double> latitudes;
      for (std::size_t s = 0; s < globe.stored.size(); ++s)
        latitudes.push_back(std::isnan(globe.stored[s]) ? kUnknown : 10.0 * static_cast<double>(s / Globe::kColumns));
      file.values(lon, globe.stored);
      file.values(lat, latitudes);
      file.values(v, counting<double>(globe.stored.size(), 0));
    }
    const ReadImageResult read = read_image(dir / "a.nc");
    ASSERT_EQ(read.info.curved.size(), 2U);
    expect_continued(coordinates_of(read.info.curved[0]), globe, where);
  }
}

TEST(NetCdfCoordinates, ThatDifferFromFileToFileAreAlongTheTime) {
  const TempDir dir;
  std::vector<fs::path> files;
  std::vector<double> expected;
  const auto write = [&](double moved, const std::string& unit) {
    Plane plane;
    for (int k = 0; k < 12; ++k) {
      const double longitude = moved + k % 4;
      if (unit == "degrees_east") expected.push_back(longitude);
      plane.first.push_back(longitude > 180 ? longitude - 360 : longitude);
      plane.second.push_back(10 + k / 4);
    }
    plane.of_first = {{"units", unit}};
    plane.of_second = {{"units", "degrees_north"}};
    files.push_back(dir / (std::to_string(files.size()) + ".nc"));
    plane.write(files.back());
  };
  for (const double moved : {170.0, 178.5, 188.0}) write(moved, "degrees_east");  // the last one is stored from -172 on
  const ReadSeriesResult read = read_series(files, {});
  ASSERT_TRUE(std::holds_alternative<AnyImageN<3>>(read.image));
  const std::vector<CurvedAxis>& curved = read.info.curved;
  ASSERT_EQ(curved.size(), 2U);
  EXPECT_EQ(curved[0].along, 7U);
  EXPECT_EQ(coordinates_of(curved[0]), expected);
  EXPECT_EQ(curved[1].along, 3U);
  EXPECT_EQ(curved[1].size(), 12U);
  write(170, "km");
  expect_error(ErrorCode::UnsupportedData,
               {"3.nc", "has other curved coordinates than", "expected coordinates of the same names, units and axes"},
               [&] { (void)read_series(files, {}); });
}

}  // namespace
}  // namespace tegl::test
