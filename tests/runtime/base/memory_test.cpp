// SPDX-License-Identifier: BSD-3-Clause
//
// Working memory of an extraction besides its image and contour: counts every allocation of this program. (Blocks of 2
// MiB and more come from the system and are not counted; extract_into_test measures the process.)
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "counted_memory.hpp"
#include "fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/stream.hpp"

namespace tegl::test {
namespace {

/// The kinds of tables, and an estimator from the data in both triangulations.
std::vector<ExtractOptions> all_variants() {
  auto result = variants();
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider}) {
    result.push_back(result.front());
    result.back().ambiguity = ambiguity;
  }
  return result;
}

/// Tests 1 and 4 threads, without and with normals.
template <Value T, int N>
void expect_at_most(std::size_t bytes, const OwnedImage<T, N>& image, double isovalue,
                    const std::vector<ExtractOptions>& all) {
  for (ExtractOptions options : all)
    for (const unsigned threads : {1u, 4u})
      for (const bool normals : {false, true}) {
        options.work.threads = threads;
        options.normals = normals ? Normals::differences : Normals::none;
        SCOPED_TRACE(testing::Message() << describe(options) << ", threads " << threads << ", normals " << normals);
        EXPECT_LE(bytes_beside(image, isovalue, options), bytes);
      }
}

template <Value T, int N>
void expect_a_sixteenth(const OwnedImage<T, N>& image, double isovalue) {
  expect_at_most(image.values.size() * sizeof(T) / 16, image, isovalue, all_variants());
}

TEST(Memory, BesideImageAndContourIsASixteenthOfTheImageIn2d) { expect_a_sixteenth(noise<float, 2>(2048, 1), 0.5); }
TEST(Memory, BesideImageAndContourIsASixteenthOfTheImageIn3d) { expect_a_sixteenth(noise<float, 3>(112, 2), 0.9); }
TEST(Memory, BesideImageAndContourIsASixteenthOfTheImageIn4d) {
  expect_a_sixteenth(noise<float, 4>({64, 16, 16, 72}, 3), 0.98);
}

/// 128 KiB and the memory that does not depend on slabs, for any small image.
TEST(Memory, BesideASmallImageIsAnEighthOfAMebibyte) {
  constexpr std::size_t kMost = (std::size_t{1} << 17) + 8192;
  expect_at_most(kMost, noise<float, 3>(64, 5), 0.5, all_variants());
  expect_at_most(kMost, noise<std::uint8_t, 3>(64, 6), 127.5, variants());
  expect_at_most(kMost, noise<float, 2>(512, 7), 0.5, all_variants());
}
TEST(Memory, BesideAnImageOfAFewMebibytesIsASixteenthOfIt) {
  expect_a_sixteenth(noise<float, 2>(1024, 8), 0.5);
  expect_a_sixteenth(noise<float, 3>(96, 9), 0.5);
}

/// For a few long rows, the lists of edges of a thread dominate.
TEST(Memory, BesideLongRows) {
  const auto image = noise<float, 2>({50000, 50}, 10);
  for (const auto& o : variants()) expect_at_most(image.values.size() * sizeof(float) / 3, image, 0.5, {o});
}

/// The working memory of a long image is that of a few slabs; a longer image needs no more.
TEST(Memory, DoesNotGrowWithTheContour) {
  const auto image = noise<float, 4>({64, 16, 16, 72}, 3);
  for (ExtractOptions options : variants()) {
    options.work.threads = 1;
    SCOPED_TRACE(describe(options));
    const std::size_t few = bytes_beside(image, 0.9999, options);
    EXPECT_LE(bytes_beside(image, 0.98, options), few + 4096);
  }
}

/// A sink that keeps nothing.
class Nowhere final : public ContourSink<3, float> {
 public:
  void add_vertices(std::span<const Vertex> vertices) override { count += vertices.size(); }
  void add_normals(std::span<const Vertex> /*normals*/) override {}
  void add_simplices(std::span<const Simplex> /*simplices*/) override {}
  void replace_corner(std::uint64_t /*simplex*/, int /*corner*/, std::uint64_t /*vertex*/) override {}
  std::size_t count = 0;
};

/// A streamed contour with periodic axes keeps some layers and the seam between them; a longer image needs no more.
TEST(Memory, OfAStreamWithPeriodicAxesDoesNotGrowWithTheLayers) {
  constexpr std::size_t kSize = 96, kLayer = kSize * kSize, kDifferent = 8;
  const auto image = noise<float, 3>({kSize, kSize, kDifferent}, 11);
  std::size_t vertices = 0;
  const auto peak = [&](std::size_t length, const AxisPeriods<3>& periods, Normals normals) {
    FunctionLayers<float, 3> layers(Grid<3>::unit({kSize, kSize, length}), [&](std::size_t k, float* to) {
      std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>(k % kDifferent * kLayer), kLayer, to);
    });
    Nowhere sink;
    ExtractOptions options;
    options.normals = normals;
    options.work.threads = 1;
    const std::size_t before = counted_memory::live_bytes;
    counted_memory::peak_bytes = before;
    extract_streamed<float>(layers, 0.9, sink, options, periods);
    vertices = sink.count;
    return counted_memory::peak_bytes - before;
  };
  for (const Normals normals : {Normals::none, Normals::differences})
    for (const double last : {0.0, 1.0}) {
      const auto periods = [&](double length) { return AxisPeriods<3>{double{kSize}, double{kSize}, last * length}; };
      const std::size_t of_few = peak(48, periods(48), normals);
      EXPECT_LE(peak(480, periods(480), normals), of_few + 4096);
      EXPECT_GT(12 * vertices, 2 * of_few) << "the vertices alone are more than all that is kept";
    }
}

}  // namespace
}  // namespace tegl::test
