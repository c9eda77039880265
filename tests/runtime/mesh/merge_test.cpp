// SPDX-License-Identifier: BSD-3-Clause
//
// Merged vertices: against the definition, on balls that touch, on layers of samples that equal the isovalue, and on
// random images of few integers.
#include "tegl/merge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>

#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/extract.hpp"
#include "tegl/measure.hpp"

namespace tegl::test {
namespace {

/// The Euler characteristic by its definition: the alternating sum of the numbers of faces. As for `check`, simplices
/// with the same vertices count several times.
template <int N, class Real>
std::int64_t euler_by_definition(const Contour<N, Real>& contour) {
  std::set<std::vector<Index>> faces;
  std::int64_t euler = 0;
  for (const auto& simplex : contour.simplices) {
    if (std::set<Index>(simplex.begin(), simplex.end()).size() < N) continue;
    euler += N % 2 == 1 ? 1 : -1;
    for (unsigned set = 1; set + 1 < (1u << N); ++set) {
      std::vector<Index> face;
      for (int j = 0; j < N; ++j)
        if ((set >> j & 1u) != 0) face.push_back(simplex[j]);
      std::sort(face.begin(), face.end());
      faces.insert(face);
    }
  }
  for (const auto& face : faces) euler += face.size() % 2 == 1 ? 1 : -1;
  return euler;
}

/// By (N-2)-face: the number of its simplices, and the sum of the orientations that they induce.
template <int N, class Real>
std::map<std::array<Index, N - 1>, std::pair<int, int>> incidences(const Contour<N, Real>& contour) {
  std::map<std::array<Index, N - 1>, std::pair<int, int>> result;
  for (const auto& simplex : contour.simplices)
    for (int omitted = 0; omitted < N; ++omitted) {
      std::array<Index, N - 1> face;
      for (int j = 0, k = 0; j < N; ++j)
        if (j != omitted) face[k++] = simplex[j];
      int sign = omitted % 2 == 0 ? 1 : -1;
      for (int i = 0; i + 1 < N; ++i)
        for (int j = i + 1; j + 1 < N; ++j)
          if (face[i] > face[j]) sign = -sign;
      std::sort(face.begin(), face.end());
      auto& [count, balance] = result[face];
      ++count;
      balance += sign;
    }
  return result;
}

/// By vertex: the nearest of those before it that stay, if it is within the tolerance.
template <int N, class Real>
std::vector<Index> kept_by_definition(const Contour<N, Real>& contour, double tolerance) {
  std::vector<Index> kept, stay;
  if (N >= 4 && tolerance == 0.0)  // the steps off the layers of the last axis, in 5D of the last two
    for (const auto& vertex : contour.vertices)
      for (int a = N == 5 ? 3 : N - 1; a < N; ++a)
        tolerance =
            std::max(tolerance, 4.0 * double{std::numeric_limits<Real>::epsilon()} * std::abs(double{vertex[a]}));
  for (Index v = 0; v < contour.vertices.size(); ++v) {
    Index best = v;
    double least = tolerance * tolerance;
    for (const Index w : stay) {
      double square = 0;
      for (int a = 0; a < N; ++a) {
        const double d = double{contour.vertices[v][a]} - double{contour.vertices[w][a]};
        square += d * d;
      }
      if (square < least || (square == least && best == v)) {
        best = w;
        least = square;
      }
    }
    kept.push_back(best);
    if (best == v) stay.push_back(v);
  }
  return kept;
}

/// Compares the result of a closed manifold with the definitions; returns it.
template <int N, class Real>
Merging<N, Real> expect_merged(Contour<N, Real> contour, double tolerance) {
  Attribute numbers{"number", "", 1, Buffer<double>(contour.simplices.size())};
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) numbers.values[s] = static_cast<double>(s);
  contour.simplex_attributes = {numbers};
  const Merging<N, Real> merging = merge_vertices(contour, {.tolerance = tolerance, .most_listed = SIZE_MAX});
  const MergeReport<N>& report = merging.report;
  // vertices and dropped simplices
  const std::vector<Index> kept = kept_by_definition(contour, tolerance);
  std::uint64_t merged = 0, collapsed = 0;
  for (Index v = 0; v < kept.size(); ++v) merged += kept[v] != v ? 1 : 0;
  for (const auto& simplex : contour.simplices) {
    std::set<Index> left;
    for (const Index v : simplex) left.insert(kept[v]);
    collapsed += left.size() < N ? 1 : 0;
  }
  EXPECT_EQ(report.counts.merged_vertices, merged);
  EXPECT_EQ(report.counts.collapsed_simplices, collapsed);
  EXPECT_EQ(report.counts.before.vertices, contour.vertices.size());
  EXPECT_EQ(report.counts.before.simplices, contour.simplices.size());
  EXPECT_EQ(report.counts.after.vertices, merging.contour.vertices.size());
  EXPECT_EQ(report.counts.after.simplices, merging.contour.simplices.size());
  if (report.counts.flat_simplices == 0) {
    EXPECT_EQ(report.counts.after.simplices, report.counts.before.simplices - collapsed);
    for (std::size_t s = 0; s < merging.contour.simplices.size(); ++s) {
      const auto origin = static_cast<std::size_t>(merging.contour.simplex_attributes[0].values[s]);
      for (int j = 0; j < N; ++j)
        EXPECT_EQ(merging.contour.vertices[merging.contour.simplices[s][j]],
                  contour.vertices[kept[contour.simplices[origin][j]]]);
    }
  }
  // invariants
  EXPECT_EQ(report.counts.euler_before, euler_by_definition(contour));
  EXPECT_EQ(report.counts.euler_after, euler_by_definition(merging.contour));
  const MeshReport checked = check(merging.contour);
  EXPECT_EQ(report.counts.components_before, check(contour).components);
  EXPECT_EQ(report.counts.components_after, checked.components);
  EXPECT_EQ(report.shrunk.size(), report.counts.shrunk_places);
  // the topology changes only in the places of the report
  if (report.counts.shrunk_places + report.counts.vanished_components + report.counts.pinched_vertices == 0) {
    EXPECT_EQ(report.counts.euler_after, report.counts.euler_before);
    EXPECT_EQ(report.counts.components_after, report.counts.components_before);
  }
  EXPECT_EQ(report.counts.pinched_vertices, checked.bad_links);
  EXPECT_EQ(report.vertices.size(), checked.bad_links);
  EXPECT_EQ(report.counts.pinched_faces, checked.nonmanifold_simplices);
  EXPECT_EQ(checked.unused_vertices, 0u);
  EXPECT_EQ(checked.degenerate_simplices, report.counts.kept_flat_simplices);
  std::vector<std::array<Index, N - 1>> pinched;
  for (const auto& [face, counts] : incidences(merging.contour)) {
    EXPECT_EQ(counts.first % 2, 0) << "an odd number of simplices";
    EXPECT_EQ(counts.second, 0) << "orientations that do not cancel";
    if (counts.first > 2) pinched.push_back(face);
  }
  EXPECT_EQ(pinched, report.faces);
  // nothing with a size is lost
  if (tolerance == 0.0) {
    EXPECT_EQ(report.counts.turned_simplices, 0u);
    EXPECT_NEAR(tegl::measure(merging.contour).size, tegl::measure(contour).size, 1e-6 * tegl::measure(contour).size);
    EXPECT_NEAR(tegl::measure(merging.contour).content.value_or(0), tegl::measure(contour).content.value_or(0),
                1e-6 * tegl::measure(contour).size);
  }
  return merging;
}

template <int N>
OwnedImage<float, N> touching_balls() {
  std::array<std::size_t, N> sizes;
  sizes.fill(8);
  sizes[0] = 13;
  OwnedImage<float, N> image{Grid<N>::unit(sizes), std::vector<float>(sample_count(Grid<N>::unit(sizes)))};
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    double value = -1e9;
    for (const double side : {-1.0, 1.0}) {  // no sample equals the isovalue except the one where the balls touch
      double square = std::pow(static_cast<double>(index[0]) - 6.0 - side * 2.3125, 2);
      for (int a = 1; a < N; ++a) square += std::pow(static_cast<double>(index[a]) - 3.0, 2);
      value = std::max(value, 2.3125 - std::sqrt(square));
    }
    image.values[i] = static_cast<float>(value);
  });
  return image;
}

template <int N>
void expect_pinch_of_balls() {
  const auto image = touching_balls<N>();
  const auto contour = extract<double>(image.view(), 0.0);
  const auto [merged, report] = expect_merged(contour, 0.0);
  EXPECT_EQ(report.counts.pinched_vertices, 1u);
  EXPECT_EQ(report.counts.pinched_faces, N == 2 ? 1u : 0u);  // in 2D the vertex is the face
  // a sphere becomes two spheres with a common point
  EXPECT_EQ(report.counts.euler_before, N % 2 == 1 ? 2 : 0);
  EXPECT_EQ(report.counts.euler_after, N % 2 == 1 ? 3 : -1);
  std::array<double, N> touch;
  touch.fill(3.0);
  touch[0] = 6.0;
  for (int a = 0; a < N; ++a) EXPECT_NEAR(merged.vertices[report.vertices.at(0)][a], touch[a], 1e-9);
}

TEST(Merge, BallsThatTouchInASampleArePinchedThere) {
  expect_pinch_of_balls<2>();
  expect_pinch_of_balls<3>();
  expect_pinch_of_balls<4>();
}

/// Two boxes above the isovalue, joined by a row of samples that equal it.
template <int N>
OwnedImage<float, N> boxes_with_bridge(std::size_t bridge) {
  std::array<std::size_t, N> sizes;
  sizes.fill(5);
  sizes[0] = 8 + bridge;
  OwnedImage<float, N> image{Grid<N>::unit(sizes), std::vector<float>(sample_count(Grid<N>::unit(sizes)))};
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    const bool inside = std::all_of(index.begin(), index.end(), [&](const std::size_t& x) {
      return x >= 1 && x + 2 <= sizes[static_cast<std::size_t>(&x - index.data())];
    });
    const bool within = index[0] >= 4 && index[0] < 4 + bridge;
    const bool on_axis = std::all_of(index.begin() + 1, index.end(), [](std::size_t x) { return x == 2; });
    image.values[i] = !inside ? 0.0F : !within ? 2.0F : on_axis ? 1.0F : 0.0F;
  });
  return image;
}

template <int N>
void expect_cut_bridge() {
  // The tube around a bridge of two samples shrinks to a segment: the contour is cut without a pinch.
  const auto image = boxes_with_bridge<N>(2);
  const auto [merged, report] = expect_merged(extract<double>(image.view(), 1.0), 0.0);
  EXPECT_EQ(report.counts.components_before, 1u);
  EXPECT_EQ(report.counts.components_after, 2u);
  EXPECT_EQ(report.counts.pinched_vertices, 0u);
  std::array<double, N> first;
  first.fill(2.0);
  auto second = first;
  first[0] = 4.0, second[0] = 5.0;
  auto places = report.shrunk;
  std::sort(places.begin(), places.end());
  ASSERT_EQ(places.size(), 2u);
  for (int a = 0; a < N; ++a) {
    EXPECT_NEAR(places[0][a], first[a], 1e-9);
    EXPECT_NEAR(places[1][a], second[a], 1e-9);
  }
}

TEST(Merge, PlacesOfTubesThatShrinkAreListed) {
  expect_cut_bridge<3>();
  expect_cut_bridge<4>();
  expect_cut_bridge<5>();
}

/// -|z - 3| at the isovalue 0: two sheets in the layer 3.
template <int N>
void expect_double_sheet() {
  std::array<std::size_t, N> sizes;
  sizes.fill(6);
  OwnedImage<std::int16_t, N> image{Grid<N>::unit(sizes), std::vector<std::int16_t>(1)};
  image.values.resize(sample_count(image.grid));
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    image.values[i] = static_cast<std::int16_t>(-std::abs(static_cast<int>(index[0]) - 3));
  });
  const auto contour = extract<float>(image.view(), 0.0, {.close = true});
  const auto [merged, report] = expect_merged(contour, 0.0);
  std::uint64_t samples = 1;
  for (int a = 1; a < N; ++a) samples *= 6;
  EXPECT_EQ(report.counts.after.vertices, samples);
  EXPECT_EQ(report.counts.vanished_components, 0u);
  const double size = std::pow(5.0, N - 1);
  EXPECT_NEAR(tegl::measure(merged).size, 2 * size, 1e-4 * size);
}

TEST(Merge, SheetsAtTheSamePlaceStay) {
  expect_double_sheet<2>();
  expect_double_sheet<3>();
  expect_double_sheet<4>();
}

TEST(Merge, AllPlacesOfVanishedPartsAreListed) {
  OwnedImage<std::uint8_t, 3> image{Grid<3>::unit({5, 5, 5}), std::vector<std::uint8_t>(125, 0)};
  image.values[2 + 5 * (2 + 5 * 2)] = 7;
  const auto [merged, report] = expect_merged(extract<float>(image.view(), 7.0), 0.0);
  EXPECT_TRUE(merged.vertices.empty());
  EXPECT_EQ(report.counts.vanished_components, 1u);
  EXPECT_EQ(report.vanished.at(0), (std::array{2.0, 2.0, 2.0}));
  EXPECT_EQ(report.counts.euler_before, 2);
  EXPECT_EQ(report.counts.euler_after, 0);
}

template <Value T, int N>
OwnedImage<T, N> few_integers(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::array<std::size_t, N> sizes;
  sizes.fill(size);
  OwnedImage<T, N> image{Grid<N>::unit(sizes), std::vector<T>(1)};
  image.values.resize(sample_count(image.grid));
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    bool border = false;
    for (const std::size_t x : index) border = border || x == 0 || x + 1 == size;
    image.values[i] = static_cast<T>(border ? 0 : random() % 5);
  });
  return image;
}

template <int N>
std::uint64_t expect_integers(std::size_t size, unsigned seed) {
  SCOPED_TRACE(::testing::Message() << N << "D, seed " << seed);
  const auto image = few_integers<std::uint8_t, N>(size, seed);
  std::uint64_t pinches = 0;
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::saddle}) {
      const auto contour = extract<double>(image.view(), 2.0, {.triangulation = triangulation, .ambiguity = ambiguity});
      pinches += expect_merged(contour, 0.0).report.counts.pinched_vertices;
    }
  return pinches;
}

TEST(Merge, ImagesOfFewIntegersStayClosed) {
  std::uint64_t pinches = 0;
  for (unsigned seed = 0; seed < 10; ++seed) pinches += expect_integers<2>(12, seed);
  for (unsigned seed = 0; seed < 4; ++seed) pinches += expect_integers<3>(7, seed);
  pinches += expect_integers<4>(5, 1);
  EXPECT_GT(pinches, 0u);
}

TEST(Merge, FiveDimensionsToo) {
  const auto image = few_integers<std::uint8_t, 5>(4, 3);
  expect_merged(extract<double>(image.view(), 2.0), 0.0);
}

TEST(Merge, AToleranceMergesByTheDefinition) {
  const auto plane = few_integers<float, 2>(20, 6);
  expect_merged(extract<float>(plane.view(), 1.9), 0.3);
  const auto space = few_integers<float, 3>(7, 5);
  expect_merged(extract<float>(space.view(), 1.9), 0.15);
  const auto four = few_integers<float, 4>(4, 7);
  expect_merged(extract<double>(four.view(), 1.9), 0.12);
}

/// The tolerance of 4D contours may be as small as the rounding of another coordinate.
TEST(Merge, EqualVerticesAreMergedWhateverTheSizesOfTheirCoordinates) {
  for (const double last : {7.0, 9.0, 10.0, 11.0, 12.0, 1e-3})
    for (double x = 64.5; x < 360.0; x += 1.0) {
      Contour<4, double> contour;
      contour.vertices = {{x, 3, 2, 1}, {x, 3, 2, last},  {x, 3, 3, 1},     {x, 4, 2, 1},
                          {x, 3, 2, 1}, {x - 1, 3, 2, 1}, {x + 1, 3, 1, 1}, {x, 2, 2, 1}};
      contour.simplices = {{0, 1, 2, 3}, {4, 5, 6, 7}};
      EXPECT_EQ(merge_vertices(contour).report.counts.merged_vertices, 1u) << x << " " << last;
    }
}

TEST(Merge, DoesNotDependOnThreads) {
  const auto image = few_integers<std::uint8_t, 3>(24, 9);
  const auto contour = extract<float>(image.view(), 2.0, {.normals = Normals::differences});
  const auto one = merge_vertices(contour, {.work = {.threads = 1}}),
             three = merge_vertices(contour, {.work = {.threads = 3}});
  EXPECT_EQ(one.contour.vertices, three.contour.vertices);
  EXPECT_EQ(one.contour.simplices, three.contour.simplices);
  EXPECT_EQ(one.contour.normals, three.contour.normals);
  EXPECT_EQ(one.report.vertices, three.report.vertices);
  EXPECT_EQ(one.report.faces, three.report.faces);
  EXPECT_EQ(merge_vertices(contour, {.most_listed = 2}).report.vertices.size(), 2u);
}

TEST(Merge, RefusesBadInput) {
  const auto image = touching_balls<2>();
  const auto contour = extract<float>(image.view(), 0.0);
  for (const double tolerance : {-1.0, std::nan(""), HUGE_VAL})
    expect_error(ErrorCode::InvalidArgument, "tolerance",
                 [&] { (void)merge_vertices(contour, {.tolerance = tolerance}); });
  auto wrapped = contour;
  wrapped.periods.resize(1);
  expect_error(ErrorCode::UnsupportedData, "wrapped", [&] { (void)merge_vertices(wrapped); });
  auto broken = contour;
  broken.simplices[0][0] = 1u << 30;
  expect_error(ErrorCode::InvalidArgument, "vertex number", [&] { (void)merge_vertices(broken); });
  expect_error(ErrorCode::Cancelled, "cancelled",
               [&] { (void)merge_vertices(contour, {.work = {.progress = [](double) { return false; }}}); });
}

}  // namespace
}  // namespace tegl::test
