// SPDX-License-Identifier: BSD-3-Clause
//
// The private parts of the extraction: bit planes against the plain comparison, limits.
#include "extract_kernel.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "bitplanes.hpp"
#include "fields.hpp"

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

TEST(Limits, MoreVerticesThanNumbersAreAnError) {
  EXPECT_NO_THROW(check_vertex_count(kMaxVertices, kMaxVertices));
  EXPECT_THROW(check_vertex_count(kMaxVertices + 1, kMaxVertices), Error);
  const auto image = test::noise<std::uint8_t, 3>(6, 7);
  for (const bool close : {false, true}) {
    ExtractOptions options;
    options.close = close;
    ImageSource<std::uint8_t, 3> source(image.view(), 100.0, 0.0);
    const auto run = [&](std::uint64_t limit) {
      return extract_source<3, float>(source, image.grid, generated_tables<3>(options), options, nullptr,
                                      {.max_vertices = limit});
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
