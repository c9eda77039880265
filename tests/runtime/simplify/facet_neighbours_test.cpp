// SPDX-License-Identifier: BSD-3-Clause
//
// Neighbours across facets, and the border that is found with them, compared with the number of simplices at each
// facet.
#include "simplify/facet_neighbours.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "fields.hpp"
#include "simplify/collapsible_complex.hpp"
#include "tegl/error.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {
namespace {

template <class T>
class NeighbouringFacets : public ::testing::Test {};
using FacetDimensions =
    ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(NeighbouringFacets, FacetDimensions);

/// Part of a ball's contour: the ball is larger than the image, so the contour has a border.
template <int N>
struct OpenContour {
  std::vector<std::array<Index, N>> simplices;
  std::size_t vertices = 0;

  OpenContour() {
    const auto image =
        test::sample_field<float, N>(test::centred_grid<N>(N == 4 ? 9 : 14, 1.0), test::Ball<N>{{}, 1.1});
    const auto contour = extract<double>(image.view(), 0.0);
    simplices.assign(contour.simplices.begin(), contour.simplices.end());
    vertices = contour.vertices.size();
  }
  /// Changes the orientation of some simplices.
  void flip_some(std::mt19937& random) {
    for (auto& simplex : simplices)
      if (random() % 7 == 0) std::swap(simplex[0], simplex[1]);
  }
};

template <int N>
std::array<Index, N - 1> sorted_facet(const std::array<Index, N>& simplex, int corner) {
  std::array<Index, N - 1> facet;
  for (int i = 0, k = 0; i < N; ++i)
    if (i != corner) facet[k++] = simplex[i];
  std::sort(facet.begin(), facet.end());
  return facet;
}

template <int N>
std::map<std::array<Index, N - 1>, int> counted_facets(const std::vector<std::array<Index, N>>& simplices) {
  std::map<std::array<Index, N - 1>, int> count;
  for (const auto& simplex : simplices)
    for (int corner = 0; corner < N; ++corner) ++count[sorted_facet<N>(simplex, corner)];
  return count;
}

TYPED_TEST(NeighbouringFacets, NeighboursAreKnownInAnotherOrderOfTheSimplices) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(3);
  OpenContour<N> contour;
  contour.flip_some(random);
  std::vector<Index> order(contour.simplices.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::shuffle(order.begin(), order.end(), random);
  std::vector<std::array<Index, N>> shuffled;
  for (const Index s : order) shuffled.push_back(contour.simplices[s]);

  const FacetNeighbours<N> original(contour.simplices, contour.vertices, 1, {});
  const FacetNeighbours<N> searched(shuffled, contour.vertices, 1, {});
  const FacetNeighbours<N> renumbered(original, order, 3, {});
  std::size_t joined = 0;
  for (Index s = 0; s < shuffled.size(); ++s)
    for (int corner = 0; corner < N; ++corner) {
      ASSERT_EQ(renumbered.across(s, corner), searched.across(s, corner));
      joined += searched.across(s, corner) != FacetNeighbours<N>::kNone;
    }
  EXPECT_GT(joined, shuffled.size());
}

TYPED_TEST(NeighbouringFacets, OfOneSimplexAreTheBorderWhateverTheOrientations) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(5);
  OpenContour<N> contour;
  contour.flip_some(random);
  const auto count = counted_facets<N>(contour.simplices);
  CollapsibleComplex<N> searched(contour.simplices, contour.vertices, 3);
  const CollapsibleComplex<N> known(contour.simplices, contour.vertices, 1, {}, searched.take_neighbours());
  EXPECT_EQ(searched.take_neighbours(), nullptr);

  std::vector<bool> is_on_border(contour.vertices, false);
  std::size_t borders = 0, unjoined = 0;
  const FacetNeighbours<N> neighbours(contour.simplices, contour.vertices, 1, {});
  for (Index s = 0; s < contour.simplices.size(); ++s)
    for (int corner = 0; corner < N; ++corner) {
      const auto facet = sorted_facet<N>(contour.simplices[s], corner);
      const bool is_border = count.at(facet) == 1;
      ASSERT_EQ((searched.border_faces(s) >> corner & 1u) != 0, is_border);
      ASSERT_EQ((known.border_faces(s) >> corner & 1u) != 0, is_border);
      borders += is_border;
      unjoined += neighbours.across(s, corner) == FacetNeighbours<N>::kNone;
      if (is_border)
        for (const Index v : facet) is_on_border[v] = true;
    }
  EXPECT_GT(borders, 0u);
  EXPECT_GT(unjoined, borders);  // those between simplices of opposite orientations
  for (Index v = 0; v < contour.vertices; ++v) {
    ASSERT_EQ(searched.on_border(v), is_on_border[v]);
    ASSERT_EQ(known.on_border(v), is_on_border[v]);
  }
}

TEST(NeighbouringFacetsOfTriangles, OfThreeSimplicesAreRefusedByNumberAndCount) {
  const std::vector<std::array<Index, 3>> triangles = {{5, 6, 7}, {3, 1, 0}, {2, 3, 1}, {1, 3, 4}};
  for (const unsigned threads : {1u, 2u}) try {
      const CollapsibleComplex<3> complex(triangles, 8, threads);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::UnsupportedData);
      EXPECT_THAT(error.what(), testing::HasSubstr("a face of simplex 1 is in 3 simplices"));
    }
}

}  // namespace
}  // namespace tegl::detail
