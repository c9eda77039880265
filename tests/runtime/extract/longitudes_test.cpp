// SPDX-License-Identifier: BSD-3-Clause
//
// Longitudes: under affine maps, of regions, and with samples that repeat the first ones a turn further.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "tegl/check.hpp"
#include "tegl/curved.hpp"
#include "tegl/measure.hpp"
#include "tegl/periodic.hpp"
#include "tegl/stream.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Grid<2> affine_grid(std::size_t columns, double step) {
  Grid<2> grid = Grid<2>::unit({columns, 5});
  grid.axes[0].name = "lon";
  grid.axes[0].unit = "degrees_east";
  grid.linear[0][0] = step;
  grid.offset = {-30.0, 0.0};
  return grid;
}

TEST(Longitudes, OfAnAffineMapHaveTheirPeriodInTheWorld) {
  const std::array axes{0};
  for (const double step : {1.2, -1.2}) {
    const Grid<2> globe = affine_grid(300, step);
    EXPECT_EQ(longitude_periods(globe), (AxisPeriods<2>{300.0, 0.0}));
    EXPECT_EQ(default_periods(globe, axes), (AxisPeriods<2>{300.0, 0.0}));
    EXPECT_EQ(contour_periods(globe, default_periods(globe, axes)).at(0).vector,
              (Vector<2>{std::copysign(360.0, step), 0.0}));
  }
  EXPECT_EQ(longitude_axes(affine_grid(36, 10.0)), std::vector<int>{0});
  EXPECT_EQ(default_periods(affine_grid(30, 10.0), axes)[0], 36.0);  // a gap
  // 360 columns are not the globe
  EXPECT_EQ(longitude_axes(affine_grid(360, 0.5)), std::vector<int>{});
  EXPECT_EQ(longitude_axes(affine_grid(360, 1.0)), std::vector<int>{0});
  // the given period is in the coordinates before the map
  expect_error(ErrorCode::InvalidArgument,
               "its samples span 174.5, and the gap behind them is 185.5; expected less than 180, or a given period, "
               "such as 350",
               [&] { (void)default_periods(affine_grid(350, 0.5), axes); });
}

TEST(Longitudes, OfFineAxesWithASampleMoreOrLessDoNotSpanTheGlobe) {
  for (const double step : {0.25, -0.25}) {  // a thousandth of all steps is more than one
    EXPECT_EQ(longitude_axes(affine_grid(1440, step)), std::vector<int>{0});
    for (const std::size_t columns : {1439U, 1441U, 1442U})
      EXPECT_EQ(longitude_axes(affine_grid(columns, step)), std::vector<int>{}) << columns;
  }
  EXPECT_EQ(longitude_axes(affine_grid(4320, 0.08333)), std::vector<int>{0});  // rounded
  EXPECT_EQ(longitude_axes(affine_grid(4320, 0.0834)), std::vector<int>{});    // 360.2 from the first to the last one
}

TEST(Longitudes, MixedWithOtherAxesHaveNoDefaultPeriod) {
  Grid<2> grid = affine_grid(300, 1.2);
  const auto refuses = [&](const char* text) {
    EXPECT_EQ(longitude_axes(grid), std::vector<int>{});
    expect_error(ErrorCode::InvalidArgument, text, [&] { (void)default_periods(grid, std::array{0}); });
  };
  grid.linear = {{{1.2, 0.0}, {0.1, 1.0}}};
  refuses(
      "the unit of axis 0 (lon) is that of longitudes, but by the affine map, the world's coordinates of axis 1 (y) "
      "also differ along it; expected a given period");
  grid.linear = {{{0.0, 1.2}, {1.0, 0.0}}};
  refuses("the world's coordinates of axis 1 (y) and not its own differ along it; expected");
  // only the vector of the axis matters: rounding, and a frame that moves along another axis
  for (const auto& [along_y, of_lon] : {std::pair{1e-17, 0.0}, std::pair{0.0, 3.0}, std::pair{1e-17, 1e-17}}) {
    grid.linear = {{{1.2, of_lon}, {along_y, 1.0}}};
    EXPECT_EQ(longitude_axes(grid), std::vector<int>{0});
    EXPECT_EQ(default_periods(grid, std::array{0})[0], 300.0);
    EXPECT_DOUBLE_EQ(contour_periods(grid, {300.0, 0.0}).at(0).vector[0], 360.0);
  }
}

TEST(Longitudes, OtherUnitsAreNotReadAsThem) {
  Grid<2> grid = affine_grid(36, 10.0);
  grid.axes[1] = Axis::rectilinear({0.0, 1e-9, 3e-9});  // in the world, two of them coincide
  grid.offset[1] = 1e9;
  EXPECT_EQ(longitude_axes(grid), std::vector<int>{0});
}

TEST(Longitudes, PeriodsWhoseSquaresAreNoNumbersAreErrors) {
  for (const double step : {1e160, 1e-160}) {
    const Grid<2> grid = affine_grid(36, step);
    expect_error(ErrorCode::InvalidGrid, "the period of axis 0 (lon) is the vector (3.6e", [&] {
      (void)contour_periods(grid, {36.0, 0.0});
    });
  }
  for (const double step : {1e100, 1e-100})
    EXPECT_EQ(contour_periods(affine_grid(36, step), {36.0, 0.0}).at(0).vector[0], 36.0 * step);
}

/// A globe of 36 columns, with coordinates by two indices or straight ones; `repeated` of its columns follow again.
struct Globe {
  OwnedImage<double, 2> image;
  std::vector<CurvedAxis> curved;
};
Globe globe(std::size_t repeated, bool is_curved, double step = 10.0) {
  const std::size_t columns = 36 + repeated;
  Globe result;
  result.image.grid = Grid<2>::unit({columns, 17});
  result.image.grid.axes[0] = Axis::uniform(columns, -175.0, step);
  result.image.grid.axes[1] = Axis::uniform(17, -80.0, 10.0);
  result.image.grid.axes[0].unit = "degrees_east";
  CurvedAxis lon{0, 3, {}, "lon", "degrees_east"}, lat{1, 3, {}, "lat", "degrees_north"};
  for (std::size_t j = 0; j < 17; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const auto x = static_cast<double>(i % 36), turns = i < 36 ? 0.0 : 1.0;
      const double angle = 2 * std::numbers::pi * x / 36;
      lon.values.push_back(-175.0 + step * (x + 36 * turns) + 0.1 * static_cast<double>(j));
      lat.values.push_back(-80.0 + 10.0 * static_cast<double>(j) + std::sin(angle));
      result.image.values.push_back(40.0 * std::cos(angle) - std::abs(lat.values.back()));
    }
  result.image.values[0] = result.image.values[36 < columns ? 36 : 0] = kNaN;
  if (is_curved) result.curved = {std::move(lon), std::move(lat)};
  return result;
}

TEST(Longitudes, SamplesThatRepeatTheFirstOnesAreLeftOut) {
  const std::array axes{0};
  for (const bool is_curved : {false, true})
    for (const double step : {10.0, -10.0})
      for (const bool is_by_points : {false, true}) {
        const Globe plain = globe(0, is_curved, step);
        const auto seams = find_seams(plain.image.grid, plain.curved, axes);
        const auto expected = extract_curved<double>(plain.image.view(), plain.curved, 0.0, {}, seams);
        EXPECT_EQ(repeated_longitudes<2>(plain.image.grid, plain.curved, 0), 0u);
        for (const std::size_t repeated : {1U, 2U, 5U}) {
          Globe longer = globe(repeated, is_curved, step);
          if (is_by_points) longer.curved = by_points(std::move(longer.curved));
          const Image<double, 2> image = longer.image.view();
          EXPECT_EQ(repeated_longitudes<2>(image.grid(), longer.curved, 0), repeated);
          EXPECT_EQ(repeated_longitudes<2>(image.grid(), longer.curved, 1), 0u);
          EXPECT_EQ(longitude_axes<2>(image.grid(), longer.curved), std::vector<int>{});
          EXPECT_EQ((longitude_axes<double, 2>(image, longer.curved)), std::vector<int>{0});
          const auto kept = without_repeated<double, 2>(image, longer.curved, axes, std::array{kNaN});
          EXPECT_EQ(kept.left_out, (std::array<std::size_t, 2>{repeated, 0}));
          EXPECT_EQ(kept.image.data(), image.data());
          const auto around = find_seams(kept.image.grid(), kept.curved, axes);
          const auto contour = extract_curved<double>(kept.image, kept.curved, 0.0, {}, around);
          EXPECT_EQ(contour.vertices, expected.vertices);
          EXPECT_EQ(contour.simplices, expected.simplices);
          const auto all = without_repeated<double, 2>(image, longer.curved, axes, std::array{400.0});
          EXPECT_EQ(all.left_out[0], 0u);
        }
      }
}

TEST(Longitudes, SamplesWithOtherValuesOrCoordinatesAreNotLeftOut) {
  const std::array axes{0};
  for (const bool is_curved : {false, true}) {
    Globe longer = globe(2, is_curved);
    const std::size_t at = 38 * 3 + 37;
    const double value = std::exchange(longer.image.values[at], 2.5);
    longer.image.values[38 * 3 + 1] = 2.25;
    const auto leave_out = [&] { return without_repeated<double, 2>(longer.image.view(), longer.curved, axes); };
    expect_error(
        ErrorCode::InvalidArgument,
        "the last 2 samples along axis 0 (x) are at the longitudes of the first, 360 degrees further, but with "
        "other values: 2.5 at the sample (37, 3), 2.25 at the sample (1, 3); expected equal values",
        [&] { (void)leave_out(); });
    EXPECT_EQ((longitude_axes<double, 2>(longer.image.view(), longer.curved)), std::vector<int>{});
    longer.image.values[at] = kNaN;
    expect_error(ErrorCode::InvalidArgument, "nan at the sample (37, 3)", [&] { (void)leave_out(); });
    longer.image.values[at] = longer.image.values[38 * 3 + 1] = value;
    EXPECT_EQ(leave_out().left_out[0], 2u);
    if (!is_curved) continue;
    const double latitude = std::exchange(longer.curved[1].values[at], 7.0);
    EXPECT_EQ(leave_out().left_out[0], 0u);
    longer.curved[1].values[at] = kNaN;
    EXPECT_EQ(leave_out().left_out[0], 0u);
    longer.curved[1].values[38 * 3 + 1] = kNaN;  // both are unknown
    EXPECT_EQ(leave_out().left_out[0], 2u);
    longer.curved[1].values[at] = longer.curved[1].values[38 * 3 + 1] = latitude;
    longer.curved[0].values[at] += 1.0;
    EXPECT_EQ(leave_out().left_out[0], 0u);
  }
}

TEST(Longitudes, ThatRepeatBeforeAMapAreLeftOutForARoundedPeriodOf360) {
  const double step = 360.0 / 78;
  ASSERT_NE(78 * step, 360.0);
  OwnedImage<float, 2> image;
  image.grid = affine_grid(79, step);
  image.values.resize(79 * 5);
  const auto left_out = [&](double period) {
    return without_repeated<float, 2>(image.view(), {}, std::array{0}, std::array{period}).left_out[0];
  };
  EXPECT_EQ(left_out(78.0), 1u);
  EXPECT_EQ(left_out(kNaN), 1u);
  EXPECT_EQ(left_out(78.001), 0u);
  EXPECT_EQ(left_out(360.0), 0u);  // in the coordinates before the map
  EXPECT_EQ(repeated_longitudes<2>(image.grid, {}, 0, 78.0), 1u);
  EXPECT_EQ(repeated_longitudes<2>(image.grid, {}, 0, 79.0), 0u);
}

TEST(Longitudes, RepeatedLatitudesMayDifferByRounding) {
  Globe longer = globe(1, true);
  for (std::size_t s = 0; s < longer.image.values.size(); ++s) {
    CurvedAxis& latitudes = longer.curved[1];
    if (s / 37 == 8) latitudes.values[s] = s % 37 == 36 ? -2.4e-16 : latitudes.values[s] - latitudes.values[8 * 37];
  }
  EXPECT_EQ(longer.curved[1].values[8 * 37], 0.0);
  EXPECT_EQ(repeated_longitudes<2>(longer.image.grid, longer.curved, 0), 1u);
  longer.curved[1].values[8 * 37 + 36] = 1e-3;
  EXPECT_EQ(repeated_longitudes<2>(longer.image.grid, longer.curved, 0), 0u);
}

TEST(Longitudes, RepeatedValuesMayDifferByRounding) {
  const auto left_out = [&]<class T>(T relative) {
    const Globe longer = globe(1, false);
    OwnedImage<T, 2> image;
    image.grid = longer.image.grid;
    for (const double value : longer.image.values) image.values.push_back(static_cast<T>(value));
    T& last = image.values[37 * 8 + 36];  // the largest value is 40
    last += relative * 40;
    return without_repeated<T, 2>(image.view(), {}, std::array{0}).left_out[0];
  };
  EXPECT_EQ(left_out(0.5e-12), 1u);
  EXPECT_EQ(left_out(0.5e-6F), 1u);
  expect_error(ErrorCode::InvalidArgument, "but with other values", [&] { (void)left_out(2e-12); });
  expect_error(ErrorCode::InvalidArgument, "but with other values", [&] { (void)left_out(2e-6F); });
}

/// A globe as `globe`, whose last row runs there and back, as the row in which a tripolar grid is folded.
Globe folded_globe(std::size_t repeated) {
  Globe result = globe(repeated, true);
  const std::size_t columns = 36 + repeated;
  for (std::size_t i = 0; i < columns; ++i) {
    const std::size_t x = i % 36;
    result.curved[0].values[columns * 16 + i] = -175.0 + 9.0 * static_cast<double>(std::min(x, 36 - x));
  }
  return result;
}

TEST(Longitudes, RepeatedSamplesOfATripolarGridAreLeftOut) {
  const std::array axes{0};
  const Globe plain = folded_globe(0);
  for (const std::size_t repeated : {1U, 2U}) {
    const Globe longer = folded_globe(repeated);
    const auto kept = without_repeated<double, 2>(longer.image.view(), longer.curved, axes);
    ASSERT_EQ(kept.left_out[0], repeated);
    EXPECT_EQ(kept.curved[0].values, plain.curved[0].values);
    EXPECT_EQ(find_seams(kept.image.grid(), kept.curved, axes)[0].vector, (Vector<2>{360.0, 0.0}));
    EXPECT_EQ(axis_of_longitudes(longer.image.grid, longer.curved[0]), 0);
    // not left out
    expect_error(ErrorCode::InvalidArgument,
                 "the last coordinates are 360 or more from the first ones, in 16 of 17 rows; expected a longer period",
                 [&] { (void)find_seams(longer.image.grid, longer.curved, axes); });
  }
}

TEST(Longitudes, OfASlantedRegionAreErrors) {
  Grid<2> grid = Grid<2>::unit({12, 12});
  std::vector<CurvedAxis> curved = {{0, 3, {}, "lon", "degrees_east"}, {1, 3, {}, "lat", "degrees_north"}};
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) {
      curved[0].values.push_back(-60 + 10 * i - 11 * j);
      curved[1].values.push_back(5 * j + 4 * i);
    }
  for (const auto& [axis, text] : {std::pair{0, "span 110"}, std::pair{1, "span 121"}})
    expect_error(ErrorCode::InvalidArgument, text, [&] { (void)find_seams(grid, curved, std::array{axis}); });
  EXPECT_EQ(axis_of_longitudes(grid, curved[0]), 0);  // by far the most along neither axis
}

TEST(Longitudes, OfASlantedRegionWiderThanHalfTheGlobeAreErrors) {
  Grid<2> grid = Grid<2>::unit({50, 30});
  std::vector<CurvedAxis> curved = {{0, 3, {}, "lon", "degrees_east"}, {1, 3, {}, "lat", "degrees_north"}};
  const auto refuses = [&](double along_0, double along_1, int axis, const char* text) {
    curved[0].values.clear();
    curved[1].values.clear();
    for (int j = 0; j < 30; ++j)
      for (int i = 0; i < 50; ++i) {
        curved[0].values.push_back(-100.0 + along_0 * i + along_1 * j);
        curved[1].values.push_back(-60.0 + 1.5 * j + i);
      }
    expect_error(ErrorCode::InvalidArgument, text, [&] { (void)find_seams(grid, curved, std::array{axis}); });
    EXPECT_EQ(find_seams(grid, curved, std::array{1 - axis})[0].vector[0], 360.0);
  };
  refuses(4.5, 3.0, 1, "the longitudes along axis 1 (y), a curved axis, span 87, in the mean of all rows");
  refuses(1.0, 7.5, 0, "the longitudes along axis 0 (x), a curved axis, span 49, in the mean of all rows");
}

TEST(Longitudes, AroundAPoleWithinTheGridAreErrors) {  // they grow on one of its sides and decrease on the other
  Grid<2> grid = Grid<2>::unit({40, 40});
  std::vector<CurvedAxis> curved = {{0, 3, {}, "lon", "degrees_east"}, {1, 3, {}, "lat", "degrees_north"}};
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < 40; ++i) {
      const double x = i - 19.5, y = j - 19.5;
      curved[0].values.push_back(std::atan2(y, x) * 180 / std::numbers::pi);
      curved[1].values.push_back(90.0 - std::hypot(x, y));
    }
  continue_longitudes(curved[0].values, grid.sizes());
  for (const int axis : {0, 1})
    expect_error(ErrorCode::InvalidArgument, "so they neither run around the globe nor return to the first ones",
                 [&] { (void)find_seams(grid, curved, std::array{axis}); });
}

TEST(Longitudes, GivenPeriodsAreAlongTheCoordinateWhoseNameStandsForTheAxis) {
  const Globe plain = globe(0, true);
  Grid<2> grid = Grid<2>::unit({17, 36});
  std::vector<CurvedAxis> turned = plain.curved;  // with the order of axes of other files
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t i = 0; i < 36; ++i)
      for (std::size_t j = 0; j < 17; ++j) turned[c].values[i * 17 + j] = plain.curved[c].values[j * 36 + i];
  for (const double period : {360.0, 400.0}) {
    EXPECT_EQ(find_seams(grid, turned, std::array{1}, std::array{period})[0].vector, (Vector<2>{period, 0.0}));
    EXPECT_EQ(find_seams(plain.image.grid, plain.curved, std::array{0}, std::array{period})[0].vector,
              (Vector<2>{period, 0.0}));
  }
  EXPECT_EQ(find_seams(grid, turned, std::array{0}, std::array{170.0})[0].vector, (Vector<2>{0.0, 170.0}));
  turned[0].unit = "m";  // no longitudes: each along its own axis
  expect_error(ErrorCode::InvalidArgument, "the step across the seam is",
               [&] { (void)find_seams(grid, turned, std::array{1}, std::array{360.0}); });
}

TEST(Longitudes, StandForTheAxisAlongWhichTheyGrow) {
  for (const double last : {-65.0, 175.0, 185.0}) {  // a region, the globe, and with a repeated column
    Grid<2> grid = Grid<2>::unit({8, static_cast<std::size_t>(last + 175.0) / 10 + 1});
    CurvedAxis lon{0, 3, {}, "lon", "degrees_east"};
    for (std::size_t j = 0; j < grid.axes[1].size(); ++j)
      for (int i = 0; i < 8; ++i) lon.values.push_back(-175.0 + 10.0 * static_cast<double>(j) + 0.5 * i);
    EXPECT_EQ(axis_of_longitudes(grid, lon), 1);
    lon.unit = "m";
    EXPECT_EQ(axis_of_longitudes(grid, lon), 0);
  }
}

TEST(Longitudes, OfCurvedGridsThatDoNotRunAroundTheGlobeOnceAreErrors) {
  const std::array axes{0};
  const auto refuses = [&](const Globe& one, const char* text) {
    expect_error(ErrorCode::InvalidArgument, text, [&] { (void)find_seams(one.image.grid, one.curved, axes); });
  };
  for (const double sign : {1.0, -1.0}) {
    refuses(globe(1, true, sign * 10.0),
            "the last coordinates are 360 from the first ones, in the mean of all rows; expected a longer "
            "period, or samples without the last ones");
    refuses(globe(2, true, sign * 10.0), "the last coordinates are 370 from the first ones");
    refuses(globe(0, true, sign * 3.0),
            "the longitudes along axis 0 (x), a curved axis, span 105, in the mean of all "
            "rows, so they neither run around the globe nor return to the first ones");
    refuses(globe(0, true, sign * 5.14), "span 179.9");
    EXPECT_EQ(find_seams(globe(0, true, sign * 5.2).image.grid, globe(0, true, sign * 5.2).curved, axes)[0].vector,
              (Vector<2>{sign * 360.0, 0.0}));  // a gap of 178 degrees
    // along latitudes, they grow by less
    const Globe slanted = globe(0, true, sign * 10.0);
    EXPECT_EQ(find_seams(slanted.image.grid, slanted.curved, std::array{1})[0].vector, (Vector<2>{}));
  }
}

TEST(Longitudes, OfAGridAroundAnIslandReturnToTheirPlaces) {
  for (const int count : {3, 4, 5, 40})
    for (const double first : {0.0, 0.3, 0.7, 1.25}) {
      Grid<2> grid = Grid<2>::unit({static_cast<std::size_t>(count), 4});
      std::vector<CurvedAxis> curved = {{0, 3, {}, "lon", "degrees_east"}, {1, 3, {}, "lat", "degrees_north"}};
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < count; ++i) {
          const double angle = 2 * std::numbers::pi * (i + first) / count;
          curved[0].values.push_back(20.0 + (1 + j) * std::cos(angle));
          curved[1].values.push_back(-5.0 + (1 + j) * std::sin(angle));
        }
      EXPECT_EQ(find_seams(grid, curved, std::array{0})[0].vector, (Vector<2>{})) << count << " " << first;
      EXPECT_EQ(axis_of_longitudes(grid, curved[0]), 0);
    }
}

}  // namespace
}  // namespace tegl
