// SPDX-License-Identifier: BSD-3-Clause
//
// Private parts of the extraction: bit planes against plain comparison, limits.
#include "kernel/extract_kernel.hpp"

#include <fstream>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fields.hpp"
#include "image/bitplanes.hpp"
#include "image/row_source.hpp"

namespace tegl::detail {
namespace {

template <class T>
class BitPlanes : public ::testing::Test {};
using ValueTypes =
    ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(BitPlanes, ValueTypes);

TYPED_TEST(BitPlanes, EqualThePlainComparisonForAnyLengthAndStride) {
  using T = TypeParam;
  const auto image = test::noise<T, 2>({700, 1}, 5);
  const double isovalue = test::noise_isovalue<T>();
  for (const std::size_t count : {1u, 7u, 63u, 64u, 65u, 128u, 200u})
    for (const std::ptrdiff_t stride : {1, 3, -1, 0}) {
      const T* const first = stride < 0 ? image.values.data() + 300 : image.values.data();
      std::vector<Word> high(4, ~Word{0});
      EXPECT_FALSE(classify_row(first, stride, count, make_threshold<T>(isovalue), high.data(), nullptr));
      for (std::size_t i = 0; i < (count + 63) / 64 * 64; ++i) {
        const bool bit = (high[i / 64] >> (i % 64) & 1u) != 0;
        const bool expected =
            i < count && static_cast<double>(first[static_cast<std::ptrdiff_t>(i) * stride]) >= isovalue;
        ASSERT_EQ(bit, expected) << count << " samples, stride " << stride << ", sample " << i;
      }
    }
}

TEST(BitPlanesOfFloats, MarkMissingSamples) {
  auto image = test::noise<float, 2>({200, 1}, 6);
  image.values[70] = image.values[199] = std::numeric_limits<float>::quiet_NaN();
  std::vector<Word> high(4), missing(4, ~Word{0});
  EXPECT_TRUE(classify_row(image.values.data(), 1, 200, make_threshold<float>(-1.0), high.data(), missing.data()));
  EXPECT_EQ(missing, (std::vector<Word>{0, Word{1} << 6, 0, Word{1} << 7}));
  EXPECT_EQ(high, (std::vector<Word>{~Word{0}, ~(Word{1} << 6), ~Word{0}, 0x7f}));
}

TEST(Limits, NumbersOfTwoBatchesAreToldApart) {
  const auto image = test::noise<std::uint8_t, 3>(8, 7);
  const ExtractOptions options;
  ImageSource<std::uint8_t, 3> source(image.view(), 100.0, 0.0);
  const auto run = [&](std::uint64_t limit) {
    return extract_source<3, float>(source, image.grid, generated_tables<3>(options), options,
                                    {.batch = 1, .max_vertices_at_once = limit})
        .contour;
  };
  const std::uint64_t count = run(~std::uint64_t{0}).vertices.size();
  EXPECT_EQ(run(count).vertices.size(), count);
  EXPECT_EQ(run(count / 2).vertices.size(), count) << "two slabs of seven";
  try {
    run(count / 8);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::TooLarge);
    EXPECT_NE(std::string(error.what()).find(std::to_string(count / 8)), std::string::npos) << error.what();
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers need address space
/// True if the contour can be extracted with `more` bytes of address space in addition to the process's.
bool fits_into(const OwnedImage<float, 3>& image, std::size_t more) {
  const pid_t child = fork();
  if (child == 0) {
    std::ifstream status("/proc/self/statm");
    std::size_t pages = 0;
    status >> pages;
    const rlim_t bytes = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + more;
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_AS, &limit);
    ExtractOptions options;
    options.work.threads = 1;
    try {
      _exit(extract<float>(image.view(), 0.5, options).simplices.empty() ? 2 : 0);
    } catch (const std::bad_alloc&) {
      _exit(1);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) < 2) << status;
  return WEXITSTATUS(status) == 0;
}

TEST(Limits, WhereLittleAddressSpaceDoesMoreDoesToo) {
  auto image = test::noise<float, 3>(120, 7);
  for (std::size_t i = 0; i < image.values.size(); ++i)  // a few parallel sheets
    image.values[i] = static_cast<float>(i / (120 * 120) % 12) / 12.0F;
  bool fitted = false;
  for (std::size_t mebibytes = 8; mebibytes < 1200; mebibytes += mebibytes < 128 ? 12 : 60) {
    const bool fits = fits_into(image, mebibytes << 20);
    EXPECT_TRUE(fits || !fitted) << mebibytes << " MiB";
    fitted |= fits;
  }
  EXPECT_TRUE(fitted);
}
#endif

TEST(Limits, MoreVerticesThanNumbersAreAnError) {
  EXPECT_NO_THROW(check_vertex_count(kMaxVertices, kMaxVertices));
  EXPECT_THROW(check_vertex_count(kMaxVertices + 1, kMaxVertices), Error);
  const auto image = test::noise<std::uint8_t, 3>(6, 7);
  for (const bool close : {false, true}) {
    ExtractOptions options;
    options.close = close;
    ImageSource<std::uint8_t, 3> source(image.view(), 100.0, 0.0);
    const auto run = [&](std::uint64_t limit) {
      return extract_source<3, float>(source, image.grid, generated_tables<3>(options), options,
                                      {.max_vertices = limit})
          .contour;
    };
    const std::uint64_t count = run(kMaxVertices).vertices.size();
    EXPECT_EQ(run(count).vertices.size(), count);
    try {
      run(count - 1);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::TooLarge);
      EXPECT_NE(std::string(error.what()).find(std::to_string(count - 1)), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace tegl::detail
