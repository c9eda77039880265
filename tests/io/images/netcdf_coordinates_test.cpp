// SPDX-License-Identifier: BSD-3-Clause
//
// Coordinates in arrays of two dimensions that are no places, or that no convention names.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "images/netcdf_files.hpp"
#include "io_support.hpp"

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
    const auto& longitudes = read.info.curved[0].values;
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
  EXPECT_EQ(read.info.curved[1].values, plane.second);
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
    EXPECT_EQ(read.info.curved[0].values, plane.first);
    EXPECT_EQ(read.info.curved[0].unit, "m");
    EXPECT_EQ(read.info.curved[1].axis, 1);
    EXPECT_EQ(read.info.curved[1].values, plane.second);
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

}  // namespace
}  // namespace tegl::test
