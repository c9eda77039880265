// SPDX-License-Identifier: BSD-3-Clause
//
// Seed sets of the images used in the literature: their sizes, compared with those of the thesis of 2005, and
// propagation from them, which must find all active tiles, at every isovalue with TEGL_ALL_ISOVALUES in the
// environment, otherwise at some. Skipped if the folder with the files does not exist.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "active.hpp"
#include "tegl/io.hpp"
#include "tegl/seed_set.hpp"

namespace tegl::test {
namespace {

namespace fs = std::filesystem;
using Volume = OwnedImage<std::uint8_t, 3>;

constexpr std::array<Neighbourhood, 3> kNeighbourhoods = {Neighbourhood::faces, Neighbourhood::faces_and_edges,
                                                          Neighbourhood::all};

struct Sizes {
  std::string path;
  std::array<std::size_t, 3> whole1;  ///< F, F+E, F+E+V
  std::array<std::size_t, 3> cover;
  std::size_t bound_off;  ///< maximum of `cover` minus the lower bound
  bool every_isovalue;    ///< tests every isovalue: the image is small enough
};
std::ostream& operator<<(std::ostream& out, const Sizes& sizes) { return out << sizes.path; }

class SeedSetOfFile : public ::testing::TestWithParam<Sizes> {
 protected:
  void SetUp() override {
    const fs::path path = fs::path(TEGL_SHARED_DATA_DIR) / "classic" / GetParam().path;
    if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
    image_ = std::get<Volume>(std::get<1>(read_image(path).image));
  }
  [[nodiscard]] SeedSet seeds(SeedMethod method, Neighbourhood neighbourhood, std::vector<int> order = {}) const {
    SeedSetOptions options;
    options.method = method;
    options.neighbourhood = neighbourhood;
    options.scan_order = std::move(order);
    return find_seeds(image_.view(), options);
  }
  [[nodiscard]] const Volume& image() const { return image_; }

 private:
  Volume image_;
};
INSTANTIATE_TEST_SUITE_P(
    SharedData, SeedSetOfFile,
    ::testing::Values(Sizes{"fuel_64x64x64_uint8.nhdr", {4624, 2774, 2400}, {45, 42, 42}, 0, true},
                      Sizes{"neghip_64x64x64_uint8.nhdr", {44493, 18061, 12085}, {27, 26, 26}, 0, true},
                      Sizes{"silicium_98x34x34_uint8.nhdr", {27816, 17766, 13918}, {224, 203, 185}, 4, true},
                      Sizes{"hydrogen_atom_128x128x128_uint8.nhdr", {95964, 29671, 16079}, {29, 28, 28}, 0, false},
                      Sizes{
                          "aneurism_256x256x256_uint8.nhdr", {18237, 12213, 11422}, {12364, 10585, 10259}, 29, false}));

TEST_P(SeedSetOfFile, HasTheSizesThatTheDocumentationGives) {
  for (std::size_t i = 0; i < kNeighbourhoods.size(); ++i) {
    const SeedSet set = seeds(SeedMethod::cover, kNeighbourhoods[i]);
    const SeedSetStats& stats = set.stats;
    const std::size_t found = set.tiles.size();
    EXPECT_EQ(stats.whole1, GetParam().whole1[i]) << name_of(kNeighbourhoods[i]);
    EXPECT_LE(found, GetParam().cover[i]) << name_of(kNeighbourhoods[i]);
    EXPECT_LE(stats.lower_bound, found);
    EXPECT_LE(found, stats.lower_bound + GetParam().bound_off) << name_of(kNeighbourhoods[i]);
  }
}

TEST_P(SeedSetOfFile, OfHydrogenIsNoLargerThanTheThesisHas) {
  if (GetParam().path.find("hydrogen") == std::string::npos) GTEST_SKIP() << "not in the thesis with these samples";
  std::vector<int> order{0, 1, 2};
  do {
    EXPECT_LE(seeds(SeedMethod::whole2, Neighbourhood::all, order).tiles.size(), 843u);
    EXPECT_LE(seeds(SeedMethod::cover, Neighbourhood::all, order).tiles.size(), 239u);
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_LE(seeds(SeedMethod::whole2, Neighbourhood::faces).tiles.size(), 2609u);
  EXPECT_LE(seeds(SeedMethod::whole2, Neighbourhood::faces_and_edges).tiles.size(), 1037u);
  EXPECT_EQ(seeds(SeedMethod::whole1, Neighbourhood::all).tiles.size(), 16079u);
  EXPECT_LE(seeds(SeedMethod::volume_thinning, Neighbourhood::all).tiles.size(), 943u);
}

TEST_P(SeedSetOfFile, ReachesAllActiveTiles) {
  if (!GetParam().every_isovalue) GTEST_SKIP() << "large";
  const PlainRanges<3> ranges(image().view());
  const TileGrid<3> grid(image().view().grid().sizes());
  std::vector<double> isovalues;
  const std::vector<double> values = distinct_values(image());
  const std::size_t step = std::getenv("TEGL_ALL_ISOVALUES") != nullptr ? 1 : 7;
  for (std::size_t i = 0; i < values.size(); i += step) isovalues.push_back(values[i]);
  for (std::size_t i = 0; i < kNeighbourhoods.size(); ++i) {
    const SeedSet set = seeds(SeedMethod::cover, kNeighbourhoods[i]);
    std::vector<double> seen(grid.count(), -1);
    for (const double isovalue : isovalues) {
      const auto active = [&](TileNumber tile) {
        return ranges.least[tile] < isovalue && isovalue <= ranges.greatest[tile];
      };
      std::vector<TileNumber> reached;
      const auto add = [&](TileNumber tile) {
        if (seen[tile] == isovalue || !active(tile)) return;
        seen[tile] = isovalue;
        reached.push_back(tile);
      };
      for (const TileNumber seed : set.tiles) add(seed);
      for (std::size_t at = 0; at < reached.size(); ++at) {
        const auto index = grid.index(reached[at]);
        for (int move = 0; move < 27; ++move) {
          const std::array<int, 3> by{move % 3 - 1, move / 3 % 3 - 1, move / 9 - 1};
          auto next = index;
          bool inside = by[0] * by[0] + by[1] * by[1] + by[2] * by[2] <= static_cast<int>(i) + 1;
          for (int a = 0; a < 3; ++a) {
            next[a] += static_cast<std::size_t>(by[a]);
            inside = inside && next[a] < grid.size(a);
          }
          if (inside) add(grid.number(next));
        }
      }
      std::size_t expected = 0;
      for (TileNumber tile = 0; tile < grid.count(); ++tile) expected += active(tile) ? 1 : 0;
      ASSERT_EQ(reached.size(), expected) << "at " << isovalue << ", " << name_of(kNeighbourhoods[i]);
    }
  }
}

}  // namespace
}  // namespace tegl::test
