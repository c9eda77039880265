// SPDX-License-Identifier: BSD-3-Clause
//
// Ambiguity resolved from the data: what each estimator draws, on noise of every value type, against tiles that are
// built one by one; and that contours stay closed manifolds, the same from every entry point.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "caps.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/extract.hpp"
#include "tegl/saddle.hpp"
#include "tegl/tile_facets.hpp"

namespace tegl::test {
namespace {

constexpr Ambiguity kEstimated[] = {Ambiguity::mean, Ambiguity::saddle, Ambiguity::custom};

const char* name_of(Ambiguity ambiguity) {
  constexpr const char* kNames[] = {"low", "high", "mean", "saddle", "custom"};
  return kNames[static_cast<int>(ambiguity)];
}

/// Options with this estimator; `custom` decides by the parity of the place and a hash of the values.
ExtractOptions with(Ambiguity ambiguity) {
  ExtractOptions options;
  options.ambiguity = ambiguity;
  if (ambiguity == Ambiguity::custom)
    options.estimator.choose = [](const AmbiguousFace& face) {
      std::size_t hash = face.axes();
      for (const std::size_t i : face.base()) hash = hash * 31 + i;
      return static_cast<facets::Choice>(hash * 2654435761u / 1024 % 3);
    };
  return options;
}

template <int N>
Grid<N> odd_grid(std::size_t samples) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a)
    grid.axes[a] = Axis::uniform(samples + static_cast<std::size_t>(a % 3), -0.7 * a, 0.5 + 0.25 * a);
  return grid;
}

}  // namespace

template <class Kind>
class Estimators : public ::testing::Test {};
template <class T, int N>
struct Kind {
  using Value = T;
  static constexpr int kDim = N;
};
using Kinds = ::testing::Types<Kind<std::uint8_t, 2>, Kind<float, 2>, Kind<std::int8_t, 3>, Kind<std::uint16_t, 3>,
                               Kind<std::int16_t, 3>, Kind<std::int32_t, 3>, Kind<float, 3>, Kind<double, 3>,
                               Kind<std::uint8_t, 4>, Kind<float, 4>>;
TYPED_TEST_SUITE(Estimators, Kinds);

TYPED_TEST(Estimators, GiveClosedManifoldsOnNoise) {
  constexpr int N = TypeParam::kDim;
  const auto image = noise<typename TypeParam::Value, N>(odd_grid<N>(N == 2 ? 70 : N == 3 ? 17 : 5), 5);
  for (const Ambiguity ambiguity : kEstimated)
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
      for (const bool close : {false, true}) {
        if (N == 4 && triangulation == Triangulation::barycentric) continue;  // refused
        SCOPED_TRACE(std::string(name_of(ambiguity)) + (close ? ", closed" : "") +
                     (triangulation == Triangulation::compact ? ", compact" : ", barycentric"));
        ExtractOptions options = with(ambiguity);
        options.triangulation = triangulation;
        options.close = close;
        const auto contour = extract(image.view(), noise_isovalue<typename TypeParam::Value>(), options);
        if (close)
          expect_closed_manifold(contour);
        else
          expect_oriented_manifold(contour);
      }
}

}  // namespace tegl::test
