// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of single tiles against the numbers in theory.md, the certificate against injected faults, regions by
// volume.
#include "filling/facets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>

#include "base/error.hpp"
#include "filling/certificate.hpp"
#include "filling/regions.hpp"
#include "share.hpp"
#include "symmetry/symmetry.hpp"
#include "symmetry/transversal.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {
namespace {

using tile::Fault;

constexpr Triangulation kBothTriangulations[] = {Triangulation::barycentric, Triangulation::compact};

std::vector<int> polygon_sizes(const TileContour& contour) {
  std::vector<int> sizes;
  for (const LocalFacet& facet : contour.facets) sizes.push_back(static_cast<int>(facet.points.size()));
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

TEST(Facets, PolygonSizesOfThe3dTransversalAreTheTheorys) {
  struct Row {
    Signature signature;
    std::size_t orbit;
    std::vector<int> low, high;
  };
  const std::vector<Row> rows = {
      {0, 1, {}, {}},
      {1, 8, {3}, {3}},
      {3, 12, {4}, {4}},
      {6, 12, {3, 3}, {6}},
      {7, 24, {5}, {5}},
      {15, 6, {4}, {4}},
      {22, 8, {3, 3, 3}, {6, 3}},
      {23, 8, {6}, {6}},
      {24, 4, {3, 3}, {3, 3}},
      {25, 24, {4, 3}, {7}},
      {27, 24, {6}, {6}},
      {30, 24, {5, 3}, {5, 3}},
      {31, 24, {5}, {5}},
      {60, 6, {4, 4}, {4, 4}},
      {61, 24, {7}, {4, 3}},
      {63, 12, {4}, {4}},
      {105, 2, {3, 3, 3, 3}, {3, 3, 3, 3}},
      {107, 8, {6, 3}, {3, 3, 3}},
      {111, 12, {6}, {3, 3}},
      {126, 4, {3, 3}, {3, 3}},
      {127, 8, {3}, {3}},
      {255, 1, {}, {}},
  };
  const CubeLattice lattice(3);
  const ContourBuilder low(lattice, 3, Alternative::low, Triangulation::barycentric);
  const ContourBuilder high(lattice, 3, Alternative::high, Triangulation::barycentric);
  const Transversal classes = transversal(3, group(3, GroupKind::Full, false));
  ASSERT_EQ(rows.size(), classes.representatives.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(rows[i].signature);
    EXPECT_EQ(rows[i].signature, classes.representatives[i]);
    EXPECT_EQ(rows[i].orbit, classes.orbit_length[i]);
    EXPECT_EQ(rows[i].low, polygon_sizes(low.build(rows[i].signature)));
    EXPECT_EQ(rows[i].high, polygon_sizes(high.build(rows[i].signature)));
  }
}

TEST(Facets, AmbiguousClassesIn3dAreTheTheorys) {
  const CubeLattice lattice(3);
  const std::set<Signature> two{6, 22, 25, 30, 60, 61, 105, 107, 111}, three{24, 126};
  for (const Signature s : transversal(3, group(3, GroupKind::Full, false)).representatives) {
    const auto count = ambiguous_faces(lattice, 3, s);
    EXPECT_EQ(two.contains(s), count[2] != 0) << s;
    EXPECT_EQ(three.contains(s), count[3] != 0) << s;
  }
}

/// The figures of one kind of contours, from a certified contour of each class, times the length of the class.
CertifiedFigures figures_of_classes(const ContourBuilder& builder, const Transversal& classes) {
  CertifiedFigures figures;
  figures.alternative = builder.alternative();
  for (std::size_t i = 0; i < classes.representatives.size(); ++i) {
    const Signature s = classes.representatives[i];
    const std::uint64_t length = classes.orbit_length[i];
    const TileContour contour = builder.build(s);
    EXPECT_EQ(certify(builder, s, contour), Fault::none) << s;
    figures.signatures += length;
    figures.max_facets = std::max(figures.max_facets, static_cast<std::uint32_t>(contour.facets.size()));
    bool others = false;
    for (const LocalFacet& facet : contour.facets) {
      const bool sphere = facet.boundary_euler == 2;
      (sphere ? figures.spheres : figures.others) += length;
      others |= !sphere;
      figures.highest_genus =
          std::max(figures.highest_genus, static_cast<std::uint32_t>((2 - facet.boundary_euler) / 2));
    }
    figures.signatures_with_others += others ? length : 0;
    if (others) figures.classes_with_others.push_back(s);
  }
  return figures;
}

/// The figures of all 4D contours. Of every signature with TEGL_FULL_TOPOLOGY; otherwise of the classes, as `gen`
/// certifies every signature in each build.
std::vector<CertifiedFigures> figures_of_4d() {
  const Transversal classes = transversal(4, group(4, GroupKind::Full, false));
  if (test::cases_to_test(65536, classes.representatives.size()) == 65536)
    return certify_all(4);  // throws at the first signature that fails
  const CubeLattice lattice(4);
  std::vector<CertifiedFigures> figures;
  for (const Triangulation t : kBothTriangulations)
    for (const Alternative a : {Alternative::low, Alternative::high})
      figures.push_back(figures_of_classes(ContourBuilder(lattice, 4, a, t), classes));
  return figures;
}

TEST(Facets, EveryFilledTileOf4dPassesAndTheTorusClassesAreTheTheorys) {
  const auto figures = figures_of_4d();
  ASSERT_EQ(4u, figures.size());
  const std::vector<Signature> tori{1910, 2022, 2038, 4086, 6076, 7128,  7129,  7134,
                                    7164, 7910, 7926, 8184, 8185, 15834, 15853, 28662};
  for (const CertifiedFigures& f : figures) {
    EXPECT_EQ(65536u, f.signatures);
    EXPECT_EQ(104448u, f.spheres);
    EXPECT_EQ(1860u, f.others);
    EXPECT_EQ(1860u, f.signatures_with_others);
    EXPECT_EQ(1u, f.highest_genus);
    EXPECT_EQ(8u, f.max_facets);
    EXPECT_EQ(16u, f.classes_with_others.size());
    if (f.alternative == Alternative::low) {
      EXPECT_EQ(tori, f.classes_with_others);
    }
  }
}

TEST(Facets, EverySignatureOf2dAnd3dPassesInEveryWay) {
  for (const int n : {2, 3}) EXPECT_EQ(4u, certify_all(n).size());
}

/// Oriented simplices in canonical form, independent of the numbers of own vertices: the own vertex of a cone is named
/// by the smallest vertex that it cones.
std::multiset<std::vector<int>> canonical(const ContourBuilder& builder, const TileContour& contour,
                                          const std::array<int, 64>& rename, bool reversed) {
  std::multiset<std::vector<int>> result;
  for (const LocalFacet& facet : contour.facets) {
    int smallest = 1000;
    for (const auto p : facet.points) smallest = std::min(smallest, rename[p]);
    for (const LocalSimplex& s : facet.simplices) {
      std::vector<int> v;
      for (int i = 0; i < builder.dim(); ++i) v.push_back(s[i] < builder.own_base() ? rename[s[i]] : 100 + smallest);
      bool odd = reversed;
      for (std::size_t i = 0; i < v.size(); ++i)
        for (std::size_t j = i + 1; j < v.size(); ++j) odd ^= v[i] > v[j];
      std::sort(v.begin(), v.end());
      v.push_back(odd ? 1 : 0);
      result.insert(v);
    }
  }
  return result;
}

class EquivarianceTest : public testing::TestWithParam<int> {};

TEST_P(EquivarianceTest, BarycentricContoursMoveWithEverySymmetryOrientationIncluded) {
  const int n = GetParam();
  const CubeLattice lattice(n);
  const ContourBuilder builder(lattice, n, Alternative::low, Triangulation::barycentric);
  const Tile& tile = builder.tile();
  std::array<int, 64> same{};
  std::iota(same.begin(), same.end(), 0);
  for (const Element& g : group(n, GroupKind::Full, false)) {
    const auto corner = corner_permutation(g, n);
    std::array<int, 64> moved{};
    for (std::uint32_t e = 0; e < tile.edge_count(); ++e)
      for (std::uint32_t f = 0; f < tile.edge_count(); ++f)
        if (std::set<std::uint32_t>{corner[tile.edges[e][0]], corner[tile.edges[e][1]]} ==
            std::set<std::uint32_t>{tile.edges[f][0], tile.edges[f][1]})
          moved[e] = static_cast<int>(f);
    for (Signature s = 0; s <= tile.full(); ++s)
      ASSERT_EQ(canonical(builder, builder.build(s), moved, g.reverses_orientation()),
                canonical(builder, builder.build(act(g, corner, static_cast<std::uint32_t>(s))), same, false))
          << "signature " << s;
  }
}

INSTANTIATE_TEST_SUITE_P(AllElements, EquivarianceTest, testing::Values(2, 3));

TEST(Facets, HighAlternativeIsTheReversedLowOneOfTheComplement) {
  for (const int n : {2, 3, 4})
    for (const Triangulation t : kBothTriangulations) {
      const CubeLattice lattice(n);
      const ContourBuilder low(lattice, n, Alternative::low, t), high(lattice, n, Alternative::high, t);
      // In 4D a share of the signatures, without those that `gen` compares in each build (the multiples of 16).
      const std::size_t all = std::size_t{low.tile().full()} + 1;
      const std::size_t count = n < 4 ? all : test::cases_to_test(all, all / 8);
      const auto stride = static_cast<Signature>(all / count);
      std::vector<TileContour> of_low(count), of_high(count);
      for (std::size_t i = 0; i < count; ++i) {
        const auto s = static_cast<Signature>(i * stride + stride / 2 - stride / 8);
        of_high[i] = high.build(s);
        of_low[count - 1 - i] = low.build(low.tile().full() - s);
      }
      EXPECT_NO_THROW(check_inversion(n, of_low, of_high)) << n;
      std::swap(of_high[1].facets[0].simplices[0][0], of_high[1].facets[0].simplices[0][1]);
      EXPECT_THROW(check_inversion(n, of_low, of_high), Error) << n;
    }
}

// ---- The certificate detects each kind of fault.

TEST(Certificate, AConeOverATorusFailsAtItsApex) {
  const CubeLattice lattice(4);
  for (const Triangulation t : kBothTriangulations) {
    const ContourBuilder builder(lattice, 4, Alternative::low, t);
    for (const Signature s : {1910u, 7128u, 28662u}) {
      TileContour contour = builder.build(s);
      ASSERT_EQ(1u, contour.facets.size());
      ASSERT_EQ(t == Triangulation::barycentric ? Filling::side : Filling::pulled, contour.facets[0].filling);
      ASSERT_EQ(0, contour.facets[0].boundary_euler);
      ASSERT_EQ(certify(builder, s, contour), Fault::none);
      contour.facets[0].simplices.clear();
      for (const LocalSimplex& b : contour.boundary)
        contour.facets[0].simplices.push_back({static_cast<std::uint8_t>(builder.own_base()), b[0], b[1], b[2]});
      EXPECT_EQ(Fault::link, certify(builder, s, contour));
    }
  }
}

TEST(Certificate, EveryKindOfFaultIsNamed) {
  const CubeLattice lattice(3);
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
  const Signature s = 15;  // one quadrilateral, two triangles
  const TileContour good = builder.build(s);
  ASSERT_EQ(certify(builder, s, good), Fault::none);
  const auto fault = [&](auto change) {
    TileContour bad = good;
    change(bad.facets[0].simplices);
    return certify(builder, s, bad);
  };
  using List = std::vector<LocalSimplex>;
  EXPECT_EQ(Fault::boundary, fault([](List& l) { l.pop_back(); }));
  EXPECT_EQ(Fault::repeated_vertex, fault([](List& l) { l.push_back(l[0]); }));
  EXPECT_EQ(Fault::repeated_vertex, fault([](List& l) { l[0][1] = l[0][0]; }));
  EXPECT_EQ(Fault::orientation, fault([](List& l) { std::swap(l[0][1], l[0][2]); }));
  EXPECT_EQ(Fault::boundary, fault([](List& l) {
              for (LocalSimplex& t : l) std::swap(t[1], t[2]);
            }));
  EXPECT_EQ(Fault::branching, fault([](List& l) {
              for (const std::uint8_t v : {std::uint8_t{50}, std::uint8_t{51}})
                l.push_back({l[0][0], l[0][1], v}), l.push_back({l[0][1], l[0][2], v});
              l.push_back({l[0][0], l[0][1], 52});
            }));
}

TEST(Certificate, AChordInAFaceOfTheTileIsRefused) {
  // Signature 61: a heptagon with two non-adjacent vertices on one square.
  const CubeLattice lattice(3);
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
  TileContour contour = builder.build(61);
  const auto cycle = contour.facets.at(0).points;
  ASSERT_EQ(7u, cycle.size());
  int refused = 0;
  for (std::size_t apex = 0; apex < cycle.size(); ++apex) {
    auto& simplices = contour.facets[0].simplices;
    simplices.clear();
    for (std::size_t k = 1; k + 1 < cycle.size(); ++k)
      simplices.push_back({cycle[apex], cycle[(apex + k) % 7], cycle[(apex + k + 1) % 7]});
    const Fault fault = certify(builder, 61, contour);
    EXPECT_TRUE(fault == Fault::none || fault == Fault::in_tile_boundary) << name_of(fault);
    refused += fault == Fault::in_tile_boundary ? 1 : 0;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 7);
}

TEST(Certificate, CompactTilesNeedNoMoreSimplicesThanBarycentricOnes) {
  for (const int n : {3, 4}) {
    const CubeLattice lattice(n);
    const ContourBuilder compact(lattice, n, Alternative::low, Triangulation::compact);
    const ContourBuilder barycentric(lattice, n, Alternative::low, Triangulation::barycentric);
    const auto count = [](const TileContour& c) {
      std::size_t sum = 0;
      for (const LocalFacet& f : c.facets) sum += f.simplices.size();
      return sum;
    };
    for (Signature s = 0; s <= compact.tile().full(); s += n == 4 ? 17 : 1)
      ASSERT_LE(count(compact.build(s)), count(barycentric.build(s))) << n << "D signature " << s;
  }
}

// ---- Regions

using Point = std::array<double, 3>;

Point mean_of(const Tile& tile, std::uint32_t mask) {
  Point sum{};
  int count = 0;
  for (std::uint32_t b = 0; b < tile.corner_count() + tile.edge_count(); ++b) {
    if (((mask >> b) & 1u) == 0) continue;
    ++count;
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] += b < tile.corner_count() ? tile.corners[b][i]
                                        : 0.5 * (tile.corners[tile.edges[b - tile.corner_count()][0]][i] +
                                                 tile.corners[tile.edges[b - tile.corner_count()][1]][i]);
  }
  for (double& x : sum) x /= count;
  return sum;
}

double volume(const RegionBuilder& builder, Signature s) {
  const Tile& tile = builder.tile();
  double total = 0;
  for (const LocalSimplex& simplex : builder.regions(s).simplices) {
    Point p[4];
    for (int i = 0; i <= tile.dim; ++i) p[i] = mean_of(tile, builder.mask_of(s, simplex[i]));
    double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int r = 0; r < tile.dim; ++r)
      for (int c = 0; c < tile.dim; ++c)
        m[r][c] = p[r + 1][static_cast<std::size_t>(c)] - p[0][static_cast<std::size_t>(c)];
    const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    total += det / (tile.dim == 3 ? 6 : tile.dim == 2 ? 2 : 1);
  }
  return total;
}

TEST(Regions, HighAndLowPartsOfATileFillItExactly) {
  // The low part in the low-connected alternative is the high part of the complement in the high-connected one. With
  // edge points at midpoints, their volumes add up to the tile's volume.
  const CubeLattice lattice(3);
  for (int k = 1; k <= 3; ++k)
    for (const RegionStyle style : {RegionStyle::cone, RegionStyle::fan}) {
      const RegionBuilder low(lattice, k, Alternative::low, Triangulation::compact, style);
      const RegionBuilder high(lattice, k, Alternative::high, Triangulation::compact, style);
      for (Signature s = 0; s <= low.tile().full(); ++s)
        ASSERT_NEAR(1.0, volume(low, s) + volume(high, ~s & low.tile().full()), 1e-12) << k << "-tile, " << s;
    }
}

TEST(Regions, EverySimplexIsPositivelyOrientedInTheUnambiguousSquares) {
  const CubeLattice lattice(2);
  const RegionBuilder builder(lattice, 2, Alternative::low, Triangulation::compact, RegionStyle::fan);
  EXPECT_NEAR(0.125, volume(builder, 1), 1e-15);
  EXPECT_NEAR(0.5, volume(builder, 3), 1e-15);
  EXPECT_NEAR(0.25, volume(builder, 6), 1e-15);  // two separate corners
  EXPECT_NEAR(0.875, volume(builder, 7), 1e-15);
  EXPECT_NEAR(1.0, volume(builder, 15), 1e-15);
}

}  // namespace
}  // namespace tegl::gen
