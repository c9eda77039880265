// SPDX-License-Identifier: BSD-3-Clause
//
// Equivariance under reflections and rotations, for every symmetric way to resolve ambiguities: the contour of the
// transformed image is the transformed contour. Compared per piece in each tile: the edges that it meets and its Euler
// characteristic. With the barycentric tables also per simplex; other triangulations choose diagonals by corner
// numbers, which symmetries do not preserve.
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "compare.hpp"
#include "estimators.hpp"
#include "grid_symmetries.hpp"
#include "random_fields.hpp"
#include "tegl/extract.hpp"
#include "tile_pieces.hpp"

namespace tegl::test {
namespace {

/// Coordinates in units of 2^-20: mirrored positions are rounded differently.
template <int N, class Real>
Contour<N, double> rounded(const Contour<N, Real>& contour) {
  Contour<N, double> result;
  result.simplices = contour.simplices;
  for (const auto& vertex : contour.vertices) {
    const auto units = in_small_units<N>(vertex);
    auto& place = result.vertices.emplace_back();
    for (int a = 0; a < N; ++a) place[a] = static_cast<double>(units[a]);
  }
  return result;
}

template <int N>
SampledField<N> random_box(std::mt19937_64& bits, const std::array<std::size_t, N>& sizes, std::int64_t bound) {
  SampledField<N> field{sizes, {}};
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  while (field.values.size() < count)
    field.values.push_back(static_cast<std::int64_t>(random_below(bits, 2 * static_cast<std::uint64_t>(bound) + 1)) -
                           bound);
  return field;
}

/// Whether barycentric contours are equivariant triangle by triangle: if no rule makes tunnels, and no 4D cell has own
/// vertices that depend on the data.
template <int N>
bool moves_simplices(Ambiguity ambiguity) {
  const bool separates = ambiguity == Ambiguity::squares || ambiguity == Ambiguity::decider;
  return ambiguity == Ambiguity::low || ambiguity == Ambiguity::high || (N < 4 && separates);
}

/// `every`: tests one of this number of symmetries. Small bounds cause ties; epsilon keeps the vertices inside their
/// edges.
template <int N>
void expect_equivariant(const std::array<std::size_t, N>& sizes, std::uint64_t seed, std::size_t every) {
  std::mt19937_64 bits(seed);
  const auto symmetries = grid_symmetries<N>();
  for (const std::int64_t bound : {2, 1 << 20}) {
    const auto image = image_of<float>(random_box<N>(bits, sizes, bound));
    for (auto [name, options] : all_ways()) {
      if (name.starts_with("random")) continue;
      SCOPED_TRACE(name + ", bound " + std::to_string(bound));
      options.epsilon = 0.01;
      const auto contour = extract<double>(image.view(), 0.0, options);
      EXPECT_GT(contour.simplices.size(), 0u);
      for (std::size_t s = seed % every; s < symmetries.size(); s += every) {
        const auto expected = moved<N>(contour, symmetries[s], sizes);
        const auto found = extract<double>(view_of(moved(image, symmetries[s])), 0.0, options);
        ASSERT_EQ(tile_pieces(found), tile_pieces(expected)) << "symmetry " << s;
        if (options.triangulation == Triangulation::barycentric && moves_simplices<N>(options.ambiguity)) {
          ASSERT_TRUE(same_surface(rounded(found), rounded(expected))) << "symmetry " << s;
        }
      }
    }
  }
}

TEST(Symmetry, KeepsHowManyVerticesAndTrianglesThereAreThoughTunnelsOwnVerticesMove) {
  std::mt19937_64 bits(4);
  const auto symmetries = grid_symmetries<3>();
  bool moved_any = false;
  for (int field = 0; field < 8; ++field) {
    const auto image = image_of<float>(random_box<3>(bits, {4, 4, 4}, 1 << 20));
    for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle}) {
      const ExtractOptions options = by_ambiguity(ambiguity);
      const auto contour = extract<double>(image.view(), 0.0, options);
      for (std::size_t s = 0; s < symmetries.size(); s += 5) {
        const auto found = rounded(extract<double>(view_of(moved(image, symmetries[s])), 0.0, options));
        const auto expected = rounded(moved<3>(contour, symmetries[s], {4, 4, 4}));
        ASSERT_EQ(found.vertices.size(), expected.vertices.size());
        ASSERT_EQ(found.simplices.size(), expected.simplices.size());
        const std::set<std::array<double, 3>> there(expected.vertices.begin(), expected.vertices.end());
        for (const auto& vertex : found.vertices) {
          if (there.contains(vertex)) continue;
          moved_any = true;
          double nearest = 0x1p22;
          for (const auto& other : expected.vertices)
            nearest = std::min(nearest, std::hypot(vertex[0] - other[0], vertex[1] - other[1], vertex[2] - other[2]));
          ASSERT_LT(nearest, 0.5 * 0x1p20);
        }
      }
    }
  }
  EXPECT_TRUE(moved_any);
}

TEST(Symmetry, OfImagesIsThatOfContoursIn2d) { expect_equivariant<2>({9, 6}, 1, 1); }
TEST(Symmetry, OfImagesIsThatOfContoursIn3d) { expect_equivariant<3>({5, 4, 6}, 2, 1); }
TEST(Symmetry, OfImagesIsThatOfContoursIn4d) { expect_equivariant<4>({3, 4, 3, 3}, 3, 23); }

}  // namespace
}  // namespace tegl::test
