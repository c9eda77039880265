// SPDX-License-Identifier: BSD-3-Clause
//
// Sizes computed in advance, contours in caller-supplied memory, 64-bit vertex numbers, and the working memory of an
// extraction.
#ifdef __linux__
#include <malloc.h>
#endif

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "fields.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

template <class I, class Real, Value T, int N>
void expect_same(const Image<T, N>& image, double isovalue, const ExtractOptions& options) {
  const auto contour = extract<Real>(image, isovalue, options);
  const ContourSize size = count(image, isovalue, options);
  EXPECT_EQ(size, (ContourSize{contour.vertices.size(), contour.simplices.size()}));
  // Room for one more of each, and guards behind it: whole registers are stored, of which no lane may change them.
  constexpr std::size_t kGuards = 17;
  std::array<Real, N> vertex;
  vertex.fill(Real{-77});
  std::array<I, N> simplex;
  simplex.fill(I{77});
  std::vector<std::array<Real, N>> vertices(size.vertices + kGuards, vertex);
  std::vector<std::array<I, N>> simplices(size.simplices + kGuards, simplex);
  auto normals = vertices;
  const auto room = [](auto& elements) { return std::span(elements).first(elements.size() - kGuards + 1); };
  const auto written =
      extract_into(image, isovalue, ContourRoom<N, Real, I>{room(vertices), room(simplices), room(normals)}, options);
  EXPECT_EQ(written.size, size);
  EXPECT_GT(written.stats.active_tiles, 0u);
  for (std::size_t k = 0; k < kGuards; ++k) {
    EXPECT_EQ(vertices[size.vertices + k], vertex);
    EXPECT_EQ(simplices[size.simplices + k], simplex);
    EXPECT_EQ(normals[size.vertices + k], vertex);
  }
  for (std::size_t v = 0; v < size.vertices; ++v)
    ASSERT_EQ(std::memcmp(&normals[v], options.normals != Normals::none ? &contour.normals[v] : &vertex, sizeof vertex),
              0)
        << v;
  for (std::size_t v = 0; v < size.vertices; ++v)
    ASSERT_EQ(std::memcmp(&vertices[v], &contour.vertices[v], sizeof vertex), 0) << "vertex " << v;
  for (std::size_t s = 0; s < size.simplices; ++s)
    for (int j = 0; j < N; ++j) ASSERT_EQ(simplices[s][j], contour.simplices[s][j]) << "simplex " << s;
}

template <int N>
void expect_same_in_all_variants(const std::array<std::size_t, N>& sizes, std::uint64_t seed) {
  for (ExtractOptions options : variants())
    for (const bool close : {false, true}) {
      options.close = close;
      options.normals = seed % 8 < 4 ? Normals::differences : Normals::none;
      SCOPED_TRACE(describe(options));
      const auto image = noise<float, N>(sizes, seed++);
      expect_same<std::uint32_t, float>(image.view(), 0.5, options);
      expect_same<std::uint64_t, double>(image.view(), 0.5, options);
      const auto holes = noise_with_missing<float, N>(Grid<N>::unit(sizes), seed++, 0.03);
      expect_same<std::uint32_t, double>(holes.view(), 0.5, options);
      expect_same<std::uint64_t, float>(holes.view(), 0.5, options);
    }
}

TEST(ExtractInto, GivesWhatExtractGivesIn2d) { expect_same_in_all_variants<2>({70, 40}, 1); }
TEST(ExtractInto, GivesWhatExtractGivesIn3d) { expect_same_in_all_variants<3>({67, 9, 12}, 101); }
TEST(ExtractInto, GivesWhatExtractGivesIn4d) { expect_same_in_all_variants<4>({9, 6, 5, 8}, 201); }

TEST(ExtractInto, SaysHowMuchRoomIsMissing) {
  const auto image = noise<std::uint8_t, 3>(12, 5);
  const double isovalue = noise_isovalue<std::uint8_t>();
  for (const bool close : {false, true}) {
    ExtractOptions options;
    options.close = close;
    const ContourSize size = count(image.view(), isovalue, options);
    for (const bool few_vertices : {false, true}) {
      std::vector<std::array<float, 3>> vertices(size.vertices - (few_vertices ? 1 : 0));
      std::vector<std::array<std::uint32_t, 3>> simplices(size.simplices - (few_vertices ? 0 : 1));
      try {
        extract_into(image.view(), isovalue, ContourRoom<3, float>{vertices, simplices}, options);
        FAIL() << "no error";
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
        const std::size_t room = few_vertices ? vertices.size() : simplices.size();
        const std::string expected = "room for " + std::to_string(room) + (few_vertices ? " vertices" : " simplices");
        EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
      }
    }
  }
}

TEST(ExtractInto, SaysHowMuchRoomForNormalsIsMissing) {
  ExtractOptions options;
  options.normals = Normals::differences;
  for (const double missing : {0.0, 0.05}) {
    const auto image = noise_with_missing<float, 3>(Grid<3>::unit({12, 12, 12}), 5, missing);
    const ContourSize size = count(image.view(), 0.5, options);
    std::vector<std::array<float, 3>> vertices(size.vertices);
    std::vector<std::array<std::uint32_t, 3>> simplices(size.simplices);
    std::vector<std::array<float, 3>> normals(size.vertices - 1);
    try {
      extract_into(image.view(), 0.5, ContourRoom<3, float>{vertices, simplices, normals}, options);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find("room for " + std::to_string(normals.size()) + " normals"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(Count, OfAnImageWithoutTilesOrWithoutContourIsZero) {
  const std::vector<float> values(20, 1.0f);
  EXPECT_EQ((count(Image<float, 2>(values.data(), Grid<2>::unit({20, 1})), 0.5)), ContourSize{});
  EXPECT_EQ((count(Image<float, 2>(values.data(), Grid<2>::unit({5, 4})), 0.5)), ContourSize{});
  EXPECT_THROW((count(Image<float, 2>(values.data(), Grid<2>::unit({5, 4})), std::numeric_limits<double>::infinity())),
               Error);
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

/// A value of /proc/self/status in bytes.
std::size_t process_memory(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (std::size_t kibibytes = 0; word == name + ":" && status >> kibibytes) return 1024 * kibibytes;
  return 0;
}

template <Value T, int N>
void expect_little_memory(const OwnedImage<T, N>& image, double isovalue) {
  for (unsigned threads = 1; threads <= 4; threads += 3) {
    ExtractOptions options;
    options.work.threads = threads;
    const ContourSize size = count(image.view(), isovalue, options);
    std::vector<std::array<float, N>> vertices(size.vertices);
    std::vector<std::array<Index, N>> simplices(size.simplices);
    const ContourRoom<N, float> room{vertices, simplices};
    extract_into(image.view(), isovalue, room, options);  // loads the library's code and starts its threads
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";  // resets the peak
    const std::size_t before = process_memory("VmRSS");
    if (process_memory("VmHWM") > before + 65536) GTEST_SKIP() << "the peak of the memory cannot be set back here";
    EXPECT_EQ(extract_into(image.view(), isovalue, room, options).size, size);
    EXPECT_LE(process_memory("VmHWM"), before + image.values.size() * sizeof(T) / 16) << threads << " threads";
  }
}

/// At most a sixteenth of the image (for large images; the minimum is two layers and a slab).
TEST(Memory, BesideImageAndContourIsLittle) {
  expect_little_memory(noise<float, 2>(4096, 1), 0.5);
  expect_little_memory(noise<float, 3>(208, 2), 0.9);
  expect_little_memory(noise<std::uint8_t, 3>(256, 3), 200.5);
  expect_little_memory(noise<float, 4>({128, 16, 16, 128}, 4), 0.98);
}

#endif

}  // namespace
}  // namespace tegl::test
