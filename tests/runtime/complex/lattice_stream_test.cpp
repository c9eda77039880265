// SPDX-License-Identifier: BSD-3-Clause
//
// Streamed contours of images on lattices are those in memory, by rows of bits with the same numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "collector.hpp"
#include "complex_cases.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "lattice_image.hpp"
#include "tegl/check.hpp"
#include "tegl/measure.hpp"

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

/// Streams the contour of an image whose last axis is periodic. Each layer is read once.
template <int N>
ExtractedSize stream_seam_to(Collector<N, double>& sink, const OwnedImage<double, N>& image, Lattice lattice,
                             const ExtractOptions& options, const AxisPeriods<N>& periods) {
  const std::size_t layers_in_all = image.grid.axes[N - 1].size(), size = image.values.size() / layers_in_all;
  std::vector<std::size_t> reads(layers_in_all);
  FunctionLayers<double, N> layers(image.grid, [&](std::size_t k, double* to) {
    ++reads.at(k);
    std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>(k * size), size, to);
  });
  const auto extracted = extract_lattice_streamed<double>(layers, lattice, kIsovalue, sink, options, periods);
  EXPECT_EQ(reads, std::vector<std::size_t>(layers_in_all, 1));
  return extracted;
}

/// Streams the contour of an image on a lattice into a sink. All layers are read once, in ascending order or, if the
/// last axis is periodic, from the last four on.
template <int N>
ExtractedSize stream_to(Collector<N, double>& sink, const OwnedImage<double, N>& image, Lattice lattice,
                        const ExtractOptions& options, const AxisPeriods<N>& periods = {}) {
  if (periods[N - 1] != 0.0) return stream_seam_to<N>(sink, image, lattice, options, periods);
  std::size_t next = 0;
  auto layers = layers_of<N>(image, next);
  const ExtractedSize extracted = extract_lattice_streamed<double>(layers, lattice, kIsovalue, sink, options, periods);
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
    EXPECT_TRUE(std::ranges::equal(sink.normals, contour.normals));
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
  if (seed % 3 == 0) grid.axes[N - 1] = Axis::uniform(sizes[N - 1], 1.0, -0.1);
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
        EXPECT_EQ(sink.normals[v], normals.at(sink.vertices[v])) << v;
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
  expect_streamed_by_cells<4>(Lattice::fcc_in_time, {20, 20, 20, 9}, 9, {Ambiguity::low, Ambiguity::mean});
}

template <int N>
Contour<N, double> contour_in(const Collector<N, double>& sink, std::vector<Period<N>> periods) {
  Contour<N, double> contour;
  contour.vertices.assign(sink.vertices.begin(), sink.vertices.end());
  contour.normals.assign(sink.normals.begin(), sink.normals.end());
  for (const auto& wide : sink.simplices) {
    auto& simplex = contour.simplices.emplace_back();
    for (int j = 0; j < N; ++j) simplex[j] = static_cast<Index>(wide[j]);
  }
  contour.periods = std::move(periods);
  return contour;
}

/// Every other layer is high, so gradients are zero away from the sides.
template <int N>
void expect_normals_of_zero(Lattice lattice, const std::array<std::size_t, N>& sizes, const AxisPeriods<N>& periods) {
  SCOPED_TRACE(testing::Message() << name_of(lattice) << ", " << sizes[N - 1] << " layers");
  const int layers = lattice == Lattice::fcc_in_time ? N - 2 : N - 1;
  OwnedImage<double, N> image;
  for (int a = 0; a < N; ++a)
    image.grid.axes[a] = Axis::uniform(sizes[a], 0.7, a == layers ? 0.1 * layer_step(lattice) : 0.1);
  image.grid.linear[0][1] = 0.3;
  std::size_t below = 1, count = 1;
  for (int a = 0; a < N; ++a) below *= a < layers ? sizes[a] : 1, count *= sizes[a];
  for (std::size_t i = 0; i < count; ++i) image.values.push_back(i / below % sizes[layers] % 2 == 0 ? 0.9 : 1.03);
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto contour = extract_lattice<double>(image.view(), lattice, kIsovalue, options, periods);
  Collector<N, double> sink;
  (void)stream_to<N>(sink, image, lattice, options, periods);
  const auto is_inside = [&](std::array<double, N> x) {  // at both ends of its edge all neighbours exist
    x[0] -= 0.3 * x[1];
    for (int a = 0; a < N; ++a) {
      const Axis& axis = image.grid.axes[a];
      const double slack = 1e-6 * axis.step();
      if (periods[a] == 0.0 && (x[a] < axis[2] + slack || x[a] > axis[axis.size() - 3] - slack)) return false;
    }
    return true;
  };
  const std::array<double, N> zero{};
  const auto in_memory = contour.normals, streamed = contour_in<N>(sink, contour.periods).normals;
  std::size_t inside = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    if (!is_inside(contour.vertices[v])) continue;
    ++inside;
    ASSERT_EQ(in_memory[v], zero);
  }
  EXPECT_GT(inside, 100u);
  // the same bytes, up to the numbers of vertices
  const auto sorted = [](const auto& vertices, const auto& normals) {
    std::vector<std::pair<std::array<double, N>, std::array<double, N>>> all;
    for (std::size_t v = 0; v < vertices.size(); ++v) all.emplace_back(vertices[v], normals[v]);
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_TRUE(sorted(contour.vertices, in_memory) == sorted(sink.vertices, streamed));
}

TEST(StreamedLattice, AGradientOfZeroHasANormalOfZero) {
  expect_normals_of_zero<2>(Lattice::triangular, {16400, 39}, {});
  expect_normals_of_zero<3>(Lattice::fcc, {140, 120, 27}, {});
  expect_normals_of_zero<3>(Lattice::bcc, {140, 120, 27}, {});
  expect_normals_of_zero<4>(Lattice::d4, {9, 8, 7, 13}, {});
  expect_normals_of_zero<4>(Lattice::fcc_in_time, {9, 8, 13, 8}, {});
  expect_normals_of_zero<3>(Lattice::fcc, {9, 8, 12}, {0.9, 0.0, 12 * 0.1 * layer_step(Lattice::fcc)});
  expect_normals_of_zero<4>(Lattice::d4, {9, 8, 7, 14}, {0.0, 0.8, 0.0, 14 * 0.1 * layer_step(Lattice::d4)});
}

/// What a streamed contour has that the plain one of noise does not.
struct StreamedCase {
  bool close = false;
  unsigned periodic = 0;                   ///< bit a: axis a
  std::size_t missing_from = ~0u;          ///< layer from which on some values are missing
  std::vector<ExtractOptions> rules = {};  ///< empty: one, by the seed
  bool has_peaks = false;                  ///< high samples are so high that mean and saddle connect them by tunnels
};

/// Coordinates as multiples of 1e-6: rows of bits place vertices as cells do, but round otherwise.
template <int N>
std::array<double, N> rounded(std::array<double, N> place) {
  for (double& x : place) x = std::round(x * 1e6);
  return place;
}
template <int N>
std::vector<std::array<double, N>> rounded(const Buffer<std::array<double, N>>& places) {
  std::vector<std::array<double, N>> result;
  for (const auto& place : places) result.push_back(rounded<N>(place));
  return result;
}

/// Takes away single values and whole blocks.
template <int N>
void remove_values(OwnedImage<double, N>& image, std::size_t from_layer) {
  const std::size_t layers = image.grid.axes[N - 1].size(), size = image.values.size() / layers;
  std::mt19937 random(3);
  for (std::size_t i = from_layer * size; i < image.values.size(); ++i)
    if (random() % 40 == 0 || i / 16 % 11 == 0) image.values[i] = std::numeric_limits<double>::quiet_NaN();
}

template <int N>
void expect_same_normals(const Contour<N, double>& one, const Contour<N, double>& other) {
  std::map<std::array<double, N>, std::array<double, N>> normals;
  for (std::size_t v = 0; v < other.normals.size(); ++v) normals[rounded<N>(other.vertices[v])] = other.normals[v];
  ASSERT_EQ(one.normals.size(), other.normals.size());
  for (std::size_t v = 0; v < one.normals.size(); ++v) {
    const auto found = normals.find(rounded<N>(one.vertices[v]));
    ASSERT_NE(found, normals.end()) << v;
    for (int a = 0; a < N; ++a) ASSERT_NEAR(one.normals[v][a], found->second[a], 1e-6) << v;
  }
}

std::vector<ExtractOptions> rules_of_streams(std::initializer_list<Ambiguity> ambiguities) {
  std::vector<ExtractOptions> rules;
  for (const Ambiguity ambiguity : ambiguities) {
    ExtractOptions& options = rules.emplace_back();
    options.ambiguity = ambiguity;
    options.triangulation = ambiguity == Ambiguity::mean ? Triangulation::barycentric : Triangulation::compact;
  }
  return rules;
}

std::vector<ExtractOptions> by_data() { return rules_of_streams({Ambiguity::mean}); }

/// The streamed contour has the places and the topology of that in memory.
template <int N>
void expect_streamed_as_in_memory(Lattice lattice, const std::array<std::size_t, N>& sizes, const StreamedCase& of,
                                  unsigned seed) {
  SCOPED_TRACE(testing::Message() << name_of(lattice) << ", " << sizes[N - 1] << " layers, periodic " << of.periodic
                                  << (of.close ? ", closed" : ""));
  Grid<N> grid;
  AxisPeriods<N> periods{};
  for (int a = 0; a < N; ++a) {
    grid.axes[a] = Axis::uniform(sizes[a], -1.0, 0.1);
    if ((of.periodic >> a & 1u) != 0) periods[a] = 0.1 * static_cast<double>(sizes[a]);
  }
  auto image = sampled_on_lattice<N>(lattice, grid, noise_everywhere<N>(seed));
  if (of.has_peaks)
    for (double& value : image.values)
      if (value >= kIsovalue) value += 10.0;
  const bool is_missing = of.missing_from < sizes[N - 1];
  if (is_missing) remove_values<N>(image, of.missing_from);
  auto rules = of.rules;
  if (rules.empty()) {
    rules = rules_of_streams({seed % 2 == 0 ? Ambiguity::low : Ambiguity::high});
    rules[0].triangulation = seed % 2 == 0 ? Triangulation::barycentric : Triangulation::compact;
  }
  for (ExtractOptions options : rules) {
    options.close = of.close;
    options.epsilon = 0.05;
    options.normals = options.ambiguity == Ambiguity::low ? Normals::differences : Normals::none;
    options.work.threads = 1 + seed % 2;
    const auto [contour, stats] =
        extract_lattice_with_stats<double>(image.view(), lattice, kIsovalue, options, periods);
    Collector<N, double> sink;
    const ExtractedSize extracted = stream_to<N>(sink, image, lattice, options, periods);
    const auto streamed = contour_in<N>(sink, contour.periods);
    EXPECT_EQ(extracted.size.vertices, streamed.vertices.size());
    EXPECT_EQ(extracted.size.simplices, streamed.simplices.size());
    EXPECT_EQ(extracted.stats.tiles, stats.tiles);
    EXPECT_EQ(extracted.stats.active_tiles, stats.active_tiles);
    EXPECT_GT(contour.simplices.size(), 100u);
    const MeshReport report = expect_oriented_manifold(streamed), expected = check(contour);
    EXPECT_EQ(report.components, expected.components);
    if (N == 4 && is_missing) {  // divided edges and copies beside missing values may be others
      EXPECT_NEAR(measure(streamed).size, measure(contour).size, 1e-9 * measure(contour).size);
      continue;
    }
    EXPECT_EQ(report.euler, expected.euler);
    EXPECT_EQ(report.boundary_simplices, expected.boundary_simplices);
    ASSERT_EQ(streamed.vertices.size(), contour.vertices.size());
    if (is_missing)
      EXPECT_TRUE(by_places<N>(rounded<N>(streamed.vertices), streamed.simplices) ==
                  by_places<N>(rounded<N>(contour.vertices), contour.simplices));
    else
      EXPECT_TRUE(by_places<N>(streamed.vertices, streamed.simplices) ==
                  by_places<N>(contour.vertices, contour.simplices));
    expect_same_normals<N>(streamed, contour);
  }
}

TEST(StreamedLattice, WithMissingValuesIsTheContourInMemory) {
  // behind the first part of 16 layers and those around it, and in those around it
  expect_streamed_as_in_memory<2>(Lattice::triangular, {16400, 26}, {.missing_from = 24}, 1);
  expect_streamed_as_in_memory<2>(Lattice::triangular, {16400, 26}, {.missing_from = 18}, 2);
  expect_streamed_as_in_memory<3>(Lattice::bcc, {140, 120, 26}, {.missing_from = 23}, 3);
  expect_streamed_as_in_memory<3>(Lattice::fcc, {140, 120, 26}, {.missing_from = 24}, 4);
  expect_streamed_as_in_memory<3>(Lattice::bcc, {130, 130, 7}, {.missing_from = 3}, 4);
  expect_streamed_as_in_memory<3>(Lattice::fcc, {130, 130, 7}, {.missing_from = 1, .rules = by_data()}, 5);
  expect_streamed_as_in_memory<4>(Lattice::d4, {26, 25, 26, 7}, {.missing_from = 1}, 6);
  expect_streamed_as_in_memory<4>(Lattice::fcc_in_time, {26, 25, 26, 5}, {.missing_from = 1, .rules = by_data()}, 7);
}

TEST(StreamedLattice, WithCapsIsTheContourInMemory) {
  expect_streamed_as_in_memory<2>(Lattice::triangular, {16400, 7}, {.close = true}, 1);
  expect_streamed_as_in_memory<3>(Lattice::fcc, {130, 130, 7}, {.close = true}, 2);
  expect_streamed_as_in_memory<3>(Lattice::bcc, {130, 130, 7}, {.close = true}, 3);
  expect_streamed_as_in_memory<3>(Lattice::bcc, {130, 130, 7}, {.close = true, .missing_from = 3}, 4);
  expect_streamed_as_in_memory<3>(Lattice::fcc, {130, 130, 6}, {.close = true, .rules = by_data()}, 5);
  expect_streamed_as_in_memory<4>(Lattice::d4, {26, 25, 26, 6}, {.close = true}, 6);
  expect_streamed_as_in_memory<4>(Lattice::fcc_in_time, {26, 25, 26, 5}, {.close = true}, 7);
}

TEST(StreamedLattice, WithCapsOverTunnelsIsTheContourInMemory) {
  const StreamedCase of = {
      .close = true, .rules = rules_of_streams({Ambiguity::mean, Ambiguity::saddle}), .has_peaks = true};
  expect_streamed_as_in_memory<4>(Lattice::d4, {26, 25, 26, 5}, of, 8);
  expect_streamed_as_in_memory<4>(Lattice::fcc_in_time, {26, 25, 26, 4}, of, 9);
  StreamedCase along_seam = of;
  along_seam.periodic = 8u;
  expect_streamed_as_in_memory<4>(Lattice::fcc_in_time, {26, 25, 26, 4}, along_seam, 10);
}

TEST(StreamedLattice, WithPeriodicAxesIsTheContourInMemory) {
  expect_streamed_as_in_memory<2>(Lattice::triangular, {16400, 8}, {.periodic = 2u}, 1);
  expect_streamed_as_in_memory<2>(Lattice::triangular, {16400, 8}, {.close = true, .periodic = 1u}, 2);
  expect_streamed_as_in_memory<3>(Lattice::fcc, {130, 130, 8}, {.periodic = 7u}, 2);
  expect_streamed_as_in_memory<3>(Lattice::fcc, {130, 130, 8}, {.close = true, .periodic = 4u}, 3);
  expect_streamed_as_in_memory<3>(Lattice::bcc, {130, 130, 8}, {.periodic = 4u}, 4);
  expect_streamed_as_in_memory<3>(Lattice::bcc, {130, 130, 8}, {.close = true, .periodic = 3u}, 5);
  // parts that have all layers, or nearly all
  expect_streamed_as_in_memory<3>(Lattice::bcc, {60, 60, 6}, {.close = true, .periodic = 4u}, 6);
  expect_streamed_as_in_memory<3>(Lattice::bcc, {130, 60, 10}, {.close = true, .periodic = 4u}, 7);
  expect_streamed_as_in_memory<3>(Lattice::fcc, {130, 130, 8}, {.periodic = 5u, .missing_from = 0}, 8);
  expect_streamed_as_in_memory<4>(Lattice::d4, {26, 25, 26, 8}, {.periodic = 15u}, 9);
  expect_streamed_as_in_memory<4>(Lattice::fcc_in_time, {26, 25, 26, 5}, {.periodic = 15u}, 11);
  expect_streamed_as_in_memory<4>(Lattice::fcc_in_time, {26, 25, 26, 3}, {.periodic = 9u, .rules = by_data()}, 12);
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

TEST(StreamedLattice, BadOptionsAndGridsAreRefused) {
  const auto image = sampled_on_lattice<3>(Lattice::fcc, Grid<3>::unit({5, 6, 7}), noise_everywhere<3>(4));
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
  ExtractOptions sobel, custom;
  sobel.normals = Normals::sobel;
  custom.ambiguity = Ambiguity::custom;
  for (const ExtractOptions& options : {sobel, custom}) refused(ErrorCode::InvalidArgument, Lattice::fcc, options);
  refused(ErrorCode::InvalidArgument, Lattice::triangular, {});
  auto one_time = sampled_on_lattice<4>(Lattice::fcc_in_time, Grid<4>::unit({4, 4, 4, 1}), noise_everywhere<4>(4));
  std::size_t next = 0;
  auto layers = layers_of<4>(one_time, next);
  Collector<4, float> sink;
  expect_error(ErrorCode::InvalidArgument, "1 times; expected at least 2",
               [&] { extract_lattice_streamed<float>(layers, Lattice::fcc_in_time, 0.5, sink); });
  std::size_t of_fcc = 0;
  auto seven = layers_of<3>(image, of_fcc);
  Collector<3, float> other;
  expect_error(ErrorCode::InvalidArgument, "axis 2 (z) is periodic and has 7 layers; expected an even number", [&] {
    extract_lattice_streamed<float>(seven, Lattice::fcc, 0.5, other, {}, AxisPeriods<3>{0.0, 0.0, 7.0});
  });
  Grid<3> uneven = Grid<3>::unit({4, 4, 6});
  uneven.axes[2] = Axis::rectilinear({0.0, 1.0, 2.5, 3.0, 4.0, 5.0});
  FunctionLayers<double, 3> six(uneven, [](std::size_t, double*) {});
  expect_error(ErrorCode::InvalidArgument, "the period of axis 2 (z) is 100, and two steps, from 4 to 100, are 96",
               [&] {
                 extract_lattice_streamed<float>(six, Lattice::fcc, 0.5, other, {}, AxisPeriods<3>{0.0, 0.0, 100.0});
               });
}

}  // namespace
}  // namespace tegl::test
