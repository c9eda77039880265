// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of 5D contours: of single 4-simplices, of the slow simplicial contour, and of contours of images.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "simplicial_contour.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using test::expect_closed_manifold;
using test::Point;
using test::same_surface;

Contour<5, double> one_simplex(const std::array<double, 5>& t) {
  Contour<5, double> contour;
  contour.vertices = {
      {0, 0, 0, 0, t[0]}, {1, 0, 0, 0, t[1]}, {0, 1, 0, 0, t[2]}, {0, 0, 1, 0, t[3]}, {0, 0, 0, 1, t[4]}};
  contour.simplices = {{0, 1, 2, 3, 4}};
  return contour;
}

TEST(SliceFive, OfASimplexIsATetrahedronOrAPrism) {
  for (unsigned above = 0; above < 32; ++above) {
    std::array<double, 5> t;
    for (unsigned j = 0; j < 5; ++j) t[j] = (above >> j & 1u) != 0 ? 1.0 : 0.0;
    const auto high = static_cast<std::size_t>(std::popcount(above));
    const Contour<4, double> cut = slice(one_simplex(t), Hyperplane<5>::across(4, 0.5));
    EXPECT_EQ(cut.vertices.size(), high * (5 - high));
    EXPECT_EQ(cut.simplices.size(), high == 0 || high == 5 ? 0u : high == 1 || high == 4 ? 1u : 3u);
    if (high == 0 || high == 5) continue;
    // a prism whose ends are equal consists of three tetrahedra of one size, with two triangles and three
    // quadrilaterals around them
    const MeshReport report = check(cut);
    EXPECT_TRUE(test::is_oriented_manifold(report));
    EXPECT_EQ(report.boundary_simplices, cut.simplices.size() == 1 ? 4u : 8u);
    for (std::size_t s = 0; s < cut.simplices.size(); ++s)
      EXPECT_NEAR(test::simplex_measure(cut, s), test::simplex_measure(cut, 0), 1e-12);
  }
}

TEST(SliceFive, KeepsTheSideThatTheContourFaces) {
  // For every pattern of heights in every vertex order, the tetrahedra's normals agree with the simplex's.
  for (unsigned pattern = 1; pattern < 31; ++pattern) {
    std::array<Index, 5> order{0, 1, 2, 3, 4};
    do {
      std::array<double, 5> t;
      for (int j = 0; j < 5; ++j) t[j] = ((pattern >> j) & 1u ? 1.0 : 0.0) + 0.1 * j;
      Contour<5, double> contour = one_simplex(t);
      contour.simplices[0] = order;
      const auto edges = test::edge_vectors(contour, 0);
      Point<4> normal;
      for (int a = 0; a < 4; ++a) {
        Eigen::Matrix<double, 5, 5> frame;
        frame.leftCols<4>() = edges;
        frame.col(4) = Eigen::Matrix<double, 5, 1>::Unit(a);
        normal[a] = frame.determinant();
      }
      const Contour<4, double> cut = slice(contour, Hyperplane<5>::across(4, 0.7));
      ASSERT_GT(cut.simplices.size(), 0u);
      ASSERT_EQ(test::share_facing(cut, [&](const Point<4>&) { return normal; }), 1.0) << pattern;
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(SliceFive, OfAClosedContourIsAClosedManifold) {
  auto image = test::coarse_noise<double, 5>(Grid<5>::unit({4, 4, 4, 4, 4}), 5, 3);
  test::for_each_sample<5>(image.grid, [&](std::size_t i, const std::array<std::size_t, 5>& index) {
    if (std::any_of(index.begin(), index.end(), [](std::size_t k) { return k == 0 || k == 3; })) image.values[i] = -1.0;
  });
  const Contour<5, double> contour = test::simplicial_contour<double>(image.view(), 1.0);
  ASSERT_GT(contour.simplices.size(), 1000u);
  for (const double at : {0.3, 1.0, 1.7, 2.0, 2.9}) {
    expect_closed_manifold(slice(contour, Hyperplane<5>::across(4, at)));
    expect_closed_manifold(slice(contour, Hyperplane<5>::across(2, at)));
  }
  expect_closed_manifold(slice(contour, {{0.4, -0.3, 0.7, 0.2, 0.5}, 2.0}));
  expect_closed_manifold(slice(contour, {{1, 1, 1, 1, 1}, 7.0}));  // many vertices lie on it
}

TEST(SliceFive, OfAnExtractedContourIsClosedAndManifold) {
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::saddle}) {
      const ExtractOptions options{.triangulation = triangulation, .ambiguity = ambiguity, .close = true};
      for (const bool has_ties : {false, true}) {
        const std::array<std::size_t, 5> sizes{3, 3, 3, 3, 3};
        const auto image =
            has_ties ? test::coarse_noise<float, 5>(Grid<5>::unit(sizes), 4, 3) : test::noise<float, 5>(sizes, 4);
        const Contour<5, float> contour = extract(image.view(), has_ties ? 1.0 : 0.5, options);
        for (const double at : {0.37, 1.0, 1.5}) {
          expect_closed_manifold(slice(contour, Hyperplane<5>::across(4, at)));
          expect_closed_manifold(slice(contour, Hyperplane<5>::across(0, at)));
        }
      }
    }
}

TEST(SliceFive, AtALayerIsTheContourOfTheLayer) {
  const auto image = test::noise<float, 5>(std::array<std::size_t, 5>{4, 4, 4, 4, 3}, 8);
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle}) {
    const ExtractOptions options{.ambiguity = ambiguity};
    const Contour<5, float> contour = extract(image.view(), 0.5, options);
    for (std::size_t k = 0; k < 3; ++k) {
      const Image<float, 4> layer(image.values.data() + 256 * k, Grid<4>::unit({4, 4, 4, 4}));
      const auto at = Hyperplane<5>::across(4, static_cast<double>(k));
      EXPECT_TRUE(same_surface(slice(contour, at), extract(layer, 0.5, options)));
      EXPECT_TRUE(same_surface(slice_image(image.view(), 0.5, at, options), extract(layer, 0.5, options)));
    }
  }
}

TEST(SliceFive, AtALayerHasTheTopologyOfTheLayerWithTies) {
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high, Ambiguity::mean, Ambiguity::saddle})
    for (const bool close : {false, true}) {
      const ExtractOptions options{.ambiguity = ambiguity, .close = close};
      for (std::uint64_t seed = 0; seed < 2; ++seed) {
        const auto image = test::coarse_noise<float, 5>(Grid<5>::unit({3, 3, 4, 3, 3}), seed, 3);
        const Contour<5, float> contour = extract(image.view(), 1.0, options);
        for (const int axis : {4, 1}) {
          for (std::size_t k = 0; k < 3; ++k) {
            const MeshReport expected = check(extract(test::layer_across(image.view(), axis, k), 1.0, options));
            const auto at = Hyperplane<5>::across(axis, static_cast<double>(k));
            std::vector<MeshReport> cuts{check(slice_image(image.view(), 1.0, at, options))};
            if (axis == 4) cuts.push_back(check(slice(contour, at)));
            for (const MeshReport& cut : cuts) {
              EXPECT_EQ(cut.components, expected.components) << "axis " << axis << ", layer " << k;
              EXPECT_EQ(cut.euler, expected.euler) << "axis " << axis << ", layer " << k;
              EXPECT_TRUE(test::is_oriented_manifold(cut));
            }
          }
        }
      }
    }
}

/// The vertices on edges of the grid: those with at most one coordinate that is no whole number.
template <int N>
std::vector<std::array<float, N>> vertices_on_edges(const Contour<N, float>& contour) {
  std::vector<std::array<float, N>> found;
  for (const auto& vertex : test::sorted_vertices(contour))
    if (std::ranges::count_if(vertex, [](float x) { return x != std::floor(x); }) <= 1) found.push_back(vertex);
  return found;
}

TEST(SliceFive, AtALayerByLowAndHighHasTheVerticesAndTheTopologyOfTheLayer) {
  const auto noise = test::noise<float, 5>(std::array<std::size_t, 5>{4, 4, 4, 4, 3}, 8);
  const auto ball = test::sample_field<float, 5>(Grid<5>::unit({7, 7, 7, 7, 5}), [](const Point<5>& x) {
    double sum = 0;
    for (const double of_axis : x) sum += (of_axis - 2.9) * (of_axis - 2.9);
    return 2.7 - std::sqrt(sum);
  });
  bool any_other_simplices = false;
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high})
    for (const bool close : {false, true})
      for (const auto& [image, isovalue] : {std::pair{&noise, 0.5}, {&ball, 0.0}}) {
        const ExtractOptions options{.ambiguity = ambiguity, .close = close};
        const Contour<5, float> contour = extract(image->view(), isovalue, options);
        for (const std::size_t k : {1u, 2u}) {
          const auto layer = extract(test::layer_across(image->view(), 4, k), isovalue, options);
          const auto cut = slice(contour, Hyperplane<5>::across(4, static_cast<double>(k)));
          EXPECT_GT(layer.simplices.size(), 100u);
          EXPECT_EQ(vertices_on_edges(cut), vertices_on_edges(layer));
          const MeshReport of_cut = check(cut), of_layer = check(layer);
          EXPECT_EQ(of_cut.components, of_layer.components);
          EXPECT_EQ(of_cut.euler, of_layer.euler);
          EXPECT_EQ(of_cut.boundary_simplices, of_layer.boundary_simplices);
          EXPECT_TRUE(test::is_oriented_manifold(of_cut));
          if (image == &ball) {
            EXPECT_EQ(test::sorted_vertices(cut), test::sorted_vertices(layer));
          }
          any_other_simplices = any_other_simplices || of_cut.simplices != of_layer.simplices;
        }
      }
  EXPECT_TRUE(any_other_simplices);  // otherwise they are equal, and this test is to say so
}

TEST(SliceFive, AtALayerIsTheContourOfTheLayerWithTies) {
  const auto image = test::coarse_noise<float, 5>(Grid<5>::unit({4, 4, 4, 3, 4}), 8, 3);
  const ExtractOptions options{.ambiguity = Ambiguity::mean};
  const Contour<5, float> contour = extract(image.view(), 1.0, options);
  for (const int axis : {4, 0})
    for (std::size_t k = 0; k < 3; ++k) {
      const auto layer = extract(test::layer_across(image.view(), axis, k), 1.0, options);
      const auto at = Hyperplane<5>::across(axis, static_cast<double>(k));
      EXPECT_TRUE(same_surface(slice_image(image.view(), 1.0, at, options), layer)) << axis << ' ' << k;
      if (axis == 4) {
        EXPECT_TRUE(same_surface(slice(contour, at), layer)) << k;
      }
    }
}

TEST(SliceFive, OfAnImageIsTheCutOfItsContour) {
  const auto image = test::noise<float, 5>(std::array<std::size_t, 5>{3, 4, 3, 3, 4}, 11);
  for (const bool close : {false, true}) {
    const ExtractOptions options{.close = close};
    const Contour<5, float> contour = extract(image.view(), 0.5, options);
    for (const auto& [axis, at] : {std::pair{4, 1.3}, {4, 0.2}, {1, 0.6}, {0, 1.5}}) {
      const auto hyperplane = Hyperplane<5>::across(axis, at);
      EXPECT_TRUE(same_surface(slice_image(image.view(), 0.5, hyperplane, options), slice(contour, hyperplane)));
    }
  }
}

TEST(SliceFive, OfAnImageAtALayerIsTheContourOfTheLayer) {
  Grid<5> grid = Grid<5>::unit({3, 4, 3, 3, 4});
  grid.offset = {1, 2, 3, 4, 5};
  grid.linear[4][4] = -2;
  grid.linear[0][1] = 0.5;
  const auto noise = test::noise<float, 5>(std::array<std::size_t, 5>{3, 4, 3, 3, 4}, 11);
  const Image<float, 5> image(noise.values.data(), grid);
  Grid<4> of_layer = Grid<4>::unit({3, 4, 3, 3});
  of_layer.offset = {1, 2, 3, 4};
  of_layer.linear[0][1] = 0.5;
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high, Ambiguity::saddle})
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
      for (const bool close : {false, true}) {
        ExtractOptions options{.triangulation = triangulation, .ambiguity = ambiguity, .close = close};
        options.normals = close ? Normals::none : Normals::sobel;
        for (std::size_t k = 0; k < 4; ++k) {
          const Image<float, 4> layer(noise.values.data() + 108 * k, of_layer);
          const Contour<4, float> expected = extract(layer, 0.5, options);
          Hyperplane<5> at = Hyperplane<5>::across(4, 5.0 - 2.0 * static_cast<double>(k));
          if (k % 2 == 1) at = {{0, 0, 0, 0, -3}, -3 * at.offset};
          const Contour<4, float> cut = slice_image(image, 0.5, at, options);
          EXPECT_TRUE(cut.vertices == expected.vertices && cut.simplices == expected.simplices) << k;
          EXPECT_TRUE(cut.normals == expected.normals);
        }
      }
}

TEST(SliceFive, AllWaysToCutAgree) {
  const auto image = test::noise<float, 5>(3, 21);
  const Contour<5, float> contour = extract(image.view(), 0.5);
  const Scrubber<5, float> scrubber(contour);
  const auto stack = slice_stack(contour, {Hyperplane<5>::across(4, 0.5), Hyperplane<5>::across(4, 1.25)});
  for (const auto& [i, at] : {std::pair{0, 0.5}, {1, 1.25}}) {
    const Contour<4, float> cut = slice(contour, Hyperplane<5>::across(4, at), {.threads = 1});
    for (const Contour<4, float>& other : {scrubber.cut(at), stack[static_cast<std::size_t>(i)],
                                           slice(contour, Hyperplane<5>::across(4, at), {.threads = 3})}) {
      EXPECT_EQ(other.vertices, cut.vertices);
      EXPECT_EQ(other.simplices, cut.simplices);
    }
  }
}

TEST(SliceFive, OfABallHasSecondOrder) {
  std::array<double, 2> errors{};
  for (int level = 0; level < 2; ++level) {
    const std::size_t samples = level == 0 ? 9 : 17;
    std::array<std::size_t, 5> sizes;
    sizes.fill(samples);
    sizes[4] = level == 0 ? 5 : 9;
    Grid<5> grid = Grid<5>::unit(sizes);
    const double step = 3.0 / static_cast<double>(samples - 1);
    for (Axis& axis : grid.axes)
      axis = Axis::uniform(axis.size(), -step * static_cast<double>(axis.size() - 1) / 2, step);
    std::vector<float> values(test::sample_count(grid));
    test::for_each_sample<5>(grid, [&](std::size_t i, const std::array<std::size_t, 5>& index) {
      double sum = 0.0;
      for (int a = 0; a < 5; ++a) sum += grid.axes[a][index[a]] * grid.axes[a][index[a]];
      values[i] = static_cast<float>(1.0 - std::sqrt(sum));
    });
    const Contour<4, float> cut =
        slice(extract(Image<float, 5>(values.data(), grid), 0.0), Hyperplane<5>::across(4, 0.3));
    const double radius = std::sqrt(1.0 - 0.09);
    const double exact = 2 * M_PI * M_PI * radius * radius * radius;
    errors[static_cast<std::size_t>(level)] = std::abs(test::measure(cut) - exact);
    expect_closed_manifold(cut);
  }
  EXPECT_LT(errors[1], 0.9);  // of 17.1
  EXPECT_GT(errors[0] / errors[1], 3.2);
}

}  // namespace
}  // namespace tegl
