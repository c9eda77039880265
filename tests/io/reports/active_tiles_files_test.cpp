// SPDX-License-Identifier: BSD-3-Clause
//
// Indexes of measured and simulated images at every value that occurs: the number of active tiles agrees with a count
// over all ranges, and contours equal those without an index. Skipped if the folder with the files does not exist. With
// TEGL_ALL_ISOVALUES in the environment (minutes), every isovalue of every 8-bit image is tested, and for floats 1 000
// values and about 2 000 of the extremes and saddles; otherwise some isovalues of the large images.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "active.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "tegl/io.hpp"
#include "tegl/io/active_tiles.hpp"

namespace tegl::test {
namespace {

namespace fs = std::filesystem;

const bool kAllIsovalues = wants_all_isovalues();

struct File {
  std::string path;
  std::size_t most;  ///< number of isovalues by default; 0: none, as the reference is slow
};
std::ostream& operator<<(std::ostream& out, const File& file) { return out << file.path; }

/// Values at which components of samples at or above, or at or below, appear or merge: extremes and saddles. Found by
/// union-find of each sample with its neighbours, from the maximum downwards and from the minimum upwards.
template <Value T, int N>
std::vector<double> critical_values(const OwnedImage<T, N>& image) {
  const auto sizes = image.grid.sizes();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (std::isfinite(static_cast<double>(image.values[i]))) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return image.values[a] < image.values[b]; });
  std::vector<double> critical;
  for (int direction = 0; direction < 2; ++direction, std::reverse(order.begin(), order.end())) {
    constexpr auto kNone = static_cast<std::size_t>(-1);
    std::vector<std::size_t> parent(image.values.size(), kNone);
    const auto find = [&](std::size_t i) {
      while (parent[i] != i) i = parent[i] = parent[parent[i]];
      return i;
    };
    for (const std::size_t i : order) {
      int met = 0;
      parent[i] = i;
      std::size_t stride = 1;
      for (int a = 0; a < N; stride *= sizes[a], ++a)
        for (const bool up : {false, true}) {
          const std::size_t at = i / stride % sizes[a];
          if (up ? at + 1 == sizes[a] : at == 0) continue;
          const std::size_t beside = up ? i + stride : i - stride;
          if (parent[beside] == kNone || find(beside) == find(i)) continue;
          parent[find(beside)] = i;
          ++met;
        }
      if (met != 1) critical.push_back(static_cast<double>(image.values[i]));
    }
  }
  std::sort(critical.begin(), critical.end());
  critical.erase(std::unique(critical.begin(), critical.end()), critical.end());
  return critical;
}

/// Every value that occurs (8-bit images) or quantiles, and values between them; for floats also critical values. If
/// there are more than some thousand, an even selection.
template <Value T, int N>
std::vector<double> isovalues_of(const OwnedImage<T, N>& image, std::size_t most) {
  std::vector<double> values = distinct_values(image);
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (sizeof(T) > 1 && kAllIsovalues) most = 500;  // and the same number between them
  const std::size_t step = kAllIsovalues && sizeof(T) == 1 ? 1 : (values.size() + most - 1) / most;
  std::vector<double> isovalues;
  for (std::size_t i = 0; i < values.size(); i += step) {
    isovalues.push_back(values[i]);
    if (kAllIsovalues && i + 1 < values.size()) isovalues.push_back((values[i] + values[i + 1]) / 2);
  }
  if (sizeof(T) > 1 && kAllIsovalues) {
    const auto critical = critical_values(image);
    for (std::size_t i = 0; i < critical.size(); i += 1 + critical.size() / 2000) isovalues.push_back(critical[i]);
  }
  return isovalues;
}

/// The number of active tiles, from sorted ends of ranges; independent of all index methods.
class ActiveCounts {
 public:
  template <int N>
  explicit ActiveCounts(const PlainRanges<N>& ranges) : least_(ranges.least), greatest_(ranges.greatest) {
    std::sort(least_.begin(), least_.end());
    std::sort(greatest_.begin(), greatest_.end());
  }
  /// The ranges that begin below minus those that end below.
  [[nodiscard]] std::size_t at(double isovalue) const {
    const auto below = [&](const std::vector<double>& values) {
      return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), isovalue) - values.begin());
    };
    return below(least_) - below(greatest_);
  }

 private:
  std::vector<double> least_, greatest_;
};

template <int N>
void expect_active(const std::vector<std::unique_ptr<ActiveTiles<N>>>& indexes, const PlainRanges<N>& plain,
                   const ActiveCounts& counts, double isovalue) {
  const auto expected = indexes.front()->find(isovalue);  // the full scan
  ASSERT_EQ(expected.size(), counts.at(isovalue));
  for (const TileNumber tile : expected)
    ASSERT_TRUE(plain.least[tile] < isovalue && isovalue <= plain.greatest[tile]) << "tile " << tile;
  for (const auto& index : indexes)
    ASSERT_EQ(index->find(isovalue), expected) << active_method_name(index->method()) << " at " << isovalue;
}

template <Value T, int N>
void expect_right(const OwnedImage<T, N>& image, std::size_t most) {
  const auto view = image.view();
  const PlainRanges<N> plain(view);
  const ActiveCounts counts(plain);
  std::vector<std::unique_ptr<ActiveTiles<N>>> indexes;
  for (const ActiveMethod method : active_methods()) indexes.push_back(build_active_tiles(view, method));
  const auto isovalues = isovalues_of(image, most);
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> workers;  // several isovalues at a time: an index is only read
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    workers.emplace_back([&] {
      for (std::size_t at; !::testing::Test::HasFailure() && (at = next++) < isovalues.size();)
        expect_active(indexes, plain, counts, isovalues[at]);
    });
  for (std::thread& worker : workers) worker.join();
}

/// Expects some contours by each method to equal those without an index.
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
      const auto contour = extract<float>(view, isovalues[i], *index);
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

TEST_F(IndexFile, ThatIsCutOrChangedAnywhereIsNoticedWithoutTheImage) {
  const auto expect_noticed = [&](const auto& image) {
    for (const ActiveMethod method : active_methods()) {
      write_active_tiles(*build_active_tiles(image.view(), method), path("whole.tindex"));
      EXPECT_EQ(check_active_tiles(path("whole.tindex")).method, method);
      std::ifstream file(path("whole.tindex"), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      for (std::size_t end = 0; end < bytes.size(); end += 1 + bytes.size() / 29) {
        std::ofstream(path("cut.tindex"), std::ios::binary) << bytes.substr(0, end);
        expect_error(ErrorCode::MalformedFile, "cut.tindex", [&] { check_active_tiles(path("cut.tindex")); });
        std::string changed = bytes;
        changed[end] = static_cast<char>(changed[end] ^ 4);
        std::ofstream(path("changed.tindex"), std::ios::binary) << changed;
        EXPECT_THROW(check_active_tiles(path("changed.tindex")), Error) << active_method_name(method) << " at " << end;
      }
      std::ofstream(path("whole.tindex"), std::ios::binary | std::ios::app) << 'a';
      expect_error(ErrorCode::MalformedFile, "after its end", [&] { check_active_tiles(path("whole.tindex")); });
    }
  };
  expect_noticed(noise<double, 3>({19, 8, 5}, 4));
  expect_noticed(noise<std::uint8_t, 2>({30, 21}, 5));
  expect_noticed(noise<std::int16_t, 3>({1, 8, 5}, 6));  // no tiles
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
