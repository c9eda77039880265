// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction without tables: in 2D to 4D compared with the one by tables, in 5D checked by invariants.
#include "kernel/tableless.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "compare.hpp"
#include "fields.hpp"
#include "image/row_source.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/extract.hpp"
#include "tegl/tile_facets.hpp"
#include "tile/built_tiles.hpp"
#include "tile/cube_symmetries.hpp"

namespace tegl::test {
namespace {

template <class Real = double, Value T, int N>
Contour<N, Real> extract_tile_by_tile(const Image<T, N>& image, double isovalue, const ExtractOptions& options = {},
                                      std::size_t tile_bytes = detail::kBuiltTileBytes) {
  detail::ImageSource<T, N> source(image, isovalue, options.epsilon);
  return detail::extract_tiles<N, Real>(source, image.grid(), options, tile_bytes).contour;
}

/// Coordinates rounded to 2^-30, to remove differences by rounding errors.
template <int N>
Contour<N, double> rounded(Contour<N, double> contour) {
  for (auto& vertex : contour.vertices)
    for (double& x : vertex) x = std::round(x * 0x1p30) * 0x1p-30;
  return contour;
}

template <Value T, int N>
void expect_as_by_tables(const Image<T, N>& image, double isovalue, ExtractOptions options = {}) {
  options.triangulation = Triangulation::barycentric;
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
    options.ambiguity = ambiguity;
    EXPECT_TRUE(same_surface(rounded(extract_tile_by_tile(image, isovalue, options)),
                             rounded(extract<double>(image, isovalue, options))));
  }
}

/// Irregular axes, one of them descending, and a world map with a reflection.
template <int N>
Grid<N> bent_grid(std::size_t samples) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) {
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < samples; ++i)
      coordinates.push_back((a == 1 ? -1.0 : 1.0) * (static_cast<double>(i) + 0.01 * static_cast<double>(i * i)));
    grid.axes[a] = Axis::rectilinear(coordinates);
    grid.linear[a][(a + 1) % N] = 0.3;
    grid.offset[a] = a;
  }
  grid.linear[0][0] = -1.0;
  return grid;
}

/// The signature of a half-space, by the signs of `weights[0] + sum of weights[1 + a] x_a`.
std::uint64_t half_space(const std::array<double, 6>& weights) {
  std::uint64_t signature = 0;
  for (unsigned v = 0; v < 32; ++v) {
    double sum = weights[0];
    for (unsigned a = 0; a < 5; ++a) sum += weights[1 + a] * ((v >> a & 1u) != 0 ? 0.5 : -0.5);
    signature |= std::uint64_t{sum >= 0} << v;
  }
  return signature;
}

TEST(CubeSymmetries, HalfSpacesThatAreTheSameUpToSymmetryHaveOneFrame) {
  const detail::CubeSymmetries symmetries(5);
  std::mt19937_64 bits(3);
  for (int i = 0; i < 100; ++i) {
    std::array<double, 6> weights;
    for (double& w : weights) w = unit_random(bits) - 0.5;
    const std::uint64_t signature = half_space(weights);
    std::shuffle(weights.begin() + 1, weights.end(), bits);
    for (std::size_t a = 1; a < 6; ++a)
      if (bits() % 2 != 0) weights[a] = -weights[a];
    const std::uint64_t turned = half_space(weights);
    EXPECT_EQ(symmetries.before(symmetries.to_frame_of(signature), signature),
              symmetries.before(symmetries.to_frame_of(turned), turned));
  }
}

TEST(CubeSymmetries, HaveAllPermutationsInLexicographicOrder) {
  for (int n = 2; n <= 5; ++n) {
    const detail::CubeSymmetries symmetries(n);
    std::vector<unsigned> axes(static_cast<std::size_t>(n));
    std::iota(axes.begin(), axes.end(), 0u);
    std::uint16_t number = 0;
    do {
      const detail::CubeSymmetry symmetry{number++, 0};
      unsigned reached = 0, cycles = 0;  // an odd permutation is one with an odd number of even cycles
      for (unsigned i = 0; i < axes.size(); ++i) {
        EXPECT_EQ(1u << axes[i], symmetries.axes(symmetry, 1u << i)) << n << ' ' << number;
        for (unsigned j = i; (reached >> j & 1u) == 0; j = axes[j]) {
          cycles += axes[j] == i ? 1 : 0;
          reached |= 1u << j;
        }
      }
      EXPECT_EQ((axes.size() - cycles) % 2 != 0, symmetries.is_mirror(symmetry)) << n << ' ' << number;
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
}

TEST(CubeSymmetries, TakeFacesWhereTheyTakeTheirCorners) {
  const detail::CubeSymmetries symmetries(3);
  for (std::uint64_t signature = 0; signature < 256; ++signature) {
    const detail::CubeSymmetry symmetry = symmetries.to_frame_of(signature);
    const std::uint64_t before = symmetries.before(symmetry, signature);
    for (unsigned v = 0; v < 8; ++v)
      EXPECT_EQ(before >> v & 1u, signature >> symmetries.base(symmetry, v, 0) & 1u) << signature;
    for (unsigned axes = 0; axes < 8; ++axes)
      for (unsigned base = 0; base < 8; ++base) {
        if ((base & axes) != 0) continue;
        const unsigned there = symmetries.axes(symmetry, axes);
        const unsigned corners = symmetries.base(symmetry, base, 0) | symmetries.base(symmetry, base | axes, 0);
        EXPECT_EQ(symmetries.base(symmetry, base, there) | there, corners);
      }
  }
}

TEST(BuiltTiles, KeepNoMoreThanTheyMayWhateverTheNumberOfBuilders) {
  constexpr std::size_t kLimit = std::size_t{1} << 20;
  const detail::CubeFaces cube(5);
  std::mt19937_64 bits(4);
  std::vector<detail::TileKey> keys(60);
  for (detail::TileKey& key : keys) key.signature = bits() & 0xffffffff;
  for (const std::size_t builders : {1, 4}) {
    detail::BuiltTiles limited(cube, {}, kLimit, builders);
    detail::BuiltTiles roomy(cube, {}, std::size_t{1} << 28, builders);
    const auto side_by_side = [&](std::size_t count, const auto& work) {
      std::vector<std::thread> threads;
      for (std::size_t i = 0; i < builders; ++i)
        threads.emplace_back([&, i] { work(i * count / builders, (i + 1) * count / builders); });
      for (std::thread& thread : threads) thread.join();
    };
    const auto tiles = limited.get(keys, side_by_side), same = roomy.get(keys, side_by_side);
    EXPECT_LE(limited.kept_bytes(), kLimit);
    EXPECT_GT(roomy.kept_bytes(), kLimit);
    for (std::size_t i = 0; i < keys.size(); ++i)
      EXPECT_EQ(tiles[i].tile->simplices, same[i].tile->simplices) << keys[i].signature;
  }
}

TEST(BuiltTiles, WhatIsTooLargeForABuilderIsAnErrorOfTegl) {
  try {
    detail::too_large_as_error([]() -> int { throw std::length_error("more than 65535 vertices in a tile"); });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::TooLarge);
    EXPECT_NE(std::string(error.what()).find("65535 vertices"), std::string::npos) << error.what();
  }
}

TEST(ExtractTiles, PlaneImagesHaveTheContoursOfTheTables) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) expect_as_by_tables(view_of(noise<float, 2>(70, seed)), 0.5);
}

TEST(ExtractTiles, VolumesHaveTheContoursOfTheTables) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) expect_as_by_tables(view_of(noise<float, 3>(12, seed)), 0.5);
}

TEST(ExtractTiles, ResolvedFromTheDataPlaneImagesHaveTheContoursOfTheTables) {
  ExtractOptions options;
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider}) {
    options.ambiguity = ambiguity;
    const auto image = noise<float, 2>(70, 5);
    EXPECT_TRUE(same_surface(rounded(extract_tile_by_tile(image.view(), 0.5, options)),
                             rounded(extract<double>(image.view(), 0.5, options))));
  }
}

TEST(ExtractTiles, ResolvedFromTheDataVolumesHaveTheTopologyOfTheTables) {
  ExtractOptions options;
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider})
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      options.ambiguity = ambiguity;
      options.close = seed % 2 == 0;
      const auto image = noise<float, 3>(9, seed);
      const MeshReport built = expect_oriented_manifold(extract_tile_by_tile(image.view(), 0.5, options));
      const MeshReport found = expect_oriented_manifold(extract<double>(image.view(), 0.5, options));
      EXPECT_EQ(built.components, found.components);
      EXPECT_EQ(built.euler, found.euler);
    }
}

TEST(ExtractTiles, AnyGridDirectionAndEpsilonHaveTheContoursOfTheTables) {
  ExtractOptions options;
  options.direction = GradientDirection::ascent;
  options.epsilon = 0.05;
  expect_as_by_tables(view_of(noise<float, 2>(bent_grid<2>(20), 1)), 0.5, options);
  expect_as_by_tables(view_of(noise<std::uint8_t, 3>(bent_grid<3>(8), 2)), 127.5, options);
}

TEST(ExtractTiles, SmoothFieldsIn4dHaveTheContoursOfTheTables) {
  expect_as_by_tables(view_of(sample_field<float, 4>(centred_grid<4>(9, 1.5), Ball<4>{})), 0.0);
  expect_as_by_tables(view_of(sample_field<float, 4>(centred_grid<4>(8, 1.6), RingTube<4>{})), 0.0);
}

TEST(ExtractTiles, TilesIn4dHaveTheContoursOfTheTablesWhereAllIsConed) {
  int coned = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto image = noise<float, 4>(2, seed);
    std::uint64_t signature = 0;
    for (unsigned v = 0; v < 16; ++v) signature |= std::uint64_t{image.values[v] >= 0.5F} << v;
    const auto sides = [&](tile::Alternative otherwise) {
      const auto tile = tile_facets<4>(signature, {.alternative = otherwise});
      return std::any_of(tile.facets.begin(), tile.facets.end(),
                         [](const auto& facet) { return facet.filling == tile::Filling::side; });
    };
    if (sides(tile::Alternative::low) || sides(tile::Alternative::high)) continue;
    ++coned;
    expect_as_by_tables(image.view(), 0.5);
  }
  EXPECT_GT(coned, 150);
}

TEST(ExtractTiles, ClosedBordersEncloseWhatTheCapsOfTheTablesDo) {
  ExtractOptions options;
  options.close = true;
  options.triangulation = Triangulation::barycentric;
  const auto expect_equal = [&](const auto& image, double isovalue) {
    const auto ours = extract_tile_by_tile(image, isovalue, options);
    const auto theirs = extract<double>(image, isovalue, options);
    expect_closed_manifold(ours);
    EXPECT_NEAR(enclosed_content(ours), enclosed_content(theirs), 1e-9);
    EXPECT_EQ(check(ours).euler, check(theirs).euler);
    EXPECT_EQ(check(ours).components, check(theirs).components);
  };
  expect_equal(view_of(noise<float, 2>(30, 1)), 0.5);
  expect_equal(view_of(noise<float, 3>(8, 1)), 0.5);
  expect_equal(view_of(sample_field<float, 4>(centred_grid<4>(6, 0.9), Ball<4>{})), 0.0);
}

TEST(ExtractTiles, NoiseIn4dIsAClosedManifold) {
  ExtractOptions options;
  options.close = true;
  expect_closed_manifold(extract_tile_by_tile(view_of(noise<float, 4>(5, 3)), 0.5, options));
}

// ---- 5D, by the public functions ----

TEST(Extract5d, ABallHasA4SphereAroundIt) {
  const auto contour = extract(view_of(sample_field<float, 5>(centred_grid<5>(7, 1.4), Ball<5>{})), 0.0);
  const MeshReport report = expect_closed_manifold(contour);
  EXPECT_EQ(report.euler, 2);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.degenerate_simplices, 0u);
}

TEST(Extract5d, MeasureAndContentOfABallConvergeWithTheSquareOfTheStep) {
  const Ball<5> ball;
  const auto errors = [&](std::size_t samples) {
    const auto contour = extract<double>(view_of(sample_field<float, 5>(centred_grid<5>(samples, 1.2), ball)), 0.0);
    return std::array{1.0 - enclosed_content(contour) / ball.content(), 1.0 - measure(contour) / ball.surface()};
  };
  const auto coarse = errors(6), fine = errors(11);  // steps of 0.48 and 0.24
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(fine[i], 0.0);
    EXPECT_NEAR(std::log2(coarse[i] / fine[i]), 2.0, 0.4);
  }
}

TEST(Extract5d, TubesAroundACircleAndASphereHaveTheirEulerCharacteristics) {
  const auto around_circle = [](const Point<5>& x) {  // S^1 x S^3
    return 0.5 - std::hypot(std::hypot(x[0], x[1]) - 1.0, std::hypot(x[2], x[3], x[4]));
  };
  const auto around_sphere = [](const Point<5>& x) {  // S^2 x S^2
    return 0.5 - std::hypot(std::hypot(x[0], x[1], x[2]) - 1.0, x[3], x[4]);
  };
  const auto grid = centred_grid<5>(8, 1.75);
  const MeshReport circle = expect_closed_manifold(extract(view_of(sample_field<float, 5>(grid, around_circle)), 0.0));
  EXPECT_EQ(circle.euler, 0);
  EXPECT_EQ(circle.components, 1u);
  const MeshReport sphere = expect_closed_manifold(extract(view_of(sample_field<float, 5>(grid, around_sphere)), 0.0));
  EXPECT_EQ(sphere.euler, 4);
  EXPECT_EQ(sphere.components, 1u);
}

/// All rules but custom.
constexpr Ambiguity kRules[] = {Ambiguity::low,    Ambiguity::high,    Ambiguity::mean,
                                Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider};

TEST(Extract5d, NoiseIsAManifoldOpenOnlyAtTheBorder) {
  const auto image = noise<float, 5>(3, 5);
  ExtractOptions options;
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : kRules) {
      options.triangulation = triangulation;
      options.ambiguity = ambiguity;
      const auto contour = extract<double>(image.view(), 0.5, options);
      EXPECT_EQ(expect_oriented_manifold(contour).degenerate_simplices, 0u);
      EXPECT_TRUE(is_open_only_where_data_end(contour, image.view()));
    }
}

TEST(Extract5d, NoSimplexOfAnOpenContourOfNoiseHasZeroSize) {
  for (const std::uint32_t seed : {21u, 22u, 23u}) {
    const auto image = noise<float, 5>(4, seed);
    for (const Ambiguity ambiguity : kRules) {
      ExtractOptions options;
      options.ambiguity = ambiguity;
      EXPECT_EQ(check(extract<double>(image.view(), 0.5, options)).degenerate_simplices, 0u)
          << seed << ", " << static_cast<int>(ambiguity);
    }
  }
}

TEST(Extract5d, CompactContoursHaveTheTopologyOfBarycentricOnesAndFewerSimplices) {
  const auto expect_same_topology = [](const auto& image, double isovalue, ExtractOptions options, double share) {
    const auto compact = extract<double>(image.view(), isovalue, options);
    options.triangulation = Triangulation::barycentric;
    const auto barycentric = extract<double>(image.view(), isovalue, options);
    EXPECT_LT(static_cast<double>(compact.simplices.size()), share * static_cast<double>(barycentric.simplices.size()));
    const MeshReport a = check(compact), b = check(barycentric);
    EXPECT_EQ(a.components, b.components);
    EXPECT_EQ(a.euler, b.euler);
  };
  ExtractOptions options;
  for (const Ambiguity ambiguity : kRules) {
    options.ambiguity = ambiguity;
    expect_same_topology(noise<float, 5>(3, 14), 0.5, options, 0.55);
    expect_same_topology(noise<float, 5>(4, 15), 0.93, options, 0.55);
  }
  expect_same_topology(sample_field<float, 5>(centred_grid<5>(8, 1.4), Ball<5>{}), 0.0, {}, 0.3);
}

TEST(Extract5d, ClosedNoiseIsAClosedManifoldAndEnclosesTheHighSide) {
  ExtractOptions options;
  options.close = true;
  const auto image = noise<std::uint8_t, 5>({4, 3, 4, 3, 3}, 6);
  const auto high = extract<double>(image.view(), 127.5, options);
  expect_closed_manifold(high);
  const double content = enclosed_content(high);
  EXPECT_GT(content, 0.0);
  // The low side is the high side of the negative, contoured with the other alternative.
  auto negative = image;
  for (std::uint8_t& value : negative.values) value = static_cast<std::uint8_t>(255 - value);
  options.ambiguity = Ambiguity::high;
  const auto low = extract<double>(negative.view(), 127.5, options);
  EXPECT_NEAR(content + enclosed_content(low), 3.0 * 2 * 3 * 2 * 2, 1e-9);
}

template <class Real>
bool same_bytes(const Contour<5, Real>& a, const Contour<5, Real>& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return same(a.vertices, b.vertices) && same(a.simplices, b.simplices) && same(a.normals, b.normals);
}

/// `extract_4d(image, isovalue, options)`: the contour of the 4D image that is layer 1.
template <class Extract4d>
void expect_contour_of_layer(const OwnedImage<float, 5>& image, const ExtractOptions& options,
                             const Extract4d& extract_4d) {
  const auto contour = extract<double>(image.view(), 0.5, options);
  // Faces with all vertices in layer 1, which is interior. Each is in two simplices, one below and one above.
  std::vector<std::array<std::array<double, 4>, 4>> found;
  for (const auto& simplex : contour.simplices) {
    std::array<std::array<double, 4>, 4> face;
    std::size_t inside = 0;
    for (const Index v : simplex)
      if (const auto& x = contour.vertices[v]; x[4] == 1.0 && inside++ < 4)
        std::copy_n(x.begin(), 4, face[inside - 1].begin());
    ASSERT_LT(inside, 5u);
    if (inside != 4) continue;
    std::sort(face.begin(), face.end());
    found.push_back(face);
  }
  std::vector<std::array<std::array<double, 4>, 4>> expected;
  const std::size_t layer = 3 * 4 * 3 * 3;
  const Image<float, 4> of_layer(image.values.data() + layer, Grid<4>::unit({3, 4, 3, 3}));
  const auto in_layer = extract_4d(of_layer, 0.5, options);
  for (const auto& simplex : in_layer.simplices) {
    std::array<std::array<double, 4>, 4> face;
    for (std::size_t j = 0; j < 4; ++j) face[j] = in_layer.vertices[simplex[j]];
    std::sort(face.begin(), face.end());
    expected.insert(expected.end(), 2, face);
  }
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  ASSERT_FALSE(expected.empty());
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_TRUE(found == expected);  // bit by bit
}

TEST(Extract5d, ALayerHasTheContourOfItsOwnImage) {
  const auto random = noise<float, 5>({3, 4, 3, 3, 3}, 7);
  const auto waves = sample_field<float, 5>(Grid<5>::unit({3, 4, 3, 3, 3}), [](const Point<5>& x) {
    return 0.5 + std::sin(1.9 * x[0] + 1.1 * x[1] - x[2]) * std::cos(1.3 * x[3] - 0.8 * x[4] + 0.4 * x[1]);
  });
  ExtractOptions options;
  for (const Ambiguity ambiguity :
       {Ambiguity::low, Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider}) {
    options.ambiguity = ambiguity;
    options.triangulation = Triangulation::barycentric;
    const auto by_tile = [](const auto&... arguments) { return extract_tile_by_tile(arguments...); };
    expect_contour_of_layer(random, options, by_tile);
    // Compact fillings of 5D contours are balanced by any rule, those of 4D contours only if the data resolve them.
    if (ambiguity == Ambiguity::low) continue;
    options.triangulation = Triangulation::compact;
    const auto by_tables = [](const auto&... arguments) { return extract<double>(arguments...); };
    expect_contour_of_layer(random, options, by_tables);
    expect_contour_of_layer(waves, options, by_tables);
  }
}

TEST(Extract5d, ResolvedFromTheDataNoiseIsClosedByCapsAndTheSameForAnyNumberOfThreads) {
  const auto image = noise<std::int16_t, 5>({3, 4, 3, 3, 3}, 11);
  ExtractOptions options;
  options.close = true;
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider}) {
    options.ambiguity = ambiguity;
    options.work.threads = 1;
    const auto one = extract<float>(image.view(), 0.5, options);
    expect_closed_manifold(one);
    options.work.threads = 3;
    EXPECT_TRUE(same_bytes(one, extract_tile_by_tile<float>(image.view(), 0.5, options, 20'000)));
  }
}

TEST(Extract5d, AnEstimatorThatAlwaysSaysLowGivesTheLowConnectedContour) {
  const auto image = noise<float, 5>(3, 12);
  ExtractOptions options;
  const ContourSize compact = count(image.view(), 0.5, options);
  options.triangulation = Triangulation::barycentric;
  const auto low = extract<double>(image.view(), 0.5, options);
  options.ambiguity = Ambiguity::custom;
  options.estimator.choose = [](const AmbiguousFace& face) {
    return face.dim() == 2 ? tile::Choice::low : tile::Choice::separate;
  };
  EXPECT_TRUE(same_surface(rounded(low), rounded(extract<double>(image.view(), 0.5, options))));
  options.triangulation = Triangulation::compact;
  EXPECT_EQ(count(image.view(), 0.5, options), compact);
  options.estimator.choose = [](const AmbiguousFace&) -> tile::Choice { throw std::runtime_error("no idea"); };
  EXPECT_THROW(extract<double>(image.view(), 0.5, options), std::runtime_error);
}

TEST(Extract5d, IsTheSameForAnyNumberOfThreadsAndAnyMemoryForTiles) {
  const auto image = noise<float, 5>({4, 3, 3, 3, 4}, 8);
  ExtractOptions options;
  options.close = true;
  options.normals = Normals::differences;
  options.work.threads = 1;
  const auto one = extract<float>(image.view(), 0.5, options);
  EXPECT_FALSE(one.simplices.empty());
  for (const unsigned threads : {2u, 3u, 4u}) {
    options.work.threads = threads;
    EXPECT_TRUE(same_bytes(one, extract<float>(image.view(), 0.5, options))) << threads << " threads";
  }
  EXPECT_TRUE(same_bytes(one, extract_tile_by_tile<float>(image.view(), 0.5, options, 0)));
  EXPECT_TRUE(same_bytes(one, extract_tile_by_tile<float>(image.view(), 0.5, options, 20'000)));
}

TEST(Extract5d, SizesAreCounted) {
  const auto image = noise<float, 5>(3, 9);
  ExtractOptions options;
  for (const bool close : {false, true}) {
    options.close = close;
    const auto contour = extract(image.view(), 0.5, options);
    const auto [size, stats] = count_with_stats(image.view(), 0.5, options);
    EXPECT_EQ(size, (ContourSize{contour.vertices.size(), contour.simplices.size()}));
    EXPECT_EQ(stats.tiles, 32u);
    EXPECT_EQ(stats.active_tiles, 32u);
  }
}

TEST(Extract5d, ViewsByAnyStridesHaveTheContourOfTheirValues) {
  const auto image = noise<float, 5>({3, 2, 3, 2, 3}, 10);
  std::vector<float> spread(2 * image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i) spread[2 * (image.values.size() - 1 - i)] = image.values[i];
  Image<float, 5>::Strides strides = image.view().strides();
  for (auto& stride : strides) stride *= -2;
  const Image<float, 5> view(spread.data() + 2 * (image.values.size() - 1), image.grid, strides);
  EXPECT_TRUE(same_bytes(extract(image.view(), 0.5), extract(view, 0.5)));
}

TEST(Extract5d, NormalsPointAwayFromABall) {
  const auto image = sample_field<double, 5>(centred_grid<5>(6, 1.5), [](const Point<5>& x) {
    double square = 0;
    for (const double c : x) square += c * c;
    return 1.0 - square;
  });
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto contour = extract<double>(image.view(), 0.0, options);
  ASSERT_EQ(contour.normals.size(), contour.vertices.size());
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    double along = 0, length = 0;
    for (int a = 0; a < 5; ++a) along += contour.normals[v][a] * contour.vertices[v][a];
    for (const double x : contour.vertices[v]) length += x * x;
    EXPECT_GT(along, 0.99 * std::sqrt(length));
  }
}

TEST(Extract5d, TellsOfProgressFromNothingToAllWithoutFalling) {
  const auto image = noise<float, 5>(3, 12);
  ExtractOptions options;
  std::vector<double> told;
  options.work.progress = [&](double fraction) {
    told.push_back(fraction);
    return true;
  };
  extract(image.view(), 0.5, options);
  ASSERT_GT(told.size(), 3u);
  EXPECT_EQ(told.front(), 0.0);
  EXPECT_EQ(told.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
}

TEST(Extract5d, StopsWhenToldTo) {
  const auto image = noise<float, 5>(3, 12);
  ExtractOptions options;
  options.work.progress = [](double) { return false; };
  try {
    extract(image.view(), 0.5, options);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

TEST(Extract5d, ImagesWithoutTilesHaveNoContour) {
  EXPECT_TRUE(extract(view_of(noise<float, 5>({3, 3, 1, 3, 3}, 13)), 0.5).vertices.empty());
}

}  // namespace
}  // namespace tegl::test
