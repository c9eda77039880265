// SPDX-License-Identifier: BSD-3-Clause
//
// Indexes of active tiles find the tiles of the definition at every relevant isovalue, for every method, dimension and
// value type; and loading restores them exactly or fails.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "active.hpp"
#include "fields.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::test {
namespace {

using ::testing::HasSubstr;

template <int N>
using Indexes = std::vector<std::unique_ptr<ActiveTiles<N>>>;

/// Indexes of all methods, each also saved and loaded.
template <Value T, int N>
Indexes<N> all_indexes(const Image<T, N>& image) {
  Indexes<N> result;
  for (const ActiveMethod method : active_methods()) {
    result.push_back(build_active_tiles(image, method));
    MemoryFile file;
    result.back()->save(file);
    result.push_back(load_active_tiles(file, image));
    EXPECT_EQ(result.back()->method(), method);
    EXPECT_EQ(result.back()->image(), result[result.size() - 2]->image());
  }
  return result;
}

template <int N>
void expect_rows_of(const ActiveTiles<N>& index, double isovalue, const std::vector<TileNumber>& tiles) {
  const TileRowSet rows = index.find_rows(isovalue);
  ASSERT_EQ(rows.rows(), index.grid().rows());
  std::set<std::size_t> needed;
  for (const TileNumber tile : tiles) needed.insert(index.grid().row(tile));
  for (const std::size_t row : needed) ASSERT_TRUE(rows.has(row)) << "row " << row;
  EXPECT_GE(rows.count(), needed.size());
}

template <Value T, int N>
void expect_right(const OwnedImage<T, N>& image, const std::vector<double>& isovalues) {
  const PlainRanges<N> plain(image.view());
  const Indexes<N> indexes = all_indexes(image.view());
  for (const double isovalue : isovalues) {
    const std::vector<TileNumber> expected = plain.active(isovalue);
    for (const auto& index : indexes) {
      SCOPED_TRACE(std::string(active_method_name(index->method())) + " at " + std::to_string(isovalue));
      ASSERT_EQ(index->find(isovalue), expected);
      expect_rows_of(*index, isovalue, expected);
    }
  }
}

template <class T>
class ActiveTilesOf : public ::testing::Test {};
using ValueTypes =
    ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(ActiveTilesOf, ValueTypes);

TYPED_TEST(ActiveTilesOf, NoiseIn2dAreThoseOfTheDefinition) {
  const auto image = noise<TypeParam, 2>({70, 23}, 1);
  expect_right(image, critical_isovalues(image, 300));
}
TYPED_TEST(ActiveTilesOf, NoiseIn3dAreThoseOfTheDefinition) {
  const auto image = noise<TypeParam, 3>({19, 9, 7}, 2);
  expect_right(image, critical_isovalues(image, 300));
}
TYPED_TEST(ActiveTilesOf, NoiseIn4dAreThoseOfTheDefinition) {
  const auto image = noise<TypeParam, 4>({11, 4, 3, 5}, 3);
  expect_right(image, critical_isovalues(image, 300));
}
TYPED_TEST(ActiveTilesOf, NoiseIn5dAreThoseOfTheDefinition) {
  const auto image = noise<TypeParam, 5>({10, 3, 4, 2, 3}, 4);
  expect_right(image, critical_isovalues(image, 200));
}
TYPED_TEST(ActiveTilesOf, FewValuesAreThoseOfTheDefinition) {
  const auto image = coarse_noise<TypeParam, 3>(Grid<3>::unit({30, 12, 9}), 5, 6);
  expect_right(image, critical_isovalues(image, 100));
}
TYPED_TEST(ActiveTilesOf, SmoothFieldAreThoseOfTheDefinition) {
  const auto image = sample_field<TypeParam>(centred_grid<3>(22, 1.5), Gyroid<3>{}, 30.0, 40.0);
  expect_right(image, critical_isovalues(image, 200));
}

TEST(ActiveTiles, LongRowsAndManyBucketsAreThoseOfTheDefinition) {
  const auto image = noise<float, 2>({300, 61}, 6);
  expect_right(image, critical_isovalues(image, 300));
}

TEST(ActiveTiles, NextToMissingValuesAreThoseOfTheDefinition) {
  const auto plane = noise_with_missing<float, 2>(Grid<2>::unit({67, 20}), 7, 0.1);
  expect_right(plane, critical_isovalues(plane, 300));
  const auto volume = noise_with_missing<double, 3>(Grid<3>::unit({17, 9, 8}), 8, 0.1);
  expect_right(volume, critical_isovalues(volume, 300));
  const auto series = noise_with_missing<float, 4>(Grid<4>::unit({9, 5, 4, 4}), 9, 0.05);
  expect_right(series, critical_isovalues(series, 300));
  EXPECT_TRUE(build_active_tiles(series.view(), ActiveMethod::interval_tree)->image().any_missing);
}

TEST(ActiveTiles, OfAnImageWithAllValuesMissingAreNone) {
  OwnedImage<float, 3> image{Grid<3>::unit({9, 5, 4}), std::vector<float>(180, std::nanf(""))};
  expect_right(image, {-1.0, 0.0, 1.0});
}

TEST(ActiveTiles, OfInfiniteValuesAreThoseOfTheDefinition) {
  auto image = noise<float, 3>({12, 6, 5}, 10);
  for (std::size_t i = 0; i < image.values.size(); i += 7) image.values[i] = std::numeric_limits<float>::infinity();
  for (std::size_t i = 3; i < image.values.size(); i += 11) image.values[i] = -std::numeric_limits<float>::infinity();
  std::vector<double> isovalues = critical_isovalues(image, 300);
  isovalues.insert(isovalues.end(), {-1e300, -1e30, 1e30, 1e300});
  expect_right(image, isovalues);
}

TEST(ActiveTiles, ZerosOfBothSignsAreOneValue) {
  OwnedImage<float, 2> image = coarse_noise<float, 2>(Grid<2>::unit({40, 9}), 11, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = image.values[i] == 1.0f ? -0.0f : image.values[i] - 1.0f;
  for (std::size_t i = 0; i < image.values.size(); i += 5) image.values[i] = 0.0f;
  expect_right(image, {-1.0, -0.5, -0.0, 0.0, std::numeric_limits<double>::denorm_min(), 0.5, 1.0});
}

TEST(ActiveTiles, BeyondTheValuesOfTheTypeAreNone) {
  const auto image = noise<std::uint8_t, 3>({20, 8, 6}, 12);
  expect_right(image, {-1e9, -0.5, 0.0, 0.5, 254.5, 255.0, 255.5, 256.0, 1e9});
}

TEST(ActiveTiles, OfConstantImagesAreNone) {
  OwnedImage<std::int16_t, 3> image{Grid<3>::unit({20, 8, 6}), std::vector<std::int16_t>(960, 5)};
  expect_right(image, {4.0, 4.5, 5.0, 5.5, 6.0});
  for (const ActiveMethod method : {ActiveMethod::interval_tree, ActiveMethod::span_space})
    EXPECT_LT(build_active_tiles(image.view(), method)->memory_bytes(), 100u);
}

TEST(ActiveTiles, OfAnAxisOfOneSampleAreNone) {
  for (int axis = 0; axis < 3; ++axis) {
    std::array<std::size_t, 3> sizes{9, 8, 7};
    sizes[axis] = 1;
    const auto image = noise<float, 3>(sizes, 13);
    EXPECT_EQ(TileGrid<3>(sizes).count(), 0u);
    for (const auto& index : all_indexes(image.view())) {
      EXPECT_TRUE(index->find(0.5).empty());
      EXPECT_EQ(index->find_rows(0.5).count(), 0u);
    }
  }
}

TEST(ActiveTiles, OfAnyStridesAreThoseOfTheDenseImage) {
  const auto image = noise<float, 3>({14, 9, 8}, 14);
  std::vector<float> spread(image.values.size() * 2);
  for (std::size_t i = 0; i < image.values.size(); ++i) spread[spread.size() - 1 - 2 * i] = image.values[i];
  const Image<float, 3> view(spread.data() + spread.size() - 1, image.grid, {-2, -28, -252});
  for (const ActiveMethod method : active_methods()) {
    MemoryFile file;
    build_active_tiles(image.view(), method)->save(file);
    const auto index = load_active_tiles(file, view);  // equal values count as the same image
    EXPECT_EQ(index->find(0.5), PlainRanges<3>(image.view()).active(0.5));
    EXPECT_EQ(build_active_tiles(view, method)->find(0.25), PlainRanges<3>(image.view()).active(0.25));
  }
}

TEST(ActiveTiles, AreTheSameForAnyNumberOfThreads) {
  const auto image = noise_with_missing<float, 3>(Grid<3>::unit({40, 30, 20}), 15, 0.01);
  for (const ActiveMethod method : active_methods()) {
    MemoryFile one, many;
    build_active_tiles(image.view(), method, {.work = {.threads = 1}})->save(one);
    build_active_tiles(image.view(), method, {.work = {.threads = 4}})->save(many);
    EXPECT_EQ(one.content, many.content) << active_method_name(method);
  }
}

TEST(ActiveTiles, OfIndexesThatNeedNoImageDoNotDependOnItsValues) {
  auto image = noise<float, 3>(8, 21);
  std::set<ActiveMethod> need_values;
  for (const auto& index : all_indexes(image.view())) {
    const std::vector<TileNumber> expected = index->find(0.5);
    ASSERT_FALSE(expected.empty());
    if (index->needs_image()) {
      need_values.insert(index->method());
      continue;
    }
    const auto values = image.values;
    std::fill(image.values.begin(), image.values.end(), 0.0F);
    EXPECT_EQ(index->find(0.5), expected) << active_method_name(index->method());
    std::copy(values.begin(), values.end(), image.values.begin());
  }
  EXPECT_EQ(need_values,
            (std::set<ActiveMethod>{ActiveMethod::full_scan, ActiveMethod::min_max_tree, ActiveMethod::seed_set}));
}

TEST(ActiveTiles, ChosenOnesAreThoseAndNotComplete) {
  const auto image = noise<float, 3>({9, 8, 7}, 16);
  const auto chosen = choose_tiles(image.view(), {3, 5, 335});
  EXPECT_FALSE(chosen->is_complete());
  EXPECT_EQ(chosen->find(0.5), (std::vector<TileNumber>{3, 5, 335}));
  MemoryFile file;
  EXPECT_THROW(chosen->save(file), Error);
  EXPECT_THROW(choose_tiles(image.view(), {3, 336}), Error);
  EXPECT_THROW(choose_tiles(image.view(), {3, 3}), Error);
}

TEST(TileGrid, NumbersAndIndicesAreInverse) {
  const TileGrid<4> grid({4, 3, 6, 2});
  EXPECT_EQ(grid.count(), 30u);
  EXPECT_EQ(grid.rows(), 10u);
  for (TileNumber tile = 0; tile < grid.count(); ++tile) {
    EXPECT_EQ(grid.number(grid.index(tile)), tile);
    EXPECT_EQ(grid.row(tile), tile / 3);
  }
}

// ---- files ----

/// The error of loading: code and message.
template <Value T, int N>
std::pair<ErrorCode, std::string> error_of_loading(std::vector<unsigned char> content, const Image<T, N>& image) {
  MemoryFile file;
  file.content = std::move(content);
  try {
    load_active_tiles(file, image);
  } catch (const Error& error) {
    return {error.code(), error.what()};
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

class ActiveTilesFile : public ::testing::TestWithParam<ActiveMethod> {
 protected:
  OwnedImage<float, 3> image_ = noise_with_missing<float, 3>(Grid<3>::unit({11, 7, 6}), 17, 0.05);
  std::vector<unsigned char> content_ = [this] {
    MemoryFile file;
    build_active_tiles(image_.view(), GetParam())->save(file);
    return file.content;
  }();
};
INSTANTIATE_TEST_SUITE_P(AllMethods, ActiveTilesFile, ::testing::ValuesIn(active_methods()), [](const auto& tested) {
  std::string name(active_method_name(tested.param));
  std::erase(name, '-');
  return name;
});

TEST_P(ActiveTilesFile, OfAnotherImageIsRefused) {
  auto other = image_;
  for (float& value : other.values) {
    if (std::isnan(value)) continue;
    value = std::nextafter(value, 2.0f);  // one bit of one value
    break;
  }
  const auto [code, message] = error_of_loading(content_, other.view());
  EXPECT_EQ(code, ErrorCode::InvalidArgument);
  EXPECT_THAT(message, HasSubstr("other values"));

  const auto larger = noise<float, 3>({11, 6, 7}, 17);
  EXPECT_THAT(error_of_loading(content_, larger.view()).second,
              HasSubstr("11 x 7 x 6 float; expected the one of 11 x 6 x 7 float"));
  const auto wider = noise<double, 3>({11, 7, 6}, 17);
  EXPECT_THAT(error_of_loading(content_, wider.view()).second, HasSubstr("expected the one of 11 x 7 x 6 double"));
  const auto flat = noise<float, 2>({11, 42}, 17);
  EXPECT_EQ(error_of_loading(content_, flat.view()).first, ErrorCode::InvalidArgument);
}

TEST(ActiveTiles, OfManyTilesComeBackFromAFile) {
  const auto image = noise<std::uint8_t, 2>({2400, 2000}, 18);  // arrays of more than one block
  for (const ActiveMethod method : {ActiveMethod::interval_tree, ActiveMethod::span_space}) {
    const auto index = build_active_tiles(image.view(), method);
    MemoryFile file;
    index->save(file);
    EXPECT_EQ(load_active_tiles(file, image.view())->find(3), index->find(3));
  }
}

TEST_P(ActiveTilesFile, CutShortAnywhereIsRefused) {
  for (std::size_t size = 0; size < content_.size(); size += 1 + content_.size() / 300) {
    const std::vector<unsigned char> cut(content_.begin(), content_.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(error_of_loading(cut, image_.view()).first, ErrorCode::MalformedFile) << size;
  }
  auto longer = content_;
  longer.push_back(0);
  EXPECT_EQ(error_of_loading(longer, image_.view()).first, ErrorCode::MalformedFile);
}

TEST_P(ActiveTilesFile, WithAnyByteChangedIsRefused) {
  for (std::size_t i = 0; i < content_.size(); i += 1 + content_.size() / 500) {
    auto changed = content_;
    changed[i] ^= 0x41;
    MemoryFile file;
    file.content = changed;
    EXPECT_THROW(load_active_tiles(file, image_.view()), Error) << "byte " << i;
  }
}

TEST_P(ActiveTilesFile, OfAnotherVersionOrByteOrderIsRefused) {
  auto changed = content_;
  changed[8] ^= 1;
  EXPECT_EQ(error_of_loading(changed, image_.view()).first, ErrorCode::UnsupportedFormat);
  changed = content_;
  changed[12] = 77;
  const auto [code, message] = error_of_loading(changed, image_.view());
  EXPECT_EQ(code, ErrorCode::UnsupportedFormat);
  EXPECT_THAT(message, HasSubstr("version 77; expected 1"));
}

TEST_P(ActiveTilesFile, HasAHeadThatCanBeReadAlone) {
  MemoryFile file;
  file.content = content_;
  const ActiveTilesHead head = read_active_tiles_head(file);
  EXPECT_EQ(head.method, GetParam());
  EXPECT_EQ(head.sizes, (std::vector<std::uint64_t>{11, 7, 6}));
  EXPECT_EQ(head.value_type, ValueType::float32);
  EXPECT_TRUE(head.any_missing);
  EXPECT_EQ(head.digest, identify(image_.view()).digest);
}

TEST_P(ActiveTilesFile, BuildingCanBeCancelled) {
  ActiveTilesOptions options;
  options.work.progress = [](double) { return false; };
  try {
    build_active_tiles(image_.view(), GetParam(), options);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

TEST_P(ActiveTilesFile, IsovaluesThatAreNotFiniteAreRefused) {
  const auto index = build_active_tiles(image_.view(), GetParam());
  EXPECT_THROW((void)index->find(std::nan("")), Error);
  EXPECT_THROW((void)index->find_rows(std::numeric_limits<double>::infinity()), Error);
}

}  // namespace
}  // namespace tegl::test
