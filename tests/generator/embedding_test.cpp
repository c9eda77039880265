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
#include <vector>

#include "filling/certificate.hpp"
#include "filling/embedding_evidence.hpp"
#include "share.hpp"

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

/// Evidence for every `step`-th signature, from `first` on.
void expect_evidence(const Lattice& lattice, int n, Triangulation triangulation, Evidence worst, Signature first,
                     Signature step) {
  for (const Alternative alternative : {Alternative::low, Alternative::high}) {
    const ContourBuilder builder(lattice, n, alternative, triangulation);
    const EmbeddingCertifier certifier(builder);
    for (Signature s = first; s <= builder.tile().full(); s += step)
      ASSERT_LE(certifier.of(builder.build(s)), worst)
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
  expect_evidence(CubeLattice(4), 4, Triangulation::barycentric, Evidence::searched, 0, 5);
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

TEST(EmbeddingEvidence, AnExchangedChordIsFound) {
  // A chord instead of a triangle keeps the topology, so the certificate passes; whether the simplices intersect is
  // seen by sampling.
  const CubeLattice lattice(4);
  const ContourBuilder builder(lattice, 4, Alternative::low, Triangulation::compact);
  const EmbeddingCertifier certifier(builder);
  TableCertifier topology(builder);
  Positions positions(builder.tile(), 3);
  int found = 0, confirmed = 0;
  for (Signature s = 1; s < 65'535 && found < 3; s += 331) {
    TileContour contour = builder.build(s);
    for (LocalFacet& facet : contour.facets) {
      if (facet.filling != Filling::pulled) continue;
      const auto original = facet.simplices;
      for (std::size_t i = 0; i < original.size() && found < 3; ++i)
        for (std::size_t j = 0; j < i && found < 3; ++j) {
          const auto changed = with_chord(original, i, j);
          if (!changed) continue;
          facet.simplices = *changed;
          if (topology.certify(s, contour) != tile::Fault::none || certifier.of(contour) != Evidence::absent) continue;
          ++found;
          for (std::size_t x = 0; x < changed->size(); ++x)
            for (std::size_t y = 0; y < x; ++y)
              if (are_seen_to_meet(builder.tile(), positions, (*changed)[x], (*changed)[y], 20)) {
                ++confirmed;
                x = y = changed->size();
              }
        }
      facet.simplices = original;
    }
  }
  EXPECT_EQ(3, found);
  EXPECT_GT(confirmed, 0);
}

}  // namespace
}  // namespace tegl::gen
