// SPDX-License-Identifier: BSD-3-Clause
//
// Malicious image files: each is refused with a message that has the actual and the expected value, with little time
// and memory.
#include <cstdlib>

#include "images/nifti_files.hpp"
#include "images/npy_files.hpp"
#include "io_support.hpp"
#include "process/limited_child.hpp"

namespace tegl::test {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

/// Reads an image in a child process and expects an error for which the program's exit code is 4. `held`: bytes of
/// samples that the file contains.
void expect_image_refused(const fs::path& path, const std::vector<std::string>& parts, std::uint64_t held = 0) {
  SCOPED_TRACE(path.filename());
  const ChildResult result = in_limited_child([&] { read_image(path); });
  EXPECT_EQ(result.signal, 0);
  ASSERT_TRUE(result.code.has_value()) << "no tegl::Error: " << result.message;
  const std::vector<ErrorCode> bad_input = {ErrorCode::MalformedFile, ErrorCode::UnsupportedFormat,
                                            ErrorCode::UnsupportedData, ErrorCode::InvalidGrid, ErrorCode::TooLarge};
  EXPECT_THAT(bad_input, testing::Contains(*result.code)) << result.message;
  EXPECT_THAT(result.message, testing::HasSubstr(path.filename().string()));
  EXPECT_LT(result.message.size(), 600U);
  for (const std::string& part : parts) EXPECT_THAT(result.message, testing::HasSubstr(part));
  if (kHasSanitizer) return;
  EXPECT_LT(result.seconds, 1.0);
  EXPECT_LT(result.peak_bytes, 2 * (held + fs::file_size(path)) + 16 * kMebibyte);
}

/// A hostile file: name, content, and parts of the error message.
struct Hostile {
  std::string name;
  std::string bytes;
  std::vector<std::string> parts;
};

void expect_all_refused(const std::vector<Hostile>& files) {
  TempDir dir;
  for (const Hostile& file : files) {
    write_file(dir / file.name, file.bytes);
    expect_image_refused(dir / file.name, file.parts);
  }
}

std::string meta(const std::string& fields, const std::string& samples, const std::string& sizes = "2 2") {
  return "NDims = 2\n" + fields + "DimSize = " + sizes + "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
         samples;
}
const std::string kBinary = "BinaryData = True\n";
const std::string kText = "BinaryData = False\n";

TEST(HostileImages, NumPy) {
  const std::string little_data(1000, '\0');
  const std::string large = npy("|u1", "1000, 1000, 1000", little_data);
  std::string long_header = npy("|u1", "10, 100", little_data);
  long_header[6] = 2;  // the length has four bytes, of which two are blanks and letters
  // an archive whose entry claims a gigabyte
  std::string bomb = zip({{"a.npy", large, true}});
  const std::size_t entry = bomb.find("PK\1\2");
  bomb.replace(entry + 24, 4, little(1'000'000'128, 4));
  // thousands of entries for one member
  const std::string one = zip({{"a.npy", npy("<U3", "2, 2", std::string(48, 'a'))}});
  const std::size_t start = one.find("PK\1\2"), end = one.find("PK\5\6");
  std::string many = one.substr(0, start);
  for (int i = 0; i < 1000; ++i) many += one.substr(start, end - start);
  many += one.substr(end, 8) + little(1000, 2) + little(1000, 2) + little(1000 * (end - start), 4) + little(start, 4) +
          little(0, 2);
  expect_all_refused({
      {"large.npy", large, {"1000 bytes of data", "expected 1000000000"}},
      {"header.npy", long_header, {"header of", "at most 1048576"}},
      {"nested.npy", npy_with(std::string(60'000, '{'), ""), {"expected '"}},
      {"axes.npy", npy("|u1", repeated("1, ", 100), "1"), {"whole numbers"}},
      {"large.npz", zip({{"a.npy", large, true}}), {"1000 bytes of data", "expected 1000000000"}},
      {"bomb.npz", bomb, {"of data", "expected"}},
      {"many.npz", many, {"no array", "1000 members"}},
  });
}

TEST(HostileImages, MetaImage) {
  const std::string zipped = compressed("1234", true);
  expect_all_refused({
      {"name300.mha", meta(kBinary + "Name = " + std::string(300, 'A') + "\n", "1234"), {"'Name'", "300 bytes", "254"}},
      {"comment300.mha", meta(kBinary + "Comment = " + std::string(300, 'A') + "\n", "1234"), {"'Comment'", "254"}},
      {"key255.mha", meta(kBinary + std::string(255, 'K') + " = 1\n", "1234"), {"'KKKK", "255 bytes", "at most 254"}},
      {"matrix.mha",
       meta(kBinary + "TransformMatrix = " + repeated("1 ", 5000) + "\n", "1234"),
       {"9999 bytes", "4096"}},
      {"cds.mha",
       meta(kBinary + "CompressedData = True\nCompressedDataSize = -1\n", zipped),
       {"CompressedDataSize is -1", "expected"}},
      {"cds_long.mha",
       meta(kBinary + "CompressedData = True\nCompressedDataSize = 999\n", zipped),
       {std::to_string(zipped.size()) + " bytes of compressed data; expected 999"}},
      {"cds_short.mha", meta(kBinary + "CompressedData = True\nCompressedDataSize = 5\n", zipped), {"ends early"}},
      {"text_stop.mha", meta(kText, "1 2 - 4 5 6 7 8 9", "3 3"), {"sample 2 is '-'", "from 0 to 255 (uint8)"}},
      {"text_300.mha", meta(kText, "1 2 3 4 5 6 7 8 300", "3 3"), {"sample 8 is '300'", "from 0 to 255 (uint8)"}},
      {"text_minus.mha", meta(kText, "1 2 -5 4", "2 2"), {"sample 2 is '-5'", "from 0 to 255"}},
      {"text_half.mha", meta(kText, "1 2.5 3 4", "2 2"), {"sample 1 is '2.5'", "whole numbers"}},
      {"text_few.mha", meta(kText, "1 2 3", "2 2"), {"3 numbers of data; expected 4 for 2 x 2"}},
      {"text_many.mha", meta(kText, "1 2 3 4 5", "2 2"), {"'5' after the last number; expected 4"}},
      {"order.mha",
       meta(kBinary + "BinaryDataByteOrderMSB = True\nElementByteOrderMSB = False\n", "1234"),
       {"BinaryDataByteOrderMSB is True", "expected the same"}},
  });
}

std::string nrrd(const std::string& fields, const std::string& encoding, const std::string& samples,
                 const std::string& sizes = "2 2", const std::string& type = "uchar") {
  return "NRRD0004\ntype: " + type + "\ndimension: 2\nsizes: " + sizes + "\n" + fields + "encoding: " + encoding +
         "\n\n" + samples;
}

TEST(HostileImages, Nrrd) {
  const std::string space = "space dimension: 2\nspace directions: (1,0) (0,1)\n";
  expect_all_refused({
      {"labels1000.nrrd",
       nrrd("labels: " + repeated("\"a\" ", 1000) + "\n", "raw", "1234"),
       {"1000 strings in labels", "expected 2"}},
      {"labels1.nrrd", nrrd("labels: \"a\"\n", "raw", "1234"), {"1 strings in labels; expected 2"}},
      {"labels_open.nrrd",
       nrrd("labels: \"" + std::string(1000, 'a') + "\n", "raw", "1234"),
       {"no closing quotation mark"}},
      {"labels_slow.nrrd",
       nrrd("labels: \"" + std::string(1000000, 'a') + "\" \"b\"\n", "raw", "1234"),
       {"string 0 of labels", "1024"}},
      {"labels_bare.nrrd", nrrd("labels: a b\n", "raw", "1234"), {"labels with 'a b'", "quotation marks"}},
      {"units.nrrd", nrrd("units: " + repeated("\"a\" ", 1000) + "\n", "raw", "1234"), {"1000 strings in units"}},
      {"space_units.nrrd",
       nrrd(space + "space units: " + repeated("\"a\" ", 1000) + "\n", "raw", "1234"),
       {"1000 strings in spaceunits", "expected 2"}},
      {"frame.nrrd",
       nrrd(space + "measurement frame: " + repeated("(1,0) ", 1000) + "\n", "raw", "1234"),
       {"measurement frame of 1000 vectors; expected 2"}},
      {"thicknesses.nrrd", nrrd("thicknesses: " + repeated("1 ", 1000) + "\n", "raw", "1234"), {"1000 thicknesses"}},
      {"kinds.nrrd", nrrd("kinds: " + repeated("domain ", 1000) + "\n", "raw", "1234"), {"1000 kinds"}},
      {"old_min.nrrd", nrrd("old min: one\n", "raw", "1234"), {"oldmin 'one'; expected a number"}},
      {"ascii1100.nrrd",
       nrrd("", "ascii", std::string(1100, '1') + " 2 3 4"),
       {"more than 1000 characters without a blank ('1111"}},
      {"ascii300.nrrd", nrrd("", "ascii", "1 2 3 300"), {"sample 3 is '300'", "from 0 to 255 (uint8)"}},
      {"ascii_signs.nrrd", nrrd("", "ascii", "1 2 3 +-5", "2 2", "short"), {"sample 3 is '+-5'"}},
      {"spacing_signs.nrrd", nrrd("spacings: 1 +-1\n", "raw", "1234"), {"spacings with '+-1'; expected numbers"}},
      {"spacing_inf.nrrd", nrrd("spacings: 1 inf\n", "raw", "1234"), {"spacings with 'inf'; expected finite numbers"}},
      {"ascii_big.nrrd", nrrd("", "ascii", "1 2 3 1e400", "2 2", "float"), {"sample 3 is '1e400'", "float"}},
      {"ascii_many.nrrd", nrrd("", "ascii", "1 2 3 4 x"), {"'x' after the last number; expected 4"}},
      {"hex_bad.nrrd", nrrd("", "hex", "0102030g"), {"'g' among the samples; expected hexadecimal digits"}},
      {"hex_many.nrrd", nrrd("", "hex", "010203045"), {"'5' after the last hexadecimal digit"}},
      {"endian.nrrd", nrrd("", "raw", "12345678", "2 2", "short"), {"without the field 'endian'"}},
      {"endian_both.nrrd",
       nrrd("endian: both\n", "raw", "12345678", "2 2", "short"),
       {"endian 'both'; expected 'little' or 'big'"}},
      {"skip.nrrd", nrrd("byte skip: -1\n", "gzip", compressed("1234")), {"byte skip -1 with encoding 'gzip'"}},
      {"spacing1e308.nrrd",
       nrrd("spacings: 1e308 1e308\n", "raw", "123456789", "3 3"),
       {"axis 0 of 3 samples", "in steps of 1e+308 ends at inf", "finite"}},
      {"directions.nrrd",
       nrrd("space dimension: 2\nspace directions: (1e308,1e308) (-1e308,1e308)\n", "raw", "123456789", "3 3"),
       {"expected"}},
      {"too_large.nrrd",
       nrrd("", "gzip", compressed(std::string(1000, '\0')), "40000 40000"),
       {"decompression, at most", "expected 1600000000"}},
  });
}

TEST(HostileImages, Nifti) {
  const auto big = NiftiHeader({1000, 1000, 200}, 64, 64).bytes();
  auto far = NiftiHeader({3, 3, 3}, 2, 8);
  far.sform({3e38F, 3e38F, 3e38F, 3e38F, 3e38F, 3e38F, 3e38F, 3e38F, 3e38F, 3e38F, 3e38F, 3e38F});
  expect_all_refused({
      {"short.nii", big, {"0 bytes of data; expected 1600000000"}},
      {"short.nii.gz", compressed(big + std::string(3000000, '\0')), {"expected 1600000352"}},
      {"offset.nii", NiftiHeader({2, 2, 2}, 2, 8).put<float>(108, 1e9F).bytes() + "12345678", {"0 bytes of data"}},
      {"singular.nii", far.bytes() + std::string(27, 'x'), {"independent directions"}},
  });
}

// ---- netCDF classic
// --------------------------------------------------------------------------------------------------

std::string big_endian(std::uint64_t value, std::size_t bytes) {
  std::string result;
  for (std::size_t i = bytes; i-- > 0;) result += static_cast<char>(value >> (8 * i));
  return result;
}

/// The header of a classic file with two dimensions and the variable v(y, x) of shorts, written field by field.
struct Classic {
  int version = 1;
  std::uint64_t records = 0;
  std::string variable = "v";
  std::string dimension = "y";
  std::uint64_t size = 2;
  std::uint64_t dimensions = 2;
  std::uint64_t rank = 2;
  std::uint64_t first_dimension = 0;
  std::uint64_t name_bytes = 0;  ///< length of the first dimension's name; 0: the actual one
  std::optional<std::uint64_t> begin = {};

  [[nodiscard]] std::string count(std::uint64_t value) const { return big_endian(value, version == 5 ? 8 : 4); }
  [[nodiscard]] std::string name(const std::string& text, std::uint64_t length = 0) const {
    return count(length == 0 ? text.size() : length) + text + std::string((4 - text.size() % 4) % 4, '\0');
  }
  [[nodiscard]] std::string bytes() const {
    std::string head = "CDF" + std::string(1, static_cast<char>(version)) + count(records);
    head += big_endian(10, 4) + count(dimensions) + name(dimension, name_bytes) + count(size) + name("x") + count(2);
    head += big_endian(0, 4) + count(0) + big_endian(11, 4) + count(1) + name(variable);
    head += count(rank) + count(first_dimension) + count(1) + big_endian(0, 4) + count(0) + big_endian(3, 4) + count(8);
    const std::size_t offset = version == 1 ? 4 : 8;
    const std::uint64_t end = head.size() + offset;
    return head + big_endian(begin.value_or(end), offset) + std::string("\0\1\0\2\0\3\0\4", 8);
  }
};

TEST(HostileImages, SoundClassicFilesOfTheTestAreRead) {
  TempDir dir;
  for (const int version : {1, 2, 5}) {
    write_file(dir / "a.nc", Classic{.version = version}.bytes());
    EXPECT_EQ((image_as<std::int16_t, 2>(read_image(dir / "a.nc").image).values),
              (std::vector<std::int16_t>{1, 2, 3, 4}));
    write_file(dir / "a.nc.gz", compressed(Classic{.version = version}.bytes()));
    EXPECT_EQ((image_as<std::int16_t, 2>(read_image(dir / "a.nc.gz").image).values.size()), 4U);
  }
}

TEST(HostileImages, NetCdfClassic) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  std::vector<Hostile> files;
  for (const int version : {1, 2, 5}) {
    const std::string end = std::to_string(version) + ".nc";
    const auto add = [&](const std::string& name, const Classic& file, const std::vector<std::string>& parts) {
      files.push_back({name + end, file.bytes(), parts});
    };
    add("var300", {.version = version, .variable = std::string(300, 'v')}, {"netCDF name of 300 bytes", "1 to 256"});
    add("dim300", {.version = version, .dimension = std::string(300, 'y')}, {"netCDF name of 300 bytes", "1 to 256"});
    add("empty_name", {.version = version, .dimension = ""}, {"netCDF name of 0 bytes"});
    add("many", {.version = version, .dimensions = 0x7fffffff}, {"announces 2147483647 dimensions"});
    add("rank", {.version = version, .rank = 0x7fffffff}, {"'v' has 2147483647 dimensions; expected at most 1024"});
    add("number", {.version = version, .first_dimension = 7}, {"dimension number 7; expected less than 2"});
    add("size", {.version = version, .size = 0x70000000}, {"'v' ends at byte", "the file's size"});
    add("begin", {.version = version, .begin = 8}, {"'v' begins at byte 8", "after the header"});
    add("end", {.version = version, .begin = 0x7ffffff0}, {"'v' ends at byte", "the file's size"});
    add("records", {.version = version, .records = 0x7fffffff, .size = 0}, {"'v' ends at byte", "the file's size"});
    add("open", {.version = version, .records = version == 5 ? kAll : 0xffffffffU, .size = 0},
        {"without a number of records"});
  }
  files.push_back({"name-1.nc", Classic{.version = 5, .name_bytes = kAll}.bytes(), {"netCDF name of -1 bytes"}});
  files.push_back({"size-1.nc", Classic{.version = 5, .size = kAll}.bytes(), {"'y' has size 18446744073709551615"}});
  files.push_back({"begin-1.nc", Classic{.version = 5, .begin = kAll - 3}.bytes(), {"'v' ends at byte"}});
  expect_all_refused(files);
}

// ---- bombs
// -----------------------------------------------------------------------------------------------------------

/// gzip of `start` and many zeros.
std::string bomb(const std::string& start, std::size_t zeros) { return compressed(start + std::string(zeros, '\0')); }

TEST(HostileImages, CompressedZerosBeyondTheImageCostNothing) {
  TempDir dir;
  constexpr std::size_t kZeros = std::size_t{64} << 20;
  write_file(dir / "bomb.nc.gz", bomb("CDF\1", kZeros));
  expect_image_refused(dir / "bomb.nc.gz", {"no variable"});
  write_file(dir / "bomb_hdf.nc.gz", bomb("\x89HDF\r\n\x1a\n", kZeros));
  expect_image_refused(dir / "bomb_hdf.nc.gz", {"HDF5 superblock"});
  write_file(dir / "bomb_any.nc.gz", bomb("", kZeros));
  expect_image_refused(dir / "bomb_any.nc.gz", {"starts with '\\x00"});
  // The images before the zeros can be read.
  write_file(dir / "bomb.nii.gz", bomb(NiftiHeader({2, 2, 2}, 2, 8).bytes(), kZeros));
  write_file(dir / "image.nc.gz", bomb(Classic{}.bytes(), kZeros));
  write_file(dir / "bomb.nrrd", nrrd("", "gzip", bomb("1234", kZeros)));
  write_file(dir / "bomb.mha", meta(kBinary + "CompressedData = True\n", bomb("1234", kZeros)));
  for (const char* name : {"bomb.nii.gz", "image.nc.gz", "bomb.nrrd", "bomb.mha"}) {
    SCOPED_TRACE(name);
    const ChildResult result = in_limited_child([&] { read_image(dir / name); });
    EXPECT_EQ(result.signal, 0);
    EXPECT_FALSE(result.code.has_value()) << result.message;
    if (kHasSanitizer) continue;
    EXPECT_LT(result.seconds, 0.5);
    EXPECT_LT(result.peak_bytes, 16 * kMebibyte);
  }
}

TEST(HostileImages, HeadersThatPromiseMoreThanTheStreamHasTakeNoMemory) {
  TempDir dir;
  // The header promises 200 MB, which deflate's ratio permits; the file contains 1 MB.
  std::mt19937 random(1);
  std::string noise(1 << 20, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  write_file(dir / "a.nrrd", nrrd("", "gzip", compressed(noise), "20000 10000"));
  expect_image_refused(dir / "a.nrrd", {"1048576 bytes of data after decompression; expected 200000000"}, noise.size());
  write_file(dir / "a.nii.gz", compressed(NiftiHeader({2000, 1000, 100}, 2, 8).bytes() + noise));
  expect_image_refused(dir / "a.nii.gz", {"expected 200000352"}, noise.size());
}

// ---- files that were found by mutation
// -------------------------------------------------------------------------------

TEST(HostileImages, OfTheSharedFolder) {
  const fs::path folder = fs::path(TEGL_SHARED_DATA_DIR) / "hostile";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  for (const char* name : {"name300.mha", "comment300.mha", "key255.mha", "cds.mha", "text_stop.mha", "text_300.mha",
                           "ascii300.nrrd", "ascii1100.nrrd", "labels1000.nrrd", "labels_open.nrrd", "labels_slow.nrrd",
                           "spacing1e308.nrrd", "var300.nc", "dim300.nc", "name-1.nc", "bomb1g.nc.gz"})
    expect_image_refused(folder / name, {});
}

}  // namespace
}  // namespace tegl::test
