// SPDX-License-Identifier: BSD-3-Clause
//
// Image views: strides, parts, and invalid arguments; names of value types.
#include "tegl/image.hpp"

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "tegl/value_type.hpp"

namespace tegl {
namespace {

TEST(Image, DenseViewRunsFastestAlongAxis0) {
  OwnedImage<std::int16_t, 3> image{Grid<3>::unit({2, 3, 4}), std::vector<std::int16_t>(24)};
  std::iota(image.values.begin(), image.values.end(), std::int16_t{0});
  const auto view = image.view();
  EXPECT_EQ(view.strides(), (std::array<std::ptrdiff_t, 3>{1, 2, 6}));
  EXPECT_EQ(view({1, 0, 0}), 1);
  EXPECT_EQ(view({0, 1, 0}), 2);
  EXPECT_EQ(view({1, 2, 3}), 23);
}

TEST(Image, StridesMayBeNegativeOrZero) {
  const std::uint8_t values[] = {10, 11, 12};
  const Image<std::uint8_t, 2> view(values + 2, Grid<2>::unit({3, 5}), {-1, 0});
  EXPECT_EQ(view({0, 4}), 12);
  EXPECT_EQ(view({2, 1}), 10);
}

TEST(Image, PartKeepsValuesAndCoordinates) {
  OwnedImage<float, 2> image{Grid<2>::unit({3, 4}), std::vector<float>(12)};
  std::iota(image.values.begin(), image.values.end(), 0.0f);
  image.grid.axes[1] = Axis::rectilinear({0.0, 1.0, 4.0, 9.0});
  const auto part = image.view().part(1, 2, 2);
  EXPECT_EQ(part.size(0), 3u);
  EXPECT_EQ(part.size(1), 2u);
  EXPECT_EQ(part({1, 0}), 7.0f);
  EXPECT_EQ(part.grid().axes[1][1], 9.0);
  EXPECT_THROW((void)image.view().part(2, 0, 1), Error);
  EXPECT_THROW((void)image.view().part(1, 3, 2), Error);
}

TEST(Image, RejectsNullEmptyAxesAndSingularMaps) {
  const auto code_of = [](const float* data, const Grid<2>& grid) {
    try {
      const Image<float, 2> image(data, grid);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::Cancelled;
  };
  const float value = 0;
  EXPECT_EQ(code_of(&value, Grid<2>::unit({1, 1})), ErrorCode::Cancelled) << "a sound image";
  EXPECT_EQ(code_of(nullptr, Grid<2>::unit({1, 1})), ErrorCode::InvalidGrid);
  EXPECT_EQ(code_of(&value, Grid<2>{}), ErrorCode::InvalidGrid);
  auto grid = Grid<2>::unit({1, 1});
  grid.linear[1][1] = 0;
  EXPECT_EQ(code_of(&value, grid), ErrorCode::InvalidGrid);
  grid.linear[1][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of(&value, grid), ErrorCode::InvalidGrid);
}

TEST(ValueType, NamesAreReadBack) {
  for (int i = 0; i < 10; ++i) {
    const auto type = static_cast<ValueType>(i);
    EXPECT_EQ(parse_value_type(name_of(type)), type) << name_of(type);
  }
  EXPECT_EQ(name_of(kValueType<std::uint8_t>), "uint8");
  EXPECT_EQ(name_of(kValueType<std::int32_t>), "int32");
  EXPECT_EQ(name_of(kValueType<float>), "float");
  EXPECT_EQ(name_of(kValueType<double>), "double");
  EXPECT_EQ(name_of(ValueType::uint64), "uint64");
  EXPECT_EQ(parse_value_type("float16"), std::nullopt);
  EXPECT_EQ(parse_value_type(""), std::nullopt);
}

}  // namespace
}  // namespace tegl
