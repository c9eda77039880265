// SPDX-License-Identifier: BSD-3-Clause
//
// NIfTI: values, every value type, scaling, orientation computed by hand, time, and inconsistent files.
#include <algorithm>
#include <cmath>
#include <limits>

#include "images/nifti_files.hpp"
#include "io_support.hpp"

namespace tegl::test {
namespace {

constexpr int kUint8 = 2;
constexpr int kInt16 = 4;

TEST(Nifti, ValuesAndSizesComeBackInOrder) {
  TempDir dir;
  const auto values = counting<std::int16_t>(3 * 4 * 5, -7);
  write_file(dir / "a.nii", NiftiHeader({3, 4, 5}, kInt16, 16).bytes() + bytes_of(values));
  const auto [any, info] = read_image(dir / "a.nii");
  const auto image = image_as<std::int16_t, 3>(any);
  EXPECT_EQ(image.values, values);
  EXPECT_EQ(image.grid.sizes(), (std::array<std::size_t, 3>{3, 4, 5}));
  EXPECT_FALSE(image.grid.has_world_map());
  EXPECT_EQ(info.format, "NIfTI");
  EXPECT_EQ(info.stored_type, ValueType::int16);
  EXPECT_EQ(info.world_frame, "");
  EXPECT_EQ(image.grid.axes[2].name, "z");
  EXPECT_EQ(image.grid.axes[2].unit, "");
}

template <class Stored, class Read>
void expect_nifti_type(int code, const char* name, double start) {
  SCOPED_TRACE(name);
  TempDir dir;
  const auto values = counting<Stored>(2 * 3 * 4, start);
  write_file(dir / "a.nii.gz",
             compressed(NiftiHeader({2, 3, 4}, code, 8 * static_cast<int>(sizeof(Stored))).bytes() + bytes_of(values)));
  const auto [any, info] = read_image(dir / "a.nii.gz");
  const auto image = image_as<Read, 3>(any);
  EXPECT_EQ(image.values, std::vector<Read>(values.begin(), values.end()));
  EXPECT_EQ(info.stored_type, parse_value_type(name));
}

TEST(Nifti, ReadsEveryNumericType) {
  expect_nifti_type<std::uint8_t, std::uint8_t>(2, "uint8", 0);
  expect_nifti_type<std::int16_t, std::int16_t>(4, "int16", -20);
  expect_nifti_type<std::int32_t, std::int32_t>(8, "int32", -2e9);
  expect_nifti_type<float, float>(16, "float", -0.25);
  expect_nifti_type<double, double>(64, "double", 1e-3);
  expect_nifti_type<std::int8_t, std::int8_t>(256, "int8", -20);
  expect_nifti_type<std::uint16_t, std::uint16_t>(512, "uint16", 65000);
  expect_nifti_type<std::uint32_t, std::int32_t>(768, "uint32", 2e9);
  expect_nifti_type<std::uint32_t, double>(768, "uint32", 4e9);
  expect_nifti_type<std::int64_t, std::int32_t>(1024, "int64", -2e9);
  expect_nifti_type<std::int64_t, double>(1024, "int64", -4e12);
  expect_nifti_type<std::uint64_t, double>(1280, "uint64", 4e12);
}

TEST(Nifti, SformWithShearIsExact) {
  TempDir dir;
  const std::array<float, 12> rows = {2, 0.5F, 0, 10, 0, 1.5F, 0.25F, -20, 0, -0.75F, 3, 30};
  auto header = NiftiHeader({4, 5, 6}, kUint8, 8).sform(rows).units(2);
  // The sform has priority over a different qform.
  header.qform({0, 0, 0, 1, 2, 3}, 1);
  write_file(dir / "a.nii", header.bytes() + std::string(120, 'x'));
  const auto [any, info] = read_image(dir / "a.nii");
  const auto image = image_as<std::uint8_t, 3>(any);
  EXPECT_EQ(info.world_frame, "RAS");
  EXPECT_EQ(image.grid.axes[0].unit, "mm");
  const std::vector<std::array<std::size_t, 3>> indices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {3, 4, 5}};
  for (const auto& i : indices) {
    const auto [x, y, z] = std::array<double, 3>{double(i[0]), double(i[1]), double(i[2])};
    const Eigen::Vector3d expected(2 * x + 0.5 * y + 10, 1.5 * y + 0.25 * z - 20, -0.75 * y + 3 * z + 30);
    EXPECT_LT((world(image.grid, i) - expected).norm(), 1e-13);
  }
}

TEST(Nifti, DiagonalSformNeedsNoWorldMap) {
  TempDir dir;
  const auto header = NiftiHeader({2, 2, 2}, kUint8, 8).sform({-2, 0, 0, 10, 0, 3, 0, -5, 0, 0, 4, 0});
  write_file(dir / "a.nii", header.bytes() + std::string(8, 'x'));
  const auto image = image_as<std::uint8_t, 3>(read_image(dir / "a.nii").image);
  EXPECT_FALSE(image.grid.has_world_map());
  EXPECT_TRUE(image.grid.axes[0].is_descending());
  EXPECT_EQ(world(image.grid, {1, 1, 1}), Eigen::Vector3d(8, -2, 4));
}

TEST(Nifti, QformIsRotationAndFlip) {
  TempDir dir;
  // A quarter turn about z, and qfac -1: the third axis points down. c = cos 45 degrees.
  const float c = 0.70710678F;
  auto header = NiftiHeader({2, 3, 4}, kUint8, 8).qform({0, 0, c, 100, 200, 300}, -1);
  header.pixdim(1, 2).pixdim(2, 3).pixdim(3, 4);
  write_file(dir / "a.nii", header.bytes() + std::string(24, 'x'));
  const auto [any, info] = read_image(dir / "a.nii");
  const auto grid = image_as<std::uint8_t, 3>(any).grid;
  EXPECT_EQ(info.world_frame, "RAS");
  EXPECT_LT((world(grid, {1, 0, 0}) - Eigen::Vector3d(100, 202, 300)).norm(), 1e-5);
  EXPECT_LT((world(grid, {0, 2, 0}) - Eigen::Vector3d(94, 200, 300)).norm(), 1e-5);
  EXPECT_LT((world(grid, {0, 0, 3}) - Eigen::Vector3d(100, 200, 288)).norm(), 1e-5);
}

TEST(Nifti, TimeIsTheLastAxisWithItsUnit) {
  TempDir dir;
  auto header = NiftiHeader({2, 3, 4, 5}, kUint8, 8).sform({0, -2, 0, 1, 2, 0, 0, 2, 0, 0, 2, 3}).units(2 | 16);
  header.pixdim(4, 2.5F).put<float>(136, 100.0F);
  write_file(dir / "a.nii", header.bytes() + std::string(120, 'x'));
  const auto grid = image_as<std::uint8_t, 4>(read_image(dir / "a.nii").image).grid;
  EXPECT_EQ(grid.axes[3].name, "t");
  EXPECT_EQ(grid.axes[3].unit, "ms");
  EXPECT_EQ(world(grid, {1, 1, 1, 4}), Eigen::Vector4d(-1, 4, 5, 110));
  EXPECT_EQ(as_eigen(grid.linear).col(3), Eigen::Vector4d(0, 0, 0, 1));
  EXPECT_EQ(grid.linear[3], unit_vector<4>(3));
}

TEST(Nifti, SlopeAndInterceptGiveFloats) {
  TempDir dir;
  const auto values = counting<std::int16_t>(8);
  write_file(dir / "a.nii", NiftiHeader({2, 2, 2}, kInt16, 16).scaling(0.5F, -3).bytes() + bytes_of(values));
  const auto [any, info] = read_image(dir / "a.nii");
  EXPECT_THAT((image_as<float, 3>(any).values), testing::ElementsAre(-3, -2.5, -2, -1.5, -1, -0.5, 0, 0.5));
  EXPECT_EQ(info.stored_type, ValueType::int16);
}

TEST(Nifti, KeptIntegersHaveTheValuesOfTheScaling) {
  TempDir dir;
  std::vector<std::int16_t> stored(6 * 5 * 4);
  for (std::size_t i = 0; i < stored.size(); ++i) stored[i] = static_cast<std::int16_t>(i * 7919 % 65536);
  for (const float slope : {0.3F, -0.3F}) {
    write_file(dir / "a.nii", NiftiHeader({6, 5, 4}, kInt16, 16).scaling(slope, -3.7F).bytes() + bytes_of(stored));
    const auto values = image_as<float, 3>(read_image(dir / "a.nii").image).values;
    ReadImageOptions options;
    options.keep_stored = true;
    const auto [any, info] = read_image(dir / "a.nii", options);
    const auto kept = image_as<std::int16_t, 3>(any).values;
    EXPECT_EQ(info.stored_type, ValueType::int16);
    ASSERT_TRUE(info.scaling.has_value());
    for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(info.scaling->value_of(kept[i]), values[i]) << slope;
    if (slope > 0) {
      EXPECT_EQ(kept, stored);
    }
  }
}

TEST(Nifti, IntegersWithoutScalingOrWithTooSmallSlopeAreNotKept) {
  TempDir dir;
  const auto stored = counting<std::int16_t>(8);
  ReadImageOptions options;
  options.keep_stored = true;
  const auto read = [&](float slope, float intercept) {
    write_file(dir / "a.nii", NiftiHeader({2, 2, 2}, kInt16, 16).scaling(slope, intercept).bytes() + bytes_of(stored));
    return read_image(dir / "a.nii", options);
  };
  EXPECT_FALSE(read(0, 3).info.scaling.has_value());
  const auto [any, info] = read(1e-3F, 1e5F);  // float has no number between the values of neighbours
  EXPECT_FALSE(info.scaling.has_value());
  EXPECT_EQ((image_as<float, 3>(any).values[1]), static_cast<float>(1e5 + static_cast<double>(1e-3F)));
}

/// Compares the integers at or above the mapped isovalue with the values at or above the isovalue. Both ascend, so that
/// integers near the isovalue suffice, and the least and the greatest.
void expect_equal_sides(const ValueScaling& scaling, double isovalue) {
  const double mapped = scaling.stored_isovalue(isovalue);
  const auto near = static_cast<std::int64_t>(std::floor(mapped));
  for (const std::int64_t any : {scaling.least, near - 1, near, near + 1, near + 2, scaling.greatest}) {
    const std::int64_t i = std::clamp(any, scaling.least, scaling.greatest);
    const auto stored = static_cast<double>(i);
    ASSERT_EQ(scaling.value_of(stored) >= isovalue, stored >= mapped) << scaling.slope << " " << isovalue << " " << i;
    ASSERT_EQ(scaling.value_of(stored) == isovalue, stored == mapped) << scaling.slope << " " << isovalue << " " << i;
  }
}

TEST(ValueScaling, IntegersAreOnTheSidesOfTheirValues) {
  for (const double slope : {0.1, 1.0 / 3.0, 1.0, 7.3e4, -0.1, -2.0})
    for (const double intercept : {0.0, -3.3, 1024.0})
      for (const bool single_precision : {false, true}) {
        const ValueScaling scaling{slope, intercept, -128, 127, single_precision};
        for (double i = -130; i <= 130; i += 0.5) {
          // beside a value as it is rounded, and as it is not
          for (const double value : {slope * i + intercept, scaling.value_of(i), scaling.value_of(std::floor(i))})
            for (const double isovalue : {value, std::nextafter(value, 1e30), std::nextafter(value, -1e30)})
              expect_equal_sides(scaling, isovalue);
        }
      }
}

TEST(Nifti, ScaledValuesOfManyBlocksComeBackInOrder) {
  TempDir dir;
  constexpr std::size_t kCount = 128 * 100 * 60;
  std::vector<std::int16_t> stored(kCount);
  for (std::size_t i = 0; i < kCount; ++i) stored[i] = static_cast<std::int16_t>(i * 7919 % 65536);
  const std::string bytes = NiftiHeader({128, 100, 60}, kInt16, 16).scaling(-0.25F, 3).bytes() + bytes_of(stored);
  write_file(dir / "a.nii", bytes);
  write_file(dir / "a.nii.gz", compressed(bytes));
  for (const char* const name : {"a.nii", "a.nii.gz"}) {
    std::vector<double> told;
    ReadImageOptions options;
    options.work.progress = [&](double fraction) {
      told.push_back(fraction);
      return true;
    };
    const auto values = image_as<float, 3>(read_image(dir / name, options).image).values;
    ASSERT_EQ(values.size(), kCount);
    for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(values[i], 3 - 0.25F * static_cast<float>(stored[i])) << i;
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end())) << name;
    EXPECT_GT(told.size(), 4U) << name;
    options.work.progress = [](double fraction) { return fraction < 0.5; };
    expect_error(ErrorCode::Cancelled, {name}, [&] { read_image(dir / name, options); });
  }
  write_file(dir / "b.nii.gz", compressed(bytes.substr(0, bytes.size() - 2)));
  expect_error(ErrorCode::MalformedFile, {"b.nii.gz", "expected"}, [&] { read_image(dir / "b.nii.gz"); });
}

TEST(Nifti, MissingValuesStayMissing) {
  TempDir dir;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  write_file(dir / "a.nii",
             NiftiHeader({2, 2, 1}, 16, 32).bytes() + bytes_of(std::vector<float>{1, nan, -infinity, 4}));
  const auto values = image_as<float, 2>(read_image(dir / "a.nii").image).values;
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(values[2], -infinity);
}

TEST(Nifti, TrailingAxesOfOneSampleAreDropped) {
  TempDir dir;
  write_file(dir / "a.nii", NiftiHeader({5, 4, 1, 1}, kUint8, 8).bytes() + std::string(20, 'x'));
  EXPECT_EQ((image_as<std::uint8_t, 2>(read_image(dir / "a.nii").image).grid.sizes()),
            (std::array<std::size_t, 2>{5, 4}));
  // An oblique single slice keeps only its own plane.
  auto header = NiftiHeader({5, 4, 1}, kUint8, 8).sform({3, 0, 0, 7, 0, 0.8F, -0.6F, 8, 0, 0.6F, 0.8F, 9});
  write_file(dir / "b.nii", header.bytes() + std::string(20, 'x'));
  const auto [any, info] = read_image(dir / "b.nii");
  const auto grid = image_as<std::uint8_t, 2>(any).grid;
  EXPECT_FALSE(grid.has_world_map());
  EXPECT_EQ(info.world_frame, "");
  EXPECT_NEAR(grid.axes[1].step(), 1.0, 1e-7);
}

TEST(Nifti, BigEndianFilesReadTheSame) {
  TempDir dir;
  std::string bytes = NiftiHeader({2, 3, 1}, kInt16, 16).bytes();
  const auto swap = [&](std::size_t offset, std::size_t size, std::size_t count = 1) {
    for (std::size_t i = 0; i < count; ++i)
      std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(offset + i * size),
                   bytes.begin() + static_cast<std::ptrdiff_t>(offset + (i + 1) * size));
  };
  swap(0, 4), swap(40, 2, 8), swap(70, 2, 2), swap(76, 4, 8), swap(108, 4), swap(252, 2, 2);
  for (const int value : {1, 2, 3, 4, 5, 258}) bytes += {static_cast<char>(value >> 8), static_cast<char>(value)};
  write_file(dir / "a.nii", bytes);
  EXPECT_THAT((image_as<std::int16_t, 2>(read_image(dir / "a.nii").image).values),
              testing::ElementsAre(1, 2, 3, 4, 5, 258));
}

TEST(Nifti, HeaderAndImageInTwoFiles) {
  TempDir dir;
  std::string header = NiftiHeader({2, 3, 2}, kUint8, 8).put<float>(108, 0).bytes();
  std::memcpy(&header[344], "ni1", 4);
  write_file(dir / "a.hdr", header.substr(0, 348));
  expect_error(ErrorCode::FileNotFound, {"a.img"}, [&] { read_image(dir / "a.hdr"); });
  write_file(dir / "a.img", bytes_of(counting<std::uint8_t>(12)));
  for (const char* name : {"a.hdr", "a.img"})
    EXPECT_EQ((image_as<std::uint8_t, 3>(read_image(dir / name).image).values), counting<std::uint8_t>(12)) << name;
  write_file(dir / "a.img", "short");
  expect_error(ErrorCode::MalformedFile, {"a.img", "5 bytes of data; expected 12"}, [&] { read_image(dir / "a.hdr"); });
}

TEST(Nifti, ShortDataIsAnErrorNotZeros) {
  TempDir dir;
  const std::string whole = NiftiHeader({4, 4, 4}, kUint8, 8).bytes() + std::string(64, 'x');
  write_file(dir / "a.nii", whole.substr(0, whole.size() - 1));
  expect_unreadable(ErrorCode::MalformedFile, dir / "a.nii", {"63 bytes of data; expected 64"});
  write_file(dir / "a.nii.gz", compressed(whole.substr(0, whole.size() - 1)));
  expect_unreadable(ErrorCode::MalformedFile, dir / "a.nii.gz",
                    {"415 bytes of data after decompression; expected 416"});
  const std::string zipped = compressed(whole);
  write_file(dir / "a.nii.gz", zipped.substr(0, zipped.size() - 12));
  expect_unreadable(ErrorCode::MalformedFile, dir / "a.nii.gz", {"ends early"});
  std::string damaged = zipped;
  damaged[damaged.size() - 6] = static_cast<char>(damaged[damaged.size() - 6] ^ 1);  // in the checksum
  write_file(dir / "a.nii.gz", damaged);
  expect_unreadable(ErrorCode::MalformedFile, dir / "a.nii.gz", {"damaged", "incorrect data check"});
}

TEST(Nifti, HeadersThatContradictThemselvesAreNamed) {
  TempDir dir;
  const auto expect = [&](NiftiHeader header, ErrorCode code, const std::string& part) {
    write_file(dir / "a.nii", header.bytes() + std::string(4096, 'x'));
    expect_unreadable(code, dir / "a.nii", {part});
  };
  const auto fresh = [] { return NiftiHeader({4, 4, 4}, kUint8, 8); };
  expect(fresh().put<std::int16_t>(40, 9), ErrorCode::MalformedFile, "9 dimensions; expected 1 to 7");
  expect(fresh().put<std::int16_t>(44, 0), ErrorCode::MalformedFile, "dimension 2 has size 0");
  expect(fresh().put<std::int16_t>(44, -3), ErrorCode::MalformedFile, "dimension 2 has size -3");
  expect(fresh().put<std::int16_t>(70, 99), ErrorCode::MalformedFile, "NIfTI type 99");
  expect(fresh().put<std::int16_t>(70, 128).put<std::int16_t>(72, 24), ErrorCode::UnsupportedData, "NIfTI type 128");
  expect(fresh().put<std::int16_t>(72, 16), ErrorCode::MalformedFile, "16 bits; expected 8 bits");
  expect(fresh().put<float>(108, -5), ErrorCode::MalformedFile, "values start at byte -5");
  expect(fresh().put<std::int32_t>(344, 0), ErrorCode::MalformedFile, "magic");
  expect(fresh().put<std::int32_t>(0, 540), ErrorCode::UnsupportedFormat, "NIfTI-2");
  expect(fresh().sform({}), ErrorCode::MalformedFile, "step of 0");
  expect(fresh().sform({1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0}), ErrorCode::MalformedFile, "independent directions");
  expect(NiftiHeader({2, 2, 2, 2, 2}, kUint8, 8), ErrorCode::UnsupportedData, "5 dimensions (2 x 2 x 2 x 2 x 2)");
  expect(NiftiHeader({32000, 32000, 32000, 2000}, 64, 64), ErrorCode::MalformedFile, "expected 524288000000000000");
  expect(NiftiHeader({32000, 32000, 32000, 32000}, 64, 64), ErrorCode::TooLarge, "32000 x 32000 x 32000 x 32000");
}

}  // namespace
}  // namespace tegl::test
