// SPDX-License-Identifier: BSD-3-Clause
//
// Indexes of measured and simulated images, at every value that occurs: active tiles as a count of all ranges has them,
// and contours as without an index. Where the folder with the files is there. With TEGL_ALL_ISOVALUES in the
// environment (minutes) at every isovalue of every image of 8 bits, and of floats at 1 000 and at as many values of
// extremes; else at some of those of the large ones.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "active.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "tegl/active_tiles_io.hpp"
#include "tegl/io.hpp"

namespace tegl::test {
namespace {

namespace fs = std::filesystem;

const bool kAllIsovalues = wants_all_isovalues();

struct File {
  std::string path;
  std::size_t most;  ///< isovalues, unless all are asked for; 0: none then, as the definition takes long
};
std::ostream& operator<<(std::ostream& out, const File& file) { return out << file.path; }

/// Values of samples that none beside them exceeds, or none is below: where components begin and end. About so many at
/// most, evenly.
template <Value T, int N>
std::vector<double> extremes_of(const OwnedImage<T, N>& image, std::size_t most) {
  std::vector<double> extremes;
  const auto view = image.view();
  const auto sizes = image.grid.sizes();
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    bool none_above = true, none_below = true;
    for (int a = 0; a < N; ++a)
      for (const int by : {-1, 1}) {
        auto beside = index;
        beside[a] += static_cast<std::size_t>(by);
        if (beside[a] >= sizes[a]) continue;
        none_above = none_above && !(view(beside) > image.values[i]);
        none_below = none_below && !(view(beside) < image.values[i]);
      }
    const bool finite = std::isfinite(static_cast<double>(image.values[i]));
    if (finite && (none_above || none_below)) extremes.push_back(static_cast<double>(image.values[i]));
  });
  std::sort(extremes.begin(), extremes.end());
  extremes.erase(std::unique(extremes.begin(), extremes.end()), extremes.end());
  std::vector<double> chosen;
  for (std::size_t i = 0; i < extremes.size(); i += 1 + extremes.size() / most) chosen.push_back(extremes[i]);
  return chosen;
}

/// Every value that occurs (images of 8 bits), or quantiles of them, and between them; of floats, extremes too.
template <Value T, int N>
std::vector<double> isovalues_of(const OwnedImage<T, N>& image, std::size_t most) {
  std::vector<double> values = distinct_values(image);
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (sizeof(T) > 1 && kAllIsovalues) most = 500;  // and as many between them
  const std::size_t step = kAllIsovalues && sizeof(T) == 1 ? 1 : (values.size() + most - 1) / most;
  std::vector<double> isovalues;
  for (std::size_t i = 0; i < values.size(); i += step) {
    isovalues.push_back(values[i]);
    if (kAllIsovalues && i + 1 < values.size()) isovalues.push_back((values[i] + values[i + 1]) / 2);
  }
  if (sizeof(T) > 1 && kAllIsovalues) {
    const auto extremes = extremes_of(image, 1000);
    isovalues.insert(isovalues.end(), extremes.begin(), extremes.end());
  }
  return isovalues;
}

/// How many tiles are active, from sorted ends of ranges: written apart from all methods.
class ActiveCounts {
 public:
  template <int N>
  explicit ActiveCounts(const PlainRanges<N>& ranges) : least_(ranges.least), greatest_(ranges.greatest) {
    std::sort(least_.begin(), least_.end());
    std::sort(greatest_.begin(), greatest_.end());
  }
  /// Those that begin below less those that end below.
  [[nodiscard]] std::size_t at(double isovalue) const {
    const auto below = [&](const std::vector<double>& values) {
      return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), isovalue) - values.begin());
    };
    return below(least_) - below(greatest_);
  }

 private:
  std::vector<double> least_, greatest_;
};

template <Value T, int N>
void expect_right(const OwnedImage<T, N>& image, std::size_t most) {
  const auto view = image.view();
  const PlainRanges<N> plain(view);
  const ActiveCounts counts(plain);
  std::vector<std::unique_ptr<ActiveTiles<N>>> indexes;
  for (const ActiveMethod method : active_methods()) indexes.push_back(build_active_tiles(view, method));
  for (const double isovalue : isovalues_of(image, most)) {
    const auto expected = indexes.front()->find(isovalue);  // the full scan
    ASSERT_EQ(expected.size(), counts.at(isovalue));
    for (const TileNumber tile : expected)
      ASSERT_TRUE(plain.least[tile] < isovalue && isovalue <= plain.greatest[tile]) << "tile " << tile;
    for (const auto& index : indexes)
      ASSERT_EQ(index->find(isovalue), expected) << active_method_name(index->method()) << " at " << isovalue;
  }
}

/// Some contours by each method, against those without.
template <Value T, int N>
void expect_same_contours(const OwnedImage<T, N>& image) {
  const auto view = image.view();
  const auto same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
  };
  const std::vector<double> isovalues = isovalues_of(image, 4);
  for (const ActiveMethod method : active_methods()) {
    const auto index = build_active_tiles(view, method);
    for (std::size_t i = 1; i < isovalues.size(); i += 1 + isovalues.size() / 4) {
      const auto expected = extract<float>(view, isovalues[i]);
      const auto contour = extract<float>(view, isovalues[i], {}, *index);
      EXPECT_TRUE(same(contour.vertices, expected.vertices) && same(contour.simplices, expected.simplices))
          << active_method_name(method) << " at " << isovalues[i];
    }
  }
}

class ActiveTilesOfFile : public ::testing::TestWithParam<File> {
 protected:
  void SetUp() override {
    const fs::path path = fs::path(TEGL_SHARED_DATA_DIR) / GetParam().path;
    if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
    image_ = read_image(path).image;
  }
  template <class Work>
  void visit(const Work& work) const {
    std::visit([&](const auto& typed) { std::visit(work, typed); }, image_);
  }

 private:
  AnyImage image_;
};
INSTANTIATE_TEST_SUITE_P(SharedData, ActiveTilesOfFile,
                         ::testing::Values(File{"classic/fuel_64x64x64_uint8.nhdr", 60},
                                           File{"classic/neghip_64x64x64_uint8.nhdr", 60},
                                           File{"classic/silicium_98x34x34_uint8.nhdr", 60},
                                           File{"classic/hydrogen_atom_128x128x128_uint8.nhdr", 6},
                                           File{"classic/aneurism_256x256x256_uint8.nhdr", 0},
                                           File{"fourd/viscous_fingers_64x64x64x24_float.nhdr", 2},
                                           File{TEGL_SOURCE_DIR "/examples/data/ocean_temperature.nc", 2},
                                           File{"dem2d/jacksboro_403x344_int16.nhdr", 40}));

TEST_P(ActiveTilesOfFile, AreThoseOfTheDefinitionAtEveryIsovalue) {
  if (GetParam().most == 0 && !kAllIsovalues) GTEST_SKIP() << "large: with TEGL_ALL_ISOVALUES";
  visit([](const auto& image) { expect_right(image, std::max<std::size_t>(1, GetParam().most)); });
}
TEST_P(ActiveTilesOfFile, GiveTheContourOfAllTiles) {
  if (GetParam().path.ends_with(".nc") && !kAllIsovalues) GTEST_SKIP() << "large: with TEGL_ALL_ISOVALUES";
  visit([](const auto& image) { expect_same_contours(image); });
}

// ---- files ----

class IndexFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tegl_index_file_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }

 private:
  fs::path folder_;
};

TEST_F(IndexFile, ComesBackAsItWas) {
  const auto image = noise_with_missing<float, 4>(Grid<4>::unit({9, 8, 5, 4}), 1, 0.05);
  for (const ActiveMethod method : active_methods()) {
    const auto index = build_active_tiles(image.view(), method);
    write_active_tiles(*index, path("a.tindex"));
    const auto read = read_active_tiles(path("a.tindex"), image.view());
    EXPECT_EQ(read->method(), method);
    EXPECT_EQ(read->image(), index->image());
    EXPECT_EQ(read->find(0.5), index->find(0.5));
    const ActiveTilesHead head = read_active_tiles_head(path("a.tindex"));
    EXPECT_EQ(head.method, method);
    EXPECT_EQ(head.sizes, (std::vector<std::uint64_t>{9, 8, 5, 4}));
  }
}

TEST_F(IndexFile, ErrorsNameTheFile) {
  const auto image = noise<float, 3>({9, 8, 5}, 2);
  const auto other = noise<float, 3>({9, 8, 5}, 3);
  const auto read = [&](const char* name) { read_active_tiles(path(name), image.view()); };
  expect_error(ErrorCode::FileNotFound, "none.tindex", [&] { read("none.tindex"); });
  write_active_tiles(*build_active_tiles(other.view(), ActiveMethod::span_space), path("other.tindex"));
  expect_error(ErrorCode::InvalidArgument, "other.tindex: the index is of an image with other values",
               [&] { read("other.tindex"); });
  write_active_tiles(*build_active_tiles(image.view(), ActiveMethod::span_space), path("cut.tindex"));
  fs::resize_file(path("cut.tindex"), fs::file_size(path("cut.tindex")) - 9);
  expect_error(ErrorCode::MalformedFile, "cut.tindex: the index is damaged", [&] { read("cut.tindex"); });
  std::ofstream(path("text.tindex")) << "this is no index but a text that someone gave the name of one";
  expect_error(ErrorCode::MalformedFile, "text.tindex: not an index of active tiles", [&] { read("text.tindex"); });
  expect_error(ErrorCode::WriteFailed, "a.tindex", [&] {
    write_active_tiles(*build_active_tiles(image.view(), ActiveMethod::span_space), path("no/a.tindex"));
  });
  expect_error(ErrorCode::InvalidArgument, "chosen tiles",
               [&] { write_active_tiles(*choose_tiles(image.view(), {1}), path("b.tindex")); });
  EXPECT_FALSE(fs::exists(path("b.tindex")));
}

}  // namespace
}  // namespace tegl::test
