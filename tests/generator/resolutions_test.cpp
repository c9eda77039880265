// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles with freely resolved ambiguities: their number, certificates and symmetry, and agreement with the tables.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "filling/facets.hpp"
#include "filling/resolutions.hpp"
#include "share.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::gen {
namespace {

using tile::Choice;
using tile::FaceLattice;
using tile::FacetBuilder;

TEST(Resolutions, ACubeHas656AndAllPass) {
  const ResolutionFigures figures = certify_all_resolutions(TileKind::cube, 3, 2);
  EXPECT_EQ(figures.pairs, 656u);
  EXPECT_EQ(figures.classes, 22u);
  EXPECT_EQ(figures.pairs_by_class, 109u);
  EXPECT_EQ(figures.tiles, figures.orbits);
  EXPECT_LT(figures.orbits, figures.pairs_by_class);
}

TEST(Resolutions, ATesseractHasAsManyAsTheTheorySays) {
  const Lattice tiles(TileKind::cube, 4);
  const FaceLattice lattice = face_lattice(TileKind::cube, 4);
  std::uint64_t pairs = 0, by_class = 0;
  for (tile::Signature s = 0; s < 65536; ++s) pairs += std::uint64_t{1} << ambiguous_polygons(lattice, s).size();
  EXPECT_EQ(pairs, 48453090u);
  const auto elements = symmetries(tiles.tile(4), GroupKind::Full, false);
  for (const std::uint32_t s : transversal(tiles.tile(4), elements).representatives)
    by_class += std::uint64_t{1} << ambiguous_polygons(lattice, s).size();
  EXPECT_EQ(by_class, 17395393u);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // ten times as slow: the sample suffices
TEST(Resolutions, EveryOneOfATesseractPasses) {
  const ResolutionFigures figures = certify_all_resolutions(TileKind::cube, 4, 0);
  EXPECT_EQ(figures.classes, 402u);
  EXPECT_EQ(figures.pairs, 48453090u);
  EXPECT_EQ(figures.pairs_by_class, 17395393u);
  EXPECT_EQ(figures.non_spherical, 30805444u);
  EXPECT_EQ(figures.classes_with_non_spherical, 190u);
  EXPECT_EQ(figures.euler.begin()->first, 2 - 2 * 5) << "the highest genus is 5";
}
#endif

TEST(Resolutions, TheCheckerboardReachesGenusFive) {
  // Every square of this signature is ambiguous; a seeded search through its 2^24 resolutions.
  const FaceLattice lattice = FaceLattice::cube(4);
  FacetBuilder builder(lattice);
  std::vector<Choice> choices(lattice.faces().size());
  const auto squares = ambiguous_polygons(lattice, 0x6996);
  ASSERT_EQ(squares.size(), 24u);
  int least = 2;
  std::uint32_t state = 1;
  for (int i = 0; i < 200000 && least > -8; ++i) {
    state = state * 1664525u + 1013904223u;
    for (std::size_t k = 0; k < squares.size(); ++k)
      choices[squares[k]] = ((state >> (8 + k)) & 1u) != 0 ? Choice::high : Choice::low;
    const auto& tile = builder.build(0x6996, {choices, tile::Alternative::low}, tile::Geometry::without);
    for (const int euler : tile.sigma_euler) least = std::min(least, euler);
  }
  EXPECT_EQ(least, -8);
}

TEST(Resolutions, OtherTilesPassToo) {
  EXPECT_EQ(certify_all_resolutions(TileKind::simplex, 3, 1).pairs, 16u);
  EXPECT_EQ(certify_all_resolutions(TileKind::simplex, 4, 1).pairs, 32u);
  EXPECT_EQ(certify_all_resolutions(TileKind::octahedron, 3, 1).pairs, 64u);
}

constexpr std::uint64_t kTesseracts = test::unless_sanitized(100000, 4000);

TEST(Resolutions, AHundredThousandTesseractsPass) {
  const ResolutionFigures figures = certify_sample(TileKind::cube, 4, kTesseracts, 2024, 0);
  EXPECT_EQ(figures.tiles, kTesseracts);
  EXPECT_LT(figures.euler.begin()->first, -2) << "a sample with nothing but simple tiles";
}

TEST(Resolutions, TilesOfDimensionSixPass) { EXPECT_EQ(certify_sample(TileKind::cube, 6, 2, 6, 2).tiles, 2u); }

TEST(Resolutions, ASampleDoesNotDependOnThreads) {
  const ResolutionFigures one = certify_sample(TileKind::cube, 4, 3000, 7, 1);
  const ResolutionFigures three = certify_sample(TileKind::cube, 4, 3000, 7, 3);
  EXPECT_EQ(one.simplices, three.simplices);
  EXPECT_EQ(one.euler, three.euler);
  EXPECT_NE(one.simplices, certify_sample(TileKind::cube, 4, 3000, 8, 2).simplices);
}

TEST(InParallel, TheFailureOfTheSmallestUnitIsTold) {
  for (int round = 0; round < 50; ++round) {
    std::atomic<int> done = 0;
    const auto work = [&](int&, std::uint64_t unit) {
      if (unit % 10 == 7) throw std::runtime_error(std::to_string(unit));
      ++done;
    };
    try {
      in_parallel(
          1000, 4, 4, [] { return 0; }, work, [](int) {});
      FAIL() << "nothing thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "7");
      EXPECT_GE(done, 7);
    }
  }
}

/// Names of a tile's vertices that are independent of the numbering of corners after a symmetry has renamed these.
class Names {
 public:
  Names(const FaceLattice& lattice, const tile::TileFacets& tile, const std::vector<std::uint32_t>& corner)
      : lattice_(lattice), tile_(tile), corner_(corner), names_(tile.vertices.size()) {}

  std::uint64_t operator()(tile::VertexId v) {
    if (names_[v] != 0) return names_[v];
    const tile::Vertex& vertex = tile_.vertices[v];
    tile::Signature face = 0;
    for (std::size_t c = 0; c < corner_.size(); ++c)
      if (((lattice_.faces()[vertex.face].corners >> c) & 1u) != 0) face |= tile::Signature{1} << corner_[c];
    std::uint64_t name = mix(face * 31 + static_cast<unsigned>(vertex.kind));
    if (vertex.copied != tile::kNoVertex) name = mix(name + (*this)(vertex.copied) * 3);
    for (const tile::Simplex& s : vertex.of) name += mix(unordered(s) + 77);
    return names_[v] = mix(name);
  }

  std::uint64_t unordered(const tile::Simplex& s) {
    std::uint64_t sum = 0;
    for (int i = 0; i < tile::size(s); ++i) sum += (*this)(s[i]);
    return mix(sum);
  }

  /// A simplex with its orientation times `sign`.
  std::uint64_t oriented(const tile::Simplex& s, int sign) {
    for (int i = 0; i < tile::size(s); ++i)
      for (int j = i + 1; j < tile::size(s); ++j)
        if ((*this)(s[j]) < (*this)(s[i])) sign = -sign;
    return unordered(s) + (sign > 0 ? 1 : 2);
  }

 private:
  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    return (x ^ (x >> 27)) * 0x94d049bb133111ebu ^ 0x9e3779b97f4a7c15u;
  }

  const FaceLattice& lattice_;
  const tile::TileFacets& tile_;
  const std::vector<std::uint32_t>& corner_;
  std::vector<std::uint64_t> names_;
};

std::multiset<std::uint64_t> named(const FaceLattice& lattice, const tile::TileFacets& tile,
                                   const std::vector<std::uint32_t>& corner, int det) {
  Names names(lattice, tile, corner);
  std::multiset<std::uint64_t> result;
  for (const tile::Facet& facet : tile.facets)
    for (const tile::Simplex& s : facet.simplices) result.insert(names.oriented(s, det));
  return result;
}

/// The faces' choices after a symmetry.
std::vector<Choice> moved(const FaceLattice& lattice, const std::vector<Choice>& choices,
                          const std::vector<std::uint32_t>& corner) {
  std::map<tile::Signature, Choice> by_corners;
  for (std::size_t f = 0; f < choices.size(); ++f) {
    tile::Signature image = 0;
    for (std::size_t c = 0; c < corner.size(); ++c)
      if (((lattice.faces()[f].corners >> c) & 1u) != 0) image |= tile::Signature{1} << corner[c];
    by_corners[image] = choices[f];
  }
  std::vector<Choice> result;
  for (const tile::Face& face : lattice.faces()) result.push_back(by_corners.at(face.corners));
  return result;
}

TEST(Resolutions, BuildingAfterASymmetryIsSymmetryAfterBuilding) {
  std::uint64_t state = 3;
  const auto random = [&] { return (state = state * 6364136223846793005u + 1442695040888963407u) >> 33; };
  for (const int n : {2, 3, 4}) {
    const FaceLattice lattice = FaceLattice::cube(n);
    FacetBuilder builder(lattice);
    const Lattice tiles(TileKind::cube, n);
    std::vector<std::uint32_t> same;
    for (std::uint32_t c = 0; c < 1u << n; ++c) same.push_back(c);
    const auto elements = symmetries(tiles.tile(n), GroupKind::Full, false);
    for (int i = 0; i < 40; ++i) {
      const tile::Signature s = n == 4 && i == 0 ? 0x6996 : random() & lattice.faces().back().corners;
      std::vector<Choice> choices(lattice.faces().size(), Choice::separate);
      for (const std::uint32_t f : ambiguous_polygons(lattice, s))
        choices[f] = random() % 2 == 0 ? Choice::low : Choice::high;
      const auto tile = builder.build(s, {choices, tile::Alternative::low});
      for (const TileSymmetry& g : elements) {
        tile::Signature image = 0;
        for (std::size_t c = 0; c < g.corner.size(); ++c)
          if (((s >> c) & 1u) != 0) image |= tile::Signature{1} << g.corner[c];
        const std::vector<Choice> image_choices = moved(lattice, choices, g.corner);
        const auto& other = builder.build(image, {image_choices, tile::Alternative::low});
        ASSERT_EQ(named(lattice, tile, g.corner, g.det), named(lattice, other, same, 1)) << n << "D, signature " << s;
      }
    }
  }
}

/// A facet up to the numbers of its interior vertices: for each edge point, the number of simplices that contain it.
using Portrait = std::pair<std::size_t, std::map<std::uint64_t, int>>;

TEST(Resolutions, EveryTesseractIsThatOfTheBarycentricTable) {
  const CubeLattice table_lattice(4);
  const FaceLattice lattice = FaceLattice::cube(4);
  FacetBuilder builder(lattice);
  const Tile& tile = table_lattice.tile(4);
  for (const bool high : {false, true}) {
    const ContourBuilder tables(table_lattice, 4, high ? Alternative::high : Alternative::low,
                                Triangulation::barycentric);
    for (std::uint32_t s = 0; s < 65536; ++s) {
      std::multiset<Portrait> ours, theirs;
      const tile::Resolution resolution{{}, high ? tile::Alternative::high : tile::Alternative::low};
      const auto& built = builder.build(s, resolution, tile::Geometry::without);
      for (const tile::Facet& facet : built.facets) {
        if (facet.filling == tile::Filling::side) continue;  // the tables have smaller ones
        Portrait portrait{facet.simplices.size(), {}};
        for (const tile::Simplex& simplex : facet.simplices)
          for (int i = 0; i < 4; ++i)
            if (const tile::Vertex& v = built.vertices[simplex[i]]; v.kind == tile::VertexKind::edge)
              ++portrait.second[lattice.faces()[v.face].corners];
        ours.insert(portrait);
      }
      for (const LocalFacet& facet : tables.build(s).facets) {
        if (facet.filling == Filling::side) continue;
        Portrait portrait{facet.simplices.size(), {}};
        for (const LocalSimplex& simplex : facet.simplices)
          for (const std::uint8_t v : simplex)
            if (v < tile.edge_count())
              ++portrait.second[std::uint64_t{1} << tile.edges[v][0] | std::uint64_t{1} << tile.edges[v][1]];
        theirs.insert(portrait);
      }
      ASSERT_EQ(ours, theirs) << "signature " << s;
    }
  }
}

}  // namespace
}  // namespace tegl::gen
