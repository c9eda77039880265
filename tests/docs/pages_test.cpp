// SPDX-License-Identifier: BSD-3-Clause
//
// The C++ snippets of docs/guides.md, docs/facets.md and docs/coming-from.md stand between [name] and [/name]. The code
// around them provides their context and checks their results.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tegl/active_tiles.hpp"
#include "tegl/check.hpp"
#include "tegl/complex.hpp"
#include "tegl/components.hpp"
#include "tegl/curved.hpp"
#include "tegl/elements.hpp"
#include "tegl/extract.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/io.hpp"
#include "tegl/measure.hpp"
#include "tegl/pick.hpp"
#include "tegl/sample.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"
#include "tegl/stream.hpp"
#include "tegl/track.hpp"

namespace {

constexpr std::size_t kSize = 20, kSteps = 9;

/// Positive inside a ball of radius 6 near the middle of kSize^3 samples, which moves along x with time.
double ball(double x, double y, double z, double t = 0.0) {
  const double middle = 9.4;
  return 6.0 - std::hypot(x - middle - 0.25 * t, y - middle, z - middle);
}

/// Its samples at one time, x fastest.
std::vector<float> volume_at(double t) {
  std::vector<float> values;
  for (std::size_t z = 0; z < kSize; ++z)
    for (std::size_t y = 0; y < kSize; ++y)
      for (std::size_t x = 0; x < kSize; ++x)
        values.push_back(
            static_cast<float>(ball(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z), t)));
  return values;
}

std::vector<float> film() {
  std::vector<float> values;
  for (std::size_t t = 0; t < kSteps; ++t)
    for (const float value : volume_at(static_cast<double>(t))) values.push_back(value);
  return values;
}

double ball_volume() { return 4.0 / 3.0 * 3.14159265358979 * 216.0; }

TEST(ComingFromVtk, ImageDataIsAGridAndItsSurfaceFacesLow) {
  const std::vector<float> values = volume_at(0);
  const float* scalars = values.data();
  const double value = 0.0;
  const std::array<std::size_t, 3> dimensions = {kSize, kSize, kSize};
  const std::array<double, 3> origin = {-10, 5, 0}, spacing = {0.5, 2, 1};
  // [vtk]
  // vtkImageData: dimensions, origin and spacing, x fastest
  tegl::Grid<3> grid;
  for (int a = 0; a < 3; ++a) grid.axes[a] = tegl::Axis::uniform(dimensions[a], origin[a], spacing[a]);
  tegl::ExtractOptions options;
  options.normals = tegl::Normals::differences;  // ComputeNormalsOn
  const tegl::Contour<3> surface = tegl::extract(tegl::Image<float, 3>(scalars, grid), value, options);
  // [/vtk]
  // [vtk_filters]
  const double volume = tegl::measure(surface).content.value();  // vtkMassProperties
  const std::vector<tegl::Contour<3>> parts =                    // vtkPolyDataConnectivityFilter
      tegl::split_components(surface, tegl::label_components(surface));
  tegl::SimplifyOptions<3> fewer;
  fewer.ratio = 0.1;  // vtkQuadricDecimation
  const tegl::Contour<3> small = tegl::simplify(surface, fewer).contour;
  tegl::write_mesh(small, "small.ply");  // vtkPLYWriter
  // [/vtk_filters]
  EXPECT_NEAR(volume, ball_volume(), 0.03 * ball_volume());  // the spacings' product is 1
  EXPECT_EQ(parts.size(), 1u);
  EXPECT_LE(small.simplices.size(), surface.simplices.size() / 9);
  ASSERT_EQ(surface.normals.size(), surface.vertices.size());
  const std::array<double, 3> middle = {-10 + 0.5 * 9.4, 5 + 2 * 9.4, 9.4};
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    double outward = 0;
    for (std::size_t a = 0; a < 3; ++a)
      outward += (static_cast<double>(surface.vertices[v][a]) - middle[a]) * static_cast<double>(surface.normals[v][a]);
    EXPECT_GT(outward, 0);  // from high to low, as in VTK
  }
  EXPECT_EQ(tegl::read_mesh("small.ply").simplices.size(), 3 * small.simplices.size());
}

TEST(Cpp, OptionsOfWork) {
  const std::vector<float> values = volume_at(0);
  const tegl::Image<float, 3> image(values.data(), tegl::Grid<3>::unit({kSize, kSize, kSize}));
  const double isovalue = 0;
  // [work]
  const tegl::WorkOptions work = {.threads = 2, .progress = [](double fraction) { return fraction < 2; }};
  const tegl::Contour<3> surface = tegl::extract(image, isovalue, {.close = true, .work = work});
  const tegl::MeshReport report = tegl::check(surface, work);
  const auto [simpler, stats] = tegl::simplify(surface, tegl::SimplifyOptions<3>{.ratio = 0.5, .work = work});
  const std::vector<tegl::Contour<3>> nested = tegl::extract_several(image, {isovalue, isovalue + 1});
  // [/work]
  EXPECT_EQ(report.bad_links, 0u);
  EXPECT_EQ(stats.simplices_before, surface.simplices.size());
  EXPECT_LE(2 * simpler.simplices.size(), surface.simplices.size() + 1);
  ASSERT_EQ(nested.size(), 2u);
  EXPECT_FALSE(nested[1].simplices.empty());
}

TEST(ComingFromNumpy, TheLastAxisOfAnArrayIsTheFirstOfAnImage) {
  const std::size_t planes = 3, rows = 4, columns = 5;
  std::vector<float> values(planes * rows * columns);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  const float* array = values.data();
  // [array]
  // an array of shape (planes, rows, columns), in C order
  const tegl::Image<float, 3> volume(array, tegl::Grid<3>::unit({columns, rows, planes}));
  // [/array]
  EXPECT_EQ(volume({1, 2, 1}), static_cast<float>((1 * rows + 2) * columns + 1));
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(columns), plane = row * static_cast<std::ptrdiff_t>(rows);
  // [strides]
  // the same array with its axes in their own order: no copy, strides count elements
  const tegl::Image<float, 3> as_indexed(array, tegl::Grid<3>::unit({planes, rows, columns}), {plane, row, 1});
  // [/strides]
  EXPECT_EQ(as_indexed({1, 2, 1}), volume({1, 2, 1}));
  EXPECT_EQ(as_indexed({2, 0, 4}), volume({4, 0, 2}));
}

TEST(ComingFromPyMCubes, AFunctionIsSampledFirst) {
  // [function]
  // marching_cubes_func((-2, -2, -2), (2, 2, 2), 64, 64, 64, f, 0)
  tegl::Grid<3> grid;
  for (tegl::Axis& axis : grid.axes) axis = tegl::Axis::uniform(64, -2.0, 4.0 / 63);
  std::vector<double> values;
  for (std::size_t k = 0; k < 64; ++k)
    for (std::size_t j = 0; j < 64; ++j)
      for (std::size_t i = 0; i < 64; ++i)
        values.push_back(1.5 - std::hypot(grid.axes[0][i], grid.axes[1][j], grid.axes[2][k]));
  const auto surface = tegl::extract<double>(tegl::Image<double, 3>(values.data(), grid), 0.0);
  // [/function]
  EXPECT_NEAR(tegl::measure(surface).content.value(), 4.0 / 3.0 * 3.14159265358979 * 3.375, 0.03);
}

TEST(ComingFromCornelius, ElementsOfAllCellsComeAtOnceAndCloseUp) {
  const std::vector<float> values = film();
  const tegl::Grid<4> grid = tegl::Grid<4>::unit({kSize, kSize, kSize, kSteps});
  const double freeze_out = 0.0;
  std::array<double, 4> sum{};
  const auto integrate = [&](const std::array<double, 4>&, const std::array<double, 4>& dsigma) {
    for (std::size_t a = 0; a < 4; ++a) sum[a] += dsigma[a];
  };
  // [cornelius]
  // instead of init(), and of find_surface_4d(), get_centroid_elem() and get_normal_elem() for each cell
  tegl::ExtractOptions options;
  options.ambiguity = tegl::Ambiguity::squares;  // as in Cornelius: the mean in squares, nothing joined in cells
  const auto contour = tegl::extract<double>(tegl::Image<float, 4>(values.data(), grid), freeze_out, options);
  const tegl::Elements<4> elements = tegl::elements_by_cell(contour, grid);
  for (std::size_t e = 0; e < elements.centroids.size(); ++e) integrate(elements.centroids[e], elements.normals[e]);
  // [/cornelius]
  // Open at the first and the last time only, with boundaries of equal size that face back and ahead.
  for (const double component : sum) EXPECT_NEAR(component, 0.0, 1e-9);
}

TEST(Guides, ASeriesOfVolumesIsReadLayerByLayer) {
  const std::vector<float> all = film();
  const auto read_volume = [&](std::size_t k, float* to) {
    const std::vector<float> values = volume_at(static_cast<double>(k));
    std::copy(values.begin(), values.end(), to);
  };
  // [series]
  const tegl::Grid<4> grid = tegl::Grid<4>::unit({20, 20, 20, 9});  // time is the last axis
  tegl::FunctionLayers<float, 4> layers(grid, [&](std::size_t k, float* to) { read_volume(k, to); });
  tegl::ContourFile<4, float> file("film.vtkhdf", grid);
  tegl::extract_streamed(layers, 0.0, file);
  file.commit();
  // [/series]
  const auto whole = tegl::extract(tegl::Image<float, 4>(all.data(), grid), 0.0);
  const auto streamed = tegl::to_contour<4>(tegl::read_mesh("film.vtkhdf"));
  ASSERT_EQ(streamed.simplices.size(), whole.simplices.size());
  EXPECT_TRUE(std::equal(whole.simplices.begin(), whole.simplices.end(), streamed.simplices.begin()));
}

TEST(Guides, TasksTakeAFewLines) {
  const std::vector<float> values = film(), other = values;
  const tegl::Grid<4> grid = tegl::Grid<4>::unit({kSize, kSize, kSize, kSteps});
  const tegl::Image<float, 4> image(values.data(), grid), pressure(other.data(), grid);
  // [cut]
  const auto time = tegl::Hyperplane<4>::across(3, 3.25);
  const tegl::Contour<3> between = tegl::slice_image(image, 0.0, time);  // reads two volumes only
  // [/cut]
  EXPECT_EQ(tegl::check(between).euler, 2);
  // [attribute]
  tegl::Contour<4> contour = tegl::extract(image, 0.0);
  contour.vertex_attributes.push_back(tegl::sample(pressure, contour, "pressure", "Pa"));
  const auto coloured = tegl::slice(contour, tegl::Hyperplane<4>::across(3, 3.25));  // has the attribute too
  // [/attribute]
  ASSERT_EQ(coloured.vertex_attributes.size(), 1u);
  for (const double value : coloured.vertex_attributes[0].values) EXPECT_NEAR(value, 0.0, 0.05);
  // [pick]
  const tegl::Contour<4> nearest = tegl::extract_component(image, 0.0, {9, 9, 2, 4}).contour;
  // [/pick]
  EXPECT_EQ(nearest.simplices.size(), contour.simplices.size());
  double fraction = 0;
  const auto user_gave_up = [] { return false; };
  // [progress]
  tegl::ExtractOptions options;
  options.work.progress = [&](double done) {
    fraction = done;
    return !user_gave_up();  // false ends the extraction with ErrorCode::Cancelled
  };
  // [/progress]
  EXPECT_EQ(tegl::extract(image, 0.0, options).simplices, contour.simplices);
  EXPECT_GT(fraction, 0.0);
}

TEST(Meshes, APolyhedronIsGivenByItsFaces) {
  std::vector<std::array<double, 3>> corners_of_prism;
  for (const double z : {0.0, 1.0})
    for (int k = 0; k < 5; ++k) corners_of_prism.push_back({std::cos(1.2566 * k), std::sin(1.2566 * k), z});
  // [polyhedron]
  tegl::CellLists cells;
  cells.types = {tegl::CellType::polyhedron};
  cells.ends = {0};  // no corners beside those of the faces
  cells.face_corners = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 1, 6, 5, 1, 2, 7, 6, 2, 3, 8, 7, 3, 4, 9, 8, 4, 0, 5, 9};
  cells.face_ends = {5, 10, 14, 18, 22, 26, 30};
  cells.face_lists_ends = {7};
  tegl::Complex<3> prism(corners_of_prism, cells);
  // [/polyhedron]
  prism.set_values(std::vector<double>{0, 0, 0, 0, 0, 1, 1, 1, 1, 1});
  EXPECT_EQ(tegl::extract(prism, 0.5).vertices.size(), 5U);
}

TEST(Meshes, APolytopeIsGivenByItsFacets) {
  std::vector<std::array<double, 4>> corners_of_product;
  const std::vector<std::array<double, 2>> triangle = {{0, 0}, {1, 0}, {0, 1}};
  for (const auto& p : triangle)
    for (const auto& q : triangle) corners_of_product.push_back({p[0], p[1], q[0], q[1]});
  // [polytope]
  // The product of two triangles (0, 1, 2) and (a, b, c) has the corners 0a, 0b, 0c, 1a, 1b, 1c, 2a, 2b, 2c.
  tegl::CellLists cells;
  cells.types = {tegl::CellType::polytope};
  cells.ends = {0};
  for (const bool along_first : {true, false})
    for (tegl::Index side = 0; side < 3; ++side) {  // the prism between two corners of one triangle, over the other one
      const auto corner = [&](tegl::Index end, tegl::Index k) {
        const tegl::Index on_side = (side + end) % 3, around = k % 3;
        return along_first ? 3 * on_side + around : 3 * around + on_side;
      };
      for (const tegl::Index end : {0U, 1U}) {
        for (tegl::Index k = 0; k < 3; ++k) cells.face_corners.push_back(corner(end, k));
        cells.face_ends.push_back(cells.face_corners.size());
      }
      for (tegl::Index k = 0; k < 3; ++k) {
        for (const tegl::Index p : {corner(0, k), corner(0, k + 1), corner(1, k + 1), corner(1, k)})
          cells.face_corners.push_back(p);
        cells.face_ends.push_back(cells.face_corners.size());
      }
      cells.facet_ends.push_back(cells.face_ends.size());
    }
  cells.facet_lists_ends = {6};
  tegl::Complex<4> product(corners_of_product, cells);
  // [/polytope]
  product.set_values(std::vector<double>{1, 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(tegl::extract(product, 0.5).vertices.size(), 4U);
}

TEST(OtherTilings, ACurvedGridHasArraysOfCoordinates) {
  const tegl::Grid<3> grid = tegl::Grid<3>::unit({12, 10, 5});
  std::vector<double> longitudes, latitudes;
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 12; ++i) {
      longitudes.push_back(150.0 + i + 0.1 * j);
      latitudes.push_back(-20.0 + j - 0.2 * i);
    }
  std::vector<float> values;
  for (int k = 0; k < 5; ++k)
    for (std::size_t at = 0; at < longitudes.size(); ++at)
      values.push_back(static_cast<float>(18.0 - std::hypot(longitudes[at] - 156, latitudes[at] + 16)));
  const tegl::Image<float, 3> image(values.data(), grid);
  // [curved]
  // Axes 0 and 1 have coordinates in arrays of both indices, axis 0 fastest. Axis 2 keeps the grid's own coordinates.
  const std::vector<tegl::CurvedAxis> curved = {{0, 0b011, longitudes, "lon", "degrees_east"},
                                                {1, 0b011, latitudes, "lat"}};
  const auto surface = tegl::extract_curved(image, curved, 15.0);
  // [/curved]
  ASSERT_FALSE(surface.vertices.empty());
  EXPECT_EQ(surface.axis_names[0], "lon");
  for (const auto& vertex : surface.vertices) EXPECT_NEAR(std::hypot(vertex[0] - 156, vertex[1] + 16), 3.0, 0.1);
}

TEST(OtherTilings, ACurvedGridAroundTheGlobeIsPeriodic) {
  const tegl::Grid<3> grid = tegl::Grid<3>::unit({36, 10, 5});
  std::vector<double> longitudes, latitudes;
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 36; ++i) {
      longitudes.push_back(10.0 * i + 0.1 * j);
      latitudes.push_back(-20.0 + 4 * j);
    }
  std::vector<float> values;
  for (int k = 0; k < 5; ++k)
    for (const double latitude : latitudes) values.push_back(static_cast<float>(15.0 - latitude + 0.1 * k));
  const tegl::Image<float, 3> image(values.data(), grid);
  const std::vector<tegl::CurvedAxis> curved = {{0, 0b011, longitudes, "lon", "degrees_east"},
                                                {1, 0b011, latitudes, "lat"}};
  // [seams]
  // Axis 0 runs around the globe: 360 degrees after the first samples follow the last ones.
  const auto seams = tegl::find_seams(image.grid(), curved, std::array{0});
  const auto closed = tegl::extract_curved(image, curved, 15.0, {}, seams);
  // [/seams]
  ASSERT_EQ(closed.periods.size(), 1u);
  EXPECT_EQ(closed.periods[0].vector[0], 360.0);
}

TEST(Facets, OfAMeshHaveTheNumbersOfTheirCells) {
  const std::vector<std::array<double, 3>> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  tegl::Complex<3> mesh(corners, tegl::CellType::tetrahedron, std::vector<tegl::Index>{0, 1, 2, 3, 1, 2, 3, 4});
  mesh.set_values({-1, 1, -1, 1, -1});
  // [facets_of_a_mesh]
  const auto polygons = tegl::extract_facets<double>(mesh, 0.0);
  std::vector<std::size_t> cells;  // of the polygons
  for (const tegl::FacetPlace& place : polygons.levels[2].places) cells.push_back(place.base);
  // [/facets_of_a_mesh]
  EXPECT_EQ(cells, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(polygons.down(2, 0).size(), 4u);
}

TEST(Facets, OfAPeriodicLatticeAreClosed) {
  tegl::OwnedImage<float, 3> samples;
  samples.grid = tegl::Grid<3>::unit({4, 5, 6});
  for (int i = 0; i < 120; ++i) samples.values.push_back(static_cast<float>(i % 7) - 2.5f);
  // [facets_of_a_lattice]
  // An image on fcc that is periodic along all axes: a closed complex.
  const auto periods = tegl::sample_periods(samples.grid, std::array{0, 1, 2});
  const auto closed = tegl::extract_facets<double>(samples.view(), tegl::Lattice::fcc, 0.0, {}, periods);
  // [/facets_of_a_lattice]
  EXPECT_GT(closed.count(2), 0u);
  EXPECT_EQ(tegl::check(closed).border, 0u);
  // [facets_of_a_division]
  // Triangles and quadrilaterals, with the numbers of their tetrahedra in `levels[2].places`
  const auto in_simplices = tegl::extract_facets<double>(samples.view(), tegl::Division::kuhn, 0.0);
  // [/facets_of_a_division]
  EXPECT_EQ(in_simplices.cells, 6u * 3u * 4u * 5u);
  EXPECT_GT(in_simplices.count(2), 0u);
}

TEST(Components, TheNearestToAPoint) {
  const std::vector<float> values = volume_at(0);
  const tegl::Contour<3> surface =
      tegl::extract(tegl::Image<float, 3>(values.data(), tegl::Grid<3>::unit({kSize, kSize, kSize})), 0.0);
  const std::array<double, 3> point = {1, 2, 3};
  // [nearest_component]
  const tegl::ComponentLabels labels = tegl::label_components(surface);
  std::vector<bool> keep(labels.count);
  const tegl::NearestComponent found = tegl::nearest_component(surface, labels, point);
  if (found.label != tegl::kNoComponent) keep[found.label] = true;  // false for all if the contour is empty
  const tegl::Contour<3> nearest = tegl::select_components(surface, labels, keep);
  // [/nearest_component]
  EXPECT_EQ(nearest.simplices.size(), surface.simplices.size());
}

}  // namespace
