// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles of any dimension: certified for all signatures if that is cheap, else for random ones, and compared with the
// builder of the tables.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "filling/facets.hpp"
#include "tegl/tile/certificate.hpp"
#include "tegl/tile/tile_certifier.hpp"

namespace tegl::tile {
namespace {

std::vector<Choice> random_choices(const FaceLattice& lattice, std::mt19937_64& random) {
  std::vector<Choice> choices(lattice.faces().size());
  for (Choice& c : choices) c = static_cast<Choice>(random() % 3);
  return choices;
}

void expect_all_certified(const FaceLattice& lattice, Alternative alternative) {
  const Signature last = lattice.faces()[lattice.tile()].corners;
  for (Signature s = 0; s <= last; ++s)
    ASSERT_EQ(certify(lattice, build_facets(lattice, s, {.choices = {}, .alternative = alternative})), Fault::none)
        << "signature " << s;
}

void expect_random_certified(const FaceLattice& lattice, int count, unsigned seed) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < count; ++i) {
    const Signature s = random() & lattice.faces()[lattice.tile()].corners;
    const std::vector<Choice> choices = random_choices(lattice, random);
    ASSERT_EQ(certify(lattice, build_facets(lattice, s, {choices, Alternative::low})), Fault::none)
        << "signature " << s << ", number " << i << " of seed " << seed;
  }
}

TEST(AnyDimension, CubesHaveTheirFaces) {
  EXPECT_EQ(FaceLattice::cube(2).faces().size(), 9u);
  EXPECT_EQ(FaceLattice::cube(4).faces().size(), 81u);
  EXPECT_EQ(FaceLattice::cube(6).faces().size(), 729u);
  EXPECT_EQ(FaceLattice::simplex(4).faces().size(), 31u);
  EXPECT_EQ(FaceLattice::octahedron(3).faces().size(), 27u);
}

TEST(AnyDimension, EverySquareAndCubeIsCertifiedInBothAlternatives) {
  for (const int n : {2, 3})
    for (const Alternative a : {Alternative::low, Alternative::high}) expect_all_certified(FaceLattice::cube(n), a);
}

TEST(AnyDimension, EverySimplexAndOctahedronIsCertified) {
  for (int n = 2; n <= 5; ++n) expect_all_certified(FaceLattice::simplex(n), Alternative::low);
  for (const Alternative a : {Alternative::low, Alternative::high}) expect_all_certified(FaceLattice::octahedron(3), a);
}

TEST(AnyDimension, EveryCubeIsCertifiedUnderEveryResolutionOfItsSquaresAndItself) {
  const FaceLattice cube = FaceLattice::cube(3);
  std::vector<Choice> choices(cube.faces().size());
  for (Signature s = 0; s < 256; ++s)
    for (unsigned squares = 0; squares < 64; ++squares)
      for (const Choice own : {Choice::separate, Choice::low, Choice::high}) {
        for (unsigned i = 0; i < 6; ++i)
          choices[cube.faces().back().faces[i]] = ((squares >> i) & 1u) != 0 ? Choice::high : Choice::low;
        choices.back() = own;
        ASSERT_EQ(certify(cube, build_facets(cube, s, {choices, Alternative::low})), Fault::none) << s;
      }
}

TEST(AnyDimension, SeededTilesWithRandomResolutionsAreCertified) {
  expect_random_certified(FaceLattice::cube(4), 300, 4);
  expect_random_certified(FaceLattice::cube(5), 4, 5);
}

/// A vertex by properties that neighbouring tiles share: its face's corners, kind and number.
using Name = std::tuple<Signature, VertexKind, std::uint32_t>;

std::multiset<std::set<Name>> named(const FaceLattice& lattice, const TileFacets& tile, const Simplices& simplices,
                                    const std::vector<int>& corner) {
  std::multiset<std::set<Name>> result;
  for (const Simplex& s : simplices) {
    std::set<Name> names;
    for (int i = 0; i < size(s); ++i) {
      const Vertex& v = tile.vertices[s[i]];
      Signature corners = 0;
      for (std::size_t c = 0; c < corner.size(); ++c)
        if (((lattice.faces()[v.face].corners >> c) & 1u) != 0) corners |= Signature{1} << corner[c];
      names.emplace(corners, v.kind, v.number);
    }
    result.insert(names);
  }
  return result;
}

TEST(AnyDimension, ContourInAFaceDependsOnTheFaceAlone) {
  std::mt19937_64 random(7);
  for (const int n : {3, 4}) {
    const FaceLattice lattice = FaceLattice::cube(n), below = FaceLattice::cube(n - 1);
    std::vector<int> same(std::size_t{1} << n);
    std::iota(same.begin(), same.end(), 0);
    for (int i = 0; i < 30; ++i) {
      const Signature s = random() & lattice.faces().back().corners;
      const std::vector<Choice> choices = random_choices(lattice, random);
      const TileFacets tile = build_facets(lattice, s, {choices, Alternative::high});
      for (std::size_t f = 0; f < tile.in_face.size(); ++f) {
        const Signature face = lattice.faces()[lattice.faces().back().faces[f]].corners;
        std::vector<int> corner;
        Signature own = 0;
        for (int v = 0; v < 1 << n; ++v) {
          if (((face >> v) & 1u) == 0) continue;
          own |= ((s >> v) & 1u) << corner.size();
          corner.push_back(v);
        }
        std::vector<Choice> own_choices;  // the faces of a face keep their order
        for (std::size_t g = 0; g < choices.size(); ++g)
          if ((lattice.faces()[g].corners & ~face) == 0) own_choices.push_back(choices[g]);
        const TileFacets alone = build_facets(below, own, {own_choices, Alternative::high});
        Simplices simplices;
        for (const Facet& facet : alone.facets)
          simplices.insert(simplices.end(), facet.simplices.begin(), facet.simplices.end());
        ASSERT_EQ(named(lattice, tile, tile.in_face[f], same), named(below, alone, simplices, corner)) << s << " " << f;
      }
    }
  }
}

TEST(AnyDimension, SpheresOfDimensionThreeAreShownAndConed) {
  const FaceLattice lattice = FaceLattice::cube(5);
  std::mt19937_64 random(55);
  int coned = 0;
  for (int i = 0; i < 10; ++i) {
    const Signature s = random() & random() & lattice.faces().back().corners;
    const TileFacets tile = build_facets(lattice, s);
    for (const Facet& f : tile.facets) coned += f.filling == Filling::cone ? 1 : 0;
    ASSERT_EQ(certify(lattice, tile), Fault::none) << "signature " << s;
  }
  EXPECT_GT(coned, 0);
}

TEST(AnyDimension, BoundariesOfFacetsAreThoseOfTheTableBuilder) {
  for (const int n : {2, 3, 4})
    for (const bool high : {false, true}) {
      const FaceLattice lattice = FaceLattice::cube(n);
      const gen::CubeLattice table_lattice(n);
      const gen::ContourBuilder builder(table_lattice, n, high ? gen::Alternative::high : gen::Alternative::low,
                                        gen::Triangulation::barycentric);
      const Signature step = n == 4 ? 37 : 1;
      for (Signature s = 0; s < Signature{1} << (1 << n); s += step) {
        const Resolution resolution{.choices = {}, .alternative = high ? Alternative::high : Alternative::low};
        std::vector<int> ours, theirs;
        for (const Facet& f : build_facets(lattice, s, resolution).facets) ours.push_back(f.boundary_euler);
        for (const gen::LocalFacet& f : builder.build(static_cast<gen::Signature>(s)).facets)
          theirs.push_back(f.boundary_euler);
        ASSERT_THAT(ours, testing::UnorderedElementsAreArray(theirs)) << n << "D, signature " << s;
      }
    }
}

TEST(AnyDimension, ATorusIsFilledFromTheSideAndCertified) {
  const FaceLattice tesseract = FaceLattice::cube(4);
  for (const Signature s : {1910u, 6076u, 28662u}) {
    const TileFacets tile = build_facets(tesseract, s);
    EXPECT_TRUE(std::any_of(tile.facets.begin(), tile.facets.end(),
                            [](const Facet& f) { return f.filling == Filling::side && f.boundary_euler == 0; }));
    EXPECT_EQ(certify(tesseract, tile), Fault::none);
  }
}

TEST(AnyDimension, WrongFillingsFailEachInItsWay) {
  const FaceLattice cube = FaceLattice::cube(3);
  const TileFacets right = build_facets(cube, 15);
  ASSERT_EQ(certify(cube, right), Fault::none);
  TileFacets wrong = right;
  wrong.facets[0].simplices[0][0] = wrong.facets[0].simplices[0][1];
  EXPECT_EQ(certify(cube, wrong), Fault::repeated_vertex);
  wrong = right;
  std::swap(wrong.facets[0].simplices[0][0], wrong.facets[0].simplices[0][1]);
  EXPECT_EQ(certify(cube, wrong), Fault::orientation);
  wrong = right;
  for (Simplex& s : wrong.facets[0].simplices) std::swap(s[0], s[1]);
  EXPECT_EQ(certify(cube, wrong), Fault::boundary);
  wrong = right;
  wrong.facets[0].simplices.pop_back();
  EXPECT_EQ(certify(cube, wrong), Fault::boundary);
  wrong = right;
  Simplex more = wrong.facets[0].simplices[0];
  for (const VertexId extra : {VertexId{0}, VertexId{1}}) {  // corners of the cube, in no contour
    more[2] = extra;
    wrong.facets[0].simplices.push_back(more);
  }
  EXPECT_EQ(certify(cube, wrong), Fault::branching);
}

TEST(AnyDimension, AContourThatLacksAComponentOrHasOneTurnedFails) {
  const FaceLattice cube = FaceLattice::cube(3);
  const TileFacets right = build_facets(cube, 129);  // two opposite corners: two triangles
  ASSERT_EQ(certify(cube, right), Fault::none);
  ASSERT_EQ(right.facets.size(), 2u);
  const auto is_of_last = [&](const Simplex& s) {
    const Simplex& t = right.facets.back().simplices[0];
    return std::find(t.begin(), t.end(), s[0]) != t.end();
  };
  TileFacets lacking = right, turned = right;
  lacking.facets.pop_back();
  std::swap(turned.facets.back().simplices[0][0], turned.facets.back().simplices[0][1]);
  for (std::size_t j = right.sigma.size(); j-- > 0;) {
    if (!is_of_last(right.sigma[j])) continue;
    lacking.sigma.erase(lacking.sigma.begin() + static_cast<std::ptrdiff_t>(j));
    lacking.sigma_sign.erase(lacking.sigma_sign.begin() + static_cast<std::ptrdiff_t>(j));
    turned.sigma_sign[j] = -turned.sigma_sign[j];
  }
  EXPECT_EQ(certify(cube, lacking), Fault::sigma);
  EXPECT_EQ(certify(cube, turned), Fault::sigma);
  TileFacets empty = right;
  empty.facets.clear(), empty.sigma.clear(), empty.sigma_sign.clear();
  EXPECT_EQ(certify(cube, empty), Fault::sigma);
}

TEST(AnyDimension, ABubbleInsideATileFails) {
  const FaceLattice cube = FaceLattice::cube(3);
  TileFacets tile = build_facets(cube, 15);
  const auto first = static_cast<VertexId>(tile.vertices.size());
  for (std::uint32_t k = 0; k < 4; ++k)
    tile.vertices.push_back({VertexKind::side, cube.tile(), 1000 + k, kNoVertex, {}});
  Simplex solid = kNoSimplex;
  for (VertexId k = 0; k < 4; ++k) solid[k] = static_cast<VertexId>(first + k);
  for (int i = 0; i < 4; ++i) {
    Simplex side = without(solid, i);
    if (i % 2 != 0) std::swap(side[0], side[1]);
    tile.facets[0].simplices.push_back(side);
  }
  EXPECT_EQ(certify(cube, tile), Fault::bubble);
}

TEST(AnyDimension, FamiliesOfSetsThatAreNoPolytopesAreRefused) {
  const auto lattice = [](int dim, std::vector<Signature> faces) { return FaceLattice(dim, faces); };
  EXPECT_NO_THROW(lattice(2, {0b0011, 0b1010, 0b1100, 0b0101}));
  EXPECT_THROW(lattice(2, {0b0011, 0b1010, 0b1100}), std::invalid_argument) << "a square without a side";
  EXPECT_THROW(lattice(3, {0b0111, 0b1011, 0b1101}), std::invalid_argument) << "a tetrahedron without a face";
  EXPECT_THROW(lattice(2, {0b0111, 0b1011, 0b1101, 0b1110}), std::invalid_argument) << "of another dimension";
  std::vector<Signature> simplex, torus;
  for (int v = 0; v < 8; ++v) simplex.push_back(0xffu & ~(Signature{1} << v));
  EXPECT_THROW(lattice(7, simplex), std::invalid_argument);
  for (unsigned v = 0; v < 7; ++v) {  // the torus with seven vertices
    torus.push_back(Signature{1} << v | Signature{1} << (v + 1) % 7 | Signature{1} << (v + 3) % 7);
    torus.push_back(Signature{1} << v | Signature{1} << (v + 2) % 7 | Signature{1} << (v + 3) % 7);
  }
  EXPECT_THROW(lattice(3, torus), std::invalid_argument);
}

TEST(AnyDimension, AConeOverATorusFailsByItsApex) {
  const FaceLattice tesseract = FaceLattice::cube(4);
  TileFacets tile = build_facets(tesseract, 1910);
  const auto apex = static_cast<VertexId>(tile.vertices.size());
  tile.vertices.push_back({VertexKind::barycentre, tesseract.tile(), 1000, kNoVertex, tile.sigma});
  tile.facets = {{Filling::cone, 0, {}}};
  for (std::size_t j = 0; j < tile.sigma.size(); ++j) {
    Simplex cone = with_apex(apex, tile.sigma[j]);
    if (tile.sigma_sign[j] < 0) std::swap(cone[0], cone[1]);
    tile.facets[0].simplices.push_back(cone);
  }
  EXPECT_EQ(certify(tesseract, tile), Fault::link);
}

TEST(AnyDimension, AChordAcrossAFaceFails) {
  const FaceLattice cube = FaceLattice::cube(3);
  TileFacets tile = build_facets(cube, 1);
  // The triangle's middle, assigned to one of the squares.
  const Simplex triangle = tile.facets[0].simplices[0];
  const auto middle = static_cast<VertexId>(tile.vertices.size());
  tile.vertices.push_back({VertexKind::barycentre, cube.faces().back().faces[0], 1000, kNoVertex, tile.sigma});
  tile.facets[0].simplices.clear();
  for (int i = 0; i < 3; ++i) {
    Simplex part = triangle;
    part[i] = middle;
    tile.facets[0].simplices.push_back(part);
  }
  EXPECT_EQ(certify(cube, tile), Fault::in_tile_boundary);
}

/// A builder that corrupts results of FacetBuilder.
class SpoiltBuilder {
 public:
  using Spoil = std::function<void(TileFacets&, Signature, const Resolution&)>;
  SpoiltBuilder(const FaceLattice& lattice, Spoil spoil) : builder_(lattice), spoil_(std::move(spoil)) {}

  const TileFacets& operator()(Signature signature, const Resolution& resolution) {
    tile_ = builder_.build(signature, resolution, Geometry::without);
    spoil_(tile_, signature, resolution);
    return tile_;
  }

 private:
  FacetBuilder builder_;
  Spoil spoil_;
  TileFacets tile_;
};

Fault certified_with(const FaceLattice& lattice, const SpoiltBuilder::Spoil& spoil, Signature signature,
                     const std::vector<Choice>& choices) {
  SpoiltBuilder builder(lattice, spoil);
  TileCertifier certifier(lattice,
                          [&](Signature s, const Resolution& r) -> const TileFacets& { return builder(s, r); });
  return certifier.certify(signature, {choices, Alternative::low});
}

TEST(TileCertifier, SeesWhatATileMakesOfItsFaces) {
  const FaceLattice lattice = FaceLattice::cube(4);
  const Signature two_corners = 0x8001;
  const std::vector<Choice> none;
  EXPECT_EQ(certified_with(
                lattice, [](TileFacets&, Signature, const Resolution&) {}, two_corners, none),
            Fault::none);
  // Removes everything, also in the faces: consistent in itself.
  const auto lose = [](TileFacets& tile, Signature, const Resolution&) {
    tile.facets.clear(), tile.sigma.clear(), tile.sigma_sign.clear();
    for (Simplices& in_face : tile.in_face) in_face.clear();
    for (std::vector<int>& signs : tile.in_face_sign) signs.clear();
  };
  EXPECT_EQ(certified_with(lattice, lose, two_corners, none), Fault::sigma);
  // Reverses all orientations.
  const auto turn = [](TileFacets& tile, Signature, const Resolution&) {
    for (Facet& facet : tile.facets)
      for (Simplex& s : facet.simplices) std::swap(s[0], s[1]);
    for (int& sign : tile.sigma_sign) sign = -sign;
    for (std::vector<int>& signs : tile.in_face_sign)
      for (int& sign : signs) sign = -sign;
  };
  EXPECT_EQ(certified_with(lattice, turn, two_corners, none), Fault::sigma);
  // The tile resolves squares in the opposite way: consistent in itself, but different from a neighbour's.
  FacetBuilder other(lattice);
  const auto disagree = [&](TileFacets& tile, Signature signature, const Resolution&) {
    tile = other.build(signature, {{}, Alternative::high}, Geometry::without);
  };
  std::vector<Choice> low(lattice.faces().size(), Choice::separate);
  for (std::size_t f = 0; f < low.size(); ++f)
    if (lattice.faces()[f].dim == 2) low[f] = Choice::low;
  EXPECT_EQ(certified_with(lattice, disagree, 0x0006, low), Fault::sigma);
  // The same faults in squares: an edge whose ends differ must have its point.
  const FaceLattice square = FaceLattice::cube(2);
  EXPECT_EQ(certified_with(square, lose, 6, none), Fault::sigma);
  EXPECT_EQ(certified_with(square, turn, 6, none), Fault::sigma);
}

TEST(TileCertifier, PassesTilesThatNobodyPlannedFor) {
  // The pyramid over a square, the prism over a triangle, and the prism over that prism.
  const std::vector<Signature> pyramid = {0b01111, 0b10011, 0b11010, 0b11100, 0b10101};
  const std::vector<Signature> prism = {0b000111, 0b111000, 0b011011, 0b110110, 0b101101};
  std::vector<Signature> duoprism = {0b000000111111, 0b111111000000};
  for (const Signature f : prism) duoprism.push_back(f | f << 6);
  std::mt19937_64 random(11);
  for (const FaceLattice& lattice : {FaceLattice(3, pyramid), FaceLattice(3, prism), FaceLattice(4, duoprism)}) {
    TileCertifier certifier(lattice);
    for (int i = 0; i < 200; ++i) {
      const Signature s = random() & lattice.faces().back().corners;
      const std::vector<Choice> choices = random_choices(lattice, random);
      ASSERT_EQ(certifier.certify(s, {choices, Alternative::low}), Fault::none) << "signature " << s;
    }
  }
}

TEST(Complexes, SolidToriCollapseToACircleAndBallsDoNot) {
  const FaceLattice tesseract = FaceLattice::cube(4);
  int tori = 0, balls = 0;
  for (const Signature s : {1910u, 6076u, 28662u, 1u, 6u})
    for (Facet facet : build_facets(tesseract, s).facets) {
      for (Simplex& simplex : facet.simplices) sort_vertices(simplex);
      EXPECT_EQ(collapses_to_a_circle(facet.simplices), facet.boundary_euler == 0);
      ++(facet.boundary_euler == 0 ? tori : balls);
    }
  EXPECT_GT(tori, 2);
  EXPECT_GT(balls, 1);
  Simplices circle, two;
  const auto edge = [](VertexId a, VertexId b) {
    Simplex s = kNoSimplex;
    s[0] = a, s[1] = b;
    return s;
  };
  circle = {edge(0, 1), edge(1, 2), edge(0, 2)};
  two = circle;
  for (const Simplex& s : circle) two.push_back(edge(static_cast<VertexId>(s[0] + 3), static_cast<VertexId>(s[1] + 3)));
  EXPECT_TRUE(collapses_to_a_circle(circle));
  EXPECT_FALSE(collapses_to_a_circle(two));
  EXPECT_FALSE(collapses_to_a_circle({edge(0, 1), edge(1, 2)}));
}

TEST(AnyDimension, TilesThatAreNoneAreRefused) {
  const FaceLattice cube = FaceLattice::cube(3);
  TileFacets tile = build_facets(cube, 15);
  tile.facets[0].simplices[0] = without(tile.facets[0].simplices[0], 0);
  EXPECT_THROW(certify(cube, tile), std::invalid_argument);
  tile = build_facets(cube, 15);
  tile.facets[0].simplices[0][0] = 10000;
  EXPECT_THROW(certify(cube, tile), std::invalid_argument);
}

TEST(AnyDimension, ABuilderKeepsNoMoreOfLargeFacesThanItMay) {
  const FaceLattice lattice = FaceLattice::cube(5);
  constexpr std::size_t kLimit = 200000;
  FacetBuilder limited(lattice, kLimit), forgetful(lattice, 0), roomy(lattice);
  std::mt19937_64 random(12);
  for (int i = 0; i < 20; ++i) {
    const Signature s = random() & lattice.faces().back().corners;
    const TileFacets& tile = limited.build(s);
    const TileFacets& same = forgetful.build(s);
    EXPECT_LE(limited.kept_bytes(), kLimit);
    EXPECT_EQ(forgetful.kept_bytes(), 0u);
    roomy.build(s);
    ASSERT_EQ(tile.facets.size(), same.facets.size());
    for (std::size_t f = 0; f < tile.facets.size(); ++f) EXPECT_EQ(tile.facets[f].simplices, same.facets[f].simplices);
  }
  EXPECT_GT(roomy.kept_bytes(), kLimit);
}

TEST(AnyDimension, WrongArgumentsAreSaid) {
  EXPECT_THROW(FaceLattice::cube(7), std::invalid_argument);
  EXPECT_THROW(build_facets(FaceLattice::cube(2), 16), std::invalid_argument);
  const std::vector<Choice> few(3);
  EXPECT_THROW(build_facets(FaceLattice::cube(2), 1, {few, Alternative::low}), std::invalid_argument);
}

}  // namespace
}  // namespace tegl::tile
