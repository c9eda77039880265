// SPDX-License-Identifier: BSD-3-Clause
//
// NRRD: encodings, detached data, spacings and spaces computed by hand, lists as time, and malformed headers.
#include "io_support.hpp"

namespace tegl::test {
namespace {

std::string nrrd_header(const std::string& lines) { return "NRRD0004\n" + lines; }

const std::string kSmall = "type: uint8\ndimension: 3\nsizes: 2 3 4\n";

TEST(Nrrd, EncodingsAllGiveTheSameValues) {
  TempDir dir;
  const auto values = counting<std::int16_t>(24, -5);
  const std::string raw = bytes_of(values);
  std::string text;
  std::string hex;
  for (const int value : values) text += std::to_string(value) + " ";
  for (const char byte : raw)
    for (const int nibble : {byte >> 4 & 15, byte & 15}) hex += "0123456789abcdef"[nibble];
  const std::string lines = "type: short\ndimension: 3\nsizes: 2 3 4\nendian: little\nencoding: ";
  for (const auto& [encoding, data] : {std::pair<std::string, std::string>{"raw", raw},
                                       {"gzip", compressed(raw)},
                                       {"gz", compressed(raw)},
                                       {"ascii", text},
                                       {"hex", hex}}) {
    SCOPED_TRACE(encoding);
    write_file(dir / "a.nrrd", nrrd_header(lines + encoding + "\n\n" + data));
    const auto [any, info] = read_image(dir / "a.nrrd");
    EXPECT_EQ((image_as<std::int16_t, 3>(any).values), values);
    EXPECT_EQ(info.format, "NRRD");
    EXPECT_EQ(info.stored_type, ValueType::int16);
    write_file(dir / "b.nhdr", nrrd_header(lines + encoding + "\ndata file: b.dat\n"));
    write_file(dir / "b.dat", data);
    EXPECT_EQ((image_as<std::int16_t, 3>(read_image(dir / "b.nhdr").image).values), values);
  }
}

TEST(Nrrd, BigEndianAndWideTypes) {
  TempDir dir;
  std::string data;
  for (const std::uint64_t value : {1U, 2U, 3U, 4000000000U})
    for (int shift = 56; shift >= 0; shift -= 8) data += static_cast<char>(value >> shift);
  write_file(dir / "a.nrrd",
             nrrd_header("type: unsigned long long\ndimension: 2\nsizes: 2 2\nendian: big\nencoding: raw\n\n" + data));
  const auto [any, info] = read_image(dir / "a.nrrd");
  EXPECT_THAT((image_as<double, 2>(any).values), testing::ElementsAre(1, 2, 3, 4000000000.0));
  EXPECT_EQ(info.stored_type, ValueType::uint64);
}

TEST(Nrrd, BigEndianSamplesOfManyBlocksInEveryEncoding) {
  TempDir dir;
  constexpr std::size_t kCount = 400 * 900;  // of 4 bytes: several blocks
  std::vector<std::int32_t> values(kCount);
  for (std::size_t i = 0; i < kCount; ++i) values[i] = static_cast<std::int32_t>(i * 2654435761U);
  std::string raw;
  for (const std::int32_t value : values)
    for (int shift = 24; shift >= 0; shift -= 8) raw += static_cast<char>(value >> shift);
  std::string hex;
  for (const char byte : raw)
    for (const int nibble : {byte >> 4 & 15, byte & 15}) hex += "0123456789abcdef"[nibble];
  for (const auto& [encoding, data] :
       {std::pair<std::string, std::string>{"raw", raw}, {"gzip", compressed(raw)}, {"hex", hex}}) {
    write_file(
        dir / "a.nrrd",
        nrrd_header("type: int\ndimension: 2\nsizes: 400 900\nendian: big\nencoding: " + encoding + "\n\n" + data));
    EXPECT_TRUE((image_as<std::int32_t, 2>(read_image(dir / "a.nrrd").image).values == values)) << encoding;
  }
}

TEST(Nrrd, SpacingsMinimaLabelsAndUnits) {
  TempDir dir;
  write_file(dir / "a.nrrd", nrrd_header("# comment\n" + kSmall +
                                         "spacings: 0.5 2 NaN\naxis mins: 10 NaN 5\naxis maxs: NaN NaN 11\n"
                                         "labels: \"lon\" \"\" \"a \\\"quoted\\\" name\"\nunits: \"deg\" \"km\" \"\"\n"
                                         "centers: cell node node\nkey:=any value: with colons\nencoding: raw\n\n" +
                                         std::string(24, 'x')));
  const auto grid = image_as<std::uint8_t, 3>(read_image(dir / "a.nrrd").image).grid;
  EXPECT_FALSE(grid.has_world_map());
  EXPECT_EQ(world(grid, {0, 0, 0}), Eigen::Vector3d(10.25, 0, 5));
  EXPECT_EQ(world(grid, {1, 2, 3}), Eigen::Vector3d(10.75, 4, 11));
  EXPECT_EQ(grid.axes[0].name, "lon");
  EXPECT_EQ(grid.axes[1].name, "y");
  EXPECT_EQ(grid.axes[2].name, "a \"quoted\" name");
  EXPECT_EQ(grid.axes[0].unit, "deg");
}

TEST(Nrrd, SpaceDirectionsAreExactAndTurnedToLps) {
  TempDir dir;
  const auto read = [&](const std::string& space) {
    write_file(dir / "a.nrrd", nrrd_header(kSmall + "space: " + space +
                                           "\nspace directions: (1,2,0) (0, 3,-1) (0.5,0,4)\nspace origin: (10,20,30)\n"
                                           "encoding: raw\n\n" +
                                           std::string(24, 'x')));
    return read_image(dir / "a.nrrd");
  };
  // Index (1, 2, 3): 1 (1,2,0) + 2 (0,3,-1) + 3 (0.5,0,4) + (10,20,30) = (12.5, 28, 40).
  const auto lps = read("left-posterior-superior");
  EXPECT_EQ(lps.info.world_frame, "LPS");
  const auto grid = image_as<std::uint8_t, 3>(lps.image).grid;
  EXPECT_EQ(grid.axes[0].unit, "mm");
  EXPECT_LT((world(grid, {1, 2, 3}) - Eigen::Vector3d(12.5, 28, 40)).norm(), 1e-13);
  const auto ras = read("RAS");
  EXPECT_EQ(ras.info.world_frame, "LPS");
  EXPECT_LT((world(image_as<std::uint8_t, 3>(ras.image).grid, {1, 2, 3}) - Eigen::Vector3d(-12.5, -28, 40)).norm(),
            1e-13);
  const auto las = read("left-anterior-superior");
  EXPECT_LT((world(image_as<std::uint8_t, 3>(las.image).grid, {1, 2, 3}) - Eigen::Vector3d(12.5, -28, 40)).norm(),
            1e-13);
  const auto other = read("3D-right-handed");
  EXPECT_EQ(other.info.world_frame, "");
  EXPECT_LT((world(image_as<std::uint8_t, 3>(other.image).grid, {1, 2, 3}) - Eigen::Vector3d(12.5, 28, 40)).norm(),
            1e-13);
}

TEST(Nrrd, TimeBesideSpaceStaysDecoupled) {
  TempDir dir;
  write_file(
      dir / "a.nrrd",
      nrrd_header("type: uint8\ndimension: 4\nsizes: 2 2 2 3\nspace: LPS\nkinds: domain domain domain time\n"
                  "space directions: (0,2,0) (2,0,0) (0,0,2) none\nspace origin: (1,1,1)\nspacings: NaN NaN NaN 0.5\n"
                  "units: \"\" \"\" \"\" \"s\"\nencoding: raw\n\n" +
                  std::string(24, 'x')));
  const auto grid = image_as<std::uint8_t, 4>(read_image(dir / "a.nrrd").image).grid;
  EXPECT_EQ(world(grid, {1, 0, 0, 2}), Eigen::Vector4d(1, 3, 1, 1));
  EXPECT_EQ(grid.axes[3].unit, "s");
  EXPECT_EQ(grid.axes[3].name, "t");
  EXPECT_EQ(grid.axes[0].unit, "mm");
}

TEST(Nrrd, ListOfImagesBecomesTheLastAxisWhereverItIs) {
  TempDir dir;
  // The value of sample (x, y, z) in image l is 8 l + its number.
  std::string first;
  std::string last;
  for (int i = 0; i < 8; ++i)
    for (int l = 0; l < 3; ++l) first += static_cast<char>(8 * l + i);
  for (int i = 0; i < 24; ++i) last += static_cast<char>(i);
  const std::string space = "space: LPS\nspace origin: (0,0,0)\nencoding: raw\n";
  const std::string directions = "(1,0,0) (0,1,0) (0,0,1)";
  write_file(dir / "a.nrrd",
             nrrd_header("type: uint8\ndimension: 4\nsizes: 3 2 2 2\nkinds: list domain domain domain\n" + space +
                         "space directions: none " + directions + "\n\n" + first));
  write_file(dir / "b.nrrd",
             nrrd_header("type: uint8\ndimension: 4\nsizes: 2 2 2 3\nkinds: domain domain domain list\n" + space +
                         "space directions: " + directions + " none\n\n" + last));
  for (const char* name : {"a.nrrd", "b.nrrd"}) {
    SCOPED_TRACE(name);
    const auto image = image_as<std::uint8_t, 4>(read_image(dir / name).image);
    EXPECT_EQ(image.grid.sizes(), (std::array<std::size_t, 4>{2, 2, 2, 3}));
    EXPECT_EQ(image.values, counting<std::uint8_t>(24));
    EXPECT_EQ(image.grid.axes[3].name, "t");
  }
}

TEST(Nrrd, SkipsLinesAndBytes) {
  TempDir dir;
  const std::string data = bytes_of(counting<std::uint8_t>(24));
  write_file(dir / "a.dat", "one\ntwo\n###" + data);
  write_file(dir / "a.nhdr", nrrd_header(kSmall + "encoding: raw\nline skip: 2\nbyte skip: 3\ndata file: a.dat\n"));
  EXPECT_EQ((image_as<std::uint8_t, 3>(read_image(dir / "a.nhdr").image).values), counting<std::uint8_t>(24));
  write_file(dir / "a.nhdr", nrrd_header(kSmall + "encoding: raw\nbyte skip: -1\ndata file: a.dat\n"));
  EXPECT_EQ((image_as<std::uint8_t, 3>(read_image(dir / "a.nhdr").image).values), counting<std::uint8_t>(24));
  write_file(dir / "a.nhdr", nrrd_header(kSmall + "encoding: raw\nline skip: 2\nbyte skip: 4\ndata file: a.dat\n"));
  expect_error(ErrorCode::MalformedFile, {"a.dat", "23 bytes of data; expected 24"},
               [&] { read_image(dir / "a.nhdr"); });
}

TEST(Nrrd, DataFilesOutsideOfTheFolderAreReadOnlyIfAllowed) {
  TempDir dir;
  fs::create_directories(dir / "headers/below");
  write_file(dir / "a.raw", bytes_of(counting<std::uint8_t>(24)));
  write_file(dir / "headers/below/b.raw", bytes_of(counting<std::uint8_t>(24)));
  const fs::path file = dir / "headers/a.nhdr";
  const auto write = [&](const std::string& name) {
    write_file(file, nrrd_header(kSmall + "encoding: raw\ndata file: " + name + "\n"));
  };
  fs::create_directory_symlink(dir.path(), dir / "headers/up");
  for (const std::string& name : {std::string("../a.raw"), (dir / "a.raw").string(), std::string("up/a.raw")}) {
    SCOPED_TRACE(name);
    write(name);
    expect_unreadable(ErrorCode::UnsupportedData, file, {name, (dir / "headers").string(), "allow_outside_paths"});
    expect_error(ErrorCode::UnsupportedData, {"allow_outside_paths"}, [&] { open_layers(file); });
    ReadImageOptions options;
    options.allow_outside_paths = true;
    EXPECT_EQ((image_as<std::uint8_t, 3>(read_image(file, options).image).values), counting<std::uint8_t>(24));
  }
  write("/etc/passwd");
  expect_unreadable(ErrorCode::UnsupportedData, file, {"/etc/passwd"});
  for (const std::string& name : {std::string("below/b.raw"), (dir / "headers/below/b.raw").string()}) {
    SCOPED_TRACE(name);
    write(name);
    EXPECT_EQ((image_as<std::uint8_t, 3>(read_image(file).image).values), counting<std::uint8_t>(24));
  }
}

TEST(Nrrd, MissingDataFileIsNamed) {
  TempDir dir;
  write_file(dir / "a.nhdr", nrrd_header(kSmall + "encoding: raw\ndata file: nowhere.raw\n"));
  expect_error(ErrorCode::FileNotFound, {"nowhere.raw", "no such file"}, [&] { read_image(dir / "a.nhdr"); });
}

TEST(Nrrd, ShortDataIsAnErrorNotZeros) {
  TempDir dir;
  const std::string text = "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23";
  const std::string zipped = compressed(std::string(24, 'x'));
  const auto expect = [&](const std::string& encoding, const std::string& data, const std::string& part) {
    SCOPED_TRACE(encoding);
    write_file(dir / "a.nrrd", nrrd_header(kSmall + "encoding: " + encoding + "\n\n" + data));
    expect_unreadable(ErrorCode::MalformedFile, dir / "a.nrrd", {part});
  };
  expect("raw", std::string(23, 'x'), "23 bytes of data; expected 24 for 2 x 3 x 4 samples of type uint8");
  expect("gzip", compressed(std::string(23, 'x')), "23 bytes of data after decompression; expected 24");
  expect("gzip", zipped.substr(0, zipped.size() - 3), "ends early");
  expect("gzip", "no gzip at all, really", "damaged");
  expect("ascii", text, "23 numbers of data; expected 24 for 2 x 3 x 4 samples of type uint8");
  expect("hex", std::string(47, 'a'), "47 bytes of data; expected 48");
}

TEST(Nrrd, BrokenHeadersAreNamed) {
  TempDir dir;
  const auto expect = [&](ErrorCode code, const std::string& lines, const std::string& part) {
    SCOPED_TRACE(lines);
    write_file(dir / "a.nrrd", nrrd_header(lines + "\n" + std::string(64, 'x')));
    expect_unreadable(code, dir / "a.nrrd", {part});
  };
  const auto bad = [&](const std::string& lines, const std::string& part) {
    expect(ErrorCode::MalformedFile, lines, part);
  };
  bad("type: uint8\ndimension: 3\nencoding: raw\n", "without the field 'sizes'");
  bad("type: uint8\ndimension: 2\nsizes: 2 3 4\nencoding: raw\n", "3 sizes ('2 3 4'); expected 2");
  bad("type: uint8\ndimension: 3\nsizes: 2 0 4\nencoding: raw\n", "size '0'");
  bad("type: uint8\ndimension: x\nsizes: 2 3 4\nencoding: raw\n", "dimension 'x'");
  bad("type: uint7\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n", "type 'uint7'");
  bad(kSmall + "encoding: raw\nflavour: vanilla\n", "'flavour: vanilla'");
  bad(kSmall + "encoding: raw\nnonsense\n", "'nonsense'");
  bad(kSmall + kSmall + "encoding: raw\n", "twice");
  bad(kSmall + "spacings: 1 2\nencoding: raw\n", "2 spacings; expected one for each of the 3 axes");
  bad(kSmall + "spacings: 1 b 3\nencoding: raw\n", "'b'");
  bad(kSmall + "space: mars\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nencoding: raw\n", "space 'mars'");
  bad(kSmall + "space: LPS\nencoding: raw\n", "without the field 'spacedirections'");
  bad(kSmall + "space: LPS\nspace directions: (1,0,0) (0,1,0)\nencoding: raw\n",
      "2 space directions; expected one for each");
  bad(kSmall + "space: LPS\nspace directions: (1,0) (0,1) (1,1)\nencoding: raw\n", "of 2 numbers; expected 3");
  bad(kSmall + "space: LPS\nspace directions: (1,0,0) (1,0,0) (0,0,1)\nencoding: raw\n", "independent directions");
  bad("type: double\ndimension: 3\nsizes: 100000 100000 100000\nencoding: raw\nendian: little\n",
      "expected 8000000000000000");
  expect(ErrorCode::TooLarge, "type: double\ndimension: 3\nsizes: 4294967296 4294967296 4294967296\nencoding: raw\n",
         "exceed any memory");
  expect(ErrorCode::UnsupportedFormat, kSmall + "encoding: bzip2\n", "encoding 'bzip2'");
  expect(ErrorCode::UnsupportedFormat, kSmall + "encoding: raw\ndata file: LIST\n", "data in several files");
  expect(ErrorCode::UnsupportedData, "type: block\nblock size: 3\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n",
         "block");
  expect(ErrorCode::UnsupportedData,
         "type: uint8\ndimension: 3\nsizes: 3 2 2\nkinds: RGB-color domain domain\nencoding: raw\n",
         "axis 0 of kind 'rgb-color' with 3 samples; expected one number per sample");
  expect(ErrorCode::UnsupportedData, "type: uint8\ndimension: 1\nsizes: 9\nencoding: raw\n", "image of 1 axes (9)");
  expect(ErrorCode::UnsupportedData, "type: uint8\ndimension: 5\nsizes: 2 2 2 2 2\nencoding: raw\n", "image of 5 axes");
  write_file(dir / "b.nrrd", "NRRD0009\n" + kSmall);
  expect_unreadable(ErrorCode::MalformedFile, dir / "b.nrrd", {"'NRRD0009'", "expected 'NRRD0001' to 'NRRD0005'"});
  write_file(dir / "c.nhdr", nrrd_header(kSmall + "encoding: raw"));
  expect_unreadable(ErrorCode::MalformedFile, dir / "c.nhdr", {"neither a 'data file' nor data after the header"});
}

}  // namespace
}  // namespace tegl::test
