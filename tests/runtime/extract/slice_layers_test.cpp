// SPDX-License-Identifier: BSD-3-Clause
//
// The slice of a contour at a layer of the image is the contour of that layer: equal oriented simplices with bitwise
// equal coordinates. Tested for every triangulation, ambiguity, border and epsilon, with and without samples that equal
// the isovalue, across every axis, at every layer, and by every function that slices. The comparison is independent of
// the library's.
//
// By default a share of the images is tested, with TEGL_FULL_TOPOLOGY=1 in the environment all of them; the test prints
// the number of layers compared.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "estimators.hpp"
#include "fields.hpp"
#include "random_fields.hpp"
#include "simplicial_contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

template <class Real>
using BitsOf = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;

/// A simplex by the bits of its corners' coordinates in ascending order, and the parity of the sorting permutation. A
/// simplex with two equal corners has no orientation.
template <int N, class Real>
struct OrientedSimplex {
  std::array<std::array<BitsOf<Real>, N>, N> corners;
  bool odd = false;

  auto operator<=>(const OrientedSimplex&) const = default;
};

template <int N, class Real>
std::vector<OrientedSimplex<N, Real>> oriented_simplices(const Contour<N, Real>& contour) {
  std::vector<OrientedSimplex<N, Real>> result;
  for (const auto& simplex : contour.simplices) {
    OrientedSimplex<N, Real> s;
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < N; ++a) s.corners[i][a] = std::bit_cast<BitsOf<Real>>(contour.vertices[simplex[i]][a]);
    bool repeats = false;
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j) {
        repeats = repeats || s.corners[i] == s.corners[j];
        s.odd = s.odd != (s.corners[j] < s.corners[i]);  // parity of the number of inversions
      }
    std::sort(s.corners.begin(), s.corners.end());
    s.odd = s.odd && !repeats;
    result.push_back(s);
  }
  std::sort(result.begin(), result.end());
  return result;
}

struct Combination {
  std::string name;
  ExtractOptions options;
  bool ties;
};

std::vector<Combination> all_combinations() {
  std::vector<Combination> result;
  for (const auto& [name, by_name] : test::all_estimators())
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
      for (const bool close : {false, true})
        for (const double epsilon : {0.0, 0.01})
          for (const bool ties : {false, true}) {
            Combination& added = result.emplace_back();
            added.options = by_name;
            added.options.triangulation = triangulation;
            added.options.close = close;
            added.options.epsilon = epsilon;
            added.options.work.threads = 1;
            added.ties = ties;
            added.name = std::string(triangulation == Triangulation::compact ? "compact" : "barycentric") + ' ' + name +
                         (close ? " closed" : " open") + (epsilon > 0 ? " epsilon" : "") + (ties ? " ties" : "");
          }
  return result;
}

struct Tally {
  std::size_t layers = 0, cuts = 0, different = 0;
};

/// Compares all layers across all axes of an image.
template <int N, class Real>
void compare_layers(const Image<float, N>& image, const Combination& combination, Tally& tally) {
  const ExtractOptions& options = combination.options;
  const auto whole = extract<Real>(image, 1.0, options);
  for (int axis = 0; axis < N; ++axis) {
    const Scrubber<N, Real> scrubber(whole, Hyperplane<N>::across(axis, 0.0));
    // Only along the last axis of 4D contours points between layers are kept off the layers (slice.hpp).
    const bool by_contour = !combination.ties || options.epsilon > 0.0 || (N == 4 && axis == N - 1);
    for (std::size_t k = 0; k < image.size(axis); ++k) {
      const double at = image.grid().axes[axis][k];
      const auto expected = oriented_simplices(extract<Real>(test::layer_across(image, axis, k), 1.0, options));
      const auto compare = [&](const Contour<N - 1, Real>& cut, const char* by) {
        ++tally.cuts;
        if (oriented_simplices(cut) == expected) return;
        if (tally.different++ < 3)
          ADD_FAILURE() << combination.name << ", " << N << "D, axis " << axis << ", layer " << k << ", by " << by
                        << ": " << cut.simplices.size() << " against " << expected.size() << " simplices";
      };
      ++tally.layers;
      compare(slice_image<Real>(image, 1.0, Hyperplane<N>::across(axis, at), options), "slice_image");
      if (!by_contour) continue;
      compare(slice(whole, Hyperplane<N>::across(axis, at)), "slice");
      compare(scrubber.cut(at), "Scrubber");
    }
  }
}

template <int N>
OwnedImage<float, N> random_image(const std::array<std::size_t, N>& sizes, std::uint64_t seed, bool ties) {
  Grid<N> grid = Grid<N>::unit(sizes);
  // Steps that neither float nor double represents exactly; one axis is descending, one uneven.
  grid.axes[0] = Axis::uniform(sizes[0], 0.1, 0.3);
  grid.axes[1] = Axis::uniform(sizes[1], 2.0, -0.7);
  std::vector<double> uneven;
  for (std::size_t i = 0; i < sizes[N - 1]; ++i) uneven.push_back(0.1 * static_cast<double>(i * i + i + 1));
  grid.axes[N - 1] = Axis::rectilinear(uneven);
  auto image = test::coarse_noise<float, N>(grid, seed, 3);
  std::mt19937_64 bits(seed);
  if (!ties)
    for (float& value : image.values) value = static_cast<float>(2.0 * test::unit_random(bits));
  return image;
}

template <int N>
void expect_cuts_are_layers(const std::array<std::size_t, N>& sizes, std::size_t images, std::size_t share) {
  Tally all;
  const std::size_t tested = test::cases_to_test(images, share);  // for each combination
  for (const Combination& combination : all_combinations()) {
    Tally tally;
    for (std::size_t seed = 0; seed < tested; ++seed) {
      const auto image = random_image<N>(sizes, seed, combination.ties);
      if (seed % 2 == 0)
        compare_layers<N, float>(image.view(), combination, tally);
      else
        compare_layers<N, double>(image.view(), combination, tally);
    }
    std::cout << N << "D " << combination.name << ": " << tally.layers << " layers, " << tally.cuts << " cuts, "
              << tally.different << " different\n";
    all.layers += tally.layers, all.cuts += tally.cuts, all.different += tally.different;
  }
  std::cout << N << "D: " << all.layers << " layers, " << all.cuts << " cuts, " << all.different << " different, "
            << tested << " of " << images << " images for each combination\n";
  EXPECT_EQ(all.different, 0u);
}

TEST(CutsAtLayers, OfSurfacesAreTheContoursOfTheLayersInEveryCombination) {
  expect_cuts_are_layers<3>({7, 6, 5}, 12, 2);
}

TEST(CutsAtLayers, Of4dContoursAreTheContoursOfTheLayersInEveryCombination) {
  expect_cuts_are_layers<4>({4, 5, 4, 4}, 12, 2);
}

}  // namespace
}  // namespace tegl
