// SPDX-License-Identifier: BSD-3-Clause
//
// Lattices with periodic axes and with caps: their cuts, and extents of simplices at the seam.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "complex/complex_cases.hpp"
#include "complex/lattice_image.hpp"
#include "invariants.hpp"
#include "tegl/check.hpp"
#include "tegl/lattice.hpp"
#include "tegl/measure.hpp"
#include "tegl/periodic.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

TEST(LatticeSeam, CutsAtTimesAreTheContoursOfFccWithItsPeriods) {
  const auto image =
      sampled_on_lattice<4>(Lattice::fcc_in_time, grid_of_torus<4>({4, 5, 6, 5}), noise_everywhere<4>(8));
  for (const Ambiguity ambiguity : kAllRules)
    for (const unsigned axes : {0u, 1u, 7u}) {
      ExtractOptions options;
      options.ambiguity = ambiguity;
      const auto contour =
          extract_lattice<double>(image.view(), Lattice::fcc_in_time, 0.5, options, periods_along<4>(axes));
      (void)expect_oriented_manifold(contour);
      for (const std::size_t k : {1, 3}) {
        Grid<3> space;
        std::copy_n(image.grid.axes.begin(), 3, space.axes.begin());
        const Image<double, 3> step(image.values.data() + k * 4 * 5 * 6, space);
        const auto expected = extract_lattice<double>(step, Lattice::fcc, 0.5, options, periods_along<3>(axes & 7u));
        const auto cut = slice(contour, Hyperplane<4>::across(3, image.grid.axes[3][k]));
        (void)expect_oriented_manifold(cut);
        EXPECT_EQ(check(cut).euler, check(expected).euler);
        EXPECT_EQ(check(cut).components, check(expected).components);
        EXPECT_NEAR(measure(cut).size, measure(expected).size, 1e-6);
      }
    }
}

TEST(LatticeSeam, CutsAcrossAPeriodAreThoseOfDataFromAnotherStart) {
  const auto test = []<int N>(Lattice lattice, const std::array<std::size_t, N>& sizes) {
    SCOPED_TRACE(std::string(name_of(lattice)));
    constexpr double kTurn = 2.0 * std::numbers::pi;
    for (int axis = 0; axis < N; ++axis) {
      const auto from = [&](double start) {
        const auto image =
            sampled_on_lattice<N>(lattice, grid_of_torus<N>(sizes), [&](auto x, const auto&, const auto&) {
              x[axis] += start;
              double sum = 0.4 * std::cos(kTurn * (x[0] - x[N - 1]));
              for (int a = 0; a < N; ++a) sum += (0.5 + 0.1 * a) * std::sin(kTurn * x[a] + a);
              return sum;
            });
        return extract_lattice<double>(image.view(), lattice, 0.05, {}, periods_along<N>((1u << N) - 1));
      };
      const auto contour = from(0.0), other = from(0.5);
      const auto unrolled = unroll(contour).contour;
      for (const double at : {0.0, 0.02, 0.07, 0.13, 0.95}) {
        const auto cut = slice(contour, Hyperplane<N>::across(axis, at));
        const auto expected = slice(other, Hyperplane<N>::across(axis, at - 0.5));
        const MeshReport report = expect_oriented_manifold(cut);
        EXPECT_GT(report.simplices, 0u);
        EXPECT_EQ(report.boundary_simplices, 0u) << axis << ", " << at;
        EXPECT_EQ(report.euler, check(expected).euler);
        // in 4D, cells may be divided in the order of the samples
        const double size = measure(cut).size;
        EXPECT_NEAR(size, measure(expected).size, N == 3 ? 1e-9 : 0.05 * size) << axis << ", " << at;
        // the parts of the unrolled contour, which ends at 0 and at 1
        double sum = 0.0;
        for (const double moved : {at - 1.0, at, at + 1.0})
          sum += measure(slice(unrolled, Hyperplane<N>::across(axis, moved))).size;
        EXPECT_TRUE(at == 0.0 || std::abs(sum - size) < 1e-9) << axis << ", " << at << ": " << sum << ", " << size;
        const auto further = slice(contour, Hyperplane<N>::across(axis, at + 1.0));
        EXPECT_NEAR(measure(further).size, measure(cut).size, 1e-9);
      }
      if (axis + 1 < N) continue;
      const auto ends = measure_cuts(contour, {0.0, 1.0, -1.0});
      EXPECT_GT(ends[0].size, 0.0);
      EXPECT_EQ(ends[0].size, ends[1].size);
      EXPECT_EQ(ends[0].size, ends[2].size);
    }
  };
  test.operator()<3>(Lattice::fcc, {8, 8, 16});
  test.operator()<3>(Lattice::bcc, {8, 8, 16});
  test.operator()<4>(Lattice::d4, {8, 8, 8, 8});
  test.operator()<4>(Lattice::fcc_in_time, {8, 8, 8, 8});
}

/// The largest extent of a simplex along an axis of period 1, with its vertices beside its first one.
template <int N>
double largest_extent(const Contour<N, double>& contour, int axis) {
  double largest = 0.0;
  for (const auto& simplex : contour.simplices) {
    double low = 0.0, high = 0.0;
    for (const Index v : simplex) {
      double beside = contour.vertices[v][axis] - contour.vertices[simplex[0]][axis];
      beside -= std::round(beside);
      low = std::min(low, beside);
      high = std::max(high, beside);
    }
    largest = std::max(largest, high - low);
  }
  return largest;
}

// At the first and last layer, prisms over pyramids have vertices of their own in hexahedra, some of them across the
// seam.
TEST(LatticeSeam, SimplicesOfPrismsOverEndPyramidsStayOnOneSideOfTheSeam) {
  for (const std::array<std::size_t, 4>& sizes : {std::array<std::size_t, 4>{4, 4, 4, 3}, {5, 3, 3, 6}, {3, 6, 5, 3}}) {
    const auto image = sampled_on_lattice<4>(Lattice::fcc_in_time, grid_of_torus<4>(sizes), noise_everywhere<4>(2));
    for (const Ambiguity ambiguity : kAllRules)
      for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
        for (const unsigned axes : {1u, 8u, 11u}) {  // never that of the layers
          SCOPED_TRACE(testing::Message() << "rule " << static_cast<int>(ambiguity) << " periods " << axes);
          ExtractOptions options;
          options.ambiguity = ambiguity;
          options.triangulation = triangulation;
          options.close = true;
          const auto contour =
              extract_lattice<double>(image.view(), Lattice::fcc_in_time, 0.5, options, periods_along<4>(axes));
          EXPECT_EQ(0u, expect_oriented_manifold(contour).boundary_simplices);
          (void)expect_oriented_manifold(unroll(contour).contour);
          for (int a = 0; a < 4; ++a) {
            if ((axes >> a & 1u) == 0) continue;
            const auto size = static_cast<double>(sizes[static_cast<std::size_t>(a)]);
            EXPECT_LT(largest_extent(contour, a), 1.001 / size);
            for (const double steps : {0.3, 1.4, size - 0.3}) {
              const auto cut = slice(contour, Hyperplane<4>::across(a, steps / size));
              EXPECT_EQ(0u, expect_oriented_manifold(cut).boundary_simplices) << steps << " along axis " << a;
              EXPECT_TRUE(measure(cut).content.has_value());
            }
          }
        }
  }
}

}  // namespace
}  // namespace tegl::test
