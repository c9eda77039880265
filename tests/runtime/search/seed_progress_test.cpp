// SPDX-License-Identifier: BSD-3-Clause
//
// Seeds, bounds, indexes and picks report progress: fractions start near 0, never decrease and end at 1, and cancelling
// works at any report. Tested for each way to find seeds: from all tiles, and from fewer if these are too many.
#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "active.hpp"
#include "fields.hpp"
#include "tegl/active_tiles.hpp"
#include "tegl/pick.hpp"
#include "tegl/seed_set.hpp"

namespace tegl::test {
namespace {

using Work = std::function<void(const Progress&)>;

void expect_rising_progress(const Work& work) {
  std::vector<double> told;
  work([&](double fraction) {
    told.push_back(fraction);
    return true;
  });
  ASSERT_FALSE(told.empty());
  EXPECT_GE(told.front(), 0.0);
  EXPECT_LE(told.front(), 0.2);
  EXPECT_EQ(told.back(), 1.0);
  for (std::size_t i = 1; i < told.size(); ++i) ASSERT_LE(told[i - 1], told[i]) << "report " << i;
  // Cancels at the first report, one in between, and the last.
  for (std::size_t stop = 0; stop < told.size(); stop += std::max<std::size_t>(1, (told.size() - 1) / 2)) {
    std::size_t reports = 0;
    try {
      work([&](double) { return reports++ < stop; });
      ADD_FAILURE() << "went on after report " << stop << " of " << told.size();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Cancelled) << error.what();
    }
    EXPECT_EQ(reports, stop + 1) << "nobody asks again";
  }
}

constexpr std::array kAll = {Neighbourhood::faces, Neighbourhood::faces_and_edges, Neighbourhood::all};
constexpr std::array kFaces = {Neighbourhood::faces};

template <Value T, int N>
void expect_of_seeds(const OwnedImage<T, N>& image, const std::vector<SeedMethod>& methods,
                     std::span<const Neighbourhood> neighbourhoods, bool reduced) {
  for (const Neighbourhood neighbourhood : neighbourhoods) {
    SeedSetOptions options;
    options.neighbourhood = neighbourhood;
    options.work.threads = 1;
    for (const SeedMethod method : methods) {
      SCOPED_TRACE(std::string(name_of(method)) + ", " + std::string(name_of(neighbourhood)));
      options.method = method;
      expect_rising_progress([&](const Progress& progress) {
        options.work.progress = progress;
        find_seeds(image.view(), options);
      });
      options.work.progress = {};
      EXPECT_EQ(find_seeds(image.view(), options).stats.reduced, reduced && method == SeedMethod::cover);
    }
    SCOPED_TRACE("bound, " + std::string(name_of(neighbourhood)));
    expect_rising_progress([&](const Progress& progress) {
      options.work.progress = progress;
      seed_lower_bound(image.view(), options);
    });
  }
}

TEST(SeedProgress, OfAllTilesRisesToTheEnd) {
  expect_of_seeds(noise<std::uint8_t, 2>({60, 50}, 1), seed_methods(), kAll, false);
  expect_of_seeds(noise<float, 3>({20, 19, 18}, 2), seed_methods(), kAll, false);
  expect_of_seeds(noise<std::int16_t, 4>({8, 7, 6, 7}, 3), seed_methods(), kAll, false);
}

TEST(SeedProgress, WhereTilesAreTooManyToChooseFromRisesToTheEnd) {
  const std::vector<SeedMethod> methods = {SeedMethod::cover, SeedMethod::whole1};
  expect_of_seeds(sample_field<float>(centred_grid<3>(40, 2.0), Waves{}), methods, kFaces, true);
  expect_of_seeds(sample_field<float>(centred_grid<2>(300, 2.0), Waves{}), methods, kAll, true);
}

TEST(SeedProgress, WithoutCountingTreesRisesToTheEnd) {
  const auto image = noise<float, 2>({1100, 1000}, 6);  // more than 2^20 tiles
  SeedSetOptions options;
  options.neighbourhood = Neighbourhood::faces;
  expect_rising_progress([&](const Progress& progress) {
    options.work.progress = progress;
    find_seeds(image.view(), options);
  });
}

TEST(SeedProgress, OfIndexesRisesToTheEnd) {
  const auto bytes = noise<std::uint8_t, 3>({30, 29, 28}, 7);
  const auto reals = noise<float, 3>({42, 41, 40}, 8);
  for (const ActiveMethod method : active_methods()) {
    SCOPED_TRACE(name_of(method));
    const auto build = [&](const auto& image) {
      return [&image, method](const Progress& progress) {
        ActiveTilesOptions options;
        options.work.threads = 1;
        options.work.progress = progress;
        build_active_tiles(image.view(), method, options);
      };
    };
    expect_rising_progress(build(bytes));
    expect_rising_progress(build(reals));
  }
}

TEST(SeedProgress, OfPicksRisesToTheEnd) {
  const auto image = noise<float, 3>({30, 29, 28}, 9);
  expect_rising_progress([&](const Progress& progress) {
    ExtractOptions options;
    options.work.threads = 1;  // with several threads the number of reports varies
    options.work.progress = progress;
    extract_component<float>(image.view(), 0.5, {10.0, 12.0, 14.0}, options);
  });
  expect_rising_progress([&](const Progress& progress) {  // without tiles
    ExtractOptions options;
    options.work.threads = 1;  // with several threads the number of reports varies
    options.work.progress = progress;
    extract_component<float>(image.view(), 2.0, {10.0, 12.0, 14.0}, options);
  });
}

}  // namespace
}  // namespace tegl::test
