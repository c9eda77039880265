// SPDX-License-Identifier: BSD-3-Clause
//
// netCDF: axes from coordinate variables, packing and missing values, the choice of a variable, and damaged files.
#include "images/netcdf_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "images/layers_support.hpp"
#include "io_support.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::NanSensitiveFloatEq;

const float kNaN = std::numeric_limits<float>::quiet_NaN();

/// t(2) z(3) y(2) x(4), with coordinates; values count from 0.
void write_standard(const fs::path& path, int format) {
  NcWriter file(path, format);
  const int t = file.dimension("time", NC_UNLIMITED);
  const int z = file.dimension("depth", 3);
  const int y = file.dimension("lat", 2);
  const int x = file.dimension("lon", 4);
  const int tv = file.variable("time", NC_DOUBLE, {t});
  const int zv = file.variable("depth", NC_FLOAT, {z});
  const int yv = file.variable("lat", NC_FLOAT, {y});
  const int v = file.variable("temp", NC_FLOAT, {t, z, y, x});
  file.text(tv, "units", "days since 2000-01-01");
  file.text(zv, "units", "m");
  file.text(v, "units", "degC");
  file.text(v, "long_name", "sea water temperature");
  file.end();
  file.values(tv, {2}, {10, 40});
  file.values(zv, {0, 10, 50});
  file.values(yv, {60, 45});
  std::vector<double> values(48);
  for (std::size_t i = 0; i < 48; ++i) values[i] = static_cast<double>(i);
  file.values(v, {2, 3, 2, 4}, values);
}

void expect_standard(const fs::path& path) {
  const auto [any, info] = read_image(path);
  const auto image = image_as<float, 4>(any);
  EXPECT_EQ(image.grid.sizes(), (std::array<std::size_t, 4>{4, 2, 3, 2}));
  EXPECT_EQ(image.values, counting<float>(48));
  EXPECT_EQ(image.grid.axes[0].name, "lon");
  EXPECT_EQ(image.grid.axes[3].name, "time");
  EXPECT_EQ(image.grid.axes[3].unit, "days since 2000-01-01");
  EXPECT_EQ(world(image.grid, {3, 1, 2, 1}), Eigen::Vector4d(3, 45, 50, 40));
  EXPECT_TRUE(image.grid.axes[1].is_uniform());
  EXPECT_TRUE(image.grid.axes[1].is_descending());
  EXPECT_FALSE(image.grid.axes[2].is_uniform());
  EXPECT_FALSE(image.grid.has_world_map());
  EXPECT_EQ(info.format, "netCDF");
  EXPECT_EQ(info.variable, "temp");
  EXPECT_THAT(info.variables, ElementsAre("temp"));
  EXPECT_EQ(info.value_unit, "degC");
  EXPECT_EQ(info.value_name, "sea water temperature");
  EXPECT_EQ(info.stored_type, ValueType::float32);
}

TEST(NetCdf, AllFormatsAndWholeFileCompressionReadTheSame) {
  TempDir dir;
  for (const int format : {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4, NC_NETCDF4 | NC_CLASSIC_MODEL}) {
    SCOPED_TRACE(format);
    write_standard(dir / "a.nc", format);
    expect_standard(dir / "a.nc");
    write_file(dir / "a.nc.gz", compressed(read_file(dir / "a.nc")));
    expect_standard(dir / "a.nc.gz");
    fs::copy_file(dir / "a.nc.gz", dir / "zipped without saying so.cdf", fs::copy_options::overwrite_existing);
    expect_standard(dir / "zipped without saying so.cdf");
  }
}

template <class T, class Read>
void expect_type(nc_type type, const char* name, double start, int format = NC_NETCDF4) {
  SCOPED_TRACE(name);
  TempDir dir;
  {
    NcWriter file(dir / "a.nc", format);
    const int y = file.dimension("y", 2);
    const int x = file.dimension("x", 3);
    const int v = file.variable("v", type, {y, x});
    file.end();
    file.values(v, {start, start + 1, start + 2, start + 3, start + 4, start + 5});
  }
  const auto [any, info] = read_image(dir / "a.nc");
  EXPECT_EQ((image_as<Read, 2>(any).values), counting<Read>(6, start));
  EXPECT_EQ(info.stored_type, parse_value_type(name));
}

TEST(NetCdf, IntegersWithoutFillStayIntegers) {
  expect_type<std::int8_t, std::int8_t>(NC_BYTE, "int8", -3, 0);
  expect_type<std::int16_t, std::int16_t>(NC_SHORT, "int16", -3, 0);
  expect_type<std::int32_t, std::int32_t>(NC_INT, "int32", -3, 0);
  expect_type<float, float>(NC_FLOAT, "float", -3, 0);
  expect_type<double, double>(NC_DOUBLE, "double", -3, 0);
  expect_type<std::uint8_t, std::uint8_t>(NC_UBYTE, "uint8", 250);
  expect_type<std::uint16_t, std::uint16_t>(NC_USHORT, "uint16", 65530);
  expect_type<std::uint32_t, double>(NC_UINT, "uint32", 4e9);
  expect_type<std::int64_t, double>(NC_INT64, "int64", -4e9);
  expect_type<std::uint64_t, std::int32_t>(NC_UINT64, "uint64", 7);
}

/// A 2 x 3 variable of one type with attributes set by `attributes(file, variable)`.
template <class Attributes>
ReadImageResult read_six(nc_type type, const std::vector<double>& values, Attributes&& attributes,
                         const ReadImageOptions& options = {}) {
  TempDir dir;
  {
    NcWriter file(dir / "a.nc", NC_NETCDF4);
    const int y = file.dimension("y", 2);
    const int x = file.dimension("x", 3);
    const int v = file.variable("v", type, {y, x});
    attributes(file, v);
    file.end();
    file.values(v, values);
  }
  return read_image(dir / "a.nc", options);
}

TEST(NetCdf, PackedShortsBecomeFloatsWithNanForMissing) {
  const auto result = read_six(NC_SHORT, {0, 1, -32768, 100, -999, 3}, [](NcWriter& file, int v) {
    file.number(v, "scale_factor", NC_DOUBLE, {0.5});
    file.number(v, "add_offset", NC_DOUBLE, {10});
    file.number(v, "_FillValue", NC_SHORT, {-32768});
    file.number(v, "missing_value", NC_SHORT, {-999});
  });
  EXPECT_THAT((image_as<float, 2>(result.image).values),
              ElementsAre(10, 10.5F, NanSensitiveFloatEq(kNaN), 60, NanSensitiveFloatEq(kNaN), 11.5F));
  EXPECT_EQ(result.info.stored_type, ValueType::int16);
}

TEST(NetCdf, ScaledIntegersOf32BitsBecomeDoubles) {
  const auto result = read_six(NC_INT, {0, 1, 2, 3, 4, 2147483647},
                               [](NcWriter& file, int v) { file.number(v, "scale_factor", NC_DOUBLE, {0.001}); });
  const auto values = image_as<double, 2>(result.image).values;
  EXPECT_EQ(values[5], 2147483647 * 0.001);
}

TEST(NetCdf, PackedIntegersAreKeptOnRequestIfNoneIsMissing) {
  const auto read = [](double scale, const std::vector<double>& stored, bool keep) {
    const auto attributes = [&](NcWriter& file, int v) {
      file.number(v, "scale_factor", NC_DOUBLE, {scale});
      file.number(v, "add_offset", NC_DOUBLE, {10.1});
      file.number(v, "_FillValue", NC_SHORT, {-32768});
      file.number(v, "valid_max", NC_SHORT, {1000});
    };
    ReadImageOptions options;
    options.keep_stored = keep;
    return read_six(NC_SHORT, stored, attributes, options);
  };
  const std::vector<double> stored = {0, 1, -32767, 100, -999, 1000};
  for (const double scale : {0.3, -0.3}) {
    const auto values = image_as<float, 2>(read(scale, stored, false).image).values;
    const auto [any, info] = read(scale, stored, true);
    const auto kept = image_as<std::int16_t, 2>(any).values;
    ASSERT_TRUE(info.scaling.has_value());
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(info.scaling->value_of(kept[i]), values[i]) << i;
  }
  for (const double missing : {-32768.0, 1001.0}) {
    std::vector<double> with = stored;
    with[3] = missing;
    const auto [any, info] = read(0.3, with, true);
    EXPECT_FALSE(info.scaling.has_value());
    EXPECT_TRUE(std::isnan(image_as<float, 2>(any).values[3]));
  }
}

TEST(NetCdf, FillValueIsComparedInTheVariablesOwnType) {
  // -1e34 is no float; the attribute is stored as double.
  const auto result = read_six(NC_FLOAT, {0, -1e34, 2, 3, 4, 5},
                               [](NcWriter& file, int v) { file.number(v, "missing_value", NC_DOUBLE, {-1e34}); });
  EXPECT_TRUE(std::isnan(image_as<float, 2>(result.image).values[1]));
}

TEST(NetCdf, ValidRangeAndDefaultFillAreMissing) {
  const auto ranged = read_six(NC_BYTE, {0, 1, 2, 3, 4, 5}, [](NcWriter& file, int v) {
    file.number(v, "valid_range", NC_BYTE, {1, 4});
  });
  EXPECT_THAT((image_as<float, 2>(ranged.image).values),
              ElementsAre(NanSensitiveFloatEq(kNaN), 1, 2, 3, 4, NanSensitiveFloatEq(kNaN)));
  const auto single = read_six(NC_DOUBLE, {0, 1, 2, 3, 4, 5}, [](NcWriter& file, int v) {
    file.number(v, "valid_min", NC_DOUBLE, {0.5});
    file.number(v, "valid_max", NC_DOUBLE, {4});
  });
  const auto doubles = image_as<double, 2>(single.image).values;
  EXPECT_TRUE(std::isnan(doubles[0]) && std::isnan(doubles[5]) && doubles[1] == 1 && doubles[4] == 4);
  const auto unwritten = read_six(NC_FLOAT, {0, 1, 2, 3, 4, NC_FILL_FLOAT}, [](NcWriter&, int) {});
  EXPECT_TRUE(std::isnan(image_as<float, 2>(unwritten.image).values[5]));
}

/// A packed variable of 24 x 90 x 200 samples, with coordinates at two times; value i of a time is 0.5 * stored + 10,
/// or missing if stored is -1 or above 30000.
void write_packed(const fs::path& path, int format, const std::vector<double>& stored) {
  NcWriter file(path, format);
  const int t = file.dimension("t", 2);
  const int z = file.dimension("z", 24);
  const int y = file.dimension("y", 90);
  const int x = file.dimension("x", 200);
  const int v = file.variable("v", NC_SHORT, {t, z, y, x});
  if ((format & NC_NETCDF4) != 0) {
    const std::array<std::size_t, 4> chunks = {1, 7, 90, 200};
    NcWriter::ok(nc_def_var_chunking(file.id(), v, NC_CHUNKED, chunks.data()));
  }
  file.number(v, "scale_factor", NC_DOUBLE, {0.5});
  file.number(v, "add_offset", NC_DOUBLE, {10});
  file.number(v, "_FillValue", NC_SHORT, {-1});
  file.number(v, "valid_max", NC_SHORT, {30000});
  file.end();
  file.values(v, stored);
}

TEST(NetCdf, PackedValuesOfManyBlocksComeBackInOrder) {
  TempDir dir;
  constexpr std::size_t kCount = 24 * 90 * 200;
  std::vector<double> stored(2 * kCount);
  for (std::size_t i = 0; i < stored.size(); ++i) stored[i] = static_cast<double>(i * 7919 % 65536) - 32768;
  const auto expect_values = [&](const Values<float>& values, std::size_t first) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = stored[first + i];
      const bool missing = value == -1 || value > 30000;
      ASSERT_TRUE(missing ? std::isnan(values[i]) : values[i] == static_cast<float>(0.5 * value + 10)) << i;
    }
  };
  for (const int format : {0, NC_NETCDF4}) {
    SCOPED_TRACE(format);
    write_packed(dir / "a.nc", format, stored);
    std::vector<double> fractions;
    ReadImageOptions options;
    options.work.progress = [&](double fraction) {
      fractions.push_back(fraction);
      return true;
    };
    const auto whole = image_as<float, 4>(read_image(dir / "a.nc", options).image);
    ASSERT_EQ(whole.values.size(), 2 * kCount);
    expect_values(whole.values, 0);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GT(fractions.size(), 3U);
    options.fixed = {{"t", 1}};
    const auto second = image_as<float, 3>(read_image(dir / "a.nc", options).image);
    ASSERT_EQ(second.values.size(), kCount);
    expect_values(second.values, kCount);
  }
}

TEST(NetCdf, SignedBytesThatMeanUnsigned) {
  const auto result =
      read_six(NC_BYTE, {0, 1, 127, -128, -2, -1}, [](NcWriter& file, int v) { file.text(v, "_Unsigned", "true"); });
  EXPECT_THAT((image_as<std::uint8_t, 2>(result.image).values), ElementsAre(0, 1, 127, 128, 254, 255));
}

TEST(NetCdf, AxesOfOneSampleAreDroppedAnywhere) {
  TempDir dir;
  {
    NcWriter file(dir / "a.nc");
    const int t = file.dimension("t", 1);
    const int y = file.dimension("y", 2);
    const int one = file.dimension("member", 1);
    const int x = file.dimension("x", 3);
    const int v = file.variable("v", NC_FLOAT, {t, y, one, x});
    file.end();
    file.values(v, {0, 1, 2, 3, 4, 5});
  }
  const auto image = image_as<float, 2>(read_image(dir / "a.nc").image);
  EXPECT_EQ(image.grid.sizes(), (std::array<std::size_t, 2>{3, 2}));
  EXPECT_EQ(image.grid.axes[1].name, "y");
}

TEST(NetCdf, TimeIsMovedToTheEnd) {
  TempDir dir;
  {
    NcWriter file(dir / "a.nc");
    const int z = file.dimension("z", 2);
    const int when = file.dimension("when", 3);
    const int x = file.dimension("x", 4);
    const int w = file.variable("when", NC_FLOAT, {when});
    file.text(w, "units", "hours since 1990-01-01 00:00");
    const int v = file.variable("v", NC_INT, {z, when, x});
    file.end();
    file.values(w, {1, 2, 4});
    std::vector<double> values(24);
    for (std::size_t i = 0; i < 24; ++i) values[i] = static_cast<double>(i);
    file.values(v, values);
  }
  const auto image = image_as<std::int32_t, 3>(read_image(dir / "a.nc").image);
  EXPECT_EQ(image.grid.axes[2].name, "when");
  EXPECT_EQ(image.grid.axes[2][2], 4);
  ASSERT_EQ(image.grid.sizes(), (std::array<std::size_t, 3>{4, 2, 3}));
  const auto view = image.view();
  for (std::size_t z = 0; z < 2; ++z)
    for (std::size_t t = 0; t < 3; ++t)
      for (std::size_t x = 0; x < 4; ++x)
        EXPECT_EQ(view({x, z, t}), static_cast<int>((z * 3 + t) * 4 + x)) << x << z << t;
}

TEST(NetCdf, SaysWhichAxesPointDown) {
  TempDir dir;
  const auto directions = [&](const std::string& unit, const std::string& positive) {
    {
      NcWriter file(dir / "a.nc");
      const int t = file.dimension("time", 3);
      const int z = file.dimension("level", 2);
      const int x = file.dimension("x", 2);
      const int zv = file.variable("level", NC_FLOAT, {z});
      if (!unit.empty()) file.text(zv, "units", unit);
      if (!positive.empty()) file.text(zv, "positive", positive);
      // Time is not the slowest dimension here, so the axes are reordered.
      const int v = file.variable("v", NC_INT, {z, t, x});
      file.end();
      file.values(zv, {1, 2});
      file.values(v, std::vector<double>(12, 1.0));
    }
    const auto whole = read_image(dir / "a.nc").info.axis_directions;
    EXPECT_EQ(open_layers(dir / "a.nc").info.axis_directions, whole);
    return whole;
  };
  const auto level_is = [](AxisDirection direction) {
    return ElementsAre(AxisDirection::unknown, direction, AxisDirection::unknown);
  };
  EXPECT_THAT(directions("m", "down"), level_is(AxisDirection::down));
  EXPECT_THAT(directions("METERS", "Down"), level_is(AxisDirection::down));
  EXPECT_THAT(directions("m", "up"), level_is(AxisDirection::up));
  EXPECT_THAT(directions("m", ""), level_is(AxisDirection::unknown));
  EXPECT_THAT(directions("", "sideways"), level_is(AxisDirection::unknown));
  for (const char* pressure : {"Pa", "hPa", "mbar", "mb", "millibar", "millibars", "dbar"})
    EXPECT_THAT(directions(pressure, ""), level_is(AxisDirection::down)) << pressure;
  EXPECT_THAT(directions("hPa", "up"), level_is(AxisDirection::up));
  EXPECT_THAT(directions("parsec", ""), level_is(AxisDirection::unknown));
}

TEST(NetCdf, OtherCalendarsAreSaidInTheUnit) {
  TempDir dir;
  const auto unit_under = [&](const std::string& calendar, const std::string& units = "days since 2000-01-01") {
    {
      NcWriter file(dir / "a.nc");
      const int t = file.dimension("time", 3);
      const int x = file.dimension("x", 2);
      const int tv = file.variable("time", NC_FLOAT, {t});
      file.text(tv, "units", units);
      if (!calendar.empty()) file.text(tv, "calendar", calendar);
      const int v = file.variable("v", NC_INT, {t, x});
      file.end();
      file.values(tv, {1, 2, 4});
      file.values(v, {1, 2, 3, 4, 5, 6});
    }
    return image_as<std::int32_t, 2>(read_image(dir / "a.nc").image).grid.axes[1].unit;
  };
  for (const char* common : {"", "standard", "Gregorian", "proleptic_gregorian"})
    EXPECT_EQ(unit_under(common), "days since 2000-01-01") << common;
  EXPECT_EQ(unit_under("noleap"), "days since 2000-01-01 (noleap)");
  EXPECT_EQ(unit_under("360_day"), "days since 2000-01-01 (360_day)");
  // Before 1582-10-15 the standard calendar is the Julian one.
  for (const char* early : {"days since 0001-01-01", "hours since 1-1-1 00:00:0.0", "days since 1582-10-14"}) {
    EXPECT_EQ(unit_under("proleptic_gregorian", early), std::string(early) + " (proleptic_gregorian)");
    EXPECT_EQ(unit_under("standard", early), early);
  }
  EXPECT_EQ(unit_under("proleptic_gregorian", "days since 1582-10-15"), "days since 1582-10-15");
}

TEST(NetCdf, SeveralVariablesMustBeChosenFrom) {
  TempDir dir;
  {
    NcWriter file(dir / "a.nc");
    const int y = file.dimension("y", 2);
    const int x = file.dimension("x", 3);
    const int c = file.dimension("chars", 8);
    const int salt = file.variable("salt", NC_FLOAT, {y, x});
    file.variable("temp", NC_SHORT, {y, x});
    file.variable("names", NC_CHAR, {y, c});
    file.variable("profile", NC_FLOAT, {x});
    file.variable("lat2d", NC_FLOAT, {y, x});
    file.text(salt, "coordinates", "lat2d");
    file.end();
  }
  expect_error(ErrorCode::VariableNotFound, {"a.nc", "2 variables", "salt (3 x 2), temp (3 x 2)"},
               [&] { read_image(dir / "a.nc"); });
  expect_error(ErrorCode::VariableNotFound, {"no variable 'sugar'", "salt (3 x 2), temp (3 x 2)"}, [&] {
    read_image(dir / "a.nc", {"sugar", {}});
  });
  const auto [any, info] = read_image(dir / "a.nc", {"temp", {}});
  EXPECT_EQ(info.variable, "temp");
  EXPECT_THAT(info.variables, ElementsAre("salt", "temp"));
  EXPECT_EQ((image_as<std::int16_t, 2>(any).values.size()), 6U);
  // A variable that is not a candidate can be selected by name.
  EXPECT_EQ(read_image(dir / "a.nc", {"lat2d", {}}).info.variable, "lat2d");
  expect_error(ErrorCode::UnsupportedData, {"'profile' is 3; expected 2 to 5 axes"}, [&] {
    read_image(dir / "a.nc", {"profile", {}});
  });
  expect_error(ErrorCode::UnsupportedData, {"'names' holds char values"}, [&] {
    read_image(dir / "a.nc", {"names", {}});
  });
}

TEST(NetCdf, VariablesInGroupsAndCoordinatesAboveThem) {
  TempDir dir;
  {
    NcWriter file(dir / "a.nc", NC_NETCDF4);
    const int y = file.dimension("y", 2);
    const int x = file.dimension("x", 3);
    const int xv = file.variable("x", NC_DOUBLE, {x});
    file.values(xv, {1, 2, 4});
    int group = 0;
    NcWriter::ok(nc_def_grp(file.id(), "model", &group));
    int v = 0;
    const std::array<int, 2> dimensions = {y, x};
    NcWriter::ok(nc_def_var(group, "v", NC_FLOAT, 2, dimensions.data(), &v));
    const std::array<float, 6> values = {0, 1, 2, 3, 4, 5};
    NcWriter::ok(nc_put_var_float(group, v, values.data()));
  }
  for (const char* name : {"", "/model/v", "model/v"}) {
    const auto [any, info] = read_image(dir / "a.nc", {name, {}});
    EXPECT_EQ(info.variable, "/model/v");
    EXPECT_EQ((image_as<float, 2>(any).grid.axes[0][2]), 4);
  }
}

TEST(NetCdf, CoordinatesMustBeStrictlyMonotone) {
  TempDir dir;
  const auto write = [&](const std::vector<double>& lon) {
    NcWriter file(dir / "a.nc");
    const int y = file.dimension("y", 2);
    const int x = file.dimension("lon", 3);
    const int xv = file.variable("lon", NC_FLOAT, {x});
    file.variable("v", NC_FLOAT, {y, x});
    file.end();
    file.values(xv, lon);
  };
  write({350, 355, 0});
  expect_error(ErrorCode::InvalidGrid, {"a.nc", "coordinate variable 'lon'", "355 and 0"},
               [&] { read_image(dir / "a.nc"); });
  write({1, 1, 2});
  expect_error(ErrorCode::InvalidGrid, {"'lon'"}, [&] { read_image(dir / "a.nc"); });
  write({1, NC_FILL_FLOAT, 2});
  expect_error(ErrorCode::InvalidGrid, {"'lon'", "nan"}, [&] { read_image(dir / "a.nc"); });
  write({340, 360, 380});
  EXPECT_EQ((image_as<float, 2>(read_image(dir / "a.nc").image).grid.axes[0][2]), 380);
}

TEST(NetCdf, FiveAxesAreReadInTheOrderOfTheFile) {
  TempDir dir;
  Grid<5> grid = Grid<5>::unit({2, 3, 4, 2, 3});
  const std::array<const char*, 5> names = {"x", "y", "z", "t", "log2_sigma"};
  for (std::size_t a = 0; a < 5; ++a) grid.axes[a].name = names[a];
  std::vector<float> values(2 * 3 * 4 * 2 * 3);
  std::iota(values.begin(), values.end(), 0.5F);
  write_image(Image<float, 5>(values.data(), grid), dir / "a.nc", {});
  const std::vector<std::filesystem::path> files = {dir / "a.nc"};
  const auto read = read_series_to_5d(files, {});
  const auto& image = std::get<OwnedImage<float, 5>>(std::get<ReadSeries5dResult>(read).image);
  EXPECT_EQ(image.values, values);
  for (std::size_t a = 0; a < 5; ++a) EXPECT_EQ(image.grid.axes[a].name, names[a]);
}

TEST(NetCdf, RankAndSizesOutsideOfImagesAreNamed) {
  TempDir dir;
  {
    NcWriter file(dir / "a.nc");
    std::vector<int> six;
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) six.push_back(file.dimension(name, 2));
    file.variable("hyper", NC_BYTE, six);
  }
  expect_error(ErrorCode::UnsupportedData, {"'hyper' is 2 x 2 x 2 x 2 x 2 x 2 (f, e, d, c, b, a)", "such as a=0"},
               [&] { read_image(dir / "a.nc"); });
  expect_error(ErrorCode::UnsupportedData, {"'hyper'", "expected 2 to 5 axes", "a fixed index"}, [&] {
    read_image(dir / "a.nc", {"hyper", {}});
  });
  {
    NcWriter file(dir / "b.nc");
    const int t = file.dimension("t", NC_UNLIMITED);
    const int y = file.dimension("y", 2);
    const int x = file.dimension("x", 2);
    file.variable("empty", NC_FLOAT, {t, y, x});
  }
  expect_error(ErrorCode::UnsupportedData, {"empty (2 x 2 x 0)"}, [&] { read_image(dir / "b.nc"); });
  expect_error(ErrorCode::UnsupportedData, {"'empty' is 2 x 2 x 0; expected at least one sample"}, [&] {
    read_image(dir / "b.nc", {"empty", {}});
  });
  { NcWriter file(dir / "c.nc"); }
  expect_error(ErrorCode::UnsupportedData, {"it has no variables"}, [&] { read_image(dir / "c.nc"); });
}

/// A variable v(member 3, t 2, z 4, y 5, x 6) whose values are their positions in the file; members have coordinates
/// 10, 20, 30.
void write_ensemble(const fs::path& path, int format) {
  NcWriter file(path, format);
  std::vector<int> dimensions;
  for (const auto& [name, size] :
       std::vector<std::pair<const char*, std::size_t>>{{"member", 3}, {"time", 2}, {"z", 4}, {"y", 5}, {"x", 6}})
    dimensions.push_back(file.dimension(name, size));
  const int member = file.variable("member", NC_FLOAT, {dimensions[0]});
  const int v = file.variable("v", NC_INT, dimensions);
  file.end();
  file.values(member, {10, 20, 30});
  std::vector<double> values(3 * 2 * 4 * 5 * 6);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  file.values(v, values);
}

TEST(NetCdf, AVariableOf5AxesIsListedAndReadAtAFixedIndex) {
  TempDir dir;
  for (const int format : {0, NC_NETCDF4}) {
    write_ensemble(dir / "a.nc", format);
    const auto list = list_image_variables(dir / "a.nc");
    ASSERT_EQ(list.size(), 1U);
    EXPECT_THAT(list[0].sizes, ElementsAre(6, 5, 4, 2, 3));
    EXPECT_THAT(list[0].axes, ElementsAre("x", "y", "z", "time", "member"));
    expect_error(ErrorCode::UnsupportedData, {"5 axes (6 x 5 x 4 x 3 x 2)", "such as member=0"},
                 [&] { read_image(dir / "a.nc"); });
    ReadImageOptions options;
    options.fixed = {{"member", 2}};
    const auto image = image_as<std::int32_t, 4>(read_image(dir / "a.nc", options).image);
    EXPECT_EQ(image.grid.sizes(), (std::array<std::size_t, 4>{6, 5, 4, 2}));
    for (std::size_t i = 0; i < 240; ++i) ASSERT_EQ(image.values[i], static_cast<int>(480 + i));
    expect_layers_of(read_image(dir / "a.nc", options).image, open_layers(dir / "a.nc", options).layers);
    options.fixed = {{"z", 1}, {"member", 1}};
    const auto plane = image_as<std::int32_t, 3>(read_image(dir / "a.nc", options).image);
    EXPECT_EQ(plane.grid.sizes(), (std::array<std::size_t, 3>{6, 5, 2}));
    EXPECT_EQ(plane.values[0], 240 + 30);
    EXPECT_EQ(plane.values[59], 240 + 120 + 30 + 29);
    expect_layers_of(read_image(dir / "a.nc", options).image, open_layers(dir / "a.nc", options).layers);
    const auto refused = [&](const std::vector<FixedIndex>& fixed, const std::string& part) {
      options.fixed = fixed;
      expect_error(ErrorCode::InvalidArgument, {"a.nc", part}, [&] { read_image(dir / "a.nc", options); });
      expect_error(ErrorCode::InvalidArgument, {"a.nc", part}, [&] { open_layers(dir / "a.nc", options); });
    };
    refused({{"member", 3}}, "member=3; expected an index from 0 to 2");
    refused({{"run", 0}}, "no dimension 'run'; expected one of member, time, z, y, x");
    refused({{"member", 0}, {"member", 1}}, "two indices of the dimension 'member', 0 and 1");
  }
  write_file(dir / "a.nrrd", "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 2 2\nencoding: raw\n\nabcd");
  ReadImageOptions options;
  options.fixed = {{"member", 0}};
  expect_error(ErrorCode::InvalidArgument, {"a.nrrd", "'member'"}, [&] { read_image(dir / "a.nrrd", options); });
}

TEST(NetCdf, TruncatedFilesAreErrorsNotZeros) {
  TempDir dir;
  for (const int format : {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4}) {
    SCOPED_TRACE(format);
    write_standard(dir / "a.nc", format);
    const std::string whole = read_file(dir / "a.nc");
    for (const std::size_t size :
         {whole.size() - 1, whole.size() / 2, std::size_t{40}, std::size_t{9}, std::size_t{5}}) {
      SCOPED_TRACE(size);
      write_file(dir / "b.nc", whole.substr(0, size));
      expect_unreadable(ErrorCode::MalformedFile, dir / "b.nc", {});
      write_file(dir / "b.nc.gz", compressed(whole.substr(0, size)));
      expect_unreadable(ErrorCode::MalformedFile, dir / "b.nc.gz", {});
    }
  }
}

TEST(NetCdf, ProgressRisesAndCancels) {
  TempDir dir;
  write_standard(dir / "a.nc", 0);
  std::vector<double> fractions;
  const auto tell = [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  };
  read_image(dir / "a.nc", {.work = {.progress = tell}});
  ASSERT_GE(fractions.size(), 2U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
  expect_error(ErrorCode::Cancelled, {"a.nc"},
               [&] { read_image(dir / "a.nc", {.work = {.progress = [](double) { return false; }}}); });
}

/// A model's file: values along time, s, eta and xi, with longitude and latitude along eta and xi, and depths along s
/// too.
void write_curved(const fs::path& path, int format, bool own_axes) {
  NcWriter file(path, format);
  const int time = file.dimension("time", 2), s = file.dimension("s", 3), eta = file.dimension("eta", 4),
            xi = file.dimension("xi", 5);
  const int lon = file.variable("lon", NC_DOUBLE, {eta, xi}), lat = file.variable("lat", NC_FLOAT, {eta, xi}),
            depth = file.variable("depth", NC_DOUBLE, {s, eta, xi}),
            v = file.variable("v", NC_FLOAT, {time, s, eta, xi});
  const int own = own_axes ? file.variable("xi", NC_DOUBLE, {xi}) : -1;
  file.text(lon, "units", "degrees_east");
  file.text(lat, "standard_name", "latitude");
  file.text(depth, "positive", "down");
  file.text(depth, "units", "m");
  file.number(depth, "_FillValue", NC_DOUBLE, {-999});
  file.text(v, "coordinates", "lon lat depth other");
  file.end();
  std::vector<double> longitudes, latitudes, depths, values;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i) {
      const double x = 178 + i + 0.5 * j;
      longitudes.push_back(x > 180 ? x - 360 : x);
      latitudes.push_back(10 + j);
    }
  for (int k = 0; k < 60; ++k) depths.push_back(k == 7 ? -999 : k);
  for (int k = 0; k < 120; ++k) values.push_back(k);
  file.values(lon, longitudes);
  file.values(lat, latitudes);
  file.values(depth, depths);
  file.values(v, values);
  if (own >= 0) file.values(own, {0, 1, 2, 3, 4});
}

TEST(NetCdf, CoordinatesInArraysAreCurvedAxes) {
  TempDir dir;
  for (const bool in_process : {true, false}) {
    write_curved(dir / "a.nc", in_process ? 0 : NC_NETCDF4, false);
    ReadImageOptions options;
    options.separate_process = !in_process;
    const ReadImageResult read = read_image(dir / "a.nc", options);
    const auto& curved = read.info.curved;
    ASSERT_EQ(curved.size(), 3U);
    EXPECT_EQ(curved[0].axis, 0);
    EXPECT_EQ(curved[0].along, 3U);
    EXPECT_EQ(curved[0].name, "lon");
    EXPECT_EQ(curved[0].unit, "degrees_east");
    EXPECT_EQ(curved[0][4], 182) << "continued across 180 degrees";
    EXPECT_EQ(curved[0][19], 183.5);
    EXPECT_EQ(curved[1].axis, 1);
    EXPECT_EQ(curved[1][19], 13);
    EXPECT_EQ(curved[2].axis, 2);
    EXPECT_EQ(curved[2].along, 7U);
    EXPECT_TRUE(std::isnan(curved[2][7]));
    EXPECT_EQ(curved[2][59], 59);
    EXPECT_EQ(read.info.axis_directions[2], AxisDirection::down);
    const auto& image = std::get<OwnedImage<float, 4>>(std::get<AnyImageN<4>>(read.image));
    EXPECT_EQ(image.grid.axes[0][4], 4) << "indices";
    EXPECT_TRUE(std::isnan(image.values[7]) && std::isnan(image.values[67])) << "unknown depth";
    EXPECT_EQ(image.values[8], 8);
  }
  ReadImageOptions section;
  section.fixed = {{"eta", 1}};
  const ReadImageResult cut = read_image(dir / "a.nc", section);
  ASSERT_EQ(cut.info.curved.size(), 1U);
  EXPECT_EQ(cut.info.curved[0].name, "depth");
  EXPECT_EQ(cut.info.remarks.size(), 2U) << "longitude and latitude along one axis";
  // A dimension with a coordinate variable of its own is straight.
  write_curved(dir / "b.nc", 0, true);
  const ReadImageResult read = read_image(dir / "b.nc");
  ASSERT_EQ(read.info.curved.size(), 1U);
  EXPECT_EQ(read.info.curved[0].name, "depth");
}

}  // namespace
}  // namespace tegl::test
