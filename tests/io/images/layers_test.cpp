// SPDX-License-Identifier: BSD-3-Clause
//
// Images read layer by layer equal those read as a whole.
#include <netcdf.h>

#include <cstdlib>

#include "images/layers_support.hpp"
#include "images/netcdf_files.hpp"
#include "images/nifti_files.hpp"
#include "io_support.hpp"

namespace tegl::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

void expect_same(const fs::path& path) { expect_layers_of(read_image(path).image, open_layers(path).layers); }

enum class Order { time_first, time_last };

/// A variable t(7) y(4) x(5) of a type, with time at the position in `order`; stored in blocks of three time steps if
/// `blocks`.
void write_sample(const fs::path& path, int format, nc_type type, Order order, bool blocks, bool packed) {
  NcWriter file(path, format);
  const int t = file.dimension("time", 7);
  const int y = file.dimension("y", 4);
  const int x = file.dimension("x", 5);
  const auto dimensions = order == Order::time_first ? std::vector{t, y, x} : std::vector{y, x, t};
  const int v = file.variable("v", type, dimensions);
  if (packed) {
    file.number(v, "scale_factor", NC_DOUBLE, {0.25});
    file.number(v, "_FillValue", type, {7});
  }
  if (blocks) {
    const auto chunks =
        order == Order::time_first ? std::vector<std::size_t>{3, 2, 5} : std::vector<std::size_t>{4, 5, 3};
    NcWriter::ok(nc_def_var_chunking(file.id(), v, NC_CHUNKED, chunks.data()));
    NcWriter::ok(nc_def_var_deflate(file.id(), v, 1, 1, 1));
  }
  file.end();
  std::vector<double> values(7 * 4 * 5);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i * i % 101);
  file.values(v, values);
}

TEST(Layers, OfNetcdfAreTheImage) {
  const TempDir dir;
  for (const int format : {0, NC_64BIT_OFFSET, NC_NETCDF4})
    for (const Order order : {Order::time_first, Order::time_last})
      for (const nc_type type : {NC_BYTE, NC_SHORT, NC_INT, NC_FLOAT, NC_DOUBLE})
        for (const bool packed : {false, true}) {
          const bool blocks = format == NC_NETCDF4;
          SCOPED_TRACE(testing::Message() << "format " << format << ", type " << type << ", packed " << packed
                                          << ", time last " << (order == Order::time_last));
          write_sample(dir / "image.nc", format, type, order, blocks, packed);
          expect_same(dir / "image.nc");
        }
}

TEST(Layers, OfTheExampleAreTheImage) { expect_same(fs::path(TEGL_SOURCE_DIR) / "examples/data/ocean_temperature.nc"); }

TEST(Layers, OfAWholeFileThatIsCompressedAreRefused) {
  const TempDir dir;
  write_sample(dir / "plain.nc", 0, NC_FLOAT, Order::time_first, false, false);
  write_file(dir / "image.nc.gz", compressed(read_file(dir / "plain.nc")));
  const Error error = error_of([&] { open_layers(dir / "image.nc.gz"); });
  EXPECT_EQ(error.code(), ErrorCode::UnsupportedData);
  EXPECT_THAT(error.what(), AllOf(HasSubstr("image.nc.gz"), HasSubstr("layer by layer")));
}

TEST(Layers, OfNrrdAreTheImageInEveryEncoding) {
  const TempDir dir;
  const auto values = counting<std::int16_t>(120, -50);
  const std::string raw = bytes_of(values);
  std::string text;
  std::string hex;
  for (const int value : values) text += std::to_string(value) + "\n";
  for (const char byte : raw)
    for (const int nibble : {byte >> 4 & 15, byte & 15}) hex += "0123456789abcdef"[nibble];
  const std::string head =
      "NRRD0004\ntype: short\ndimension: 4\nsizes: 4 5 6 1\nendian: little\nspace: RAS\n"
      "space directions: (2,0,0) (0,3,1) (0,0,4) none\nspace origin: (1,2,3)\n";
  for (const auto& [encoding, bytes] :
       {std::pair<std::string, std::string>{"raw", raw}, {"gzip", compressed(raw)}, {"ascii", text}, {"hex", hex}}) {
    SCOPED_TRACE(encoding);
    write_file(dir / "a.nrrd", head + "encoding: " + encoding + "\n\n" + bytes);
    expect_same(dir / "a.nrrd");
    write_file(dir / "b.nhdr", head + "byte skip: 3\nencoding: " + encoding + "\ndata file: b.dat\n");
    write_file(dir / "b.dat", encoding == "gzip" ? compressed("   " + raw) : "   " + bytes);
    expect_same(dir / "b.nhdr");
    write_file(dir / "c.nrrd", head + "encoding: " + encoding + "\n\n" + bytes.substr(0, bytes.size() - 5));
    EXPECT_EQ(error_of([&] { expect_same(dir / "c.nrrd"); }).code(), ErrorCode::MalformedFile);
  }
  write_file(dir / "big.nrrd", "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 5 3\nendian: big\nencoding: raw\n\n" +
                                   std::string(120, 'x'));
  expect_same(dir / "big.nrrd");
}

TEST(Layers, OfListsOfImagesAreTheImageIfTheListIsTheLastAxis) {
  const TempDir dir;
  const std::string directions = "(1,0,0) (0,1,0) (0,0,1)";
  const auto write = [&](const std::string& sizes, const std::string& kinds, const std::string& axes) {
    write_file(dir / "a.nrrd", "NRRD0004\ntype: uchar\ndimension: 4\nsizes: " + sizes + "\nkinds: " + kinds +
                                   "\nspace: LPS\nspace directions: " + axes + "\nencoding: raw\n\n" +
                                   bytes_of(counting<std::uint8_t>(24)));
  };
  write("2 2 2 3", "domain domain domain list", directions + " none");
  expect_same(dir / "a.nrrd");
  write("3 2 2 2", "list domain domain domain", "none " + directions);
  expect_error(ErrorCode::UnsupportedData, {"a.nrrd", "list of images along axis 0 of 4", "layer by layer"},
               [&] { open_layers(dir / "a.nrrd"); });
}

TEST(Layers, OfMetaImageAreTheImage) {
  const TempDir dir;
  const auto values = counting<std::int16_t>(120, -50);
  const std::string raw = bytes_of(values);
  std::string text;
  for (const int value : values) text += std::to_string(value) + " ";
  const auto write = [&](const std::string& fields, const std::string& bytes) {
    write_file(dir / "a.mha", "NDims = 3\n" + fields +
                                  "Offset = 1 2 3\nElementSpacing = 2 3 4\nDimSize = 4 5 6\nElementType = MET_SHORT\n"
                                  "ElementDataFile = LOCAL\n" +
                                  bytes);
    expect_same(dir / "a.mha");
  };
  write("BinaryData = True\n", raw);
  write("BinaryData = True\nBinaryDataByteOrderMSB = True\n", raw);
  write("BinaryData = True\nCompressedData = True\n", compressed(raw, true));
  write("BinaryData = False\n", text);
}

TEST(Layers, OfNiftiAreTheImageScaledAndCompressedToo) {
  const TempDir dir;
  const std::string raw = bytes_of(counting<std::int16_t>(120, -50));
  for (const float slope : {0.0F, 0.5F}) {
    const std::string file =
        NiftiHeader({2, 3, 4, 5}, 4, 16).scaling(slope, 3).put<float>(108, 400).bytes() + std::string(48, 'e') + raw;
    write_file(dir / "a.nii", file);
    expect_same(dir / "a.nii");
    write_file(dir / "a.nii.gz", compressed(file));
    expect_same(dir / "a.nii.gz");
  }
}

TEST(Layers, OfCompressedFilesCanBeReadAgain) {
  const TempDir dir;
  const auto values = counting<std::uint8_t>(60);
  write_file(dir / "a.nrrd",
             "NRRD0004\ntype: uchar\ndimension: 2\nsizes: 6 10\nencoding: gzip\n\n" + compressed(bytes_of(values)));
  const OpenLayersResult opened = open_layers(dir / "a.nrrd");
  auto& layers = *std::get<std::unique_ptr<LayerReader<std::uint8_t, 2>>>(std::get<AnyLayersN<2>>(opened.layers));
  for (const std::size_t k : {std::size_t{2}, std::size_t{7}, std::size_t{3}, std::size_t{9}, std::size_t{0}}) {
    std::array<std::uint8_t, 6> row{};
    layers.read(k, row.data());
    EXPECT_TRUE(std::equal(row.begin(), row.end(), values.begin() + static_cast<std::ptrdiff_t>(6 * k))) << k;
  }
}

TEST(Layers, OfDamagedCompressedSamplesAreAnErrorAtTheLastLayer) {
  const TempDir dir;
  std::string bytes = compressed(bytes_of(counting<std::uint8_t>(60)));
  bytes[bytes.size() - 6] ^= 1;  // the checksum
  write_file(dir / "a.nrrd", "NRRD0004\ntype: uchar\ndimension: 2\nsizes: 6 10\nencoding: gzip\n\n" + bytes);
  const OpenLayersResult opened = open_layers(dir / "a.nrrd");
  auto& layers = *std::get<std::unique_ptr<LayerReader<std::uint8_t, 2>>>(std::get<AnyLayersN<2>>(opened.layers));
  std::array<std::uint8_t, 6> row{};
  layers.read(0, row.data());
  expect_error(ErrorCode::MalformedFile, {"a.nrrd", "damaged"}, [&] { layers.read(9, row.data()); });
}

TEST(Layers, OfRawValuesAreThoseOfTheFile) {
  const TempDir dir;
  OwnedImage<std::int16_t, 3> image{Grid<3>::unit({3, 4, 5}), {}};
  for (int i = 0; i < 60; ++i) image.values.push_back(static_cast<std::int16_t>(i * 521 - 9000));
  const std::array<const char*, 3> names = {"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) image.grid.axes[a].name = names[a];
  std::string bytes = bytes_of(image.values);
  write_file(dir / "little.raw", "header" + bytes);
  for (std::size_t i = 0; i < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
  write_file(dir / "big.raw", bytes + "rest");
  const AnyImage any = AnyImageN<3>(image);
  expect_layers_of(any, open_raw_layers(dir / "little.raw", {{3, 4, 5}, ValueType::int16, 6, false}).layers);
  expect_layers_of(any, open_raw_layers(dir / "big.raw", {{3, 4, 5}, ValueType::int16, 0, true}).layers);
  // a trailing axis of one sample is dropped
  expect_layers_of(any, open_raw_layers(dir / "big.raw", {{3, 4, 5, 1}, ValueType::int16, 0, true}).layers);
}

TEST(Layers, ThatCannotBeReadAreNamed) {
  TempDir dir;
  write_file(dir / "a.raw", std::string(100, 'x'));
  OpenLayersResult opened = open_raw_layers(dir / "a.raw", {{10, 10}, ValueType::uint8});
  fs::resize_file(dir / "a.raw", 75);
  auto& layers = *std::get<std::unique_ptr<LayerReader<std::uint8_t, 2>>>(std::get<AnyLayersN<2>>(opened.layers));
  std::array<std::uint8_t, 10> row;
  layers.read(6, row.data());
  expect_error(ErrorCode::MalformedFile, {"a.raw", "(layer 7)"}, [&] { layers.read(7, row.data()); });
}

TEST(Layers, OfRawValuesThatCannotBeAreRefused) {
  const TempDir dir;
  write_file(dir / "values.raw", std::string(100, 'x'));
  const auto error = [&](const RawLayout& layout) {
    return error_of([&] { open_raw_layers(dir / "values.raw", layout); });
  };
  EXPECT_EQ(error({{10, 11}, ValueType::uint8}).code(), ErrorCode::MalformedFile);
  EXPECT_THAT(error({{10, 11}, ValueType::uint8}).what(), AllOf(HasSubstr("100 bytes"), HasSubstr("110")));
  EXPECT_EQ(error({{10, 10}, ValueType::uint8, 1}).code(), ErrorCode::MalformedFile);
  EXPECT_EQ(error({{10, 10}, ValueType::uint8, ~std::uint64_t{0}}).code(), ErrorCode::MalformedFile);
  EXPECT_EQ(error({{10, 0}, ValueType::uint8}).code(), ErrorCode::InvalidArgument);
  EXPECT_EQ(error({{100}, ValueType::uint8}).code(), ErrorCode::InvalidArgument);
  EXPECT_EQ(error({{2, 2, 5, 5, 1, 1}, ValueType::uint8}).code(), ErrorCode::InvalidArgument);
  // five axes are read as a whole only
  EXPECT_EQ(error({{2, 2, 1, 5, 5}, ValueType::uint8}).code(), ErrorCode::UnsupportedData);
  EXPECT_THAT(error({{5, 5}, ValueType::uint32}).what(), AllOf(HasSubstr("'uint32'"), HasSubstr("uint16")));
  EXPECT_EQ(error({{5, 5}, ValueType::int64}).code(), ErrorCode::InvalidArgument);
  EXPECT_THAT(error({.sizes = {5, 5}}).what(), HasSubstr("no type of values; expected uint8"));
  RawLayout layout{{5, 5}, ValueType::uint8};
  layout.spacing = {1.0};
  EXPECT_THAT(error(layout).what(), HasSubstr("spacings of 1 axes, and sizes of 2"));
  layout.spacing = {1.0, 0.0};
  EXPECT_THAT(error(layout).what(), HasSubstr("a spacing of 0"));
  layout.spacing = {1.0, 1e308};
  layout.origin = {0.0, 1e308};
  EXPECT_THAT(error(layout).what(), HasSubstr("expected coordinates that are finite and differ"));
  layout.spacing = {1.0, 1.0};
  layout.origin = {0.0, 1e30};
  EXPECT_THAT(error(layout).what(), HasSubstr("expected coordinates that are finite and differ"));
  layout.origin = {};
  layout.axis_units = {"mm"};
  EXPECT_THAT(error(layout).what(), HasSubstr("units of 1 axes"));
}

TEST(Layers, OfRawValuesHaveTheAxesOfTheirLayout) {
  const TempDir dir;
  write_file(dir / "values.raw", std::string(100, 'x'));
  RawLayout layout{{10, 10}, ValueType::uint8};
  layout.spacing = {0.5, -2.0};
  layout.origin = {3.0, 4.0};
  layout.axis_names = {"a", ""};
  layout.axis_units = {"mm", "s"};
  const OpenLayersResult opened = open_raw_layers(dir / "values.raw", layout);
  const auto& layers = std::get<std::unique_ptr<LayerReader<std::uint8_t, 2>>>(std::get<AnyLayersN<2>>(opened.layers));
  const Grid<2>& grid = layers->grid();
  EXPECT_EQ(grid.axes[0][9], 7.5);
  EXPECT_EQ(grid.axes[1][9], -14.0);
  EXPECT_EQ(grid.axes[0].name, "a");
  EXPECT_EQ(grid.axes[1].name, "y");
  EXPECT_EQ(grid.axes[0].unit, "mm");
  EXPECT_EQ(grid.axes[1].unit, "s");
}

}  // namespace
}  // namespace tegl::test
