// SPDX-License-Identifier: BSD-3-Clause
//
// Series of files as one image: values, coordinates and order; and inconsistent files.
#include "images/series_request.hpp"

#include "images/layers_support.hpp"
#include "images/netcdf_files.hpp"
#include "images/nifti_files.hpp"
#include "io_support.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

/// An NRRD of int16 with these sizes; sample i is `first` + i. `extra`: further header lines.
std::string nrrd(const std::vector<std::size_t>& sizes, int first, const std::string& extra = "",
                 const std::string& type = "short") {
  std::string text = "NRRD0004\ntype: " + type +
                     "\nencoding: raw\nendian: little\ndimension: " + std::to_string(sizes.size()) + "\nsizes:";
  std::size_t count = 1;
  for (const std::size_t size : sizes) {
    text += " " + std::to_string(size);
    count *= size;
  }
  std::vector<std::int16_t> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<std::int16_t>(static_cast<std::size_t>(first) + i);
  return text + "\n" + extra + "\n" + bytes_of(values);
}

class Series : public testing::Test {
 protected:
  /// Writes an NRRD and adds it to the list.
  void add(const std::string& name, const std::string& bytes) {
    files_.push_back(dir_ / name);
    write_file(files_.back(), bytes);
  }
  void add_three() {
    for (int k = 0; k < 3; ++k) add("frame_" + std::to_string(k) + ".nrrd", nrrd({2, 3, 4}, 100 * k));
  }
  [[nodiscard]] std::vector<double> last_axis(const SeriesOptions& options = {}) const {
    const auto image = image_as<std::int16_t, 4>(read_series(files_, options).image);
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < image.grid.axes[3].size(); ++i) coordinates.push_back(image.grid.axes[3][i]);
    return coordinates;
  }
  void expect_refused(ErrorCode code, const std::vector<std::string>& parts, const SeriesOptions& options = {}) const {
    expect_error(code, parts, [&] { read_series(files_, options); });
    expect_error(code, parts, [&] { open_series(files_, options); });
  }

  TempDir dir_;
  std::vector<fs::path> files_;
};

TEST_F(Series, OfVolumesIsA4dImage) {
  for (int k = 0; k < 3; ++k)
    add("frame_" + std::to_string(k) + ".nrrd", nrrd({2, 3, 4}, 100 * k, "spacings: 0.5 2 3\naxis mins: 1 2 3\n"));
  const ReadImageResult read = read_series(files_);
  const auto image = image_as<std::int16_t, 4>(read.image);
  EXPECT_EQ(image.grid.sizes(), (std::array<std::size_t, 4>{2, 3, 4, 3}));
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(image.values[24 * k + i], static_cast<int>(100 * k + i));
  EXPECT_EQ(image.grid.axes[0].step(), 0.5);
  EXPECT_EQ(image.grid.axes[2].origin(), 3);
  EXPECT_EQ(image.grid.axes[3].name, "t");
  EXPECT_EQ(image.grid.axes[3].step(), 1);
  EXPECT_EQ(read.info.format, "NRRD");
  expect_layers_of(read.image, open_series(files_).layers);
}

TEST_F(Series, ReportsProgressWhileItIsOpened) {
  add_three();
  std::vector<double> shares;
  SeriesOptions options;
  options.work.progress = [&](double share) {
    shares.push_back(share);
    return true;
  };
  const OpenSeriesResult opened = open_series(files_, options);
  EXPECT_GE(shares.size(), files_.size());
  EXPECT_EQ(shares.back(), 1.0);
  const std::size_t calls = shares.size();
  expect_layers_of(read_series(files_).image, opened.layers);
  EXPECT_EQ(shares.size(), calls);
  options.work.progress = [](double) { return false; };
  expect_error(ErrorCode::Cancelled, {"cancelled"}, [&] { open_series(files_, options); });
  expect_error(ErrorCode::Cancelled, {"cancelled"},
               [&] { open_layers(files_[0], {.work = {.progress = [](double) { return false; }}}); });
}

TEST_F(Series, OfPlanesIsA3dImage) {
  for (int k = 0; k < 5; ++k) add("slice_" + std::to_string(k) + ".nrrd", nrrd({4, 3}, 10 * k));
  SeriesOptions options;
  options.step = 2.5;
  options.unit = "mm";
  const auto image = image_as<std::int16_t, 3>(read_series(files_, options).image);
  EXPECT_EQ(image.grid.axes[2].name, "z");
  EXPECT_EQ(image.grid.axes[2].unit, "mm");
  EXPECT_EQ(image.grid.axes[2][4], 10);
  EXPECT_EQ(image.values[12 * 4 + 11], 51);
}

TEST_F(Series, OfOneFileIsThatFile) {
  add("one.nrrd", nrrd({2, 3, 4}, 7));
  EXPECT_EQ((image_as<std::int16_t, 3>(read_series(files_).image).values[0]), 7);
}

TEST_F(Series, HasTheWorldMapOfItsFiles) {
  const std::string space =
      "space: left-posterior-superior\nspace directions: (0.8,0.6,0) (-0.6,0.8,0) (0,0,2)\nspace origin: (5,6,7)\n";
  add("a.nrrd", nrrd({2, 2, 2}, 0, space));
  add("b.nrrd", nrrd({2, 2, 2}, 9, space));
  const ReadImageResult read = read_series(files_);
  const auto image = image_as<std::int16_t, 4>(read.image);
  const auto one = image_as<std::int16_t, 3>(read_image(files_[0]).image);
  EXPECT_EQ(as_eigen(image.grid.linear).topLeftCorner(3, 3), as_eigen(one.grid.linear));
  EXPECT_EQ(image.grid.linear[3], unit_vector<4>(3));
  EXPECT_EQ(as_eigen(image.grid.offset).head(3), as_eigen(one.grid.offset));
  EXPECT_EQ(read.info.world_frame, "LPS");
}

TEST_F(Series, TakesCoordinatesAndSteps) {
  add_three();
  SeriesOptions options;
  options.coordinates = {0, 0.5, 2};
  EXPECT_THAT(last_axis(options), ElementsAre(0, 0.5, 2));
  options.coordinates = {};
  options.step = -3;
  EXPECT_THAT(last_axis(options), ElementsAre(0, -3, -6));
}

TEST_F(Series, IsOrderedByNumbersInNamesOrByCoordinatesIfThatIsAskedFor) {
  for (const int k : {1, 10, 2}) add("frame_" + std::to_string(k) + ".nrrd", nrrd({2, 2, 2}, k));
  const auto firsts = [&](const SeriesOptions& options) {
    const auto image = image_as<std::int16_t, 4>(read_series(files_, options).image);
    return std::vector<int>{image.values[0], image.values[8], image.values[16]};
  };
  SeriesOptions options;
  EXPECT_THAT(firsts(options), ElementsAre(1, 10, 2));
  options.order = SeriesOrder::by_name;
  EXPECT_THAT(firsts(options), ElementsAre(1, 2, 10));
  options.coordinates = {5, 6, 4};
  options.order = SeriesOrder::coordinate;
  EXPECT_THAT(firsts(options), ElementsAre(2, 1, 10));
  EXPECT_THAT(last_axis(options), ElementsAre(4, 5, 6));
}

TEST_F(Series, CoordinatesStayWithTheirFilesInEveryOrder) {
  for (const int k : {10, 2, 1}) add("frame_" + std::to_string(k) + ".nrrd", nrrd({2, 2, 2}, k));
  const auto names = [](const std::vector<fs::path>& files) {
    std::vector<std::string> result;
    for (const fs::path& file : files) result.push_back(file.stem().string());
    return result;
  };
  SeriesOptions options;
  options.coordinates = {1.5, 0.5, 0};
  for (const SeriesOrder order : {SeriesOrder::given, SeriesOrder::by_name, SeriesOrder::coordinate}) {
    options.order = order;
    const ReadSeriesResult read = read_series(files_, options);
    const auto image = image_as<std::int16_t, 4>(read.image);
    for (std::size_t i = 0; i < 3; ++i) {
      const int k = image.values[8 * i];
      EXPECT_EQ(image.grid.axes[3][i], k == 10 ? 1.5 : k == 2 ? 0.5 : 0);
      EXPECT_EQ(read.files[i].stem(), "frame_" + std::to_string(k));
    }
    const OpenSeriesResult opened = open_series(files_, options);
    expect_layers_of(read.image, opened.layers);
    EXPECT_EQ(opened.files, read.files);
  }
  options.order = SeriesOrder::given;
  EXPECT_THAT(names(read_series(files_, options).files), ElementsAre("frame_10", "frame_2", "frame_1"));
  options.order = SeriesOrder::by_name;
  EXPECT_THAT(names(read_series(files_, options).files), ElementsAre("frame_1", "frame_2", "frame_10"));
  options.coordinates = {0.5, 1.5, 0};  // frame_10 before frame_2
  expect_refused(
      ErrorCode::InvalidArgument,
      {"frame_10.nrrd", "lies at 0.5", "the given coordinates", "frame_2.nrrd at 1.5", "order of their names"},
      options);
}

TEST_F(Series, LiesWhereTheHeadersSay) {
  for (const int k : {3, 1, 2})
    add("frame_" + std::to_string(k) + ".nrrd", nrrd({2, 2, 2, 1}, k,
                                                     "axis mins: 0 0 0 " + std::to_string(k * k) +
                                                         "\nunits: \"mm\" \"mm\" \"mm\" \"s\"\nlabels: \"x\" \"y\" "
                                                         "\"z\" \"time\"\n"));
  expect_refused(ErrorCode::UnsupportedData, {"frame_2.nrrd", "lies at 4", "frame_1.nrrd at 1", "descending"});
  SeriesOptions options;
  options.order = SeriesOrder::coordinate;
  const auto image = image_as<std::int16_t, 4>(read_series(files_, options).image);
  EXPECT_EQ(image.grid.axes[3].name, "time");
  EXPECT_EQ(image.grid.axes[3].unit, "s");
  EXPECT_THAT(last_axis(options), ElementsAre(1, 4, 9));
  EXPECT_EQ(image.values[0], 1);
  EXPECT_EQ(image.values[16], 3);
  options.coordinates = {1, 2, 3};  // given coordinates have priority over the headers'
  options.order = SeriesOrder::given;
  EXPECT_THAT(last_axis(options), ElementsAre(1, 2, 3));
}

TEST_F(Series, OfNetcdfLiesAtItsTimes) {
  for (int k = 0; k < 3; ++k) {
    files_.push_back(dir_ / ("month_" + std::to_string(k) + ".nc"));
    NcWriter file(files_.back());
    const std::vector<int> dims = {file.dimension("time", 1), file.dimension("lat", 3), file.dimension("lon", 4)};
    const int time = file.variable("time", NC_DOUBLE, {dims[0]});
    const int value = file.variable("sst", NC_FLOAT, dims);
    file.text(time, "units", "days since 2000-01-01");
    file.text(value, "units", "degC");
    file.end();
    file.values(time, std::vector<double>{15.0 + 30 * k * k});
    file.values(value, std::vector<double>(12, k));
  }
  const ReadImageResult read = read_series(files_);
  const auto image = image_as<float, 3>(read.image);
  EXPECT_EQ(image.grid.axes[2].name, "time");
  EXPECT_EQ(image.grid.axes[2].unit, "days since 2000-01-01");
  EXPECT_EQ(image.grid.axes[2][1], 45);
  EXPECT_EQ(image.grid.axes[2][2], 135);
  EXPECT_EQ(image.values[12], 1);
  EXPECT_EQ(read.info.value_unit, "degC");
  expect_layers_of(read.image, open_series(files_).layers);
}

/// The values of an image of `keep_stored`, which has stored integers of type T if `kept`, else values.
template <class T>
std::vector<float> values_of(const ReadImageResult& read, bool kept) {
  EXPECT_EQ(read.info.scaling.has_value(), kept);
  if (!kept) {
    const auto values = image_as<float, 4>(read.image).values;
    return {values.begin(), values.end()};
  }
  std::vector<float> values;
  for (const T stored : image_as<T, 4>(read.image).values)
    values.push_back(static_cast<float>(read.info.scaling->value_of(stored)));
  return values;
}

TEST_F(Series, KeepsStoredIntegersIfAllFilesHaveOneScaling) {
  constexpr int kInt16 = 4;
  SeriesOptions options;
  options.keep_stored = true;
  const auto write = [&](const std::vector<float>& slopes) {
    files_.clear();
    for (std::size_t k = 0; k < slopes.size(); ++k) {
      std::vector<std::int16_t> stored(24);
      for (std::size_t i = 0; i < 24; ++i) stored[i] = static_cast<std::int16_t>((24 * k + i) * 7919 % 65536);
      add("volume_" + std::to_string(k) + ".nii",
          NiftiHeader({2, 3, 4}, kInt16, 16).scaling(slopes[k], -3.7F).bytes() + bytes_of(stored));
    }
  };
  for (const auto& [slopes, kept] : std::vector<std::pair<std::vector<float>, bool>>{
           {{0.3F, 0.3F, 0.3F}, true}, {{-0.3F, -0.3F}, true}, {{0.3F, 0.3F, 0.4F}, false}, {{0.3F, -0.3F}, false}}) {
    write(slopes);
    const ReadImageResult converted = read_series(files_);
    EXPECT_EQ(values_of<std::int16_t>(read_series(files_, options), kept), values_of<std::int16_t>(converted, false));
    expect_layers_of(converted.image, open_series(files_, options).layers);
  }
  write({0.3F, 1e-9F});  // float has no number between the values of neighbouring integers of the second file
  EXPECT_EQ(values_of<std::int16_t>(read_series(files_, options), false),
            values_of<std::int16_t>(read_series(files_), false));
}

TEST_F(Series, WithAMissingValueInAnyFileIsConverted) {
  SeriesOptions options;
  options.keep_stored = true;
  std::vector<double> told;
  options.work.progress = [&](double share) {
    told.push_back(share);
    return true;
  };
  for (const int missing : {-1, 2}) {
    files_.clear();
    told.clear();
    for (int k = 0; k < 3; ++k) {
      files_.push_back(dir_ / ("volume_" + std::to_string(k) + ".nc"));
      NcWriter file(files_.back());
      const int value =
          file.variable("v", NC_SHORT, {file.dimension("z", 2), file.dimension("y", 3), file.dimension("x", 4)});
      file.number(value, "scale_factor", NC_DOUBLE, {0.3});
      file.number(value, "_FillValue", NC_SHORT, {-5});
      file.end();
      std::vector<double> stored(24, 10.0 * k);
      if (k == missing) stored[7] = -5;
      file.values(value, stored);
    }
    const auto values = values_of<std::int16_t>(read_series(files_), false);
    const auto read = read_series(files_, options);
    EXPECT_THAT(values_of<std::int16_t>(read, missing < 0), testing::Pointwise(testing::NanSensitiveFloatEq(), values));
    EXPECT_EQ(std::isnan(values[24 + 24 + 7]), missing == 2);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_EQ(told.back(), 1);
  }
}

/// Files of one day each often count time from that day: all of them are at 0.
TEST_F(Series, OfFilesThatCountFromDaysOfTheirOwnLiesOnOneAxis) {
  struct Case {
    std::vector<std::pair<std::string, double>> times;  // unit, value
    std::vector<double> expected;                       // in the first unit; empty: refused
  };
  const std::vector<Case> cases = {
      {{{"days since 2000-01-01", 0}, {"days since 2000-01-02", 0}, {"days since 2000-01-09", 0}}, {0, 1, 8}},
      {{{"Hours Since 2000-02-28 12:00", 1},
        {"hours since 2000-02-28 12:30 UTC", 2},
        {"days  since 2000-3-1T0:0:0.0Z", 0.5}},
       {1, 2.5, 48}},
      {{{"hours since 2000-01-01 00:00 +02:00", 0}, {"hours since 2000-01-01", 0}, {"s since 2000-01-01", 7200}},
       {0, 2, 4}},
      {{{"days since 1500-01-01", 1}, {"hours since 1500-01-01", 48}, {"days since 1500-01-01", 4}}, {1, 2, 4}},
      {{{"days since 1500-01-01", 0}, {"days since 1500-01-02", 0}, {"days since 1500-01-09", 0}}, {}},
      {{{"days since 2000-01-01", 0}, {"days since 2000-01-02 (noleap)", 0}, {"days since 2000-01-03", 0}}, {}},
      {{{"months since 2000-01-01", 0}, {"months since 2000-02-01", 0}, {"months since 2000-03-01", 0}}, {}},
      {{{"days since 2000-01-01", 0}, {"days since 2000-02-31", 0}, {"days since 2000-03-01", 0}}, {}},
      {{{"days since 2000-01-01", 0}, {"days", 1}, {"days", 2}}, {}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.times[1].first);
    files_.clear();
    for (std::size_t k = 0; k < 3; ++k) {
      files_.push_back(dir_ / ("own_day_" + std::to_string(k) + ".nc"));
      NcWriter file(files_.back());
      const std::vector<int> dims = {file.dimension("time", 1), file.dimension("lat", 3), file.dimension("lon", 4)};
      const int time = file.variable("time", NC_DOUBLE, {dims[0]});
      const int value = file.variable("temperature", NC_FLOAT, dims);
      file.text(time, "units", one.times[k].first);
      file.end();
      file.values(time, std::vector<double>{one.times[k].second});
      file.values(value, std::vector<double>(12, 1.0));
    }
    if (one.expected.empty()) {
      expect_refused(ErrorCode::UnsupportedData, {one.times[1].first, "explicit coordinates"}, {});
      continue;
    }
    const ReadImageResult read = read_series(files_);
    const auto image = image_as<float, 3>(read.image);
    EXPECT_EQ(image.grid.axes[2].unit, one.times[0].first);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(image.grid.axes[2][k], one.expected[static_cast<std::size_t>(k)]);
  }
}

/// A direction that all files give to their axis of one sample becomes the direction of the combined axis.
TEST_F(Series, OfNetcdfHasTheDirectionThatAllFilesGiveItsNewAxis) {
  struct Case {
    std::vector<std::string> positive;
    std::string unit;
    AxisDirection direction;
  };
  const std::vector<Case> cases = {
      {{"down", "Down", "down"}, "m", AxisDirection::down}, {{"up", "up", "up"}, "m", AxisDirection::up},
      {{"", "", ""}, "hPa", AxisDirection::down},           {{"", "", ""}, "m", AxisDirection::unknown},
      {{"down", "", "down"}, "m", AxisDirection::unknown},  {{"", "down", "down"}, "m", AxisDirection::unknown},
      {{"down", "up", "down"}, "m", AxisDirection::unknown}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.positive[0] + ", " + one.positive[1] + ", " + one.unit);
    files_.clear();
    for (std::size_t k = 0; k < 3; ++k) {
      files_.push_back(dir_ / ("level_" + std::to_string(k) + ".nc"));
      NcWriter file(files_.back());
      const std::vector<int> dims = {file.dimension("lev", 1), file.dimension("lat", 3), file.dimension("lon", 4)};
      const int level = file.variable("lev", NC_DOUBLE, {dims[0]});
      const int value = file.variable("temperature", NC_FLOAT, dims);
      file.text(level, "units", one.unit);
      if (!one.positive[k].empty()) file.text(level, "positive", one.positive[k]);
      file.end();
      file.values(level, std::vector<double>{100.0 - 10.0 * static_cast<double>(k)});
      file.values(value, std::vector<double>(12, 1.0));
    }
    const std::vector<AxisDirection> expected = {AxisDirection::unknown, AxisDirection::unknown, one.direction};
    EXPECT_EQ(read_series(files_).info.axis_directions, expected);
    SeriesOptions given;  // given coordinates differ from those in the files
    given.step = 2.5;
    EXPECT_EQ(read_series(files_, given).info.axis_directions.back(), AxisDirection::unknown);
  }
}

TEST_F(Series, ConvertsTheTimesOfHeadersAndNeverTheirUnitAlone) {
  const auto add_times = [&](const std::string& unit) {
    files_.clear();
    for (const int k : {0, 1, 3})
      add("frame_" + std::to_string(k) + ".nrrd",
          nrrd({2, 2, 2, 1}, k,
               "axis mins: 0 0 0 " + std::to_string(k) + "\nunits: \"\" \"\" \"\" \"" + unit + "\"\n"));
  };
  const auto unit_of = [&](const SeriesOptions& options) {
    return image_as<std::int16_t, 4>(read_series(files_, options).image).grid.axes[3].unit;
  };
  SeriesOptions options;
  add_times("days since 2000-01-01");
  options.unit = "h";
  EXPECT_THAT(last_axis(options), ElementsAre(0, 24, 72));
  EXPECT_EQ(unit_of(options), "h since 2000-01-01");
  options.unit = "hours since 2000-01-01";
  EXPECT_THAT(last_axis(options), ElementsAre(0, 24, 72));
  EXPECT_EQ(unit_of(options), "hours since 2000-01-01");
  options.unit = "day";
  EXPECT_THAT(last_axis(options), ElementsAre(0, 1, 3));
  add_times("Days  Since 2000-01-01");
  options.unit = "h";
  EXPECT_THAT(last_axis(options), ElementsAre(0, 24, 72));
  add_times("days since 2000-01-01");
  for (const char* const other : {"mm", "months", "hours since 1999-01-01"}) {
    options.unit = other;
    expect_refused(ErrorCode::InvalidArgument, {"frame_0.nrrd", "days since 2000-01-01", other}, options);
  }
  add_times("ms");
  options.unit = "s";
  EXPECT_THAT(last_axis(options), ElementsAre(0, 0.001, 0.003));
  options.unit = "ms";
  EXPECT_THAT(last_axis(options), ElementsAre(0, 1, 3));
  options.unit = "h";  // given coordinates have no other unit
  options.coordinates = {0, 1, 2};
  EXPECT_THAT(last_axis(options), ElementsAre(0, 1, 2));
  EXPECT_EQ(unit_of(options), "h");
  options.coordinates = {};
  add_times("");
  EXPECT_THAT(last_axis(options), ElementsAre(0, 1, 3));
  EXPECT_EQ(unit_of(options), "h");
}

TEST_F(Series, OfRawValuesIsReadByTheLayoutOfOneFile) {
  for (int k = 0; k < 3; ++k) {
    std::vector<float> values(24);
    for (std::size_t i = 0; i < 24; ++i) values[i] = static_cast<float>(i) + 100 * static_cast<float>(k);
    add("f" + std::to_string(k) + ".raw", "head" + bytes_of(values));
  }
  SeriesOptions options;
  options.raw = RawLayout{{2, 3, 4}, ValueType::float32, 4, false};
  const ReadImageResult read = read_series(files_, options);
  EXPECT_EQ((image_as<float, 4>(read.image).values[24 + 5]), 105);
  expect_layers_of(read.image, open_series(files_, options).layers);
  files_.resize(1);
  EXPECT_EQ((image_as<float, 3>(read_series(files_, options).image).values[5]), 5);
}

TEST_F(Series, OfFilesThatDoNotFitNamesTheFileAndWhatDiffers) {
  const std::string first = nrrd({2, 3, 4}, 0, "spacings: 1 1 2\nunits: \"mm\" \"mm\" \"mm\"\n");
  const auto refuse = [&](const std::string& second, const std::vector<std::string>& parts) {
    files_.clear();
    add("a.nrrd", first);
    add("b.nrrd", second);
    std::vector<std::string> all = parts;
    all.push_back(files_[1].string());
    all.push_back(files_[0].string());
    expect_refused(ErrorCode::UnsupportedData, all);
  };
  const std::string units = "units: \"mm\" \"mm\" \"mm\"\n";
  refuse(nrrd({2, 3, 5}, 0, "spacings: 1 1 2\n" + units), {"2 x 3 x 5", "2 x 3 x 4"});
  refuse(nrrd({2, 3}, 0), {"2 x 3 samples", "2 x 3 x 4"});
  refuse(nrrd({2, 3, 4}, 0, "spacings: 1 1 2.1\n" + units), {"other steps", "'z'", "2.1"});
  refuse(nrrd({2, 3, 4}, 0, "spacings: 1 1 2\naxis mins: 0 0.5 0\n" + units), {"origin 0.5", "'y'", "expected 0"});
  refuse(nrrd({2, 3, 4}, 0, "spacings: 1 1 2\n" + units, "ushort"), {"uint16", "int16"});
  refuse(nrrd({2, 3, 4}, 0, "spacings: 1 1 2\nunits: \"mm\" \"mm\" \"cm\"\n"), {"'cm'", "'mm'"});
  refuse(nrrd({2, 3, 4}, 0, "spacings: 1 1 2\nsample units: \"K\"\n" + units), {"'K'"});
  refuse(nrrd({2, 3, 4}, 0,
              "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,2)\nspace origin: (0,0,0)\n"),
         {"frame", "LPS"});
}

TEST_F(Series, OfFilesThatAreTurnedOrShiftedInSpaceIsRefused) {
  const auto placed = [](const std::string& directions, const std::string& origin) {
    return nrrd({2, 3, 4}, 0,
                "space: left-posterior-superior\nspace directions: " + directions + "\nspace origin: " + origin + "\n");
  };
  add("a.nrrd", placed("(0.8,0.6,0) (-0.6,0.8,0) (0,0,2)", "(0,0,0)"));
  add("b.nrrd", placed("(0.6,0.8,0) (-0.8,0.6,0) (0,0,2)", "(0,0,0)"));
  expect_refused(ErrorCode::UnsupportedData, {"b.nrrd", "orientation"});
  add("b.nrrd", placed("(0.8,0.6,0) (-0.6,0.8,0) (0,0,2)", "(0,1,0)"));
  expect_refused(ErrorCode::UnsupportedData, {"b.nrrd"});
  add("b.nrrd", placed("(0.80000001,0.6,0) (-0.6,0.8,0) (0,0,2)", "(0,1e-7,0)"));
  EXPECT_EQ(read_series(files_).image.index(), 2U);  // writers' rounding errors are tolerated
}

TEST_F(Series, OfFourAxesIsReadToFiveOnly) {
  for (const char* const name : {"a.nrrd", "b.nrrd"}) add(name, nrrd({2, 2, 2, 2}, 0));
  expect_refused(ErrorCode::UnsupportedData, {"a.nrrd", "image of 5 axes", "5 for contours"});
  const auto read = read_series_to_5d(files_, SeriesOptions{});
  ASSERT_TRUE(std::holds_alternative<ReadSeries5dResult>(read));
}

TEST_F(Series, OptionsThatDoNotFitAreRefused) {
  expect_refused(ErrorCode::InvalidArgument, {"no files"});
  add_three();
  SeriesOptions options;
  options.coordinates = {0, 1};
  expect_refused(ErrorCode::InvalidArgument, {"2 coordinates for 3 files"}, options);
  options.coordinates = {0, 2, 2};
  expect_refused(ErrorCode::InvalidArgument, {"frame_2.nrrd", "lies at 2", "ascending"}, options);
  options.step = 1;
  expect_refused(ErrorCode::InvalidArgument, {"one of the two"}, options);
  options.coordinates = {};
  options.step = 0;
  expect_refused(ErrorCode::InvalidArgument, {"step of 0"}, options);
  options.step = 1e-320;
  expect_refused(ErrorCode::InvalidArgument, {"step of 1e-320", "2.2e-308"}, options);
  options = {};
  options.order = SeriesOrder::coordinate;
  expect_refused(ErrorCode::UnsupportedData, {"has no coordinate along a further axis"}, options);
}

TEST_F(Series, DamagedFilesAreNamed) {
  add_three();
  write_file(files_[1], nrrd({2, 3, 4}, 0).substr(0, 100));
  expect_error(ErrorCode::MalformedFile, {"frame_1.nrrd"}, [&] { read_series(files_); });
  write_file(files_[1], nrrd({2, 3, 4}, 0));
  files_.push_back(dir_ / "none.nrrd");
  expect_refused(ErrorCode::FileNotFound, {"none.nrrd"});
}

TEST_F(Series, TellsItsProgressAndCanBeStopped) {
  add_three();
  std::vector<double> told;
  SeriesOptions options;
  options.work.progress = [&](double share) {
    told.push_back(share);
    return true;
  };
  read_series(files_, options);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
  options.work.progress = [](double share) { return share < 0.5; };
  expect_error(ErrorCode::Cancelled, {}, [&] { read_series(files_, options); });
}

TEST(NaturalOrder, CountsRunsOfDigitsAsNumbers) {
  std::vector<std::string> names = {"f10", "f9", "f2b", "f2a10", "f2a9", "f", "f02", "f2", "g1", "e100"};
  std::sort(names.begin(), names.end(), natural_less);
  EXPECT_THAT(names, ElementsAreArray({"e100", "f", "f02", "f2", "f2a9", "f2a10", "f2b", "f9", "f10", "g1"}));
  for (const std::string& a : names) EXPECT_FALSE(natural_less(a, a));
  EXPECT_TRUE(natural_less("a99999999999999999999998", "a99999999999999999999999"));
}

class SeriesRequests : public Series {
 protected:
  [[nodiscard]] SeriesOptions options(const SeriesRequest& request) const {
    return series_options(files_, request, {"TIMES", "STEP", "UNIT", "SORT", "SORT time", "SORT name", "SORT given"});
  }
  void expect_refused_in_words(const std::vector<std::string>& parts, const SeriesRequest& request) const {
    expect_error(ErrorCode::InvalidArgument, parts, [&] { (void)options(request); });
  }
};

TEST_F(SeriesRequests, BecomeOptions) {
  add_three();
  SeriesRequest request;
  EXPECT_EQ(options(request).order, SeriesOrder::given);
  request.variable = "v";
  request.times = {5, 6, 4};
  request.time_unit = "s";
  request.sort = SeriesOrder::by_name;
  EXPECT_THAT(options(request).coordinates, ElementsAre(5, 6, 4));
  EXPECT_EQ(options(request).variable, "v");
  EXPECT_EQ(options(request).unit, "s");
  EXPECT_EQ(options(request).order, SeriesOrder::by_name);
  request.times.reset();
  request.time_step = -2;
  EXPECT_EQ(options(request).step, -2);
}

TEST_F(SeriesRequests, ThatMakeNoSenseAreRefusedInTheCallersWords) {
  add_three();
  SeriesRequest request;
  request.times = {1, 2};
  expect_refused_in_words({"TIMES has 2 numbers for 3 files"}, request);
  request.times = std::vector<double>();
  expect_refused_in_words({"TIMES has 0 numbers for 3 files"}, request);
  request.times = {1, 2, 3};
  request.time_step = 1;
  expect_refused_in_words({"TIMES with STEP"}, request);
  request.times.reset();
  request.sort = SeriesOrder::coordinate;
  expect_refused_in_words({"SORT time with STEP"}, request);
  request.time_step = 0;
  request.sort = SeriesOrder::by_name;
  expect_refused_in_words({"STEP is 0"}, request);
  files_.resize(1);
  expect_refused_in_words({"STEP with one file, ", "frame_0.nrrd"}, request);
}

TEST_F(SeriesRequests, OfFilesAsAShellListsThemAskForTheOrderThatIsMeant) {
  for (const int k : {1, 10, 2}) add("frame_" + std::to_string(k) + ".nrrd", nrrd({2, 2, 2}, k));
  expect_refused_in_words({"frame_10.nrrd comes before ", "frame_2.nrrd", "SORT name", "SORT given"}, {});
  SeriesRequest request;
  request.sort = SeriesOrder::given;
  EXPECT_NO_THROW((void)options(request));
}

}  // namespace
}  // namespace tegl::test
