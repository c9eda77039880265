// SPDX-License-Identifier: BSD-3-Clause
//
// Lattices with periodic axes and with caps: closed oriented manifolds, the tori of the cells, the contour of the cells
// with the seam identified, contents, numbers at samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "complex/lattice_image.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_grid.hpp"
#include "lattice/lattice_in_time.hpp"
#include "lattice/periodic_lattice.hpp"
#include "periodic/periodic_layers.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/lattice.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

/// A grid from 0 whose periods are 1 along all axes.
template <int N>
Grid<N> grid_of_torus(const std::array<std::size_t, N>& sizes) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(sizes[a], 0.0, 1.0 / static_cast<double>(sizes[a]));
  return grid;
}

/// Periods of 1 along the axes with bits in `axes`.
template <int N>
AxisPeriods<N> periods_along(unsigned axes) {
  AxisPeriods<N> periods{};
  for (int a = 0; a < N; ++a) periods[a] = (axes >> a & 1u) != 0 ? 1.0 : 0.0;
  return periods;
}

/// Calls test(lattice, image of noise) for all lattices, with few samples along each axis.
template <class Test>
void for_each_noise(const Test& test) {
  const auto run = [&]<int N>(Lattice lattice, const std::array<std::size_t, N>& sizes) {
    SCOPED_TRACE(std::string(name_of(lattice)));
    test(lattice, sampled_on_lattice<N>(lattice, grid_of_torus<N>(sizes), noise_everywhere<N>(5)));
  };
  run.template operator()<2>(Lattice::triangular, {3, 6});
  run.template operator()<2>(Lattice::triangular, {70, 8});
  run.template operator()<3>(Lattice::fcc, {3, 4, 6});
  run.template operator()<3>(Lattice::fcc, {6, 5, 8});
  run.template operator()<3>(Lattice::bcc, {3, 4, 6});
  run.template operator()<3>(Lattice::bcc, {6, 5, 8});
  run.template operator()<4>(Lattice::d4, {3, 4, 3, 6});
  run.template operator()<4>(Lattice::fcc_in_time, {3, 4, 6, 3});
}

TEST(LatticeSeam, ContoursAreClosedManifoldsAlongPeriodicAxes) {
  for_each_noise([]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    for (ExtractOptions options : fixed_rules())
      for (unsigned axes = 1; axes < 1u << N; ++axes)
        for (const bool close : {false, true}) {
          if (N == 4 && axes != 5u && axes != 8u && axes != 15u) continue;
          options.close = close;
          const auto periods = periods_along<N>(axes);
          const auto contour = extract_lattice<double>(image.view(), lattice, 0.5, options, periods);
          const MeshReport report = expect_oriented_manifold(contour);
          EXPECT_GT(report.simplices, 0u);
          EXPECT_EQ(contour.periods.size(), static_cast<std::size_t>(std::popcount(axes)));
          EXPECT_EQ(report.boundary_simplices == 0, close || axes == (1u << N) - 1) << axes;
          for (const auto& vertex : contour.vertices)
            for (int a = 0; a < N; ++a)
              EXPECT_TRUE((axes >> a & 1u) == 0 || (vertex[a] > -1e-12 && vertex[a] < 1.0)) << vertex[a];
          const auto [unrolled, originals] = unroll(contour);
          expect_oriented_manifold(unrolled);
          EXPECT_NEAR(measure(unrolled).size, measure(contour).size, 1e-9);
          ASSERT_EQ(originals.size(), unrolled.vertices.size());
          for (std::size_t s = 0; s < contour.simplices.size(); ++s)
            for (int j = 0; j < N; ++j) {
              const Index v = unrolled.simplices[s][j];
              EXPECT_EQ(originals[v], contour.simplices[s][j]);
              for (int a = 0; a < N; ++a) {  // no simplex is longer than a cell
                const double length =
                    std::abs(unrolled.vertices[unrolled.simplices[s][0]][a] - unrolled.vertices[v][a]);
                EXPECT_LT(length, 2.01 / static_cast<double>(image.grid.axes[a].size()));
              }
            }
        }
  });
}

/// The numbers of faces of each dimension, by their corners.
template <int N>
std::vector<std::set<std::vector<Index>>> faces_of(const Complex<N>& complex) {
  std::vector<std::set<std::vector<Index>>> faces(N + 1);
  for (const detail::CellGroup& group : detail::ComplexAccess::cells(complex).groups) {
    // the cells of these lattices are simplices and cross-polytopes
    const bool is_simplex = group.corner_count == N + 1;
    for (std::size_t c = 0; c < group.size(); ++c) {
      const std::vector<Index> corners(group.cell(c), group.cell(c) + group.corner_count);
      faces[N].insert([sorted = corners]() mutable {
        std::sort(sorted.begin(), sorted.end());
        return sorted;
      }());
      for (unsigned set = 1; set < 1u << corners.size(); ++set) {
        const int count = std::popcount(set);
        if (count > N) continue;
        // corners 2 i and 2 i + 1 of a cross-polytope are opposite ones
        bool is_face = true;
        for (unsigned i = 0; !is_simplex && i < corners.size(); i += 2) is_face = is_face && (set >> i & 3u) != 3u;
        if (!is_face) continue;
        std::vector<Index> face;
        for (unsigned i = 0; i < corners.size(); ++i)
          if ((set >> i & 1u) != 0) face.push_back(corners[i]);
        std::sort(face.begin(), face.end());
        faces[static_cast<std::size_t>(count - 1)].insert(face);
      }
    }
  }
  return faces;
}

TEST(LatticeSeam, CellsWithAllAxesPeriodicAreATorus) {
  for_each_noise([]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    const auto complex = detail::periodic_lattice_complex(image.view(), lattice, periods_along<N>((1u << N) - 1));
    if (lattice == Lattice::fcc_in_time) {  // prisms over an octahedron and two tetrahedra for each sample
      EXPECT_EQ(complex.cell_count(), 3 * image.values.size());
      return;
    }
    const auto faces = faces_of<N>(complex);
    EXPECT_EQ(faces[0].size(), image.values.size());
    EXPECT_EQ(faces[N].size(), complex.cell_count());
    std::ptrdiff_t euler = 0;
    for (int k = 0; k <= N; ++k) euler += (k % 2 == 0 ? 1 : -1) * static_cast<std::ptrdiff_t>(faces[k].size());
    EXPECT_EQ(euler, 0);
    // cells for each sample: 2 triangles; 1 octahedron and 2 tetrahedra; 6 tetrahedra; 3 sixteen-cells
    const std::size_t each = lattice == Lattice::triangular ? 2 : lattice == Lattice::bcc ? 6 : 3;
    EXPECT_EQ(complex.cell_count(), each * image.values.size());
  });
}

/// The contour of all cells between the samples and their copies across the ends, with equal points merged.
template <int N>
std::pair<ContourSize, double> merged_across_ends(Lattice lattice, const OwnedImage<double, N>& image,
                                                  const AxisPeriods<N>& periods, const ExtractOptions& options) {
  Grid<N> longer;
  std::array<std::size_t, 4> margin{};
  for (int a = 0; a < N; ++a) {
    margin[a] = 2;
    longer.axes[a] = detail::wrapped_axis(image.grid.axes[a], periods[a], 2, 2);
  }
  const bool is_in_time = lattice == Lattice::fcc_in_time;
  if (is_in_time) {
    margin[N - 1] = 0;
    longer.axes[N - 1] = detail::wrapped_axis(image.grid.axes[N - 1], periods[N - 1], 0, 1);
  }
  std::vector<double> values;
  const auto sizes = image.grid.sizes();
  detail::for_each_sample<N>(longer.sizes(), [&](std::array<std::size_t, N> index) {
    for (int a = 0; a < N; ++a) index[a] = (index[a] + sizes[a] - margin[static_cast<std::size_t>(a)]) % sizes[a];
    values.push_back(image.view()(index));
  });
  Complex<N> complex({}, std::span<const CellType>(), {});
  if constexpr (N == 4)
    if (is_in_time) complex = detail::fcc_over_times(detail::fcc_at_a_time(longer, margin), longer, values);
  if (!is_in_time) {
    const auto cells = detail::cells_of_lattice(lattice, detail::four_sizes(longer), margin);
    complex = Complex<N>(detail::points_of(longer, N - 1), cells.types, cells.corners);
    complex.set_values(values);
  }
  const auto contour = extract<double>(complex, 0.5, options);
  std::set<std::array<std::int64_t, N>> places;
  for (const auto& vertex : contour.vertices) {
    std::array<std::int64_t, N> place;
    for (int a = 0; a < N; ++a) place[a] = std::llround((vertex[a] - std::floor(vertex[a] + 1e-9)) * 1e8) % 100000000;
    places.insert(place);
  }
  return {{places.size(), contour.simplices.size()}, measure(contour).size};
}

TEST(LatticeSeam, TheContourIsThatOfTheLongerImageWithTheSeamIdentified) {
  for_each_noise([]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    const auto periods = periods_along<N>((1u << N) - 1);
    for (const ExtractOptions& options : fixed_rules()) {
      const auto contour = extract_lattice<double>(image.view(), lattice, 0.5, options, periods);
      const auto [size, content] = merged_across_ends<N>(lattice, image, periods, options);
      // compact 4D: diagonals depend on the numbers of samples, and in prisms so do vertices inside
      if (lattice == Lattice::fcc_in_time && options.triangulation == Triangulation::compact) continue;
      EXPECT_EQ(contour.vertices.size(), size.vertices);
      if (N == 4 && options.triangulation == Triangulation::compact) continue;
      EXPECT_EQ(contour.simplices.size(), size.simplices);
      EXPECT_NEAR(measure(contour).size, content, 1e-9 * content);
    }
  });
}

TEST(LatticeSeam, SamplesMovedAroundThePeriodsGiveTheSameContour) {
  for_each_noise([]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    const auto sizes = image.grid.sizes();
    OwnedImage<double, N> moved = image;
    std::size_t i = 0;
    detail::for_each_sample<N>(sizes, [&](std::array<std::size_t, N> index) {
      for (int a = 0; a < N; ++a) index[a] = (index[a] + (a == detail::layer_axis(lattice) ? 2 : 1)) % sizes[a];
      moved.values[i++] = image.view()(index);
    });
    const auto periods = periods_along<N>((1u << N) - 1);
    ExtractOptions options;
    options.triangulation = Triangulation::barycentric;  // compact 4D: diagonals depend on the numbers of samples
    options.normals = Normals::differences;
    const auto a = extract_lattice<double>(image.view(), lattice, 0.5, options, periods);
    const auto b = extract_lattice<double>(moved.view(), lattice, 0.5, options, periods);
    EXPECT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_EQ(check(a).euler, check(b).euler);
    EXPECT_NEAR(measure(a).size, measure(b).size, 1e-9);
    // normals, too
    std::array<double, N> sum_a{}, sum_b{};
    for (const auto& normal : a.normals)
      for (int k = 0; k < N; ++k) sum_a[k] += std::abs(normal[k]);
    for (const auto& normal : b.normals)
      for (int k = 0; k < N; ++k) sum_b[k] += std::abs(normal[k]);
    for (int k = 0; k < N; ++k) EXPECT_NEAR(sum_a[k], sum_b[k], 1e-6 * sum_a[k]);
    ExtractOptions many = options;
    many.work.threads = 3;
    EXPECT_EQ(extract_lattice<double>(image.view(), lattice, 0.5, many, periods).vertices, a.vertices);
  });
}

TEST(LatticeSeam, TheGyroidsCellHasEulerCharacteristicMinusEight) {
  const auto gyroid = [](const std::array<double, 3>& x, const auto&, const auto&) {
    const auto s = [&](int a) { return std::sin(2 * std::numbers::pi * x[a]); };
    const auto c = [&](int a) { return std::cos(2 * std::numbers::pi * x[a]); };
    return s(0) * c(1) + s(1) * c(2) + s(2) * c(0);
  };
  const auto expect_gyroid = [&](Lattice lattice, const std::array<std::size_t, 3>& sizes) {
    const auto image = sampled_on_lattice<3>(lattice, grid_of_torus<3>(sizes), gyroid);
    const auto contour = extract_lattice<double>(image.view(), lattice, 0.01, {}, periods_along<3>(7u));
    EXPECT_EQ(expect_closed_manifold(contour).euler, -8);
    EXPECT_EQ(check(contour).components, 1u);
    EXPECT_NEAR(measure(contour).size, 3.0915, 0.05);  // of the minimal surface in a cube of side 1
  };
  expect_gyroid(Lattice::fcc, {17, 16, 24});
  expect_gyroid(Lattice::bcc, {13, 12, 26});
}

TEST(LatticeSeam, ABallAcrossTheSeamHasTheContentOfABall) {
  const auto expect_ball = [](Lattice lattice, const auto& sizes, double content) {
    constexpr int N = std::tuple_size_v<std::remove_cvref_t<decltype(sizes)>>;
    const auto image =
        sampled_on_lattice<N>(lattice, grid_of_torus<N>(sizes), [](const auto& x, const auto&, const auto&) {
          double square = 0;
          for (const double each : x) square += std::pow(each - std::round(each), 2);
          return 0.3 - std::sqrt(square);
        });
    ExtractOptions options;
    options.normals = Normals::differences;
    const auto contour = extract_lattice<double>(image.view(), lattice, 0.0, options, periods_along<N>((1u << N) - 1));
    (void)expect_closed_manifold(contour);
    EXPECT_NEAR(measure(contour).content.value(), content, 0.06 * content);
    for (std::size_t v = 0; v < contour.vertices.size(); ++v)
      for (int a = 0; a < N; ++a) {
        const double x = contour.vertices[v][a];
        EXPECT_NEAR(contour.normals[v][a], (x - std::round(x)) / 0.3, 0.2);
      }
  };
  constexpr double kPi = std::numbers::pi;
  expect_ball(Lattice::triangular, std::array<std::size_t, 2>{20, 24}, kPi * 0.09);
  expect_ball(Lattice::fcc, std::array<std::size_t, 3>{15, 16, 20}, 4.0 / 3.0 * kPi * 0.027);
  expect_ball(Lattice::bcc, std::array<std::size_t, 3>{15, 14, 28}, 4.0 / 3.0 * kPi * 0.027);
  expect_ball(Lattice::d4, std::array<std::size_t, 4>{11, 12, 11, 22}, 0.5 * kPi * kPi * 0.0081);
  expect_ball(Lattice::fcc_in_time, std::array<std::size_t, 4>{12, 13, 16, 13}, 0.5 * kPi * kPi * 0.0081);
}

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

using Place4 = std::array<std::int64_t, 4>;

/// The places of vertices modulo periods of 1, moved by `by`, as whole numbers.
std::vector<Place4> places_moved(const Buffer<std::array<double, 4>>& vertices, const std::array<double, 4>& by) {
  constexpr std::int64_t kParts = 1'000'000;
  std::vector<Place4> places;
  for (const auto& vertex : vertices) {
    Place4& place = places.emplace_back();
    for (int a = 0; a < 4; ++a) place[a] = (std::llround((vertex[a] + by[a]) * kParts) % kParts + kParts) % kParts;
  }
  return places;
}

/// The contour's polyhedra in the cells, by the places of their points.
std::set<std::set<Place4>> polyhedra_of(const FacetHierarchy<4, double>& facets, const std::array<double, 4>& by) {
  const std::vector<Place4> places = places_moved(facets.vertices, by);
  std::set<std::set<Place4>> polyhedra;
  for (std::size_t f = 0; f < facets.count(3); ++f) {
    std::set<Place4> points;
    for (const Index p : facets.points_of(3, f)) points.insert(places[p]);
    EXPECT_TRUE(polyhedra.insert(points).second);
  }
  return polyhedra;
}

/// Simplices whose points on edges are not all in one polyhedron.
std::size_t count_beyond_polyhedra(const Contour<4, double>& contour, const std::vector<Place4>& places,
                                   const std::set<std::set<Place4>>& polyhedra) {
  std::map<Place4, std::vector<const std::set<Place4>*>> at;
  for (const std::set<Place4>& polyhedron : polyhedra)
    for (const Place4& point : polyhedron) at[point].push_back(&polyhedron);
  return static_cast<std::size_t>(
      std::count_if(contour.simplices.begin(), contour.simplices.end(), [&](const auto& simplex) {
        std::set<Place4> points;
        for (const Index v : simplex)
          if (at.contains(places[v])) points.insert(places[v]);  // others are inside of a cell
        if (points.empty()) return false;
        const auto& beside = at.at(*points.begin());
        return std::none_of(beside.begin(), beside.end(), [&](const std::set<Place4>* each) {
          return std::includes(each->begin(), each->end(), points.begin(), points.end());
        });
      }));
}

TEST(LatticeSeam, CompactContoursOfMovedSamplesOnD4DifferInDiagonalsOnly) {
  constexpr std::array<std::size_t, 4> kSizes = {8, 8, 8, 8}, kMoved = {3, 1, 2, 4};  // layers by an even number
  constexpr double kIsovalue = 0.05;
  const auto image = sampled_on_lattice<4>(Lattice::d4, grid_of_torus<4>(kSizes), [](auto x, const auto&, const auto&) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    double sum = 0.4 * std::cos(kTurn * (x[0] - x[3]));
    for (int a = 0; a < 4; ++a) sum += (0.5 + 0.1 * a) * std::sin(kTurn * x[a] + a);
    return sum;
  });
  OwnedImage<double, 4> moved = image;
  std::array<double, 4> by{};
  for (int a = 0; a < 4; ++a) by[a] = static_cast<double>(kMoved[a]) / 8.0;
  std::size_t i = 0;
  detail::for_each_sample<4>(kSizes, [&](std::array<std::size_t, 4> index) {
    for (int a = 0; a < 4; ++a) index[a] = (index[a] + kMoved[a]) % kSizes[a];
    moved.values[i++] = image.view()(index);
  });
  const auto periods = periods_along<4>(15u);
  const auto polyhedra = polyhedra_of(extract_facets<double>(image.view(), Lattice::d4, kIsovalue, {}, periods), {});
  EXPECT_GT(polyhedra.size(), 1000u);
  EXPECT_EQ(polyhedra, polyhedra_of(extract_facets<double>(moved.view(), Lattice::d4, kIsovalue, {}, periods), by));

  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
    const bool is_compact = triangulation == Triangulation::compact;
    SCOPED_TRACE(is_compact ? "compact" : "barycentric");
    ExtractOptions options;
    options.triangulation = triangulation;
    const auto a = extract_lattice<double>(image.view(), Lattice::d4, kIsovalue, options, periods);
    const auto b = extract_lattice<double>(moved.view(), Lattice::d4, kIsovalue, options, periods);
    auto places_a = places_moved(a.vertices, {}), places_b = places_moved(b.vertices, by);
    EXPECT_EQ(count_beyond_polyhedra(a, places_a, polyhedra), 0u);
    EXPECT_EQ(count_beyond_polyhedra(b, places_b, polyhedra), 0u);
    std::sort(places_a.begin(), places_a.end());
    std::sort(places_b.begin(), places_b.end());
    EXPECT_EQ(places_a, places_b);
    EXPECT_EQ(a.simplices.size() == b.simplices.size(), !is_compact);
    // without diagonals, sizes are the same, those of cuts too
    double farthest = std::abs(measure(a).size / measure(b).size - 1.0);
    EXPECT_EQ(farthest < 1e-12, !is_compact) << farthest;
    for (int axis = 0; axis < 4; ++axis)
      for (const double place : {0.02, 0.13, 0.4, 0.77}) {
        const double size = measure(slice(a, Hyperplane<4>::across(axis, place))).size;
        const double of_moved = measure(slice(b, Hyperplane<4>::across(axis, place - by[axis]))).size;
        farthest = std::max(farthest, std::abs(of_moved / size - 1.0));
      }
    EXPECT_LT(farthest, is_compact ? 0.05 : 1e-9);
    EXPECT_EQ(farthest < 1e-9, !is_compact) << farthest;
  }
}

TEST(LatticeSeam, RulesByTheDataGiveManifolds) {
  for_each_noise([]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    for (const Ambiguity ambiguity : kAllRules)
      for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
        for (const unsigned axes : {0u, (1u << N) - 1}) {
          ExtractOptions options;
          options.ambiguity = ambiguity;
          options.triangulation = triangulation;
          const auto contour = extract_lattice<double>(image.view(), lattice, 0.5, options, periods_along<N>(axes));
          EXPECT_EQ(expect_oriented_manifold(contour).boundary_simplices == 0, axes != 0);
          options.work.threads = 3;
          const auto with_threads =
              extract_lattice<double>(image.view(), lattice, 0.5, options, periods_along<N>(axes));
          EXPECT_EQ(with_threads.simplices, contour.simplices);
          if (lattice != Lattice::triangular && lattice != Lattice::bcc) continue;
          options.ambiguity = Ambiguity::low;  // no cell is ambiguous
          const auto low = extract_lattice<double>(image.view(), lattice, 0.5, options, periods_along<N>(axes));
          EXPECT_EQ(low.vertices, contour.vertices);
          EXPECT_EQ(low.simplices.size(), contour.simplices.size());
          EXPECT_EQ(check(low).euler, check(contour).euler);
        }
  });
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

TEST(LatticeSeam, AtMissingValuesOnTheSeamTheContourIsAManifold) {
  for_each_noise([]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    for (unsigned seed = 1; seed < 8; ++seed) {
      OwnedImage<double, N> with_holes = image;
      std::mt19937 random(seed);
      for (double& value : with_holes.values)
        if (random() % 12 == 0) value = std::numeric_limits<double>::quiet_NaN();
      for (const bool close : {false, true}) {
        ExtractOptions options;
        options.close = close;
        options.normals = Normals::differences;
        const unsigned axes = seed % 2 == 0 ? (1u << N) - 1 : 1u;
        const auto contour = extract_lattice<double>(with_holes.view(), lattice, 0.5, options, periods_along<N>(axes));
        (void)expect_oriented_manifold(contour);
        EXPECT_EQ(contour.normals.size(), contour.vertices.size());
      }
    }
  });
}

template <int N>
void expect_sides_fill_the_cells(Lattice lattice, std::size_t samples, unsigned axes) {
  SCOPED_TRACE(testing::Message() << name_of(lattice) << " " << axes);
  auto image = lattice_image<N>(lattice, samples, noise_everywhere<N>(9));
  AxisPeriods<N> periods{};
  for (int a = 0; a < N; ++a)
    if ((axes >> a & 1u) != 0) periods[a] = image.grid.axes[a].step() * static_cast<double>(image.grid.axes[a].size());
  for (ExtractOptions options : fixed_rules()) {
    options.close = true;
    const auto content_of = [&](const OwnedImage<double, N>& of, double isovalue) {
      const auto contour = extract_lattice<double>(of.view(), lattice, isovalue, options, periods);
      (void)expect_closed_manifold(contour);
      return measure(contour).content.value();
    };
    OwnedImage<double, N> negative = image;
    for (double& value : negative.values) value = -value;
    const double all = content_of(image, -1.0);
    const double high = content_of(image, 0.4);
    options.ambiguity = options.ambiguity == Ambiguity::low ? Ambiguity::high : Ambiguity::low;
    EXPECT_NEAR(high + content_of(negative, -0.4), all, 1e-9 * all);
    EXPECT_GT(high, 0.3 * all);
  }
}

TEST(LatticeSeam, ClosedPartsOfBothSidesFillTheCells) {
  expect_sides_fill_the_cells<2>(Lattice::triangular, 12, 0);
  expect_sides_fill_the_cells<3>(Lattice::fcc, 8, 0);
  expect_sides_fill_the_cells<3>(Lattice::bcc, 8, 0);
  expect_sides_fill_the_cells<4>(Lattice::d4, 5, 0);
  expect_sides_fill_the_cells<4>(Lattice::fcc_in_time, 5, 0);
}

TEST(LatticeSeam, CapsHaveTheContentOfTheCellsAndUnitNormals) {
  // high everywhere: the caps are the border of the cells; an octahedron, two tetrahedra for each inner sample
  const auto image = lattice_image<3>(Lattice::fcc, 9, [](const auto& x, const auto&, const auto&) { return x[0]; });
  ExtractOptions options;
  options.close = true;
  options.normals = Normals::differences;
  const auto all = extract_lattice<double>(image.view(), Lattice::fcc, -9.0, options);
  (void)expect_closed_manifold(all);
  double volume = 0;
  const double w = image.grid.axes[0].step(), octahedron = w * w * w * std::numbers::sqrt2 / 3;
  const auto cells = detail::cells_of_lattice(Lattice::fcc, detail::four_sizes(image.grid));
  for (const CellType type : cells.types)
    volume += octahedron / (type == CellType::octahedron ? 1 : type == CellType::pyramid ? 2 : 4);
  EXPECT_NEAR(measure(all).content.value(), volume, 1e-9 * volume);
  const auto half = extract_lattice<double>(image.view(), Lattice::fcc, 0.01, options);
  for (const auto& normal : half.normals) {
    EXPECT_NEAR(normal[0], -1.0, 1e-9);
    EXPECT_NEAR(std::hypot(normal[1], normal[2]), 0.0, 1e-9);
  }
}

template <int N>
void expect_coordinates_as_numbers(Lattice lattice, std::size_t samples, bool close, double missing) {
  SCOPED_TRACE(std::string(name_of(lattice)));
  auto image = lattice_image<N>(lattice, samples, noise_everywhere<N>(4));
  if (missing > 0) image.values[image.values.size() / 2] = std::numeric_limits<double>::quiet_NaN();
  const int layers = lattice == Lattice::fcc_in_time ? 2 : N - 1;
  std::vector<double> numbers;
  for (const auto& point : detail::points_of(image.grid, layers)) {
    numbers.insert(numbers.end(), point.begin(), point.end());
    numbers.push_back(7.0);
  }
  ExtractOptions options;
  options.close = close;
  options.epsilon = 0.1;
  const auto contour = extract_lattice<double>(image.view(), lattice, 0.5, options);
  const Attribute attribute = interpolate_lattice(image.view(), lattice, 0.5, numbers, "places", "m", options);
  EXPECT_EQ(attribute.width, N + 1);
  EXPECT_EQ(attribute.unit, "m");
  ASSERT_EQ(attribute.values.size(), (N + 1) * contour.vertices.size());
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    for (int a = 0; a < N; ++a) EXPECT_NEAR(attribute.values[(N + 1) * v + a], contour.vertices[v][a], 1e-12);
    EXPECT_NEAR(attribute.values[(N + 1) * v + N], 7.0, 1e-12);
  }
  numbers.pop_back();
  expect_error(ErrorCode::InvalidArgument, "expected one or several for each of the",
               [&] { (void)interpolate_lattice(image.view(), lattice, 0.5, numbers, "places", "", options); });
}

TEST(LatticeSeam, NumbersAtSamplesAreInterpolatedAsCoordinates) {
  for (const bool close : {false, true})
    for (const double missing : {0.0, 1.0}) {
      expect_coordinates_as_numbers<2>(Lattice::triangular, 10, close, missing);
      expect_coordinates_as_numbers<3>(Lattice::fcc, 7, close, missing);
      expect_coordinates_as_numbers<3>(Lattice::bcc, 7, close, missing);
      expect_coordinates_as_numbers<4>(Lattice::d4, 4, close, missing);
      expect_coordinates_as_numbers<4>(Lattice::fcc_in_time, 4, close, missing);
    }
}

TEST(LatticeSeam, NumbersAreInterpolatedAcrossTheSeam) {
  const auto image = sampled_on_lattice<3>(Lattice::fcc, grid_of_torus<3>({6, 5, 8}), noise_everywhere<3>(5));
  const auto periods = periods_along<3>(7u);
  std::vector<double> numbers(image.values.begin(), image.values.end());
  for (double& each : numbers) each = 3 * each + 1;
  const auto attribute = interpolate_lattice(image.view(), Lattice::fcc, 0.5, numbers, "n", "", {}, periods);
  EXPECT_EQ(attribute.values.size(), extract_lattice(image.view(), Lattice::fcc, 0.5, {}, periods).vertices.size());
  for (const double each : attribute.values) EXPECT_NEAR(each, 2.5, 1e-9);
}

TEST(LatticeSeam, BadPeriodsAreRefused) {
  const auto refused = [](Lattice lattice, const auto& sizes, unsigned axes, const std::string& text,
                          double factor = 1.0) {
    constexpr int N = std::tuple_size_v<std::remove_cvref_t<decltype(sizes)>>;
    const auto image = sampled_on_lattice<N>(lattice, grid_of_torus<N>(sizes), noise_everywhere<N>(5));
    auto periods = periods_along<N>(axes);
    for (double& period : periods) period *= factor;
    expect_error(ErrorCode::InvalidArgument, text,
                 [&] { (void)extract_lattice(image.view(), lattice, 0.5, {}, periods); });
  };
  using Sizes = std::array<std::size_t, 3>;
  refused(Lattice::fcc, Sizes{6, 6, 7}, 4u,
          "lattice fcc: axis 2 (z) is periodic and has 7 layers; expected an even number");
  refused(Lattice::bcc, Sizes{6, 6, 4}, 4u,
          "lattice bcc: axis 2 (z) is periodic and has 4 layers; expected an even number");
  refused(Lattice::fcc, Sizes{2, 6, 8}, 1u, "axis 0 (x) is periodic and has 2 samples; expected at least 3");
  refused(Lattice::fcc, Sizes{6, 6, 8}, 2u, "the period of axis 1 (y) is 1.25; expected 1, the number of samples",
          1.25);
  refused(Lattice::fcc_in_time, std::array<std::size_t, 4>{4, 4, 7, 4}, 4u, "axis 2 (z) is periodic and has 7 layers");
  refused(Lattice::fcc_in_time, std::array<std::size_t, 4>{4, 4, 6, 2}, 8u, "axis 3 (t) is periodic and has 2 samples");
}

/// A sphere on layers at these places of a period of 1, from another layer on.
Contour<3, double> sphere_between(Lattice lattice, const std::vector<double>& layers, std::size_t start = 0) {
  std::vector<double> places;
  for (std::size_t k = 0; k < layers.size(); ++k)
    places.push_back(layers[(start + k) % layers.size()] + (start + k < layers.size() ? 0.0 : 1.0));
  Grid<3> grid = grid_of_torus<3>({12, 12, layers.size()});
  grid.axes[2] = Axis::rectilinear(places);
  const auto image = sampled_on_lattice<3>(lattice, grid, [](const std::array<double, 3>& x, const auto&, const auto&) {
    return 0.4 - std::hypot(std::remainder(x[0] - 0.5, 1.0), std::remainder(x[1] - 0.5, 1.0),
                            std::remainder(x[2] - 0.1, 1.0));
  });
  return extract_lattice<double>(image.view(), lattice, 0.0, {}, periods_along<3>(7u));
}

TEST(LatticeSeam, CellsAreShorterThanHalfAPeriod) {
  for (const Lattice lattice : {Lattice::fcc, Lattice::bcc}) {
    // two steps of 0.22 and 0.27, anywhere; at most two layers of a cell are as far apart
    const std::vector<double> layers = {0.0, 0.22, 0.49, 0.6, 0.7, 0.85};
    const auto expected = sphere_between(lattice, layers);
    EXPECT_GT(expected.simplices.size(), 100u);
    for (const std::size_t start : {2u, 4u}) {
      const auto contour = sphere_between(lattice, layers, start);
      EXPECT_NEAR(measure(contour).size, measure(expected).size, 1e-9);
      EXPECT_EQ(check(contour).euler, check(expected).euler);
      EXPECT_EQ(check(contour).components, check(expected).components);
      EXPECT_NEAR(measure(unroll(contour).contour).size, measure(expected).size, 1e-9);
    }
    const auto expect_refused = [&](const std::vector<double>& bad, const std::string& text) {
      const std::string whole = "lattice " + std::string(name_of(lattice)) + ": the period of axis 2 (z)" + text;
      expect_error(ErrorCode::InvalidArgument, whole, [&] { (void)sphere_between(lattice, bad); });
    };
    expect_refused({0.0, 0.25, 0.51, 0.6, 0.7, 0.85}, " is 1, and two steps, from 0 to 0.51, are 0.51; expected two");
    expect_refused({0.0, 0.1, 0.2, 0.3, 0.4, 0.7}, " is 1, and two steps, from 0.4 to 1, are 0.6");
  }
  // a period in another unit, of uneven layers
  Grid<3> grid = grid_of_torus<3>({4, 4, 8});
  grid.axes[2] = Axis::rectilinear({0.0, 0.1, 0.25, 0.4, 0.5, 0.6, 0.7, 0.85});
  const auto image = sampled_on_lattice<3>(Lattice::fcc, grid, noise_everywhere<3>(5));
  expect_error(ErrorCode::InvalidArgument, "lattice fcc: the period of axis 2 (z) is 100, and", [&] {
    (void)extract_lattice(image.view(), Lattice::fcc, 0.5, {}, {1.0, 1.0, 100.0});
  });
}

/// Errors of size and content, and the Euler characteristic, at spacings of which each is half of the one before.
template <int N, class F>
void expect_order_two_by_halves(Lattice lattice, std::size_t samples, const F& f, double size, double content,
                                std::ptrdiff_t euler) {
  SCOPED_TRACE(std::string(name_of(lattice)));
  std::array<double, 2> of_size{}, of_content{};
  for (std::size_t i = 0; i < 2; ++i) {
    // the mean over places of the grid, as errors at one place also have a part of a higher frequency
    for (const double shift : {0.0, 0.21, 0.37, 0.5}) {
      const double step = 2.2 / static_cast<double>(samples - 1) / static_cast<double>(i + 1);
      const auto image = lattice_image<N>(lattice, (samples - 1) * (i + 1) + 1, [&](auto x, const auto&, const auto&) {
        for (int a = 0; a < N; ++a) x[a] += shift * step * (1 + 0.3 * a);
        return f(x);
      });
      const auto contour = extract_lattice<double>(image.view(), lattice, 0.0);
      EXPECT_EQ(expect_closed_manifold(contour).euler, euler);
      of_size[i] += measure(contour).size - size;
      of_content[i] += measure(contour).content.value() - content;
    }
  }
  EXPECT_NEAR(of_size[0] / of_size[1], 4.0, 0.8);
  EXPECT_NEAR(of_content[0] / of_content[1], 4.0, 0.8);
}

TEST(LatticeConvergence, OfSpheresAndToriIsOfOrderTwoOnEveryLattice) {
  constexpr double kPi = std::numbers::pi;
  expect_order_two_by_halves<2>(Lattice::triangular, 16, ball<2>, 2 * kPi * 0.7, kPi * 0.49, 0);
  const auto torus = [](const std::array<double, 3>& x) {
    return 0.25 - std::hypot(std::hypot(x[0], x[1]) - 0.6, x[2]);
  };
  const double area = 4 * kPi * kPi * 0.6 * 0.25, volume = 2 * kPi * kPi * 0.6 * 0.0625;
  for (const Lattice lattice : {Lattice::fcc, Lattice::bcc}) {
    expect_order_two_by_halves<3>(lattice, 14, ball<3>, 4 * kPi * 0.49, 4.0 / 3.0 * kPi * 0.343, 2);
    expect_order_two_by_halves<3>(lattice, 20, torus, area, volume, 0);
  }
  for (const Lattice lattice : {Lattice::d4, Lattice::fcc_in_time})
    expect_order_two_by_halves<4>(lattice, 9, ball<4>, 2 * kPi * kPi * 0.343, 0.5 * kPi * kPi * 0.2401, 0);
}

}  // namespace
}  // namespace tegl::test
