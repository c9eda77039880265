// SPDX-License-Identifier: BSD-3-Clause
//
// The contour as facets of every dimension: the boundary of a boundary is zero, each interior facet has two cofacets,
// and every triangulation made by `extract` is a subdivision.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "compare.hpp"
#include "errors.hpp"
#include "estimators.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/tile_facets.hpp"

namespace tegl {

inline std::ostream& operator<<(std::ostream& out, const FacetReport& r) {
  return out << "facets " << r.facets[0] << ' ' << r.facets[1] << ' ' << r.facets[2] << ' ' << r.facets[3] << ", euler "
             << r.euler << ", components " << r.components << ", tori " << r.tori << ", border " << r.border
             << ", branching " << r.branching << ", conflicts " << r.conflicts << ", open " << r.open_boundaries;
}

}  // namespace tegl

namespace tegl::test {
namespace {

template <class T>
class Facets : public ::testing::Test {};
template <int N>
using Dim = std::integral_constant<int, N>;
using Dimensions = ::testing::Types<Dim<2>, Dim<3>, Dim<4>>;
TYPED_TEST_SUITE(Facets, Dimensions);

template <int N>
std::size_t noise_size() {
  return N == 2 ? 70 : N == 3 ? 20 : 8;
}

/// All ways to resolve ambiguity, open and closed. The triangulations compact and barycentric have equal facets.
std::vector<ExtractOptions> facet_variants() {
  std::vector<ExtractOptions> result;
  for (const bool close : {false, true})
    for (const NamedOptions& way : all_estimators()) {
      result.push_back(way.options);
      result.back().close = close;
    }
  return result;
}

template <int N, class Real>
FacetReport expect_sound(const FacetHierarchy<N, Real>& facets) {
  const FacetReport report = check(facets);
  EXPECT_EQ(report.branching, 0u) << report;
  EXPECT_EQ(report.conflicts, 0u) << report;
  EXPECT_EQ(report.open_boundaries, 0u) << report;
  return report;
}

TYPED_TEST(Facets, OfNoiseHaveTheTopologyOfTheContour) {
  constexpr int N = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= (N == 4 ? 1 : 3); ++seed) {
    const auto image = noise<float, N>(noise_size<N>(), seed);
    for (const ExtractOptions& options : facet_variants()) {
      SCOPED_TRACE(describe(options) + ", seed " + std::to_string(seed));
      const auto report = expect_sound(extract_facets<double>(image.view(), 0.5, options));
      const auto expected = check(extract<double>(image.view(), 0.5, options));
      EXPECT_EQ(report.euler, expected.euler) << report;
      EXPECT_EQ(report.components, expected.components) << report;
      EXPECT_EQ(report.border == 0, expected.boundary_simplices == 0) << report;
      if (options.close) {
        EXPECT_EQ(report.border, 0u) << report;
      }
    }
  }
}

TYPED_TEST(Facets, NextToMissingValuesAreAManifoldInItsRidges) {
  constexpr int N = TypeParam::value;
  Grid<N> grid;
  for (Axis& axis : grid.axes) axis = Axis::uniform(noise_size<N>());
  for (std::uint64_t seed = 1; seed <= (N == 4 ? 1 : 3); ++seed) {
    const auto image = noise_with_missing<float, N>(grid, seed, 0.04);
    for (const ExtractOptions& options : facet_variants()) {
      SCOPED_TRACE(describe(options) + ", seed " + std::to_string(seed));
      const auto report = expect_sound(extract_facets<double>(image.view(), 0.5, options));
      const auto expected = check(extract<double>(image.view(), 0.5, options));
      EXPECT_EQ(report.components, expected.components) << report;
      // In 4D `extract` separates holes that meet in a point by degenerate simplices, which join their borders.
      if (N < 4) {
        EXPECT_EQ(report.euler, expected.euler) << report;
      }
      if (N < 4) {
        EXPECT_EQ(report.border, expected.boundary_simplices) << report;
      }
    }
  }
}

TYPED_TEST(Facets, KnowWhatTheyBound) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::int16_t, N>(noise_size<N>(), 7);
  auto facets = extract_facets<float>(image.view(), 0.0);
  EXPECT_TRUE(facets.up(0, 0).empty());
  facets.connect_up();
  for (int k = 0; k + 1 < N; ++k) {
    std::size_t found = 0;
    for (std::size_t f = 0; f < facets.count(k); ++f) {
      const auto up = facets.up(k, f);
      EXPECT_TRUE(std::is_sorted(up.begin(), up.end()));
      for (std::size_t i = 0; i < up.size(); ++i) {
        const auto down = facets.down(k + 1, up[i]);
        const auto at = std::find(down.begin(), down.end(), f);
        ASSERT_NE(at, down.end());
        EXPECT_EQ(facets.down_signs(k + 1, up[i])[static_cast<std::size_t>(at - down.begin())],
                  facets.up_signs(k, f)[i]);
        ++found;
      }
    }
    EXPECT_EQ(found, facets.levels[k + 1].down.size());
  }
}

TYPED_TEST(Facets, LieInTheFacesOfTheGridThatTheyName) {
  constexpr int N = TypeParam::value;
  const auto image = noise<float, N>(noise_size<N>(), 11);
  for (const ExtractOptions& options : facet_variants()) {
    if (!options.close) continue;
    SCOPED_TRACE(describe(options));
    const bool has_tunnels = options.ambiguity == Ambiguity::mean || options.ambiguity == Ambiguity::saddle ||
                             options.ambiguity == Ambiguity::custom;
    std::size_t in_tunnels = 0;
    const auto facets = extract_facets<double>(image.view(), 0.5, options);
    for (int k = 0; k < N; ++k)
      for (std::size_t f = 0; f < facets.count(k); ++f) {
        const FacetPlace& place = facets.levels[k].places[f];
        const int dim = std::popcount(unsigned{place.axes});
        if (k < 2 && dim == 3 && !place.is_cap)
          ++in_tunnels;
        else
          ASSERT_EQ(dim, place.is_cap ? k : k + 1);
        const auto base = facets.index_of(place.base);
        for (unsigned v = 0, corner = 0; v < 1u << N; ++v) {
          if ((v & ~place.axes) != 0) continue;
          auto index = base;
          for (int a = 0; a < N; ++a) index[a] += v >> a & 1u;
          ASSERT_EQ(place.signature >> corner++ & 1u, image.view()(index) >= 0.5f ? 1u : 0u);
        }
        for (const Index point : facets.points_of(k, f))
          for (int a = 0; a < N; ++a) {
            const double x = facets.vertices[point][a] - static_cast<double>(base[a]);
            ASSERT_GE(x, 0.0);
            ASSERT_LE(x, (place.axes >> a & 1u) != 0 ? 1.0 : 0.0);
          }
      }
    EXPECT_EQ(in_tunnels > 0, N > 2 && has_tunnels);
  }
}

/// A grid with all special features: a descending axis, a non-uniform one, and a world map.
template <int N>
Grid<N> twisted_grid(std::size_t samples) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(samples + static_cast<std::size_t>(a), 0.25, 0.5);
  grid.axes[0] = Axis::uniform(samples, 1.0, -0.75);
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < samples; ++i) coordinates.push_back(static_cast<double>(i * i + i));
  grid.axes[1] = Axis::rectilinear(coordinates);
  if (N < 4) grid.linear[0][1] = 0.5;
  return grid;
}

TYPED_TEST(Facets, HavePointsAndNormalsBitByBitWhereTheContourHasThem) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint8_t, N>(twisted_grid<N>(noise_size<N>()), 3);  // many samples at the isovalue
  for (ExtractOptions options : facet_variants()) {
    if (options.close) continue;
    const double epsilon = options.ambiguity == Ambiguity::high ? 0.0 : 0.1;
    SCOPED_TRACE(describe(options));
    options.normals = Normals::differences;
    options.epsilon = epsilon;
    const auto facets = extract_facets<float>(image.view(), 128.0, options);
    const auto contour = extract<float>(image.view(), 128.0, options);
    using Pair = std::pair<std::array<float, N>, std::array<float, N>>;
    std::multiset<Pair> left;
    for (std::size_t v = 0; v < contour.vertices.size(); ++v) left.insert({contour.vertices[v], contour.normals[v]});
    for (std::size_t v = 0; v < facets.vertices.size(); ++v) {
      const auto at = left.find({facets.vertices[v], facets.normals[v]});
      ASSERT_NE(at, left.end()) << "point " << v;
      left.erase(at);
    }
    if (facets.vertices.size() == contour.vertices.size())
      EXPECT_TRUE(std::equal(facets.vertices.begin(), facets.vertices.end(), contour.vertices.begin()));
    else
      EXPECT_TRUE(N == 4 || (N == 3 && options.ambiguity >= Ambiguity::mean))
          << "the contour has vertices that are not on edges";
  }
}

TEST(FacetsOf2d, AreTheSegmentsOfTheContour) {
  const auto image = noise<float, 2>(twisted_grid<2>(60), 5);
  for (ExtractOptions options : facet_variants())
    for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
      options.direction = direction;
      SCOPED_TRACE(describe(options));
      const auto facets = extract_facets<double>(image.view(), 0.5, options);
      Contour<2, double> contour = extract<double>(image.view(), 0.5, options);
      const auto expected = contour;
      contour.simplices.clear();
      contour.vertices = facets.vertices;
      for (std::size_t f = 0; f < facets.count(1); ++f)
        contour.simplices.push_back({facets.down(1, f)[0], facets.down(1, f)[1]});
      EXPECT_TRUE(same_surface(contour, expected));
    }
}

TEST(FacetsOf3d, ArePolygonsThatTheTrianglesOfTheContourSubdivide) {
  const auto image = noise<float, 3>(twisted_grid<3>(14), 9);
  for (ExtractOptions options : facet_variants())
    for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
      options.direction = direction;
      SCOPED_TRACE(describe(options));
      const auto facets = extract_facets<double>(image.view(), 0.5, options);
      const auto contour = extract<double>(image.view(), 0.5, options);
      // Both number points in the same order, so a triangle belongs to the polygon that contains its three points. If
      // ambiguity is resolved from the data, the contour has further points between them, which polygons lack.
      constexpr Index kOther = ~Index{0};
      std::vector<Index> number(contour.vertices.size(), kOther);
      Index next = 0;
      for (std::size_t v = 0; v < contour.vertices.size() && next < facets.vertices.size(); ++v)
        if (contour.vertices[v] == facets.vertices[next]) number[v] = next++;
      ASSERT_EQ(next, facets.vertices.size());
      const std::size_t others = contour.vertices.size() - facets.vertices.size();
      const bool by_table = options.ambiguity == Ambiguity::low || options.ambiguity == Ambiguity::high;
      EXPECT_EQ(others == 0, by_table);
      std::map<std::array<Index, 3>, std::vector<std::array<Index, 3>>> triangles;
      std::size_t used = 0, incomplete = 0;
      for (const auto& simplex : contour.simplices) {
        const std::array<Index, 3> triangle{number[simplex[0]], number[simplex[1]], number[simplex[2]]};
        auto corners = triangle;
        std::sort(corners.begin(), corners.end());
        if (corners[2] == kOther)
          ++used;
        else
          triangles[corners].push_back(triangle);
      }
      for (std::size_t f = 0; f < facets.count(2); ++f) {
        const auto polygon = facets.points_of(2, f);
        std::map<std::pair<Index, Index>, int> edges;
        const auto add = [&](Index a, Index b, int sign) { edges[std::minmax(a, b)] += a < b ? sign : -sign; };
        for (std::size_t i = 0; i < polygon.size(); ++i) add(polygon[i], polygon[(i + 1) % polygon.size()], -1);
        auto sorted = polygon;
        std::sort(sorted.begin(), sorted.end());
        for (std::size_t i = 0; i < sorted.size(); ++i)
          for (std::size_t j = i + 1; j < sorted.size(); ++j)
            for (std::size_t l = j + 1; l < sorted.size(); ++l) {
              const auto at = triangles.find({sorted[i], sorted[j], sorted[l]});
              if (at == triangles.end()) continue;
              for (const auto& t : at->second) {
                ++used;
                for (int c = 0; c < 3; ++c) add(t[c], t[(c + 1) % 3], 1);
              }
            }
        if (std::any_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; })) ++incomplete;
      }
      EXPECT_LE(incomplete, others);
      EXPECT_EQ(used, contour.simplices.size());
    }
}

/// An image whose only tile has this signature.
OwnedImage<float, 4> tile_image(unsigned signature) {
  OwnedImage<float, 4> image{Grid<4>::unit({2, 2, 2, 2}), std::vector<float>(16)};
  for (unsigned v = 0; v < 16; ++v) image.values[v] = (signature >> v & 1u) != 0 ? 1.0f : 0.0f;
  return image;
}

TEST(FacetsOf4d, AreThoseThatTheBuilderOfTilesFinds) {
  std::mt19937_64 bits(4);
  std::vector<unsigned> signatures = {1910, 2022, 2038, 4086, 6076, 7128,  7129,  7134,
                                      7164, 7910, 7926, 8184, 8185, 15834, 15853, 28662};
  const std::size_t tori = signatures.size();
  while (signatures.size() < 1200) signatures.push_back(static_cast<unsigned>(random_below(bits, 65536)));
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high})
    for (std::size_t i = 0; i < signatures.size(); ++i) {
      const unsigned signature = ambiguity == Ambiguity::low ? signatures[i] : 65535 - signatures[i];
      ExtractOptions options;
      options.ambiguity = ambiguity;
      const auto facets = extract_facets<float>(view_of(tile_image(signature)), 0.5, options);
      auto expected = tile_facets<4>(signature, {.alternative = ambiguity == Ambiguity::low ? tile::Alternative::low
                                                                                            : tile::Alternative::high})
                          .sigma_euler;
      std::vector<int> eulers;
      for (std::size_t f = 0; f < facets.count(3); ++f) eulers.push_back(2 * facet_euler(facets, 3, f));
      std::sort(expected.begin(), expected.end());
      std::sort(eulers.begin(), eulers.end());
      ASSERT_EQ(eulers, expected) << "signature " << signature;
      if (i < tori) {
        EXPECT_EQ(check(facets).tori, 1u) << "signature " << signature;
      }
    }
}

/// The Euler characteristics of the connected components of a facet's simplices.
std::vector<int> parts_of(const tile::Facet& facet) {
  std::map<tile::VertexId, tile::VertexId> leader;
  const std::function<tile::VertexId(tile::VertexId)> find = [&](tile::VertexId v) {
    const auto at = leader.try_emplace(v, v).first;
    return at->second == v ? v : at->second = find(at->second);
  };
  for (const tile::Simplex& simplex : facet.simplices)
    for (int j = 1; j < tile::size(simplex); ++j) leader[find(simplex[j])] = find(simplex[0]);
  std::set<std::vector<tile::VertexId>> faces;
  for (const tile::Simplex& simplex : facet.simplices)
    for (unsigned set = 1; set < 1u << tile::size(simplex); ++set) {
      std::vector<tile::VertexId> face;
      for (int j = 0; j < tile::size(simplex); ++j)
        if ((set >> j & 1u) != 0) face.push_back(simplex[j]);
      std::sort(face.begin(), face.end());
      faces.insert(face);
    }
  std::map<tile::VertexId, int> euler;
  for (const auto& face : faces) euler[find(face[0])] += face.size() % 2 == 1 ? 1 : -1;
  std::vector<int> result;
  for (const auto& [first, sum] : euler) result.push_back(sum);
  return result;
}

TEST(FacetsOf4d, ResolvedInAnyWayAreThoseThatTheBuilderOfTilesFinds) {
  std::mt19937_64 bits(5);
  std::vector<tile::Choice> signs(kFaceCount<4>);
  ExtractOptions options;
  options.ambiguity = Ambiguity::custom;
  options.estimator.choose = [&](const AmbiguousFace& face) {
    unsigned base = 0;
    for (unsigned a = 0; a < 4; ++a) base |= static_cast<unsigned>(face.base()[a]) << a;
    return signs[face_number<4>(base, face.axes())];
  };
  std::size_t several = 0, negative = 0;
  for (int i = 0; i < 600; ++i) {
    const auto signature = static_cast<unsigned>(random_below(bits, 65536));
    for (tile::Choice& sign : signs) sign = static_cast<tile::Choice>(random_below(bits, 3));
    const auto hierarchy = extract_facets<float>(view_of(tile_image(signature)), 0.5, options);
    std::vector<int> expected, eulers;
    for (const tile::Facet& facet : tile_facets<4>(signature, {.choices = signs}).facets)
      for (const int euler : parts_of(facet)) expected.push_back(euler);
    for (std::size_t f = 0; f < hierarchy.count(3); ++f) eulers.push_back(facet_euler(hierarchy, 3, f));
    std::sort(expected.begin(), expected.end());
    std::sort(eulers.begin(), eulers.end());
    ASSERT_EQ(eulers, expected) << "signature " << signature << ", " << i;
    expect_sound(hierarchy);
    several += eulers.empty() || eulers.back() < 2 ? 0 : 1;
    negative += eulers.empty() || eulers.front() >= 0 ? 0 : 1;
  }
  EXPECT_GT(several, 10u) << "facets with a boundary of several parts";
  EXPECT_GT(negative, 10u) << "handlebodies";
}

TYPED_TEST(Facets, OfEstimatorsThatAnswerDifferentlyOrThrowAreAnError) {
  constexpr int N = TypeParam::value;
  const auto image = noise<float, N>(noise_size<N>(), 22);
  ExtractOptions options;
  options.ambiguity = Ambiguity::custom;
  std::atomic<unsigned> calls = 0;
  options.estimator.choose = [&](const AmbiguousFace&) {
    return static_cast<tile::Choice>((++calls * 2654435761u >> 8) % 3);
  };
  if (N > 2)
    expect_error(ErrorCode::InvalidArgument, "gave different results for the same face",
                 [&] { extract_facets<float>(image.view(), 0.5, options); });
  options.estimator.choose = [](const AmbiguousFace&) -> tile::Choice { throw std::domain_error("no opinion"); };
  EXPECT_THROW(extract_facets<float>(image.view(), 0.5, options), std::domain_error);
}

TYPED_TEST(Facets, AreTheSameForAnyNumberOfThreads) {
  constexpr int N = TypeParam::value;
  const auto image = noise<float, N>(noise_size<N>(), 21);
  for (ExtractOptions options : facet_variants()) {
    if (!options.close) continue;
    SCOPED_TRACE(describe(options));
    options.work.threads = 1;
    const auto one = extract_facets<float>(image.view(), 0.5, options);
    options.work.threads = 4;
    const auto four = extract_facets<float>(image.view(), 0.5, options);
    EXPECT_EQ(one.vertices, four.vertices);
    for (int k = 0; k < N; ++k) {
      EXPECT_EQ(one.levels[k].down, four.levels[k].down);
      EXPECT_EQ(one.levels[k].down_signs, four.levels[k].down_signs);
      ASSERT_EQ(one.count(k), four.count(k));
      for (std::size_t f = 0; f < one.count(k); ++f) {
        const FacetPlace &a = one.levels[k].places[f], &b = four.levels[k].places[f];
        ASSERT_TRUE(a.base == b.base && a.axes == b.axes && a.number == b.number && a.signature == b.signature &&
                    a.is_cap == b.is_cap);
      }
    }
  }
}

TEST(FacetsOf4d, OfAPlaneAreCubes) {
  // The hyperplane t = 1.5 meets 3 x 3 x 3 tiles, each in a cube.
  const auto image = sample_field<float, 4>(Grid<4>::unit({4, 4, 4, 4}), [](const Point<4>& x) { return x[3]; });
  const auto facets = extract_facets<double>(image.view(), 1.5);
  EXPECT_EQ(facets.count(3), 27u);
  EXPECT_EQ(facets.count(2), 3u * 4 * 9);
  EXPECT_EQ(facets.count(1), 3u * 3 * 16);
  EXPECT_EQ(facets.count(0), 64u);
  for (std::size_t f = 0; f < 27; ++f) EXPECT_EQ(facets.down(3, f).size(), 6u);
  EXPECT_EQ(check(facets).euler, 1);
  EXPECT_EQ(check(facets).border, 6u * 9);
}

TEST(FacetsOf3d, OfAnImageWithoutTilesAreNone) {
  const std::vector<float> values = {0, 1, 0, 1};
  const auto facets = extract_facets<float>(Image<float, 3>(values.data(), Grid<3>::unit({2, 2, 1})), 0.5);
  EXPECT_EQ(facets.count(0) + facets.count(1) + facets.count(2), 0u);
  EXPECT_EQ(check(facets).euler, 0);
}

TEST(FacetsOf3d, CanBeCancelledAndTellErrors) {
  const auto image = noise<float, 3>(12, 1);
  ExtractOptions options;
  int calls = 0;
  options.work.progress = [&](double) { return ++calls < 3; };
  try {
    extract_facets<float>(image.view(), 0.5, options);
    FAIL() << "not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
  double last = 0;
  options.work.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  };
  extract_facets<float>(image.view(), 0.5, options);
  EXPECT_EQ(last, 1.0);
  try {
    extract_facets<float>(image.view(), std::nan(""));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidIsovalue);
  }
}

}  // namespace
}  // namespace tegl::test
