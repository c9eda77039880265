// SPDX-License-Identifier: BSD-3-Clause
//
// The proof that tables are embedded, against sampled positions of the points on edges, in exact integers; tables;
// faults.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "filling/certificate.hpp"
#include "filling/embedding_evidence.hpp"
#include "share.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "tables/tile_tables.hpp"

namespace tegl::gen {
namespace {

using test::cases_to_test;

constexpr std::int64_t kSteps = 1024;  ///< positions on an edge

/// Determinant by expansion along the first row.
std::int64_t determinant_of(const std::vector<std::vector<std::int64_t>>& m) {
  if (m.size() == 1) return m[0][0];
  std::int64_t sum = 0;
  for (std::size_t column = 0; column < m.size(); ++column) {
    if (m[0][column] == 0) continue;
    std::vector<std::vector<std::int64_t>> minor;
    for (std::size_t r = 1; r < m.size(); ++r) {
      minor.push_back(m[r]);
      minor.back().erase(minor.back().begin() + static_cast<std::ptrdiff_t>(column));
    }
    sum += (column % 2 == 0 ? 1 : -1) * m[0][column] * determinant_of(minor);
  }
  return sum;
}

/// Positions on edges, and the Radon partition of n + 2 points there.
class Positions {
 public:
  Positions(const Tile& tile, std::uint32_t seed) : tile_(tile), random_(seed), at_(tile.edge_count()) {}

  /// New positions: uniform, or near the ends.
  void draw() {
    for (std::int64_t& t : at_) {
      const auto near = std::int64_t{1} << random_() % 10;
      const auto kind = random_() % 3;
      t = kind == 0 ? 1 + random_() % (kSteps - 1) : kind == 1 ? near : kSteps - near;
    }
  }
  /// Whether the relative interiors of the points on edges p and those on q meet. n + 2 edges in general position.
  [[nodiscard]] bool meet(const std::vector<std::uint8_t>& p, const std::vector<std::uint8_t>& q) const {
    std::vector<std::uint8_t> all(p);
    all.insert(all.end(), q.begin(), q.end());
    int sign = 0;
    for (std::size_t drop = 0; drop < all.size(); ++drop) {
      std::vector<std::vector<std::int64_t>> rows;
      for (std::size_t k = 0; k < all.size(); ++k)
        if (k != drop) rows.push_back(row(all[k]));
      const std::int64_t d = determinant_of(rows) * (drop % 2 == 0 ? 1 : -1) * (drop < p.size() ? 1 : -1);
      if (d == 0 || (sign != 0 && (d > 0) != (sign > 0))) return false;
      sign = d > 0 ? 1 : -1;
    }
    return true;
  }

 private:
  [[nodiscard]] std::vector<std::int64_t> row(std::uint8_t e) const {
    std::vector<std::int64_t> result{1};
    const auto& [a, b] = tile_.edges[e];
    for (int i = 0; i < tile_.dim; ++i)
      result.push_back(static_cast<std::int64_t>(tile_.corners[a][i]) * (kSteps - at_[e]) +
                       static_cast<std::int64_t>(tile_.corners[b][i]) * at_[e]);
    return result;
  }

  const Tile& tile_;
  std::mt19937 random_;
  std::vector<std::int64_t> at_;
};

/// A position, out of `tries`, at which two simplices on edges intersect outside of their common vertices.
bool are_seen_to_meet(const Tile& tile, Positions& positions, const LocalSimplex& a, const LocalSimplex& b, int tries) {
  const int n = tile.dim;
  for (int i = 0; i < tries; ++i) {
    positions.draw();
    for (unsigned p = 1; p < 1u << n; ++p)
      for (unsigned q = 1; q < 1u << n; ++q) {
        if (std::popcount(p) + std::popcount(q) != n + 2) continue;
        std::vector<std::uint8_t> of_a, of_b;
        for (int k = 0; k < n; ++k) {
          if ((p >> k & 1u) != 0) of_a.push_back(a[k]);
          if ((q >> k & 1u) != 0) of_b.push_back(b[k]);
        }
        if (std::find_first_of(of_a.begin(), of_a.end(), of_b.begin(), of_b.end()) != of_a.end()) continue;
        if (positions.meet(of_a, of_b)) return true;
      }
  }
  return false;
}

LocalSimplex random_simplex(const Tile& tile, std::mt19937& random) {
  std::vector<std::uint8_t> edges(tile.edge_count());
  for (std::size_t e = 0; e < edges.size(); ++e) edges[e] = static_cast<std::uint8_t>(e);
  std::shuffle(edges.begin(), edges.end(), random);
  LocalSimplex result{};
  std::copy_n(edges.begin(), tile.dim, result.begin());
  return result;
}

void expect_proofs_agree_with_samples(TileKind kind, int n, int pairs, int tries) {
  const Lattice lattice(kind, n);
  const Tile& tile = lattice.tile(n);
  const EmbeddingProof proof(tile);
  Positions positions(tile, 7);
  std::mt19937 random(1);
  int apart = 0, seen = 0;
  for (int i = 0; i < pairs; ++i) {
    const LocalSimplex a = random_simplex(tile, random), b = random_simplex(tile, random);
    const bool is_apart = proof.holds(std::array{a, b});
    const bool is_seen = are_seen_to_meet(tile, positions, a, b, tries);
    ASSERT_FALSE(is_apart && is_seen) << n << "-tile, pair " << i;
    apart += is_apart;
    seen += is_seen;
  }
  EXPECT_GT(apart, pairs / 50);
  // Where the proof fails, some positions intersect; a few of them are rare.
  EXPECT_GT(seen, (pairs - apart) * 8 / 10) << apart << " of " << pairs << " apart";
}

TEST(EmbeddingProof, AgreesWithSampledPositionsIn2d) { expect_proofs_agree_with_samples(TileKind::cube, 2, 200, 300); }
TEST(EmbeddingProof, AgreesWithSampledPositionsIn3d) { expect_proofs_agree_with_samples(TileKind::cube, 3, 300, 300); }
TEST(EmbeddingProof, AgreesWithSampledPositionsIn4d) { expect_proofs_agree_with_samples(TileKind::cube, 4, 60, 60); }
TEST(EmbeddingProof, AgreesWithSampledPositionsInOctahedra) {
  expect_proofs_agree_with_samples(TileKind::octahedron, 3, 300, 300);
}

TEST(EmbeddingProof, SegmentsAcrossASquareMeetAndParallelOnesDoNot) {
  const CubeLattice lattice(2);
  const Tile& square = lattice.tile(2);
  const std::uint8_t left = square.edge_between(0, 2), right = square.edge_between(1, 3);
  const std::uint8_t below = square.edge_between(0, 1), above = square.edge_between(2, 3);
  const EmbeddingProof proof(square);
  EXPECT_FALSE(proof.holds(std::array{LocalSimplex{left, right}, LocalSimplex{below, above}}));
  EXPECT_TRUE(proof.holds(std::array{LocalSimplex{left, below}, LocalSimplex{right, above}}));
  EXPECT_TRUE(proof.holds(std::array{LocalSimplex{left, below}, LocalSimplex{left, above}}));
}

/// Few positions, for tests of many entries.
constexpr SearchPlan kShortSearch{.seed = 5, .uniform = 16, .near_ends = 16, .descents = 2, .steps = 32};

/// Expects evidence for every `step`-th signature, from `first` on.
void expect_evidence(const Lattice& lattice, int n, Triangulation triangulation, Evidence worst, Signature first,
                     Signature step) {
  for (const Alternative alternative : {Alternative::low, Alternative::high}) {
    const ContourBuilder builder(lattice, n, alternative, triangulation);
    const EmbeddingCertifier certifier(builder);
    for (Signature s = first; s <= builder.tile().full(); s += step)
      ASSERT_LE(certifier.of(builder.build(s), s, kShortSearch), worst)
          << n << "-tile, " << triangulation_name(triangulation) << ", signature " << s;
  }
}

TEST(EmbeddingEvidence, AllEntriesIn2dAnd3dAreProved) {
  for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
    for (int n = 2; n <= 3; ++n) expect_evidence(CubeLattice(n), n, t, Evidence::proved, 0, 1);
    for (int n = 3; n <= 4; ++n) expect_evidence(Lattice(TileKind::simplex, n), n, t, Evidence::proved, 0, 1);
    expect_evidence(Lattice(TileKind::octahedron, 3), 3, t, Evidence::proved, 0, 1);
  }
}

TEST(EmbeddingEvidence, CompactEntriesIn4dAreProved) {
  const Signature step = cases_to_test(65'536, 256) == 65'536 ? 1 : 257;
  expect_evidence(CubeLattice(4), 4, Triangulation::compact, Evidence::proved, 3, step);
}

TEST(EmbeddingEvidence, BarycentricEntriesIn4dAreProvedOrSearched) {
  // The only entries without a proof have two cones from inside.
  const CubeLattice lattice(4);
  const TileClasses classes = tile_classes(lattice.tile(4));
  const ContourBuilder builder(lattice, 4, Alternative::low, Triangulation::barycentric);
  const EmbeddingCertifier certifier(builder);
  std::vector<Signature> searched;
  for (const std::uint32_t s : classes.classes.representatives) {
    const TileContour contour = builder.build(s);
    const Evidence evidence = certifier.of(contour, s, kShortSearch);
    ASSERT_NE(Evidence::absent, evidence) << s;
    if (evidence == Evidence::proved) continue;
    searched.push_back(s);
    EXPECT_EQ(2u, contour.cone_vertices) << s;
    EXPECT_TRUE(contour.side_masks.empty()) << s;
  }
  EXPECT_EQ((std::vector<Signature>{1972, 2040, 6633, 7140, 7921}), searched);
}

TEST(EmbeddingEvidence, CopiesOfSidesAreProved) {
  const CubeLattice lattice(4);
  const ContourBuilder builder(lattice, 4, Alternative::low, Triangulation::barycentric);
  const EmbeddingCertifier certifier(builder);
  for (const Signature s : {1910u, 2022u, 6076u, 7128u, 15853u, 28662u}) {
    const TileContour contour = builder.build(s);
    ASSERT_FALSE(contour.side_masks.empty()) << s;
    EXPECT_EQ(Evidence::proved, certifier.of(contour, s)) << s;
  }
}

/// Replaces two tetrahedra over a triangle by three around the edge between their opposite vertices. Nothing if they do
/// not share a triangle.
std::optional<std::vector<LocalSimplex>> with_chord(const std::vector<LocalSimplex>& simplices, std::size_t i,
                                                    std::size_t j) {
  LocalSimplex a = simplices[i];
  std::size_t alone = 4;  // the vertex of i that is not in j
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::find(simplices[j].begin(), simplices[j].end(), a[k]) != simplices[j].end()) continue;
    if (alone != 4) return {};
    alone = k;
  }
  std::uint8_t other = 0;
  for (const std::uint8_t v : simplices[j])
    if (std::find(a.begin(), a.end(), v) == a.end()) other = v;
  std::vector<LocalSimplex> result;
  for (std::size_t k = 0; k < simplices.size(); ++k)
    if (k != i && k != j) result.push_back(simplices[k]);
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == alone) continue;
    LocalSimplex t = a;
    t[k] = other;
    result.push_back(t);
  }
  return result;
}

/// The message of certify_embedding for a table in which only one signature has a contour; "" if it passes.
std::string failure_of(const ContourBuilder& builder, const TileClasses& classes, Signature s,
                       const TileContour& contour) {
  std::vector<TileContour> contours(std::size_t{builder.tile().full()} + 1);
  contours[s] = contour;
  CertifiedFigures figures;
  try {
    certify_embedding(builder, contours, classes, figures);
  } catch (const Error& error) {
    EXPECT_EQ(ErrorCode::CertificateFailed, error.code());
    return error.what();
  }
  return "";
}

/// Calls take(contour) for variants of a contour whose facets of a kind have one chord in place of a triangle, until it
/// returns false. The certificate of topology passes.
template <class Take>
void for_each_exchanged_chord(const ContourBuilder& builder, TableCertifier& topology, Signature s, Filling kind,
                              const Take& take) {
  TileContour contour = builder.build(s);
  for (LocalFacet& facet : contour.facets) {
    if (facet.filling != kind) continue;
    const auto original = facet.simplices;
    for (std::size_t i = 0; i < original.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const auto changed = with_chord(original, i, j);
        if (!changed) continue;
        facet.simplices = *changed;
        if (topology.certify(s, contour) == tile::Fault::none && !take(contour, facet)) return;
      }
    facet.simplices = original;
  }
}

class Mutations : public testing::Test {
 protected:
  const CubeLattice lattice_{4};
  const TileClasses classes_ = tile_classes(lattice_.tile(4));
};

TEST_F(Mutations, AnExchangedChordIsFound) {
  // A chord instead of a triangle keeps the topology, so the certificate passes; whether the simplices intersect is
  // seen by sampling.
  const ContourBuilder builder(lattice_, 4, Alternative::low, Triangulation::compact);
  const EmbeddingCertifier certifier(builder);
  TableCertifier topology(builder);
  Positions positions(builder.tile(), 3);
  int found = 0, confirmed = 0;
  for (Signature s = 1; s < 65'535 && found < 3; s += 331)
    for_each_exchanged_chord(
        builder, topology, s, Filling::pulled, [&](const TileContour& contour, const LocalFacet& facet) {
          if (certifier.of(contour, s) != Evidence::absent) return true;
          ++found;
          EXPECT_EQ(fmt::format("signature {} of the 4-tile: its simplices intersect for some positions", s),
                    failure_of(builder, classes_, s, contour));
          for (std::size_t x = 0; x < facet.simplices.size(); ++x)
            for (std::size_t y = 0; y < x; ++y)
              if (are_seen_to_meet(builder.tile(), positions, facet.simplices[x], facet.simplices[y], 20)) {
                ++confirmed;
                x = y = facet.simplices.size();
              }
          return found < 3;
        });
  EXPECT_EQ(3, found);
  EXPECT_GT(confirmed, 0);
}

TEST_F(Mutations, AnExchangedChordInAConeIsFoundByTheSearch) {
  const ContourBuilder builder(lattice_, 4, Alternative::low, Triangulation::barycentric);
  const EmbeddingCertifier certifier(builder);
  TableCertifier topology(builder);
  int found = 0;
  for (Signature s = 107; s < 65'535 && found < 3; s += 331)
    for_each_exchanged_chord(builder, topology, s, Filling::cone, [&](const TileContour& contour, const LocalFacet&) {
      const auto pairs = certifier.unproved_pairs(contour);
      EXPECT_FALSE(pairs.empty()) << s;
      if (certifier.of(contour, s, pairs, kShortSearch) != Evidence::absent) return true;
      ++found;
      EXPECT_EQ(fmt::format("signature {} of the 4-tile: its simplices intersect for some positions", s),
                failure_of(builder, classes_, s, contour));
      return false;
    });
  EXPECT_EQ(3, found);
}

TEST_F(Mutations, ExchangedSideVerticesAreFoundByTheSearch) {
  const ContourBuilder builder(lattice_, 4, Alternative::low, Triangulation::barycentric);
  for (const Signature s : {1910u, 6076u, 28662u}) {
    TileContour contour = builder.build(s);
    ASSERT_EQ("", failure_of(builder, classes_, s, contour));
    std::vector<std::uint64_t*> corners;  // side vertices at a corner
    for (std::uint64_t& mask : contour.side_masks)
      if (std::has_single_bit(mask) && mask < 0x10000u) corners.push_back(&mask);
    ASSERT_GE(corners.size(), 2u);
    std::swap(*corners.front(), *corners.back());
    EXPECT_EQ(fmt::format("signature {} of the 4-tile: its simplices intersect for some positions", s),
              failure_of(builder, classes_, s, contour));
  }
}

}  // namespace
}  // namespace tegl::gen
