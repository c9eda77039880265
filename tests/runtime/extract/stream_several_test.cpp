// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of several isovalues. In memory: each equals the contour of its own extraction. Streamed: each equals that
// of its own pass, every layer is read once, calls are serialised, and all end if one fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <random>
#include <thread>
#include <vector>

#include "fields.hpp"
#include "tegl/stream.hpp"

namespace tegl::test {
namespace {

using Layers = FunctionLayers<float, 3>;

/// Keeps the contour; counts concurrent callers.
class KeepingSink final : public ContourSink<3, double> {
 public:
  explicit KeepingSink(std::atomic<int>& inside) : inside_(inside) {}
  void add_vertices(std::span<const Vertex> more) override {
    const Call call(*this);
    if (fails_at != 0 && vertices.size() > fails_at) throw Error(ErrorCode::WriteFailed, "the disk is full");
    vertices.insert(vertices.end(), more.begin(), more.end());
  }
  void add_normals(std::span<const Vertex> more) override {
    const Call call(*this);
    normals.insert(normals.end(), more.begin(), more.end());
  }
  void add_simplices(std::span<const Simplex> more) override {
    const Call call(*this);
    simplices.insert(simplices.end(), more.begin(), more.end());
  }
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override {
    const Call call(*this);
    simplices.at(simplex).at(static_cast<std::size_t>(corner)) = vertex;
  }

  std::vector<Vertex> vertices, normals;
  std::vector<Simplex> simplices;
  std::size_t fails_at = 0;  ///< number of vertices at which it fails; 0: never

 private:
  struct Call {
    explicit Call(KeepingSink& sink) : inside(sink.inside_) { EXPECT_EQ(++inside, 1) << "two calls at a time"; }
    ~Call() { --inside; }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;
    std::atomic<int>& inside;
  };
  std::atomic<int>& inside_;
};

class StreamSeveral : public testing::Test {
 protected:
  static constexpr std::size_t kSize = 24;

  void SetUp() override {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> values(0, 10);
    for (float& value : values_) value = values(random);
    values_[5 * kSize * kSize + 77] = std::numeric_limits<float>::quiet_NaN();
  }
  /// Layers that record the number of reads and concurrent readers.
  Layers layers() {
    return Layers(Grid<3>::unit({kSize, kSize, kSize}), [this](std::size_t k, float* to) {
      EXPECT_EQ(++inside_, 1);
      EXPECT_EQ(std::this_thread::get_id(), thread_);
      ++reads_.at(k);
      std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(k * kSize * kSize), kSize * kSize, to);
      --inside_;
    });
  }
  /// Contours at these isovalues, with new sinks.
  std::vector<StreamedContour<3, double>> contours(const std::vector<double>& isovalues) {
    std::vector<StreamedContour<3, double>> result;
    for (const double isovalue : isovalues) {
      sinks_.push_back(std::make_unique<KeepingSink>(inside_));
      result.push_back({isovalue, sinks_.back().get()});
    }
    return result;
  }

  std::vector<float> values_ = std::vector<float>(kSize * kSize * kSize);
  std::vector<int> reads_ = std::vector<int>(kSize);
  std::atomic<int> inside_ = 0;
  std::thread::id thread_ = std::this_thread::get_id();
  std::vector<std::unique_ptr<KeepingSink>> sinks_;
};

TEST_F(StreamSeveral, GivesEachContourOfAPassOfItsOwnAndReadsOnce) {
  for (const bool close : {false, true}) {
    sinks_.clear();
    std::fill(reads_.begin(), reads_.end(), 0);
    ExtractOptions options;
    options.close = close;
    options.normals = Normals::differences;
    auto several = contours({5, 2, 8, 99});
    auto source = layers();
    const auto extracted = extract_streamed_several<double>(source, several, options);
    EXPECT_THAT(reads_, testing::Each(1));
    ASSERT_EQ(extracted.size(), several.size());
    for (std::size_t i = 0; i < several.size(); ++i) {
      KeepingSink alone(inside_);
      auto again = layers();
      const auto [size, stats] = extract_streamed<double>(again, several[i].isovalue, alone, options);
      EXPECT_EQ(extracted[i].size, size);
      EXPECT_EQ(extracted[i].stats.active_tiles, stats.active_tiles);
      EXPECT_EQ(sinks_[i]->vertices, alone.vertices);
      EXPECT_EQ(sinks_[i]->normals, alone.normals);
      EXPECT_EQ(sinks_[i]->simplices, alone.simplices);
    }
    EXPECT_GT(extracted[0].size.simplices, 0U);
    EXPECT_EQ(extracted[3].size.simplices, 0U);
  }
}

TEST_F(StreamSeveral, EndsWithTheErrorOfWhoeverFails) {
  for (std::size_t failing = 0; failing < 3; ++failing) {
    sinks_.clear();
    auto several = contours({5, 2, 8});
    sinks_[failing]->fails_at = 500;
    auto source = layers();
    try {
      extract_streamed_several<double>(source, several);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::WriteFailed) << error.what();
    }
  }
}

TEST_F(StreamSeveral, EndsWithTheErrorOfTheReader) {
  auto several = contours({5, 2, 8});
  Layers broken(Grid<3>::unit({kSize, kSize, kSize}), [&](std::size_t k, float* to) {
    if (k == 9) throw Error(ErrorCode::MalformedFile, "cut short");
    std::copy_n(values_.begin(), kSize * kSize, to);
  });
  try {
    extract_streamed_several<double>(broken, several);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::MalformedFile) << error.what();
  }
}

TEST_F(StreamSeveral, CanBeCancelled) {
  auto several = contours({5, 2, 8});
  auto source = layers();
  ExtractOptions options;
  options.work.progress = [](double share) { return share < 0.4; };
  try {
    extract_streamed_several<double>(source, several, options);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

TEST_F(StreamSeveral, IsTheSameForAnyNumberOfThreads) {
  for (const unsigned threads : {1U, 2U, 3U, 16U}) {
    ExtractOptions options;
    options.work.threads = threads;
    auto several = contours({5, 2, 8, 6, 3});
    auto source = layers();
    extract_streamed_several<double>(source, several, options);
    for (std::size_t i = 0; i < several.size(); ++i) {
      const auto& here = *sinks_[sinks_.size() - several.size() + i];
      EXPECT_EQ(here.vertices, sinks_[i]->vertices);
      EXPECT_EQ(here.simplices, sinks_[i]->simplices);
    }
  }
}

TEST_F(StreamSeveral, TakesNoMoreThreadsForMoreContours) {
  const auto count_threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  if (!std::filesystem::exists("/proc/self/task")) GTEST_SKIP() << "the system does not list threads";
  const auto before = count_threads();
  std::ptrdiff_t most = 0;
  ExtractOptions options;
  options.work.threads = 2;
  options.work.progress = [&](double) {
    most = std::max(most, count_threads());
    return true;
  };
  std::vector<double> isovalues;
  for (int i = 0; i < 100; ++i) isovalues.push_back(0.1 * i);
  auto several = contours(isovalues);
  auto source = layers();
  extract_streamed_several<double>(source, several, options);
  EXPECT_THAT(reads_, testing::Each(1));
  EXPECT_LE(most, before + 2);
}

TEST_F(StreamSeveral, TellsAProgressThatDoesNotFall) {
  double last = 0;
  ExtractOptions options;
  options.work.progress = [&](double share) {
    EXPECT_EQ(std::this_thread::get_id(), thread_);
    EXPECT_GE(share, last);
    last = share;
    return true;
  };
  auto several = contours({5, 2, 8});
  auto source = layers();
  extract_streamed_several<double>(source, several, options);
  EXPECT_EQ(last, 1);
}

TEST_F(StreamSeveral, OfAnImageWithoutTilesIsEmpty) {
  auto several = contours({5, 2});
  Layers flat(Grid<3>::unit({4, 4, 1}), [](std::size_t, float* to) { std::fill_n(to, 16, 5.0F); });
  const auto extracted = extract_streamed_several<double>(flat, several);
  EXPECT_EQ(extracted[1].size.simplices, 0U);
  EXPECT_EQ(extracted[1].stats.tiles, 0U);
}

TEST_F(StreamSeveral, RefusesAContourWithoutASink) {
  auto several = contours({5, 2});
  several[1].sink = nullptr;
  auto source = layers();
  EXPECT_THROW(extract_streamed_several<double>(source, several), Error);
  EXPECT_TRUE(extract_streamed_several<double>(source, {}).empty());
  EXPECT_THAT(reads_, testing::Each(0));
}

template <class Rows>
bool equal_bytes(const Rows& a, const Rows& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

template <class Real, Value T, int N>
void expect_each_equals_its_own(const Image<T, N>& image, const std::vector<double>& isovalues) {
  ExtractOptions options;
  options.close = N < 5;
  options.normals = Normals::differences;
  options.work.threads = 2;
  const auto several = extract_several<Real>(image, isovalues, options);
  ASSERT_EQ(several.size(), isovalues.size());
  for (std::size_t i = 0; i < isovalues.size(); ++i) {
    SCOPED_TRACE(isovalues[i]);
    const auto alone = extract<Real>(image, isovalues[i], options);
    EXPECT_TRUE(equal_bytes(several[i].vertices, alone.vertices));
    EXPECT_TRUE(equal_bytes(several[i].normals, alone.normals));
    EXPECT_TRUE(equal_bytes(several[i].simplices, alone.simplices));
    EXPECT_EQ(several[i].axis_names, alone.axis_names);
  }
}

template <class Real, Value T, int N>
void expect_each_equals_its_own(const OwnedImage<T, N>& image, const std::vector<double>& isovalues) {
  expect_each_equals_its_own<Real>(image.view(), isovalues);
}

TEST(ExtractSeveral, EachContourEqualsItsOwnExtraction) {
  const std::vector<double> isovalues = {0.5, 0.9, 0.2, 0.5, 7.0};
  expect_each_equals_its_own<float>(noise<float, 2>({40, 30}, 1), isovalues);
  expect_each_equals_its_own<double>(noise<double, 3>({12, 11, 10}, 2), isovalues);
  expect_each_equals_its_own<float>(noise<float, 4>({7, 6, 5, 6}, 3), isovalues);
  expect_each_equals_its_own<float>(noise<float, 5>({3, 3, 3, 3, 2}, 4), {0.5, 0.9});
  // Fortran order: the layers are transposed first.
  const auto image = noise<float, 3>({70, 60, 50}, 5);
  Grid<3> turned = image.grid;
  std::reverse(turned.axes.begin(), turned.axes.end());
  expect_each_equals_its_own<float>(Image<float, 3>(image.values.data(), turned, {70 * 60, 70, 1}), {0.5, 0.9});
}

TEST(ExtractSeveral, WithoutIsovaluesIsEmpty) {
  const auto image = noise<float, 3>(5, 1);
  EXPECT_TRUE(extract_several(image.view(), {}).empty());
}

TEST(ExtractSeveral, ReportsAProgressThatDoesNotFallAndCanBeCancelled) {
  const auto image = noise<float, 3>({24, 23, 22}, 6);
  const std::vector<double> isovalues = {0.2, 0.5, 0.8};
  std::vector<double> fractions;
  ExtractOptions options;
  options.work.progress = [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  };
  extract_several(image.view(), isovalues, options);
  ASSERT_FALSE(fractions.empty());
  EXPECT_EQ(fractions.front(), 0.0);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);

  options.work.progress = [](double fraction) { return fraction < 0.6; };
  try {
    extract_several(image.view(), isovalues, options);
    ADD_FAILURE() << "not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

TEST(ExtractSeveral, RefusesAnIsovalueThatIsNotFiniteBeforeTheFirstContour) {
  const auto image = noise<float, 3>({9, 8, 7}, 7);
  bool begun = false;
  ExtractOptions options;
  options.work.progress = [&](double) { return begun = true; };
  try {
    extract_several(image.view(), std::vector<double>{0.5, std::nan("")}, options);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidIsovalue);
  }
  EXPECT_FALSE(begun);
}

}  // namespace
}  // namespace tegl::test
