// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles of every signature, embedded in a larger grid of low or high samples: the contour is a closed oriented manifold
// whose topology follows from the corners. Based on: the scheme of CGAL's Isosurfacing_3 tests (single cells, then
// embedded), here in n dimensions.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "only_targets.hpp"
#include "tegl/extract.hpp"
#include "tile/edge_means.hpp"
#include "tile/extract_tables.hpp"
#include "tile/signature_set.hpp"
#include "tile/variant_table.hpp"

namespace tegl::test {
namespace {

/// A 4^N grid of `around` whose middle tile has the signature. Magnitudes are random, so that no points coincide and no
/// four of them are coplanar by chance.
template <int N>
OwnedImage<double, N> embedded_tile(unsigned signature, bool around) {
  std::array<std::size_t, N> sizes;
  sizes.fill(4);
  OwnedImage<double, N> image{Grid<N>::unit(sizes), {}};
  image.values.resize(sample_count(image.grid));
  std::mt19937_64 bits(signature);
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    bool inside = true;
    unsigned corner = 0;
    for (int a = 0; a < N; ++a) {
      inside = inside && (index[a] == 1 || index[a] == 2);
      corner |= static_cast<unsigned>(index[a] == 2) << a;
    }
    const bool high = inside ? (signature >> corner & 1u) != 0 : around;
    const double size = 0.5 + unit_random(bits);
    image.values[i] = high ? size : -size;
  });
  return image;
}

/// Euler characteristic of the solid of the corners in `set` if diagonals are kept separate. It is homotopy equivalent
/// to the complex of all edges, squares and cubes whose corners all lie in the set. Exception: if just two corners of a
/// 3-diagonal are missing, each is cut off by a triangle (theory, section 2: class 126), and the tile's centre fills
/// the ring of the other six.
template <int N>
int euler_of_solid(unsigned set) {
  int euler = 0;
  if (N == 3)
    for (unsigned v = 0; v < 4; ++v) euler += set == (255u & ~(1u << v | 1u << (7 - v))) ? 1 : 0;
  for (unsigned axes = 0; axes < 1u << N; ++axes)
    for (unsigned base = 0; base < 1u << N; ++base) {
      if ((base & axes) != 0) continue;
      bool all = true;
      for (unsigned sub = axes;; sub = (sub - 1) & axes) {
        all = all && (set >> (base | sub) & 1u) != 0;
        if (sub == 0) break;
      }
      if (all) euler += std::popcount(axes) % 2 == 0 ? 1 : -1;
    }
  return euler;
}

/// Number of connected components of the corners in `set`, connected along edges.
template <int N>
unsigned components_of_corners(unsigned set) {
  unsigned count = 0;
  while (set != 0) {
    unsigned reached = set & -set;
    for (unsigned before = 0; reached != before;) {
      before = reached;
      for (unsigned v = 0; v < 1u << N; ++v)
        for (int a = 0; a < N; ++a)
          if ((before >> v & 1u) != 0) reached |= (1u << (v ^ 1u << a)) & set;
    }
    set &= ~reached;
    ++count;
  }
  return count;
}

template <int N>
void expect_sound_tile(unsigned signature) {
  for (const bool around : {false, true})
    for (const ExtractOptions& options : variants()) {
      SCOPED_TRACE(describe(options) + ", signature " + std::to_string(signature) + (around ? " in high" : " in low"));
      const auto image = embedded_tile<N>(signature, around);
      const auto contour = extract<double>(image.view(), 0.0, options);
      const auto report = expect_closed_manifold(contour);
      EXPECT_EQ(report.degenerate_simplices, 0u);
      // The corners that differ from the surroundings form components; if the alternative separates them, the contour
      // is the boundary of their thickening.
      constexpr unsigned kAll = (1u << (1u << N)) - 1;
      const unsigned set = around ? ~signature & kAll : signature;
      if ((options.ambiguity == Ambiguity::low) != around) {
        EXPECT_EQ(report.euler, N == 3 ? 2 * euler_of_solid<N>(set) : 0);
        EXPECT_GE(report.components, components_of_corners<N>(set));
      }
    }
}

TEST(Tile, All16SignaturesIn2dAreClosedManifolds) {
  for (unsigned s = 0; s < 16; ++s) expect_sound_tile<2>(s);
}
TEST(Tile, All256SignaturesIn3dAreClosedManifoldsOfTheRightEulerCharacteristic) {
  for (unsigned s = 0; s < 256; ++s) expect_sound_tile<3>(s);
}
TEST(Tile, EveryEightyThirdSignatureIn4dIsAClosedManifold) {
  for (unsigned s = 0; s < 65536; s += 83) expect_sound_tile<4>(s);
}
TEST(Tile, TorusClassesIn4dAreClosedManifolds) {
  for (const unsigned s : {1910u, 2022u, 2038u, 4086u, 6076u, 7128u, 7129u, 7134u, 7164u, 7910u, 7926u, 8184u, 8185u,
                           15834u, 15853u, 28662u})
    expect_sound_tile<4>(s);
}

/// All different masks without corners of the own vertices of resolved cubes.
std::vector<std::uint32_t> masks_of_edges() {
  const tables::TileTable& table = detail::variant_table<3>(Triangulation::compact).tile;
  std::vector<std::uint32_t> masks;
  for (unsigned key = 0; key < detail::kKeys<3>; ++key) {
    const detail::SimplexList<3> list(table, key);
    for (unsigned j = 0; j < list.list().side_vertices; ++j)
      if (!detail::is_on_ray(list.side_mask(j))) masks.push_back(static_cast<std::uint32_t>(list.side_mask(j)));
  }
  std::sort(masks.begin(), masks.end());
  masks.erase(std::unique(masks.begin(), masks.end()), masks.end());
  return masks;
}

/// `some_edges(bits)`: the edges of a mean, as bits.
template <int K, class SomeEdges>
void expect_own_vertices(const SomeEdges& some_edges) {
  using Means = detail::EdgeMeans<K>;
  std::mt19937_64 bits(5);
  for (int i = 0; i < 2'000; ++i) {
    Means means;
    means.count = 1 + bits() % Means::kMost;
    for (auto& of_edge : means.alphas)
      for (double& alpha : of_edge) alpha = bits() % 8 == 0 ? static_cast<double>(bits() % 3) / 2 : unit_random(bits);
    for (std::size_t m = 0; m < means.count; ++m) means.edges[m] = some_edges(bits);
    typename Means::Coordinates found;
    detail::find_means<K>(means, found);
    for (std::size_t m = 0; m < means.count; ++m) {
      const auto on_edge = [&](unsigned e) { return detail::edge_point<K>(e, means.alphas[e][m]); };
      const auto expected = detail::mask_place<K>(std::uint64_t{means.edges[m]} << (1u << K), std::identity(), on_edge,
                                                  true, detail::NoRays());
      for (unsigned a = 0; a < K; ++a) ASSERT_EQ(found[a][m], expected[a]) << "edges " << means.edges[m];
    }
  }
}

TEST(EdgeMeans, AreTheOwnVerticesOfCubes) {
  const std::vector<std::uint32_t> masks = masks_of_edges();
  ASSERT_GT(masks.size(), 10u);
  expect_own_vertices<3>([&](auto& bits) { return masks[bits() % masks.size()] >> 8; });
}

TEST(EdgeMeans, AreTheOwnVerticesOfTesseracts) {
  expect_own_vertices<4>([](auto& bits) { return static_cast<std::uint32_t>(bits() & bits()) | 1u << bits() % 32; });
}

TEST(SignatureSet, FindsItsMembersInARowOnAllInstructionSets) {
  std::mt19937_64 bits(11);
  with_all_targets([&] {
    for (std::size_t count = 0; count <= 64; ++count) {
      std::array<bool, 256> members{};
      for (bool& member : members) member = bits() % (1 + count % 3) == 0;
      const detail::SignatureSet set(members);
      std::vector<std::uint16_t> row(64 + 31, 0xffff);  // what follows the last tile does not count
      std::uint64_t expected = 0;
      for (std::size_t i = 0; i < count; ++i) {
        row[i] = static_cast<std::uint16_t>(bits() % 256);
        expected |= std::uint64_t{members[row[i]]} << i;
        ASSERT_EQ(set.contains(row[i]), members[row[i]]);
      }
      ASSERT_EQ(detail::members_of(set, row.data(), count), expected) << count;
    }
  });
}

}  // namespace
}  // namespace tegl::test
