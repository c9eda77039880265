// SPDX-License-Identifier: BSD-3-Clause
//
// NumPy's files: types, orders and versions of .npy; members of .npz; malformed headers and archives.
#include "images/npy_files.hpp"

#include <array>
#include <cmath>

#include "io_support.hpp"
#include "tegl/io/series.hpp"

namespace tegl::test {
namespace {

const std::vector<std::int16_t> kValues = counting<std::int16_t>(24, -5);
const std::string kArray = npy("<i2", "4, 3, 2", bytes_of(kValues));

template <class T>
std::vector<T> read_values(const fs::path& path) {
  const auto image = image_as<T, 3>(read_image(path).image);
  return {image.values.begin(), image.values.end()};
}

TEST(Npy, TheLastAxisIsX) {
  TempDir dir;
  write_file(dir / "a.npy", kArray);
  const auto [any, info] = read_image(dir / "a.npy");
  const auto image = image_as<std::int16_t, 3>(any);
  EXPECT_EQ(image.values, kValues);
  EXPECT_EQ(image.grid.axes[0].size(), 2U);
  EXPECT_EQ(image.grid.axes[2].size(), 4U);
  EXPECT_EQ(image.grid.axes[0].name, "x");
  EXPECT_EQ(world(image.grid, {1, 2, 3}), (Eigen::Vector3d{1, 2, 3}));
  EXPECT_EQ(info.format, "NumPy");
  EXPECT_EQ(info.stored_type, ValueType::int16);
}

TEST(Npy, IsRecognisedByItsFirstBytes) {
  TempDir dir;
  write_file(dir / "array.dat", kArray);
  EXPECT_EQ(read_values<std::int16_t>(dir / "array.dat"), kValues);
}

TEST(Npy, VersionsAndSpellingsOfTheHeaderAreTheSame) {
  TempDir dir;
  const std::string bytes = bytes_of(kValues);
  const std::vector<std::string> arrays = {
      npy_with("{'descr': '<i2', 'fortran_order': False, 'shape': (4, 3, 2), }", bytes, 2),
      npy_with("{'descr': '<i2', 'fortran_order': False, 'shape': (4, 3, 2), }", bytes, 3),
      npy_with("{\"shape\":(4L,3L,2L),\"descr\":\"<i2\",\"fortran_order\":False}", bytes),
      npy_with("{'shape': (4, 3, 2,), 'fortran_order': False, 'descr': '<i2'}", bytes + "more bytes"),
  };
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    SCOPED_TRACE(i);
    write_file(dir / "a.npy", arrays[i]);
    EXPECT_EQ(read_values<std::int16_t>(dir / "a.npy"), kValues);
  }
}

TEST(Npy, FortranOrderIsTheSameImage) {
  TempDir dir;
  for (const auto& shape : std::vector<std::vector<std::size_t>>{{40, 70}, {5, 33, 4}, {3, 4, 35, 6}}) {
    std::size_t count = 1;
    std::string text;
    for (const std::size_t size : shape) {
      count *= size;
      text += std::to_string(size) + ", ";
    }
    // value = index in C order
    std::vector<std::int32_t> in_c(count), in_fortran(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t rest = i, place = count;
      std::size_t at = 0;
      for (std::size_t a = shape.size(); a-- > 0; rest /= shape[a]) {
        place /= shape[a];
        at += rest % shape[a] * place;
      }
      in_c[i] = static_cast<std::int32_t>(i);
      in_fortran[at] = static_cast<std::int32_t>(i);
    }
    write_file(dir / "c.npy", npy("<i4", text, bytes_of(in_c)));
    write_file(dir / "f.npy", npy("<i4", text, bytes_of(in_fortran), true));
    const auto samples = [](const AnyImage& any) {
      return std::visit(
          [](const auto& image) {
            return std::visit([](const auto& i) { return std::vector<double>(i.values.begin(), i.values.end()); },
                              image);
          },
          any);
    };
    EXPECT_EQ(samples(read_image(dir / "c.npy").image), samples(read_image(dir / "f.npy").image));
    expect_error(ErrorCode::UnsupportedData, {"f.npy", "Fortran order", "C order"},
                 [&] { (void)open_layers(dir / "f.npy"); });
  }
}

template <class Stored, class Read>
void expect_numbers(const std::string& type) {
  SCOPED_TRACE(type);
  TempDir dir;
  write_file(dir / "a.npy", npy(type, "4, 3, 2", bytes_of(counting<Stored>(24, 3))));
  EXPECT_EQ(read_values<Read>(dir / "a.npy"), counting<Read>(24, 3));
}

TEST(Npy, ReadsEveryNumericType) {
  expect_numbers<std::int8_t, std::int8_t>("|i1");
  expect_numbers<std::uint8_t, std::uint8_t>("|u1");
  expect_numbers<std::int16_t, std::int16_t>("<i2");
  expect_numbers<std::uint16_t, std::uint16_t>("<u2");
  expect_numbers<std::int32_t, std::int32_t>("<i4");
  expect_numbers<std::uint32_t, std::int32_t>("<u4");
  expect_numbers<std::int64_t, std::int32_t>("<i8");
  expect_numbers<std::uint64_t, std::int32_t>("<u8");
  expect_numbers<float, float>("<f4");
  expect_numbers<double, double>("=f8");
  TempDir dir;
  write_file(dir / "b.npy", npy("|b1", "2, 2", std::string("\0\1\1\0", 4)));
  EXPECT_EQ((image_as<std::uint8_t, 2>(read_image(dir / "b.npy").image).values),
            (std::vector<std::uint8_t>{0, 1, 1, 0}));
}

TEST(Npy, BigEndianFilesReadTheSame) {
  TempDir dir;
  std::string bytes = bytes_of(kValues);
  for (std::size_t i = 0; i < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
  write_file(dir / "a.npy", npy(">i2", "4, 3, 2", bytes));
  EXPECT_EQ(read_values<std::int16_t>(dir / "a.npy"), kValues);
}

TEST(Npy, HalvesBecomeFloatsExactly) {
  TempDir dir;
  // 1, -2, the largest number, the smallest normal one, the smallest one, 1 + 2^-10, infinity, NaN
  const std::vector<std::uint16_t> halves = {0x3c00, 0xc000, 0x7bff, 0x0400, 0x0001, 0x3c01, 0x7c00, 0x7e00};
  write_file(dir / "h.npy", npy("<f2", "2, 4", bytes_of(halves)));
  const auto [any, info] = read_image(dir / "h.npy");
  const auto image = image_as<float, 2>(any);
  const std::vector<float> expected = {1.0f, -2.0f, 65504.0f, 0x1p-14f, 0x1p-24f, 1.0f + 0x1p-10f, INFINITY};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(image.values[i], expected[i]) << i;
  EXPECT_TRUE(std::isnan(image.values[7]));
}

TEST(Npy, ArchivesHoldImagesOfFiveAxes) {
  TempDir dir;
  write_file(dir / "a.npz", zip({{"a.npy", npy("<i2", "2, 2, 3, 1, 2", bytes_of(kValues)), true}}));
  const std::array<std::filesystem::path, 1> files = {dir / "a.npz"};
  const auto read = std::get<ReadSeries5dResult>(read_series_to_5d(files));
  const auto& image = std::get<OwnedImage<float, 5>>(read.image);
  EXPECT_EQ(image.values, std::vector<float>(kValues.begin(), kValues.end()));
  EXPECT_EQ(image.grid.axes[2].size(), 3U);
  EXPECT_EQ(image.grid.axes[4].size(), 2U);
}

TEST(Npy, LayersAreTheImage) {
  TempDir dir;
  write_file(dir / "a.npy", kArray);
  write_file(dir / "a.npz", zip({{"a.npy", kArray, true}}));
  for (const char* name : {"a.npy", "a.npz"}) {
    SCOPED_TRACE(name);
    auto opened = open_layers(dir / name);
    auto& layers = *std::get<std::unique_ptr<LayerReader<std::int16_t, 3>>>(std::get<1>(opened.layers));
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<std::int16_t> layer(6);
      layers.read(k, layer.data());
      EXPECT_EQ(layer, std::vector<std::int16_t>(kValues.begin() + static_cast<std::ptrdiff_t>(6 * k),
                                                 kValues.begin() + static_cast<std::ptrdiff_t>(6 * k + 6)));
    }
  }
}

TEST(Npy, BrokenHeadersAreNamed) {
  TempDir dir;
  const std::string data = bytes_of(kValues);
  const auto expect_broken = [&](ErrorCode code, const std::string& bytes, const std::vector<std::string>& parts) {
    write_file(dir / "a.npy", bytes);
    expect_unreadable(code, dir / "a.npy", parts);
  };
  const auto headed = [&](const std::string& dictionary) { return npy_with(dictionary, data); };
  expect_broken(ErrorCode::MalformedFile, "NUMPY and no magic", {"'NUMPY ", "expected '\\x93NUMPY'"});
  expect_broken(ErrorCode::UnsupportedFormat, npy_with("{}", data, 4), {"version 4.0", "expected 1, 2 or 3"});
  expect_broken(ErrorCode::MalformedFile, kArray.substr(0, 40), {"header of 128 bytes", "no more than the file has"});
  expect_broken(ErrorCode::MalformedFile, kArray.substr(0, kArray.size() - 1), {"expected 48", "4"});
  expect_broken(ErrorCode::MalformedFile, headed("{'descr': '<i2', 'shape': (4, 3, 2)}"), {"no key fortran_order"});
  expect_broken(ErrorCode::MalformedFile, headed("{'descr': '<i2', 'descr': '<i2'}"), {"'descr'", "once"});
  expect_broken(ErrorCode::MalformedFile, headed("{'order': 1}"), {"'order'"});
  expect_broken(ErrorCode::MalformedFile, headed("{'descr': '<i2"), {"string without an end"});
  expect_broken(ErrorCode::MalformedFile, headed("{'fortran_order': 1}"), {"expected True or False"});
  expect_broken(ErrorCode::MalformedFile, headed("{'shape': (4, -3)}"), {"'-3", "whole numbers"});
  expect_broken(ErrorCode::MalformedFile, headed("{'shape': (99999999999999999999999)}"), {"whole numbers"});
  expect_broken(ErrorCode::TooLarge, npy("<i2", "4294967296, 4294967296, 4", data), {"exceed any memory"});
  expect_broken(ErrorCode::MalformedFile, npy("<i2", "4000, 4000, 4000", data), {"48 bytes", "expected"});
  expect_broken(ErrorCode::UnsupportedData, npy("<i2", "0, 3", ""), {"(0, 3)", "without samples"});
  expect_broken(ErrorCode::UnsupportedData, npy("<i2", "24,", data), {"1 axes"});
  expect_broken(ErrorCode::UnsupportedData, npy("<i2", "", data), {"0 axes"});
  expect_broken(ErrorCode::UnsupportedData, npy("<c8", "2, 3", data), {"'<c8'", "float32"});
  expect_broken(ErrorCode::UnsupportedData, npy("|O", "2, 3", data), {"'|O'"});
  expect_broken(ErrorCode::UnsupportedData, npy("<U5", "2, 3", data), {"'<U5'"});
  expect_broken(ErrorCode::UnsupportedData, headed("{'descr': [('a', '<i2'), ('b', '<f4')], 'shape': (2, 2)}"),
                {"several fields"});
}

TEST(Npz, ReadsStoredAndDeflatedMembers) {
  TempDir dir;
  const std::string other = npy("<f4", "2, 2", bytes_of(std::vector<float>{1, 2, 3, 4}));
  for (const bool deflated : {false, true})
    for (const bool zip64 : {false, true}) {
      SCOPED_TRACE(deflated);
      write_file(dir / "a.npz",
                 zip({{"first.npy", kArray, deflated, 0, 0, zip64}, {"notes.txt", "text"}}, "a comment"));
      const auto [any, info] = read_image(dir / "a.npz");
      EXPECT_EQ((image_as<std::int16_t, 3>(any).values), kValues);
      EXPECT_EQ(info.variable, "first");
      // one of several
      write_file(dir / "b.npz", zip({{"first.npy", kArray, deflated, 0, 0, zip64}, {"second.npy", other, deflated}}));
      ReadImageOptions options;
      options.variable = "second";
      const auto chosen = image_as<float, 2>(read_image(dir / "b.npz", options).image);
      EXPECT_EQ(chosen.values, (std::vector<float>{1, 2, 3, 4}));
      expect_unreadable(ErrorCode::VariableNotFound, dir / "b.npz",
                        {"2 arrays", "first (2 x 3 x 4)", "second (2 x 2)"});
      options.variable = "third";
      expect_error(ErrorCode::VariableNotFound, {"'third'", "first (2 x 3 x 4)"},
                   [&] { read_image(dir / "b.npz", options); });
    }
}

TEST(Npz, AnArrayOfOneTextNamesTheLattice) {
  TempDir dir;
  const auto text = [](const std::string& name, const std::string& type, const std::string& shape = "") {
    std::string samples;
    for (const char c : name) samples += little(static_cast<unsigned char>(c), 4);
    return npy(type, shape, samples);
  };
  const auto lattice = [&](const std::string& array) {
    for (const bool deflated : {false, true}) {
      write_file(dir / "a.npz", zip({{"a.npy", npy("<i2", "3, 4", bytes_of(std::vector<std::int16_t>(12))), true},
                                     {"sample_lattice.npy", array, deflated}}));
      const auto found = read_image(dir / "a.npz").info.lattice;
      if (found != Lattice::triangular) return found;
    }
    return std::optional(Lattice::triangular);
  };
  EXPECT_EQ(lattice(text("triangular", "<U10")), Lattice::triangular);
  EXPECT_EQ(lattice(text("cubic", "<U5")), std::nullopt);
  EXPECT_EQ(lattice(npy("|S10", "", "triangular")), Lattice::triangular);
  EXPECT_EQ(lattice(npy("|S12", "", std::string("triangular\0\0", 12))), Lattice::triangular);
  EXPECT_EQ(lattice(npy("S5", "", "cubic")), std::nullopt);
  const auto refused = [&](const std::string& array, const char* message) {
    expect_error(ErrorCode::MalformedFile, {message}, [&] { (void)lattice(array); });
  };
  refused(text("cube", "<U4"), "sample_lattice is 'cube'; expected cubic, triangular");
  refused(text("ab", "<U1", "2,"), "array 'sample_lattice': the type '<U1' and the shape (2); expected one text");
  refused(npy("<i4", "", little(3, 4)), "array 'sample_lattice': the type '<i4' and the shape (); expected one text");
  refused(npy("|S2000", "", std::string(5000, 'a')), "bytes; expected one text, the name of a lattice");
  refused(npy("|S4", "", "cube"), "sample_lattice is 'cube'; expected cubic, triangular");
  refused("\x93NUMPY", "sample_lattice");
}

TEST(Npz, ListsTheArraysThatAreImages) {
  TempDir dir;
  write_file(dir / "a.npz", zip({{"a.npy", kArray},
                                 {"words.npy", npy("<U5", "2, 3", std::string(120, 'x'))},
                                 {"line.npy", npy("<i2", "24,", bytes_of(kValues))},
                                 {"b.npy", npy("<i2", "3, 1, 8", bytes_of(kValues)), true}}));
  const auto variables = list_image_variables(dir / "a.npz");
  ASSERT_EQ(variables.size(), 2U);
  EXPECT_EQ(variables[0].name, "a");
  EXPECT_EQ(variables[0].sizes, (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_EQ(variables[1].name, "b");
  EXPECT_EQ(variables[1].sizes, (std::vector<std::size_t>{8, 3}));
}

TEST(Npz, BrokenArchivesAreNamed) {
  TempDir dir;
  const auto expect_broken = [&](ErrorCode code, const std::string& bytes, const std::vector<std::string>& parts) {
    write_file(dir / "a.npz", bytes);
    expect_unreadable(code, dir / "a.npz", parts);
  };
  const std::string good = zip({{"a.npy", kArray, true}});
  expect_broken(ErrorCode::MalformedFile, good.substr(0, good.size() - 5), {"without a directory", "truncated"});
  expect_broken(ErrorCode::MalformedFile, "PK", {"without a directory"});
  expect_broken(ErrorCode::MalformedFile, zip({{"a.npy", kArray, true, 0, 1}}), {"CRC-32", "expected"});
  expect_broken(ErrorCode::UnsupportedFormat, zip({{"a.npy", kArray, true, 1}}), {"encrypted", "'a.npy'"});
  expect_broken(ErrorCode::UnsupportedData, zip({{"notes.txt", "text"}}), {"no array", "1 members"});
  std::string other_method = zip({{"a.npy", kArray}});
  other_method[other_method.find("PK\1\2") + 10] = 14;
  expect_broken(ErrorCode::UnsupportedFormat, other_method, {"compression 14", "0 or 8"});
  std::string far = zip({{"a.npy", kArray}});
  far[far.find("PK\1\2") + 45] = 1;  // offset of the member
  expect_broken(ErrorCode::MalformedFile, far, {"without the member 'a.npy'"});
  std::string large = zip({{"a.npy", kArray}});
  large[large.find("PK\1\2") + 23] = 1;
  large[large.find("PK\1\2") + 27] = 1;  // sizes
  expect_broken(ErrorCode::MalformedFile, large, {"'a.npy'", "of a zip archive of"});
  // the array needs more bytes than its member has
  expect_broken(ErrorCode::MalformedFile, zip({{"a.npy", npy("<i2", "4, 3, 200", bytes_of(kValues)), true}}),
                {"48 bytes", "expected 4800"});
}

}  // namespace
}  // namespace tegl::test
