// SPDX-License-Identifier: BSD-3-Clause
//
// For every failing allocation, followed by further failures or not: the caller gets std::bad_alloc or the complete
// result, and all memory is released.
#include "failing_memory.hpp"

#ifdef __linux__
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"
#include "tegl/stream.hpp"

namespace tegl::test {
namespace {

constexpr std::uint64_t kNoBytes = 14695981039346656037u;  ///< digest of nothing

/// A number that differs for different results.
template <class Range>
std::uint64_t digest(const Range& rows, std::uint64_t sum) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(rows.data());
  for (std::size_t i = 0; i < rows.size() * sizeof(rows[0]); ++i) sum = (sum ^ bytes[i]) * 1099511628211u;
  return sum;
}
template <int N, class Real>
std::uint64_t digest(const Contour<N, Real>& contour) {
  return digest(contour.normals, digest(contour.simplices, digest(contour.vertices, kNoBytes)));
}

/// A sink that stores a digest without allocating.
template <int N>
struct DigestSink final : ContourSink<N, float> {
  using typename ContourSink<N, float>::Vertex;
  using typename ContourSink<N, float>::Simplex;
  void add_vertices(std::span<const Vertex> vertices) override { sum = digest(vertices, sum); }
  void add_normals(std::span<const Vertex> normals) override { sum = digest(normals, sum); }
  void add_simplices(std::span<const Simplex> simplices) override { sum = digest(simplices, sum); }
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override {
    sum = digest(std::array{simplex, static_cast<std::uint64_t>(corner), vertex}, sum);
  }
  std::uint64_t sum = kNoBytes;
};

template <int N>
OwnedImage<float, N> layered(const std::array<std::size_t, N>& sizes, double missing) {
  return noise_with_missing<float, N>(Grid<N>::unit(sizes), 3, missing);
}

template <int N>
std::uint64_t extracted_into(const OwnedImage<float, N>& image, const ExtractOptions& options) {
  const ContourSize size = count(image.view(), 0.5, options);
  std::vector<std::array<float, N>> vertices(size.vertices);
  std::vector<std::array<float, N>> normals(options.normals != Normals::none ? size.vertices : 0);
  std::vector<std::array<std::uint64_t, N>> simplices(size.simplices);
  extract_into(image.view(), 0.5, ContourRoom<N, float, std::uint64_t>{vertices, simplices, normals}, options);
  return digest(normals, digest(simplices, digest(vertices, 1)));
}

template <int N>
std::uint64_t streamed(const OwnedImage<float, N>& image, const ExtractOptions& options) {
  std::size_t layer = 1;
  for (int a = 0; a < N - 1; ++a) layer *= image.grid.axes[a].size();
  FunctionLayers<float, N> layers(
      image.grid, [&](std::size_t k, float* to) { std::copy_n(image.values.data() + k * layer, layer, to); });
  DigestSink<N> sink;
  extract_streamed<float>(layers, 0.5, sink, options);
  return sink.sum;
}

template <int N>
void expect_all_ways_survive(const std::array<std::size_t, N>& sizes, unsigned threads) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer has its own memory";
#endif
  for (const double missing : {0.0, 0.02}) {
    const auto image = layered<N>(sizes, missing);
    ExtractOptions options;
    options.work.threads = threads;
    options.normals = missing == 0.0 ? Normals::differences : Normals::none;
    options.close = missing != 0.0;
    options.triangulation = missing == 0.0 ? Triangulation::compact : Triangulation::barycentric;
    // Threads keep memory of their own.
    const bool alone = threads == 1;
    EXPECT_GT(expect_survives(
                  "extract", [&] { return digest(extract<float>(image.view(), 0.5, options)); }, alone),
              20);
    EXPECT_GT(expect_survives(
                  "extract_into", [&] { return extracted_into(image, options); }, alone),
              20);
    EXPECT_GT(expect_survives(
                  "streamed", [&] { return streamed(image, options); }, alone),
              20);
    if constexpr (N > 2) {
      EXPECT_GT(expect_survives(
                    "slice_image",
                    [&] { return digest(slice_image(image.view(), 0.5, Hyperplane<N>::across(N - 1, 1.25), options)); },
                    alone),
                20);
      if (!alone) continue;
      const auto contour = extract<float>(image.view(), 0.5, options);
      EXPECT_GT(expect_survives(
                    "slice", [&] { return digest(slice(contour, Hyperplane<N>::across(N - 1, 1.25))); }, true),
                10);
      EXPECT_GT(expect_survives(
                    "check", [&] { return check(contour).components; }, true),
                5);
    }
  }
}

TEST(OutOfMemory, IsSurvivedIn2d) { expect_all_ways_survive<2>({50, 12}, 1); }
TEST(OutOfMemory, IsSurvivedIn3d) { expect_all_ways_survive<3>({11, 8, 7}, 1); }
TEST(OutOfMemory, IsSurvivedIn4d) { expect_all_ways_survive<4>({5, 4, 4, 5}, 1); }
TEST(OutOfMemory, IsSurvivedIn5d) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer has its own memory";
#endif
  const auto corner = sample_field<float, 5>(Grid<5>::unit({2, 2, 2, 2, 2}),
                                             [](const Point<5>& x) { return 0.25 - x[0] - x[1] - x[2] - x[3] - x[4]; });
  ExtractOptions options;
  options.work.threads = 1;
  options.normals = Normals::differences;
  EXPECT_GT(expect_survives(
                "extract", [&] { return digest(extract<float>(corner.view(), 0.0, options)); }, true),
            20);
  const auto contour = extract<float>(corner.view(), 0.0, options);
  EXPECT_GT(expect_survives(
                "check", [&] { return check(contour).components; }, true),
            5);
}
TEST(OutOfMemory, IsSurvivedBySeveralThreads) { expect_all_ways_survive<3>({30, 20, 9}, 3); }

TEST(OutOfMemory, IsSurvivedBySimplification) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer has its own memory";
#endif
  const auto image = sample_field<float, 3>(centred_grid<3>(9, 1.0), Ball<3>{{}, 0.7});
  const auto contour = extract<float>(image.view(), 0.0, {});
  for (const unsigned threads : {1u, 3u})
    for (const bool measure : {false, true}) {
      SimplifyOptions<3> options;
      options.work.threads = threads;
      options.measure = measure;
      if (measure)
        options.max_error = 0.05;
      else
        options.ratio = 0.5;
      const auto simplified = [&] { return simplify(contour, options).contour; };
      ASSERT_LT(simplified().simplices.size(), contour.simplices.size());
      EXPECT_GT(expect_survives(
                    measure ? "simplify to an error" : "simplify to a count", [&] { return digest(simplified()); },
                    threads == 1),
                20);
    }
}

#ifdef __linux__
/// Contours so large that the system supplies their memory in large blocks, reserved beforehand or grown.
TEST(OutOfMemory, OfLargeBlocksIsSurvived) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer has its own memory";
#endif
  const auto image = layered<3>({50, 50, 40}, 0.0);
  ExtractOptions options;
  options.work.threads = 1;
  options.normals = Normals::differences;
  const std::int64_t before = memory.mapped_bytes;
  {
    const auto contour = extract<float>(image.view(), 0.5, options);
    ASSERT_GE(memory.mapped_bytes - before, 3 * (std::int64_t{1} << 21)) << "three outputs in large blocks";
  }
  EXPECT_GT(expect_survives(
                "extract", [&] { return digest(extract<float>(image.view(), 0.5, options)); }, true),
            20);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// More address space never makes a contour fail that succeeds with less: reserving address space, so that outputs need
/// not move, does not exhaust it elsewhere.
TEST(OutOfMemory, NeverComesFromMoreAddressSpace) {
  const auto image = sample_field<float, 3>(centred_grid<3>(90, 1.0), Ball<3>{{}, 0.7});
  ExtractOptions options;
  options.work.threads = 1;
  const auto succeeds_with = [&](rlim_t more) {
    const pid_t child = fork();
    if (child == 0) {
      std::size_t pages = 0;
      std::ifstream("/proc/self/statm") >> pages;
      const rlim_t limit = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more;
      const rlimit limits{limit, limit};
      setrlimit(RLIMIT_AS, &limits);
      try {
        extract<float>(image.view(), 0.0, options);
      } catch (const std::bad_alloc&) {
        _exit(1);
      }
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status) == 0;
  };
  bool succeeded = false;
  for (rlim_t more = 0; more <= rlim_t{240} << 20; more += rlim_t{4} << 20) {
    const bool succeeds = succeeds_with(more);
    EXPECT_TRUE(succeeds || !succeeded) << "with " << (more >> 20) << " MiB, but not with less";
    succeeded = succeeded || succeeds;
  }
  EXPECT_TRUE(succeeded);
}
#endif
#endif

}  // namespace
}  // namespace tegl::test
