// SPDX-License-Identifier: BSD-3-Clause
//
// Streamed contours of images on lattices are those in memory, by rows of bits with the same numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "collector.hpp"
#include "complex_cases.hpp"
#include "errors.hpp"
#include "lattice_image.hpp"
#include "tegl/check.hpp"

namespace tegl::test {
namespace {

constexpr double kIsovalue = 0.97;  // of noise: few active cells, everywhere

/// Layers of an image in memory, each of which may be requested once, in ascending order.
template <int N>
FunctionLayers<double, N> layers_of(const OwnedImage<double, N>& image, std::size_t& next) {
  const std::size_t size = image.values.size() / image.grid.axes[N - 1].size();
  return {image.grid, [&image, &next, size](std::size_t k, double* to) {
            EXPECT_EQ(k, next++);
            std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>(k * size), size, to);
          }};
}

/// Streams the contour of an image on a lattice into a sink. All layers are read.
template <int N>
ExtractedSize stream_to(Collector<N, double>& sink, const OwnedImage<double, N>& image, Lattice lattice,
                        const ExtractOptions& options) {
  std::size_t next = 0;
  auto layers = layers_of<N>(image, next);
  const ExtractedSize extracted = extract_lattice_streamed<double>(layers, lattice, kIsovalue, sink, options);
  EXPECT_EQ(next, image.grid.axes[N - 1].size());
  return extracted;
}

template <int N>
void expect_streamed(Lattice lattice, const std::array<std::size_t, N>& sizes, unsigned seed) {
  SCOPED_TRACE(testing::Message() << name_of(lattice) << ", " << sizes[N - 1] << " layers");
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(sizes[a], -1.0, a + 1 < N ? 0.1 : 0.1 * layer_step(lattice));
  if (seed % 2 == 0) grid.linear[0][1] = 0.3;
  if (seed % 3 == 0) {
    std::vector<double> uneven;
    for (std::size_t k = 0; k < sizes[N - 1]; ++k)
      uneven.push_back(0.1 * static_cast<double>(k) + (k % 2 == 1 ? 0.02 : 0.0));
    grid.axes[N - 1] = Axis::rectilinear(uneven);
  }
  const auto image = sampled_on_lattice<N>(lattice, grid, noise_everywhere<N>(seed));
  for (ExtractOptions options : fixed_rules()) {
    options.epsilon = options.triangulation == Triangulation::compact ? 0.05 : 0.0;
    options.normals = seed % 2 == 0 ? Normals::differences : Normals::none;
    options.work.threads = 1 + seed % 3;
    const auto [contour, stats] = extract_lattice_with_stats<double>(image.view(), lattice, kIsovalue, options);
    Collector<N, double> sink;
    const ExtractedSize extracted = stream_to(sink, image, lattice, options);
    EXPECT_EQ(extracted.size.vertices, contour.vertices.size());
    EXPECT_EQ(extracted.size.simplices, contour.simplices.size());
    EXPECT_EQ(extracted.stats.tiles, stats.tiles);
    EXPECT_EQ(extracted.stats.active_tiles, stats.active_tiles);
    EXPECT_TRUE(std::ranges::equal(sink.vertices, contour.vertices));
    ASSERT_EQ(sink.normals.size(), contour.normals.size());
    for (std::size_t v = 0; v < contour.normals.size(); ++v)
      for (int a = 0; a < N; ++a) ASSERT_NEAR(sink.normals[v][a], contour.normals[v][a], 1e-6) << v;
    EXPECT_TRUE(std::ranges::equal(sink.simplices, contour.simplices, [](const auto& wide, const auto& narrow) {
      return std::equal(wide.begin(), wide.end(), narrow.begin());
    }));
  }
}

TEST(StreamedLattice, IsTheContourInMemory) {
  unsigned seed = 1;
  // a layer or some more than whole parts of 16
  for (const std::size_t layers : {2, 17, 22, 39}) {
    // layers so large that parts have 16 of them
    expect_streamed<2>(Lattice::triangular, {16400, layers}, seed++);
    expect_streamed<3>(Lattice::fcc, {140, 120, layers}, seed++);
    expect_streamed<3>(Lattice::bcc, {140, 120, layers}, seed++);
  }
}

/// The simplices of a contour by the coordinates of their vertices, sorted.
template <int N, class Vertices, class Simplices>
std::vector<std::array<std::array<double, N>, N>> by_places(const Vertices& vertices, const Simplices& simplices) {
  std::vector<std::array<std::array<double, N>, N>> result;
  for (const auto& simplex : simplices) {
    auto& places = result.emplace_back();
    for (int j = 0; j < N; ++j) places[j] = vertices[simplex[j]];
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// The same contour as in memory, up to the numbers of vertices and the order of simplices.
template <int N>
void expect_streamed_by_cells(Lattice lattice, const std::array<std::size_t, N>& sizes, unsigned seed,
                              const std::vector<Ambiguity>& rules) {
  SCOPED_TRACE(testing::Message() << name_of(lattice) << ", " << sizes[N - 1] << " layers");
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(sizes[a], -1.0, 0.1);
  if (seed % 2 == 0) grid.linear[0][1] = 0.3;
  const auto image = sampled_on_lattice<N>(lattice, grid, noise_everywhere<N>(seed));
  for (const Ambiguity ambiguity : rules)
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
      ExtractOptions options;
      options.ambiguity = ambiguity;
      options.triangulation = triangulation;
      options.epsilon = 0.05;
      options.normals = triangulation == Triangulation::compact ? Normals::differences : Normals::none;
      options.work.threads = 1 + seed % 3;
      const auto [contour, stats] = extract_lattice_with_stats<double>(image.view(), lattice, kIsovalue, options);
      Collector<N, double> sink;
      const ExtractedSize extracted = stream_to(sink, image, lattice, options);
      EXPECT_GT(contour.simplices.size(), 100u);
      ASSERT_EQ(extracted.size.vertices, contour.vertices.size());
      ASSERT_EQ(extracted.size.simplices, contour.simplices.size());
      EXPECT_EQ(sink.vertices.size(), contour.vertices.size());
      EXPECT_EQ(extracted.stats.tiles, stats.tiles);
      EXPECT_EQ(extracted.stats.active_tiles, stats.active_tiles);
      EXPECT_TRUE(by_places<N>(sink.vertices, sink.simplices) == by_places<N>(contour.vertices, contour.simplices));
      std::map<std::array<double, N>, std::array<double, N>> normals;
      for (std::size_t v = 0; v < contour.normals.size(); ++v) normals[contour.vertices[v]] = contour.normals[v];
      ASSERT_EQ(sink.normals.size(), contour.normals.size());
      for (std::size_t v = 0; v < sink.normals.size(); ++v)
        for (int a = 0; a < N; ++a) ASSERT_NEAR(sink.normals[v][a], normals.at(sink.vertices[v])[a], 1e-6) << v;
    }
}

TEST(StreamedLattice, ByCellsIsTheContourInMemory) {
  const std::vector<Ambiguity> by_data = {Ambiguity::mean, Ambiguity::decider};
  // parts of 26, 8 and 2 layers, so that there is a last part of one layer, and one of the layers around it only
  expect_streamed_by_cells<3>(Lattice::fcc, {50, 48, 53}, 1, by_data);
  expect_streamed_by_cells<4>(Lattice::d4, {20, 20, 20, 9}, 2, {Ambiguity::low, Ambiguity::mean});
  expect_streamed_by_cells<4>(Lattice::d4, {33, 30, 31, 5}, 3, {Ambiguity::low});
  expect_streamed_by_cells<4>(Lattice::fcc_in_time, {20, 20, 20, 9}, 4, {Ambiguity::high, Ambiguity::mean});
  expect_streamed_by_cells<4>(Lattice::fcc_in_time, {33, 30, 31, 4}, 5, {Ambiguity::saddle});
  expect_streamed_by_cells<4>(Lattice::fcc_in_time, {20, 20, 20, 2}, 6, {Ambiguity::high});
}

TEST(StreamedLattice, SeveralIsovaluesTakeOnePass) {
  Grid<3> grid = Grid<3>::unit({150, 140, 40});
  const auto image = sampled_on_lattice<3>(Lattice::fcc, grid, noise_everywhere<3>(4));
  std::size_t next = 0;
  auto layers = layers_of<3>(image, next);
  std::array<Collector<3, float>, 2> sinks;
  const std::array<StreamedContour<3, float>, 2> contours = {{{0.05, &sinks[0]}, {0.95, &sinks[1]}}};
  const auto sizes = extract_lattice_streamed_several<float>(layers, Lattice::fcc, contours);
  EXPECT_EQ(next, 40u);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto contour = extract_lattice<float>(image.view(), Lattice::fcc, contours[i].isovalue);
    EXPECT_EQ(sizes[i].size.simplices, contour.simplices.size());
    EXPECT_TRUE(std::ranges::equal(sinks[i].vertices, contour.vertices));
  }
}

TEST(StreamedLattice, WhatOnlyMemoryHasIsRefused) {
  auto image = sampled_on_lattice<3>(Lattice::fcc, Grid<3>::unit({5, 6, 7}), noise_everywhere<3>(4));
  const auto refused = [&](ErrorCode code, Lattice lattice, const ExtractOptions& options) {
    std::size_t next = 0;
    auto layers = layers_of<3>(image, next);
    Collector<3, float> sink;
    try {
      extract_lattice_streamed<float>(layers, lattice, 0.5, sink, options);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
    }
  };
  ExtractOptions close, sobel, custom;
  close.close = true;
  sobel.normals = Normals::sobel;
  custom.ambiguity = Ambiguity::custom;
  for (const ExtractOptions& options : {close, sobel, custom})
    refused(ErrorCode::InvalidArgument, Lattice::fcc, options);
  refused(ErrorCode::InvalidArgument, Lattice::triangular, {});
  image.values[100] = std::numeric_limits<double>::quiet_NaN();
  refused(ErrorCode::UnsupportedData, Lattice::fcc, {});
  ExtractOptions mean;
  mean.ambiguity = Ambiguity::mean;  // by cells
  refused(ErrorCode::UnsupportedData, Lattice::fcc, mean);
  auto one_time = sampled_on_lattice<4>(Lattice::fcc_in_time, Grid<4>::unit({4, 4, 4, 1}), noise_everywhere<4>(4));
  std::size_t next = 0;
  auto layers = layers_of<4>(one_time, next);
  Collector<4, float> sink;
  expect_error(ErrorCode::InvalidArgument, "1 times; expected at least 2",
               [&] { extract_lattice_streamed<float>(layers, Lattice::fcc_in_time, 0.5, sink); });
}

}  // namespace
}  // namespace tegl::test
