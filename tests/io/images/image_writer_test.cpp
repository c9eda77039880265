// SPDX-License-Identifier: BSD-3-Clause
//
// Images that are written are read back with the same values, coordinates, names and units.
#include "tegl/io/image_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "errors.hpp"
#include "fields.hpp"
#include "io_support.hpp"

namespace tegl::test {
namespace {

template <int N>
Grid<N> named_grid() {
  Grid<N> grid;
  constexpr std::array<std::size_t, 4> kSizes = {4, 3, 5, 2};
  constexpr std::array<const char*, 4> kNames = {"lon", "y \"2\"", "depth", "time"};
  for (std::size_t a = 0; a < N; ++a) {
    grid.axes[a] = Axis::uniform(kSizes[a], 0.1 * static_cast<double>(a) - 1, a == 1 ? -0.3 : 0.7);
    grid.axes[a].name = kNames[a];
    grid.axes[a].unit = a == 3 ? "s" : "mm";
  }
  return grid;
}

template <class T, int N>
void expect_same(const OwnedImage<T, N>& image, const ReadImageResult& read, double tolerance = 0) {
  const auto& any = std::get<AnyImageN<N>>(read.image);
  ASSERT_TRUE((std::holds_alternative<OwnedImage<T, N>>(any)));
  const auto& found = std::get<OwnedImage<T, N>>(any);
  ASSERT_EQ(found.values.size(), image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const auto wanted = static_cast<double>(image.values[i]);
    EXPECT_TRUE(found.values[i] == image.values[i] ||
                (std::isnan(wanted) && std::isnan(static_cast<double>(found.values[i]))))
        << i;
  }
  // the world coordinates of all samples along each axis
  for (int a = 0; a < N; ++a) {
    EXPECT_EQ(found.grid.axes[a].unit, image.grid.axes[a].unit);
    for (std::size_t i = 0; i < image.grid.axes[a].size(); ++i)
      for (int row = 0; row < N; ++row) {
        const auto at = [&](const Grid<N>& grid) {
          double sum = grid.offset[row];
          for (int b = 0; b < N; ++b) sum += grid.linear[row][b] * grid.axes[b][b == a ? i : 0];
          return sum;
        };
        EXPECT_NEAR(at(found.grid), at(image.grid), tolerance) << "axis " << a << " sample " << i;
      }
  }
}

template <int N>
void write_noise(const Grid<N>& grid, const fs::path& path, const ImageInfo& info = {}) {
  const auto image = noise<float, N>(grid, 1);
  write_image(image.view(), path, info);
}

class ImageWriter : public testing::Test {
 protected:
  [[nodiscard]] fs::path path(const std::string& name) const { return dir_ / name; }

 private:
  TempDir dir_;
};

TEST_F(ImageWriter, VtiGivesValuesAndCoordinatesBack) {
  const auto check = [&]<class T, int N>(OwnedImage<T, N> image) {
    for (Axis& axis : image.grid.axes) axis.unit = "";  // not written
    ImageInfo info;
    info.variable = "a \"<&> b";
    write_image(image.view(), path("a.vti"), info);
    const ReadImageResult read = read_image(path("a.vti"));
    expect_same(image, read, 1e-14);
    EXPECT_EQ(read.info.variable, info.variable);
  };
  check(noise<float, 2>(named_grid<2>(), 2));
  check(noise<double, 3>(named_grid<3>(), 3));
  check(noise<std::int16_t, 3>(named_grid<3>(), 4));
  check(noise<std::uint8_t, 3>(named_grid<3>(), 5));
  auto turned = noise<float, 3>(named_grid<3>(), 6);
  turned.grid.linear = {{{0.0, -2.0, 0.0}, {0.6, 0.0, 0.8}, {-0.8, 0.0, 0.6}}};
  turned.grid.offset = {10.0, -20.0, 0.5};
  check(turned);
  auto uneven = noise<float, 3>(named_grid<3>(), 7);
  uneven.grid.axes[0] = Axis::rectilinear({0.0, 1.0, 3.0, 4.0});
  expect_error(ErrorCode::UnsupportedData, "uneven steps", [&] { write_image(uneven.view(), path("b.vti")); });
  const auto film = noise<float, 4>(named_grid<4>(), 8);
  expect_error(ErrorCode::UnsupportedData, "4 axes", [&] { write_image(film.view(), path("b.vti")); });
  EXPECT_FALSE(fs::exists(path("b.vti")));
}

TEST_F(ImageWriter, NrrdAndNetcdfGiveTheImageBack) {
  for (const std::string name : {"a.nrrd", "a.nc"}) {
    const double tolerance = name == "a.nc" ? 0 : 1e-15;
    const auto check = [&]<class T, int N>(OwnedImage<T, N> image) {
      ImageInfo info;
      info.value_unit = "degC";
      info.value_name = "a long name";
      write_image(image.view(), path(name), info);
      const ReadImageResult read = read_image(path(name));
      expect_same(image, read, tolerance);
      EXPECT_EQ(read.info.value_unit, "degC");
      EXPECT_EQ(read.info.value_name, "a long name");
      return std::get<OwnedImage<T, N>>(std::get<AnyImageN<N>>(read.image)).grid.axes[0].name;
    };
    EXPECT_EQ(check(noise_with_missing<float, 3>(named_grid<3>(), 1, 0.2)), "lon");
    check(noise_with_missing<double, 4>(named_grid<4>(), 2, 0.2));
    check(noise<std::uint8_t, 2>(named_grid<2>(), 3));
    check(noise<std::int8_t, 3>(named_grid<3>(), 4));
    check(noise<std::uint16_t, 3>(named_grid<3>(), 5));
    check(noise<std::int16_t, 4>(named_grid<4>(), 6));
    check(noise<std::int32_t, 2>(named_grid<2>(), 7));
  }
}

TEST_F(ImageWriter, NrrdKeepsAWorldMapAndItsFrame) {
  Grid<4> grid = named_grid<4>();
  grid.linear[0] = {0.8, -0.6, 0, 0};
  grid.linear[1] = {0.6, 0.8, 0, 0};
  grid.offset = {10, -20, 30, 0};
  const auto image = noise<float, 4>(grid, 1);
  ImageInfo info;
  info.world_frame = "LPS";
  write_image(image.view(), path("a.nrrd"), info);
  const ReadImageResult read = read_image(path("a.nrrd"));
  expect_same(image, read, 1e-13);
  EXPECT_EQ(read.info.world_frame, "LPS");
  // without an oblique axis the frame is kept, too
  write_noise<3>(named_grid<3>(), path("b.nrrd"), info);
  EXPECT_EQ(read_image(path("b.nrrd")).info.world_frame, "LPS");
  // RAS is read as LPS: x and y change their signs
  info.world_frame = "RAS";
  write_noise<3>(named_grid<3>(), path("c.nrrd"), info);
  const auto found = read_image(path("c.nrrd"));
  EXPECT_EQ(found.info.world_frame, "LPS");
  const auto& ras = std::get<OwnedImage<float, 3>>(std::get<AnyImageN<3>>(found.image));
  EXPECT_NEAR(ras.grid.axes[0][1], 1 - 0.7, 1e-15);
  EXPECT_NEAR(ras.grid.axes[2][0], -0.8, 1e-15);
}

TEST_F(ImageWriter, FiveAxesGoThroughNrrdAndRawFiles) {
  Grid<5> grid = Grid<5>::unit({3, 4, 2, 3, 2});
  grid.axes[4] = Axis::uniform(2, -1.5, 0.25);
  grid.axes[4].name = "log2_sigma";
  const auto image = noise<float, 5>(grid, 1);
  ImageInfo info;
  for (const char* const frame : {"", "LPS"}) {
    info.world_frame = frame;
    write_image(image.view(), path("a.nrrd"), info);
    const std::vector<fs::path> files = {path("a.nrrd")};
    const auto read = std::get<ReadSeries5dResult>(read_series_to_5d(files));
    const auto& found = std::get<OwnedImage<float, 5>>(read.image);
    EXPECT_EQ(found.values, image.values);
    EXPECT_EQ(found.grid.axes[4].name, "log2_sigma");
    EXPECT_EQ(found.grid.axes[4][1], -1.25);
    EXPECT_EQ(found.grid.axes[2][1], 1.0);
    EXPECT_EQ(read.info.world_frame, frame);
  }
  expect_error(ErrorCode::UnsupportedData, "image of 5 axes (3 x 4 x 2 x 3 x 2)", [&] { read_image(path("a.nrrd")); });
  // others stay as they are
  write_noise<3>(named_grid<3>(), path("b.nrrd"));
  const std::vector<fs::path> three = {path("b.nrrd")};
  EXPECT_TRUE(std::holds_alternative<ReadSeriesResult>(read_series_to_5d(three)));
  // 32-bit values become double
  const std::vector<std::int32_t> values(32, (1 << 24) + 1);
  write_file(path("c.raw"), std::string(reinterpret_cast<const char*>(values.data()), values.size() * 4));
  const std::vector<fs::path> raw = {path("c.raw")};
  SeriesOptions options;
  options.raw = RawLayout{.sizes = {2, 2, 2, 2, 2}, .type = ValueType::int32};
  const auto whole = std::get<ReadSeries5dResult>(read_series_to_5d(raw, options));
  const auto& doubles = std::get<OwnedImage<double, 5>>(whole.image);
  EXPECT_EQ(doubles.values[31], (1 << 24) + 1);
}

TEST_F(ImageWriter, CellsStayCells) {
  ImageInfo info;
  info.samples_are_cells = true;
  for (const std::string name : {"a.nrrd", "a.vti"}) {
    const auto check = [&]<int N>(Grid<N> grid) {
      for (Axis& axis : grid.axes)
        if (name == "a.vti") axis.unit = "";
      const auto image = noise<float, N>(grid, 1);
      write_image(image.view(), path(name), info);
      const ReadImageResult read = read_image(path(name));
      expect_same(image, read, 1e-14);
      EXPECT_TRUE(read.info.samples_are_cells) << name;
    };
    check(named_grid<2>());
    check(named_grid<3>());
    if (name == "a.nrrd") check(named_grid<4>());
    info.world_frame = "LPS";
    check(named_grid<3>());
    info.world_frame = "";
  }
}

TEST_F(ImageWriter, LatticesAreRecorded) {
  const auto check = [&]<int N>(Grid<N> grid, Lattice lattice) {
    const auto image = noise<float, N>(grid, 1);
    ImageInfo info;
    info.lattice = lattice;
    for (const std::string name : {"a.nrrd", "a.nc"}) {
      write_image(image.view(), path(name), info);
      EXPECT_EQ(read_image(path(name)).info.lattice, lattice) << name;
      EXPECT_EQ(open_layers(path(name)).info.lattice, lattice) << name;
      EXPECT_EQ(read_image(path(name), {.separate_process = true}).info.lattice, lattice) << name;
    }
  };
  check(named_grid<2>(), Lattice::triangular);
  check(named_grid<3>(), Lattice::fcc);
  check(named_grid<3>(), Lattice::bcc);
  check(named_grid<4>(), Lattice::d4);
  check(named_grid<4>(), Lattice::fcc_in_time);
  // one time of fcc over time is fcc; other dimensions have none
  const ReadImageResult one = read_image(path("a.nc"), {.fixed = {{named_grid<4>().axes[3].name, 1}}});
  EXPECT_EQ(one.info.lattice, Lattice::fcc);
  expect_error(ErrorCode::UnsupportedData, "one index of a dimension of samples on the lattice fcc_in_time", [&] {
    (void)read_image(path("a.nc"), {.fixed = {{named_grid<4>().axes[0].name, 1}}});
  });
  // fcc files over time
  ImageInfo info;
  info.lattice = Lattice::fcc;
  std::vector<fs::path> files;
  const auto each = noise<float, 3>(named_grid<3>(), 1);
  for (const char* const name : {"t0.nrrd", "t1.nrrd"}) {
    files.push_back(path(name));
    write_image(each.view(), files.back(), info);
  }
  EXPECT_EQ(read_series(files).info.lattice, Lattice::fcc_in_time);
  info.lattice = Lattice::bcc;
  write_image(each.view(), files[1], info);
  expect_error(ErrorCode::UnsupportedData, "is on the lattice bcc; expected fcc", [&] { (void)read_series(files); });
  write_image(each.view(), files[0], info);
  expect_error(ErrorCode::UnsupportedData, "is on the lattice bcc, and one of several files",
               [&] { (void)read_series(files); });
}

TEST_F(ImageWriter, FormatsThatRecordLatticesGiveThemBack) {
  Grid<3> grid;
  for (Axis& axis : grid.axes) axis = Axis::uniform(4, 0.0, 1.0);
  const OwnedImage<float, 3> image{grid, Values<float>(64)};
  ImageInfo info;
  info.lattice = Lattice::bcc;
  for (const char* const name : {"a.nrrd", "a.nc", "a.cdf", "a.vti"}) {
    write_image(image.view(), path(name), info);
    EXPECT_EQ(read_image(path(name)).info.lattice.has_value(), records_lattice(path(name))) << name;
  }
  EXPECT_FALSE(records_lattice(path("a.vti")));
  EXPECT_FALSE(records_lattice(path("a.png")));
}

TEST_F(ImageWriter, WrongLatticesAreErrors) {
  const auto nrrd = [&](const std::string& key) {
    write_file(path("a.nrrd"), "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 2 2\nencoding: raw\n" + key + "\n\nabcd");
    return path("a.nrrd");
  };
  EXPECT_EQ(read_image(nrrd("sample_lattice:=triangular")).info.lattice, Lattice::triangular);
  EXPECT_EQ(read_image(nrrd("sample_lattice:=cubic")).info.lattice, std::nullopt);
  EXPECT_EQ(read_image(nrrd("lattice:=hexagonal")).info.lattice, std::nullopt);
  expect_error(ErrorCode::MalformedFile, "sample_lattice is 'hexagonal'; expected cubic, triangular, fcc",
               [&] { (void)read_image(nrrd("sample_lattice:=hexagonal")); });
  expect_error(ErrorCode::MalformedFile, "key 'sample_lattice' twice",
               [&] { (void)read_image(nrrd("sample_lattice:=cubic\nsample_lattice:=cubic")); });
  expect_error(ErrorCode::UnsupportedData, "has the lattice fcc, and is read as an image of 2 axes; expected 3",
               [&] { (void)read_image(nrrd("sample_lattice:=fcc")); });
}

TEST_F(ImageWriter, NetcdfKeepsUnevenAxesAndCalendars) {
  Grid<3> grid = named_grid<3>();
  grid.axes[0] = Axis::rectilinear({0, 1, 4, 9});
  grid.axes[0].name = "lon";
  grid.axes[2].name = "time";
  grid.axes[2].unit = "days since 2000-01-01 (noleap)";
  const auto image = noise<float, 3>(grid, 1);
  ImageInfo info;
  info.variable = "temp";
  info.axis_directions = {AxisDirection::unknown, AxisDirection::down, AxisDirection::unknown};
  write_image(image.view(), path("a.nc"), info);
  const ReadImageResult read = read_image(path("a.nc"));
  expect_same(image, read);
  EXPECT_EQ(read.info.variable, "temp");
  EXPECT_EQ(read.info.axis_directions[1], AxisDirection::down);
}

TEST_F(ImageWriter, RefusesWhatAFormatCannotHold) {
  Grid<3> uneven = named_grid<3>();
  uneven.axes[0] = Axis::rectilinear({0, 1, 4, 9});
  expect_error(ErrorCode::UnsupportedData, "axis 'x' has uneven steps, which NRRD cannot hold",
               [&] { write_noise<3>(uneven, path("a.nrrd")); });
  Grid<3> oblique = named_grid<3>();
  oblique.linear[0][1] = 0.5;
  expect_error(ErrorCode::UnsupportedData, "axis 'lon' is oblique, which netCDF cannot hold",
               [&] { write_noise<3>(oblique, path("a.nc")); });
  expect_error(ErrorCode::UnsupportedFormat, "extension '.png'; expected .nrrd, .nc or .vti",
               [&] { write_noise<3>(oblique, path("a.png")); });
  FunctionLayers<float, 3> failing(named_grid<3>(), [](std::size_t k, float* to) {
    if (k == 2) throw Error(ErrorCode::MalformedFile, "a source that fails");
    std::fill_n(to, 12, 0.0F);
  });
  for (const std::string name : {"b.nrrd", "b.nc"}) {
    expect_error(ErrorCode::MalformedFile, "a source that fails", [&] { write_layers(failing, path(name)); });
    EXPECT_FALSE(std::filesystem::exists(path(name)));
  }
  expect_error(ErrorCode::WriteFailed, "no_such_folder", [&] {
    write_noise<2>(Grid<2>::unit({2, 2}), path("no_such_folder/a.nc"));
  });
}

}  // namespace
}  // namespace tegl::test
