// SPDX-License-Identifier: BSD-3-Clause
//
// MetaImage: attached and detached data, compression, text, geometry computed by hand, and malformed headers.
#include <cmath>
#include <limits>

#include "io_support.hpp"

namespace tegl::test {
namespace {

std::string header(const std::string& lines, const std::string& type = "MET_SHORT") {
  return "ObjectType = Image\nNDims = 3\n" + lines + "DimSize = 2 3 4\nElementType = " + type + "\nElementDataFile = ";
}
const std::string kBinary = "BinaryData = True\nBinaryDataByteOrderMSB = False\n";

TEST(MetaImage, AttachedDetachedCompressedAndTextAreTheSame) {
  TempDir dir;
  const auto values = counting<std::int16_t>(24, -5);
  const std::string raw = bytes_of(values);
  const std::string zipped = compressed(raw, true);
  std::string text;
  for (const int value : values) text += std::to_string(value) + " ";
  const std::string pressed =
      kBinary + "CompressedData = True\nCompressedDataSize = " + std::to_string(zipped.size()) + "\n";
  write_file(dir / "a.mha", header(kBinary) + "LOCAL\n" + raw);
  write_file(dir / "b.mhd", header(kBinary) + "b.raw\n");
  write_file(dir / "b.raw", raw);
  write_file(dir / "c.mha", header(pressed) + "LOCAL\n" + zipped);
  write_file(dir / "d.mhd", header(pressed) + "d.zraw\n");
  write_file(dir / "d.zraw", zipped);
  write_file(dir / "e.mha", header("BinaryData = False\n") + "LOCAL\n" + text);
  write_file(dir / "f.mhd", header(kBinary + "HeaderSize = -1\n") + "f.raw\n");
  write_file(dir / "f.raw", "some header" + raw);
  for (const char* name : {"a.mha", "b.mhd", "c.mha", "d.mhd", "e.mha", "f.mhd"}) {
    SCOPED_TRACE(name);
    const auto [any, info] = read_image(dir / name);
    EXPECT_EQ((image_as<std::int16_t, 3>(any).values), values);
    EXPECT_EQ(info.format, "MetaImage");
    EXPECT_EQ(info.stored_type, ValueType::int16);
    EXPECT_EQ(info.world_frame, "");
  }
}

TEST(MetaImage, BigEndianFilesReadTheSame) {
  TempDir dir;
  std::string data;
  for (int i = 0; i < 24; ++i) data += {static_cast<char>(i), static_cast<char>(2 * i)};
  write_file(dir / "a.mha", header("BinaryData = True\nBinaryDataByteOrderMSB = True\n") + "LOCAL\n" + data);
  const auto values = image_as<std::int16_t, 3>(read_image(dir / "a.mha").image).values;
  for (int i = 0; i < 24; ++i) EXPECT_EQ(values[static_cast<std::size_t>(i)], 256 * i + 2 * i);
}

template <class Stored, class Read>
void expect_type(const std::string& keyword, const char* name) {
  SCOPED_TRACE(keyword);
  TempDir dir;
  write_file(dir / "a.mha", header(kBinary, keyword) + "LOCAL\n" + bytes_of(counting<Stored>(24, 3)));
  const auto [any, info] = read_image(dir / "a.mha");
  EXPECT_EQ((image_as<Read, 3>(any).values), counting<Read>(24, 3));
  EXPECT_EQ(info.stored_type, parse_value_type(name));
}

TEST(MetaImage, ReadsEveryNumericType) {
  expect_type<std::int8_t, std::int8_t>("MET_CHAR", "int8");
  expect_type<std::uint8_t, std::uint8_t>("MET_UCHAR", "uint8");
  expect_type<std::int16_t, std::int16_t>("MET_SHORT", "int16");
  expect_type<std::uint16_t, std::uint16_t>("MET_USHORT", "uint16");
  expect_type<std::int32_t, std::int32_t>("MET_INT", "int32");
  expect_type<std::uint32_t, std::int32_t>("MET_UINT", "uint32");
  expect_type<std::int64_t, std::int32_t>("MET_LONG_LONG", "int64");
  expect_type<std::uint64_t, std::int32_t>("MET_ULONG_LONG", "uint64");
  expect_type<float, float>("MET_FLOAT", "float");
  expect_type<double, double>("MET_DOUBLE", "double");
}

TEST(MetaImage, GeometryFollowsTheDirectionOfEachAxis) {
  TempDir dir;
  // Axis 0 runs along y, axis 1 along -x, axis 2 along z; steps 2, 3, 4; origin (10, 20, 30).
  write_file(dir / "a.mha", header(kBinary + "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\n"
                                             "ElementSpacing = 2 3 4\nAnatomicalOrientation = RAI\n") +
                                "LOCAL\n" + std::string(48, 'x'));
  const auto [any, info] = read_image(dir / "a.mha");
  const auto grid = image_as<std::int16_t, 3>(any).grid;
  EXPECT_EQ(world(grid, {1, 2, 3}), Eigen::Vector3d(4, 22, 42));
  EXPECT_EQ(info.world_frame, "LPS");
  EXPECT_EQ(grid.axes[0].unit, "mm");
}

TEST(MetaImage, ShortDataIsAnErrorNotZeros) {
  TempDir dir;
  const auto expect = [&](const std::string& fields, const std::string& data, const std::string& part) {
    write_file(dir / "a.mha", header(fields) + "LOCAL\n" + data);
    expect_unreadable(ErrorCode::MalformedFile, dir / "a.mha", {part});
  };
  expect(kBinary, std::string(47, 'x'), "47 bytes of data; expected 48");
  expect(kBinary + "CompressedData = True\n", compressed(std::string(40, 'x'), true),
         "40 bytes of data after decompression; expected 48");
  expect(kBinary + "CompressedData = True\n", compressed(std::string(48, 'x'), true).substr(0, 8), "ends early");
  expect(kBinary + "CompressedData = True\n", "not compressed at all", "damaged");
  expect("BinaryData = False\n", "1 2 3 4", "4 numbers of data; expected 24");
  expect("BinaryData = False\n", "1 2 three",
         "sample 2 is 'three'; expected whole numbers from -32768 to 32767 (int16)");
}

TEST(MetaImage, BrokenHeadersAreNamed) {
  TempDir dir;
  const auto expect = [&](ErrorCode code, const std::string& text, const std::string& part) {
    SCOPED_TRACE(text);
    write_file(dir / "a.mha", text + "\n" + std::string(64, 'x'));
    expect_unreadable(code, dir / "a.mha", {part});
  };
  const auto bad = [&](const std::string& text, const std::string& part) {
    expect(ErrorCode::MalformedFile, text, part);
  };
  bad("nonsense", "'nonsense'; expected 'Key = value'");
  bad("NDims = 0\nDimSize = 2\nElementType = MET_SHORT\nElementDataFile = LOCAL", "NDims is 0");
  bad("NDims = 3\nDimSize = 2 3\nElementType = MET_SHORT\nElementDataFile = LOCAL", "DimSize of 2 numbers; expected 3");
  bad("NDims = 2\nDimSize = 2 -3\nElementType = MET_SHORT\nElementDataFile = LOCAL", "'-3'");
  bad("NDims = 2\nDimSize = 2 3\nElementType = MET_WORD\nElementDataFile = LOCAL", "MET_WORD");
  bad("NDims = 2\nDimSize = 2 3\nElementDataFile = LOCAL", "without the field 'ElementType'");
  bad(header(kBinary + "ElementSpacing = 1 2\n") + "LOCAL", "ElementSpacing of 2 numbers; expected 3");
  bad(header(kBinary + "ElementSpacing = 1 0 2\n") + "LOCAL", "step of 0");
  bad(header(kBinary + "TransformMatrix = 1 0 0 1 0 0 0 0 1\n") + "LOCAL", "independent directions");
  bad(header("BinaryData = Maybe\n") + "LOCAL", "expected True or False");
  bad(header(kBinary + "NDims = 3\n") + "LOCAL", "twice");
  expect(ErrorCode::UnsupportedData, header(kBinary + "ElementNumberOfChannels = 3\n") + "LOCAL", "3 channels");
  expect(ErrorCode::UnsupportedData, "ObjectType = Mesh\nElementDataFile = LOCAL", "'Mesh'; expected Image");
  expect(ErrorCode::UnsupportedFormat, header(kBinary) + "LIST", "'LIST'");
  expect(ErrorCode::UnsupportedFormat, header(kBinary) + "slice%03d.raw 1 4 1",
         "expected LOCAL or the name of one file");
  write_file(dir / "b.mhd", header(kBinary) + "nowhere.raw\n");
  expect_error(ErrorCode::FileNotFound, {"nowhere.raw"}, [&] { read_image(dir / "b.mhd"); });
}

TEST(MetaImage, TextMayHaveFractionsExponentsAndPlusSigns) {
  TempDir dir;
  std::string text = "1e2 +3 -4.0 32767 -32768";
  for (int i = 5; i < 24; ++i) text += "\r\n7";
  write_file(dir / "a.mha", header("BinaryData = False\n") + "LOCAL\n" + text + "\n");
  const auto values = image_as<std::int16_t, 3>(read_image(dir / "a.mha").image).values;
  EXPECT_EQ(std::vector<std::int16_t>(values.begin(), values.begin() + 6),
            (std::vector<std::int16_t>{100, 3, -4, 32767, -32768, 7}));
  std::string reals = "nan -inf 1e-60 0.1";
  for (int i = 4; i < 24; ++i) reals += " 0";
  write_file(dir / "b.mha", header("BinaryData = False\n", "MET_FLOAT") + "LOCAL\n" + reals);
  const auto floats = image_as<float, 3>(read_image(dir / "b.mha").image).values;
  EXPECT_TRUE(std::isnan(floats[0]));
  EXPECT_EQ(floats[1], -std::numeric_limits<float>::infinity());
  EXPECT_EQ(floats[2], 0.0F);
  EXPECT_EQ(floats[3], 0.1F);
}

TEST(MetaImage, SamplesOutsideOfTheFolderAreReadOnlyIfAllowed) {
  TempDir dir;
  fs::create_directories(dir / "headers/below");
  const std::string raw = bytes_of(counting<std::int16_t>(24));
  const std::string outside = "../outside.raw";
  const std::string absolute = (dir / "outside.raw").string();
  write_file(dir / "outside.raw", raw);
  write_file(dir / "headers/below/inside.raw", raw);
  fs::create_symlink(dir / "outside.raw", dir / "headers/link.raw");
  fs::create_symlink("below/inside.raw", dir / "headers/good.raw");
  const fs::path file = dir / "headers/a.mhd";
  for (const std::string& name : {outside, absolute, std::string("link.raw"), std::string("below/../../outside.raw"),
                                  std::string("/etc/passwd")}) {
    SCOPED_TRACE(name);
    write_file(file, header(kBinary) + name + "\n");
    expect_unreadable(ErrorCode::UnsupportedData, file,
                      {name, "outside of the folder '" + (dir / "headers").string(), "allow_outside_paths"});
    ReadImageOptions options;
    options.allow_outside_paths = true;
    if (name != "/etc/passwd") {
      EXPECT_EQ((image_as<std::int16_t, 3>(read_image(file, options).image).values), counting<std::int16_t>(24));
    }
  }
  for (const char* name : {"below/inside.raw", "good.raw", "below/../good.raw"}) {
    SCOPED_TRACE(name);
    write_file(file, header(kBinary) + name + "\n");
    EXPECT_EQ((image_as<std::int16_t, 3>(read_image(file).image).values), counting<std::int16_t>(24));
  }
}

}  // namespace
}  // namespace tegl::test
