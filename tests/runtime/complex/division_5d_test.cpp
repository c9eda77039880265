// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of divided 5D images: the contour in a simplex is certified for all signatures, the extraction compared with
// that of complexes in 2D to 4D, and 5D contours are checked by invariants, analytic values and their cuts.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "complex/division_cases.hpp"
#include "complex/image_points.hpp"
#include "division/divided_contour.hpp"
#include "division/simplex_contour.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr std::array kDivisions = {Division::kuhn, Division::symmetric};

/// The ends of an edge of an N-simplex by its number.
template <int N>
std::vector<std::array<int, 2>> edge_ends() {
  std::vector<std::array<int, 2>> ends(detail::SimplexContour<N>::kEdges);
  for (int i = 0; i <= N; ++i)
    for (int j = i + 1; j <= N; ++j) ends[detail::edge_number<N>(i, j)] = {i, j};
  return ends;
}

/// Sorts the numbers; returns whether that is an odd permutation.
template <std::size_t Size>
bool sort_odd(std::array<int, Size>& numbers) {
  bool odd = false;
  for (std::size_t i = 1; i < Size; ++i)
    for (std::size_t j = i; j > 0 && numbers[j] < numbers[j - 1]; --j) {
      std::swap(numbers[j], numbers[j - 1]);
      odd = !odd;
    }
  return odd;
}

/// The oriented faces of the contour in an N-simplex that are in one simplex of it: +1 or -1 by sorted edges.
template <int N>
std::map<std::array<int, N - 1>, int> border_of(unsigned signature) {
  std::map<std::array<int, N - 1>, int> border;
  for (const auto& simplex : detail::SimplexContour<N>::instance().of(signature))
    for (std::size_t omitted = 0; omitted < N; ++omitted) {
      std::array<int, N - 1> face;
      for (std::size_t j = 0, k = 0; j < N; ++j)
        if (j != omitted) face[k++] = simplex[j];
      const bool odd = sort_odd(face);
      border[face] += odd != (omitted % 2 != 0) ? -1 : 1;
    }
  std::erase_if(border, [](const auto& each) { return each.second == 0; });
  return border;
}

TEST(SimplexContour, HasTheSizeOfAProductOfSimplices) {
  const auto& contour = detail::SimplexContour<5>::instance();
  constexpr std::array kSizes = {0u, 1u, 4u, 6u, 4u, 1u, 0u};
  for (unsigned signature = 0; signature < 64; ++signature)
    EXPECT_EQ(contour.of(signature).size(), kSizes[static_cast<std::size_t>(std::popcount(signature))]);
}

TEST(SimplexContour, InFacetsIsTheContourOfTheFacetForAllSignatures) {
  // So neighbours agree, and the border of a contour is in the facets.
  const auto ends = edge_ends<5>();
  for (unsigned signature = 0; signature < 64; ++signature) {
    std::map<std::array<int, 4>, int> expected;
    for (int omitted = 0; omitted <= 5; ++omitted) {
      unsigned of_facet = 0;
      std::array<int, 5> vertices;
      for (int v = 0, k = 0; v <= 5; ++v)
        if (v != omitted) {
          of_facet |= (signature >> v & 1u) << k;
          vertices[static_cast<std::size_t>(k++)] = v;
        }
      const auto ends_in_facet = edge_ends<4>();
      for (const auto& simplex : detail::SimplexContour<4>::instance().of(of_facet)) {
        std::array<int, 4> face;
        for (std::size_t j = 0; j < 4; ++j) {
          const auto [a, b] = ends_in_facet[simplex[j]];
          face[j] = static_cast<int>(
              detail::edge_number<5>(vertices[static_cast<std::size_t>(a)], vertices[static_cast<std::size_t>(b)]));
        }
        // The facet opposite to vertex `omitted` has the sign (-1)^omitted, and the direction towards high is last in
        // the frames of both contours.
        const bool odd = sort_odd(face) != (omitted % 2 != 0);
        EXPECT_TRUE(expected.emplace(face, odd ? -1 : 1).second);
      }
    }
    EXPECT_EQ(border_of<5>(signature), expected) << signature;
    for (const auto& simplex : detail::SimplexContour<5>::instance().of(signature))
      for (const std::uint8_t edge : simplex)
        EXPECT_NE(signature >> ends[edge][0] & 1u, signature >> ends[edge][1] & 1u) << signature;
  }
}

TEST(SimplexContour, IsPositiveForAllValues) {
  // With the test of its border: the simplices fill the contour without overlaps, whatever the values.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> size(1e-3, 1.0);
  const auto ends = edge_ends<5>();
  for (unsigned signature = 1; signature < 63; ++signature)
    for (int trial = 0; trial < 50; ++trial) {
      Eigen::Matrix<double, 5, 6> points = Eigen::Matrix<double, 5, 6>::Random();
      if (points.rightCols<5>().colwise().operator-(points.col(0)).determinant() < 0) points.col(1).swap(points.col(2));
      std::array<double, 6> values;
      for (unsigned v = 0; v < 6; ++v) values[v] = (signature >> v & 1u) != 0 ? size(random) : -size(random);
      for (const auto& simplex : detail::SimplexContour<5>::instance().of(signature)) {
        Eigen::Matrix<double, 5, 5> corners;
        for (int j = 0; j < 5; ++j) {
          const auto [a, b] = ends[simplex[static_cast<std::size_t>(j)]];
          const double alpha = values[static_cast<std::size_t>(a)] /
                               (values[static_cast<std::size_t>(a)] - values[static_cast<std::size_t>(b)]);
          corners.col(j) = points.col(a) + alpha * (points.col(b) - points.col(a));
        }
        Eigen::Matrix<double, 5, 5> frame;
        frame.leftCols<4>() = corners.rightCols<4>().colwise() - corners.col(0);
        auto [high, low] = ends[simplex[0]];
        if (values[static_cast<std::size_t>(high)] < 0) std::swap(high, low);
        frame.col(4) = points.col(high) - points.col(low);
        EXPECT_GT(frame.determinant(), 0) << signature;
      }
    }
}

/// The contour of an image whose cells are divided, cell by cell as in 5D.
template <int N>
Contour<N, double> extract_by_cells(const OwnedImage<double, N>& image, Division division, double isovalue,
                                    const ExtractOptions& options = {}) {
  Contour<N, double> contour;
  contour.direction = options.direction;
  const Image<double, N> view = image.view();
  const ExtractedSize size = detail::extract_divided_cells<N, double>(
      image.grid,
      [&](const std::array<std::size_t, N>& from, std::size_t count, double* out) {
        std::array<std::size_t, N> at = from;
        for (std::size_t i = 0; i < count; ++i, ++at[0]) out[i] = view(at);
      },
      division, isovalue, options, &contour);
  EXPECT_EQ(size.size.vertices, contour.vertices.size());
  EXPECT_EQ(size.size.simplices, contour.simplices.size());
  return contour;
}

template <int N>
void expect_as_complexes(std::size_t samples, bool close) {
  ExtractOptions options;
  options.close = close;
  options.direction = close ? GradientDirection::ascent : GradientDirection::descent;
  auto image = noise<N>(samples, 8);
  if (close)
    for (double& value : image.values) value = 1.0 - value;  // high at the border
  for (const Division division : kDivisions) {
    SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << (close ? ", closed" : ""));
    const auto contour = extract_by_cells(image, division, 0.5, options);
    const auto expected = extract<double>(divided_complex(image.view(), division), 0.5, options);
    const MeshReport report = expect_closed_manifold(contour), of_complex = check(expected);
    EXPECT_EQ(report.components, of_complex.components);
    EXPECT_EQ(report.euler, of_complex.euler);
    if (!close) {
      EXPECT_EQ(report.vertices, of_complex.vertices);
    }
    const auto measures = measure(contour), of_expected = measure(expected);
    EXPECT_NEAR(measures.size, of_expected.size, 1e-9 * of_expected.size);
    EXPECT_NEAR(measures.content.value(), of_expected.content.value(), 1e-9);
  }
}

TEST(Division5d, CellByCellIsTheContourOfComplexes) {
  for (const bool close : {false, true}) {
    expect_as_complexes<2>(20, close);
    expect_as_complexes<3>(9, close);
    expect_as_complexes<4>(5, close);
  }
}

TEST(Division5d, NoiseHasAClosedOrientedManifold) {
  for (const Division division : kDivisions) {
    const auto image = noise<5>(division == Division::kuhn ? 5 : 4, 3);
    const auto contour = extract_divided<double>(image.view(), division, 0.5);
    EXPECT_GT(contour.simplices.size(), 10000u);
    const MeshReport report = expect_closed_manifold(contour);
    EXPECT_EQ(report.degenerate_simplices, 0u);
    EXPECT_GT(measure(contour).content.value(), 0.0);
    const ContourSize size = count_divided(image.view(), division, 0.5);
    EXPECT_EQ(size.vertices, contour.vertices.size());
    EXPECT_EQ(size.simplices, contour.simplices.size());
  }
}

TEST(Division5d, SmallIntegersHaveAClosedOrientedManifold) {
  for (const Division division : kDivisions) {
    OwnedImage<std::uint8_t, 5> image{noise<5>(4, 1).grid, {}};
    std::mt19937 random(7);
    for (const double value : noise<5>(4, 1).values)
      image.values.push_back(static_cast<std::uint8_t>(value == 0.0 ? 0 : random() % 3));
    ExtractOptions options;
    options.epsilon = 0.01;
    for (const double isovalue : {1.0, 2.0}) {
      expect_closed_manifold(extract_divided<float>(image.view(), division, isovalue));
      EXPECT_EQ(expect_closed_manifold(extract_divided(image.view(), division, isovalue, options)).degenerate_simplices,
                0u);
    }
  }
}

TEST(Division5d, ABallHasASphereOfOrderTwo) {
  constexpr double kPi = std::numbers::pi;
  const double size = 8.0 / 3.0 * kPi * kPi * std::pow(0.7, 4), content = 8.0 / 15.0 * kPi * kPi * std::pow(0.7, 5);
  for (const Division division : kDivisions) {
    const auto errors = [&](std::size_t samples) {
      const auto image = sampled<5>(samples, ball<5>);
      const auto contour = extract_divided<double>(image.view(), division, 0.0);
      const Measures<5> measures = measure(contour);
      return std::array{std::abs(measures.size - size), std::abs(measures.content.value() - content)};
    };
    const auto small = sampled<5>(5, ball<5>);
    EXPECT_EQ(expect_closed_manifold(extract_divided<double>(small.view(), division, 0.0)).euler, 2);
    const std::size_t coarse = division == Division::kuhn ? 6 : 5, fine = division == Division::kuhn ? 9 : 7;
    const double ratio = static_cast<double>(fine - 1) / static_cast<double>(coarse - 1);
    const auto of_coarse = errors(coarse), of_fine = errors(fine);
    for (const std::size_t k : {0u, 1u})
      EXPECT_NEAR(2.0, std::log(of_coarse[k] / of_fine[k]) / std::log(ratio), 0.5)
          << name_of(division) << (k == 0 ? ", size" : ", content");
  }
}

TEST(Division5d, AtTheBorderTheContourEndsOrIsClosed) {
  for (const Division division : kDivisions) {
    const auto image = sampled<5>(division == Division::kuhn ? 4 : 3,
                                  [](const std::array<double, 5>& x) { return 1.3 + ball<5>(x) + 0.1 * x[0]; });
    const MeshReport open = expect_oriented_manifold(extract_divided<double>(image.view(), division, 0.5));
    EXPECT_GT(open.boundary_simplices, 0u);
    ExtractOptions options;
    options.close = true;
    for (const double isovalue : {0.5, -9.0}) {  // below all values: the whole box
      const auto closed = extract_divided<double>(image.view(), division, isovalue, options);
      EXPECT_EQ(expect_closed_manifold(closed).euler, 2);
      const double content = measure(closed).content.value();
      EXPECT_GT(content, isovalue < 0 ? 32.0 - 1e-9 : 1.0);
      EXPECT_LT(content, isovalue < 0 ? 32.0 + 1e-9 : 31.0);
    }
  }
}

template <class Real>
bool same_bytes(const Contour<5, Real>& first, const Contour<5, Real>& second) {
  return first.vertices.size() == second.vertices.size() && first.simplices == second.simplices &&
         std::memcmp(first.vertices.data(), second.vertices.data(),
                     first.vertices.size() * sizeof(first.vertices[0])) == 0;
}

TEST(Division5d, AnyNumberOfThreadsGivesTheSameBytes) {
  const auto image = noise<5>(5, 9);
  for (const bool close : {false, true}) {
    ExtractOptions options;
    options.close = close;
    options.work.threads = 1;
    const auto one = extract_divided(image.view(), Division::kuhn, 0.3, options);
    options.work.threads = 5;
    EXPECT_TRUE(same_bytes(extract_divided(image.view(), Division::kuhn, 0.3, options), one));
  }
}

TEST(Division5d, MirroredGridsHaveTheSameSide) {
  auto image = noise<5>(4, 2);
  const auto content = [&] {
    return measure(extract_divided<double>(image.view(), Division::kuhn, 0.4)).content.value();
  };
  const double expected = content();
  EXPECT_GT(expected, 0);
  image.grid.linear[2][2] = -1;
  EXPECT_NEAR(content(), expected, 1e-12);
  image.grid.axes[4] = Axis::uniform(4, 1.0, -2.0 / 3);
  EXPECT_NEAR(content(), expected, 1e-12);
}

TEST(Division5d, AtALayerTheCutIsTheDividedContourOfTheLayer) {
  for (const Division division : kDivisions) {
    const auto image = noise<5>(4, 6);
    const auto contour = extract_divided<double>(image.view(), division, 0.5);
    for (const int axis : {4, 3, 0}) {
      SCOPED_TRACE(testing::Message() << name_of(division) << ", axis " << axis);
      OwnedImage<double, 4> layer;
      const auto part = image.view().part(axis, 1, 1);
      for (int a = 0; a < 4; ++a) layer.grid.axes[a] = image.grid.axes[a < axis ? a : a + 1];
      detail::for_each_sample<4>(layer.grid.sizes(), [&](const std::array<std::size_t, 4>& at) {
        std::array<std::size_t, 5> index{};
        for (int a = 0; a < 4; ++a) index[a < axis ? a : a + 1] = at[a];
        layer.values.push_back(part(index));
      });
      const auto expected = extract<double>(divided_complex(layer.view(), division), 0.5);
      const auto cut = slice(contour, Hyperplane<5>::across(axis, image.grid.axes[axis][1]));
      const MeshReport report = expect_closed_manifold(cut), of_layer = check(expected);
      EXPECT_GT(of_layer.simplices, 100u);
      EXPECT_EQ(report.components, of_layer.components);
      EXPECT_EQ(report.euler, of_layer.euler);
      EXPECT_NEAR(measure(cut).size, measure(expected).size, 1e-9);
      EXPECT_NEAR(measure(cut).content.value(), measure(expected).content.value(), 1e-9);
    }
  }
}

TEST(Division5d, ErrorsNameTheOption) {
  auto image = noise<5>(3, 1);
  const auto extract_with = [&](Division division, const ExtractOptions& options) {
    (void)extract_divided(image.view(), division, 0.5, options);
  };
  expect_error(ErrorCode::InvalidArgument, "division hybrid of a 5D image; expected kuhn or symmetric",
               [&] { extract_with(Division::hybrid, {}); });
  ExtractOptions options;
  options.normals = Normals::differences;
  expect_error(ErrorCode::InvalidArgument, "normals of a divided 5D image; expected none",
               [&] { extract_with(Division::kuhn, options); });
  options.normals = Normals::none;
  options.triangulation = Triangulation::barycentric;
  expect_error(ErrorCode::InvalidArgument, "triangulation barycentric of a divided 5D image; expected compact",
               [&] { extract_with(Division::kuhn, options); });
  expect_error(ErrorCode::InvalidIsovalue, "isovalue inf",
               [&] { (void)extract_divided(image.view(), Division::kuhn, std::numeric_limits<double>::infinity()); });
  image.values.back() = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::UnsupportedData, "5D image with missing values", [&] { extract_with(Division::kuhn, {}); });
  expect_error(ErrorCode::UnsupportedData, "beside layer 1", [&] { extract_with(Division::symmetric, {}); });
}

TEST(Division5d, AnAxisOfOneSampleHasAnEmptyContour) {
  OwnedImage<double, 5> image{Grid<5>::unit({3, 3, 1, 3, 3}), {}};
  image.values.resize(81);
  image.values[40] = 1.0;
  EXPECT_TRUE(extract_divided(image.view(), Division::symmetric, 0.5).simplices.empty());
}

}  // namespace
}  // namespace tegl
