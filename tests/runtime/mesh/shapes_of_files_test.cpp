// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of measured and simulated 3D and 4D data: components, facets, triangulations, normals, measures, elements,
// slices and projections, each compared with independently computed values. Skipped if the folder with the files does
// not exist.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include "compare.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "real_images.hpp"
#include "simplicial_contour.hpp"
#include "tegl/components.hpp"
#include "tegl/elements.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/io.hpp"
#include "tegl/measure.hpp"
#include "tegl/normals.hpp"
#include "tegl/polygons.hpp"
#include "tegl/project.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

struct File {
  std::string path;
  double quantile;  ///< of the values; the isovalue is slightly above it
};
std::ostream& operator<<(std::ostream& out, const File& file) { return out << file.path; }

std::string name_of(const ::testing::TestParamInfo<File>& info) {
  const std::string name = std::filesystem::path(info.param.path).filename().string();
  return name.substr(0, name.find('.'));
}

template <int N>
class ShapeOfFile : public ::testing::TestWithParam<File> {
 protected:
  /// Calls `visit` with the middle of the file's image and the isovalue.
  template <class Visit>
  void with_image(const Visit& visit) {
    const std::filesystem::path path = std::filesystem::path(TEGL_SHARED_DATA_DIR) / GetParam().path;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    const ReadImageResult read = read_image(path);
    ASSERT_TRUE(std::holds_alternative<AnyImageN<N>>(read.image));
    std::array<std::size_t, N> most;
    most.fill(N == 3 ? 48 : 24);
    if (N == 4) most[3] = 8;
    const auto of_image = [&](const auto& owned) {
      const auto image = middle(owned.view(), most);
      visit(image, isovalue_at(image, GetParam().quantile));
    };
    std::visit(of_image, std::get<AnyImageN<N>>(read.image));
  }
};
class SurfaceOfFile : public ShapeOfFile<3> {};
class FilmOfFile : public ShapeOfFile<4> {};

ExtractOptions closed() {
  ExtractOptions options;
  options.close = true;
  return options;
}

// ---- properties in 3D and 4D ----

template <Value T, int N>
void expect_parts_of_the_samples(const Image<T, N>& image, double isovalue) {
  const auto contour = extract<double>(image, isovalue, closed());
  const MeshReport report = expect_closed_manifold(contour);
  const ComponentLabels labels = label_components(contour);
  EXPECT_GT(labels.count, 1u);
  EXPECT_EQ(labels.count, surfaces_by_samples(image, isovalue));
  const FacetReport facets = check(extract_facets<double>(image, isovalue, closed()));
  EXPECT_EQ(facets.components, labels.count);
  EXPECT_EQ(facets.branching + facets.conflicts + facets.open_boundaries + facets.border, 0u);
  EXPECT_EQ(facets.euler, report.euler);
  double content = 0;
  for (const auto& part : components(contour, labels)) content += part.content.value();
  EXPECT_NEAR(content, enclosed_content(contour), 1e-9 * content);
}

/// The content of the closed contour equals the flux of the position through the elements, whose sum is 0. The share of
/// high tile corners approximates it up to the active tiles: each contributes an error of at most one tile, of either
/// sign, so the mean error is far smaller.
template <Value T, int N>
void expect_measures_and_elements_by_gauss(const Image<T, N>& image, double isovalue) {
  const auto contour = extract<double>(image, isovalue, closed());
  const Measures<N> measures = tegl::measure(contour);
  EXPECT_NEAR(measures.size, test::measure(contour), 1e-9 * measures.size);
  ASSERT_TRUE(measures.content.has_value());
  for (const auto& all : {elements(contour), elements_by_cell(contour, image.grid())}) {
    const ElementSum<N> sum = sum_of(all);
    EXPECT_LT(sum.closure_error(), 1e-13);
    EXPECT_NEAR(sum.measure, measures.size, 1e-12 * measures.size);
    double flux = 0;
    for (std::size_t e = 0; e < all.normals.size(); ++e)
      for (int a = 0; a < N; ++a) flux += all.centroids[e][a] * all.normals[e][a];
    if (all.normals.size() == contour.simplices.size()) {
      EXPECT_NEAR(flux / N, *measures.content, 1e-9 * *measures.content);
    }
  }
  double high = 0;
  for_each_sample<N>(image.grid(), [&](std::size_t, const std::array<std::size_t, N>& index) {
    double share = 1;  // half a step at the border
    for (int a = 0; a < N; ++a) share *= index[a] == 0 || index[a] + 1 == image.size(a) ? 0.5 : 1.0;
    if (static_cast<double>(image(index)) >= isovalue) high += share;
  });
  const auto unit = on_unit_grid(image);
  const auto [steps, stats] = extract_with_stats<double>(unit.view(), isovalue, closed());
  EXPECT_NEAR(*tegl::measure(steps).content, high, 0.25 * static_cast<double>(stats.active_tiles));
}

/// At vertices on edges of the grid away from the border: central differences at both ends, interpolated.
template <Value T, int N>
void expect_normals_by_differences(const Image<T, N>& image, double isovalue) {
  const auto unit = on_unit_grid(image);
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto contour = extract<double>(unit.view(), isovalue, options);
  const auto from_image = gradient_normals(unit.view(), contour);
  const auto from_shape = geometric_normals(contour);
  std::size_t compared = 0;
  double agreeing = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    std::array<std::size_t, N> index;
    int along = -1, between = 0;
    bool is_inside = true;
    for (int a = 0; a < N; ++a) {
      index[a] = static_cast<std::size_t>(contour.vertices[v][a]);
      if (contour.vertices[v][a] != std::floor(contour.vertices[v][a])) along = a, ++between;
      is_inside = is_inside && index[a] > 0 && index[a] + 2 < image.size(a);
    }
    if (!is_inside || between != 1) continue;
    std::array<double, N> expected;
    double square = 0, product = 0;
    for (int a = 0; a < N; ++a) {
      const auto difference = [&](std::array<std::size_t, N> at) {
        ++at[a];
        const auto after = static_cast<double>(image(at));
        at[a] -= 2;
        return 0.5 * (after - static_cast<double>(image(at)));
      };
      auto next = index;
      ++next[along];
      const double share = contour.vertices[v][along] - static_cast<double>(index[along]);
      expected[a] = -((1 - share) * difference(index) + share * difference(next));
      square += expected[a] * expected[a];
      product += from_image[v][a] * from_shape[v][a];
    }
    if (square == 0) continue;
    ++compared;
    agreeing += product > 0.5;
    for (int a = 0; a < N; ++a) {
      ASSERT_NEAR(contour.normals[v][a], expected[a] / std::sqrt(square), 1e-5) << "vertex " << v;
      ASSERT_NEAR(from_image[v][a], contour.normals[v][a], 1e-5) << "vertex " << v;
    }
  }
  EXPECT_GT(compared, 500u);
  EXPECT_GT(agreeing, 0.85 * static_cast<double>(compared));
}

TEST_P(SurfaceOfFile, HasThePartsOfItsSamples) {
  with_image([](const auto& image, double isovalue) {
    expect_parts_of_the_samples(image, isovalue);
    EXPECT_EQ(check(extract(image, isovalue, closed())).euler, euler_by_samples(image, isovalue));
  });
}
TEST_P(FilmOfFile, HasThePartsOfItsSamples) {
  with_image([](const auto& image, double isovalue) { expect_parts_of_the_samples(image, isovalue); });
}
TEST_P(SurfaceOfFile, MeasuresAndElementsAgreeByGauss) {
  with_image([](const auto& image, double isovalue) { expect_measures_and_elements_by_gauss(image, isovalue); });
}
TEST_P(FilmOfFile, MeasuresAndElementsAgreeByGauss) {
  with_image([](const auto& image, double isovalue) { expect_measures_and_elements_by_gauss(image, isovalue); });
}
TEST_P(SurfaceOfFile, NormalsAreDifferencesOfSamples) {
  with_image([](const auto& image, double isovalue) { expect_normals_by_differences(image, isovalue); });
}
TEST_P(FilmOfFile, NormalsAreDifferencesOfSamples) {
  with_image([](const auto& image, double isovalue) { expect_normals_by_differences(image, isovalue); });
}

// ---- 3D ----

TEST_P(SurfaceOfFile, TriangulatedInAnyWayIsTheSame) {
  with_image([](const auto& image, double isovalue) {
    const auto facets = extract_facets<double>(image, isovalue, closed());
    std::size_t triangles = 0, corners = 0;
    for (std::size_t f = 0; f < facets.count(2); ++f) {
      const std::size_t points = facets.down(2, f).size();
      triangles += points - 2;
      corners += points == 3 ? 1 : points;
    }
    const std::int64_t euler = euler_by_samples(image, isovalue);
    const double content = enclosed_content(extract<double>(image, isovalue, closed()));
    for (const PolygonTriangulation method :
         {PolygonTriangulation::fan, PolygonTriangulation::zigzag, PolygonTriangulation::halving_chord,
          PolygonTriangulation::halving_kink, PolygonTriangulation::barycentric}) {
      SCOPED_TRACE("method " + std::to_string(static_cast<int>(method)));
      const auto contour = triangulate(facets, method);
      const MeshReport report = check(contour);
      EXPECT_TRUE(is_oriented_manifold(report));
      EXPECT_EQ(report.boundary_simplices, 0u);
      EXPECT_EQ(report.euler, euler);
      EXPECT_EQ(report.simplices, method == PolygonTriangulation::barycentric ? corners : triangles);
      EXPECT_NEAR(enclosed_content(contour), content, 0.02 * content);
    }
  });
}

TEST_P(SurfaceOfFile, FlatNormalsTimesAreasAreItsElements) {
  with_image([](const auto& image, double isovalue) {
    const auto contour = extract<double>(image, isovalue);
    const auto normals = flat_normals(contour);
    const auto all = elements(contour);
    ASSERT_EQ(normals.size(), all.normals.size());
    for (std::size_t s = 0; s < normals.size(); ++s)
      for (int a = 0; a < 3; ++a)
        ASSERT_NEAR(normals[s][a] * all.measures[s], all.normals[s][a], 1e-9 * all.measures[s]) << s;
  });
}

// ---- 4D ----

TEST_P(FilmOfFile, CutsAcrossAnyAxisAreTheContoursOfLayers) {
  with_image([](const auto& image, double isovalue) {
    const auto unit = on_unit_grid(image);
    const auto contour = extract<double>(unit.view(), isovalue);
    for (int axis = 0; axis < 4; ++axis)
      for (const std::size_t i : {std::size_t{0}, image.size(axis) / 2, image.size(axis) - 1})
        EXPECT_TRUE(same_surface(slice(contour, Hyperplane<4>::across(axis, static_cast<double>(i))),
                                 extract<double>(layer_across(unit.view(), axis, i), isovalue)))
            << "axis " << axis << ", layer " << i;
  });
}

TEST_P(FilmOfFile, StacksAndScrubbersOfObliqueCutsAreThoseCuts) {
  with_image([](const auto& image, double isovalue) {
    const auto unit = on_unit_grid(image);
    const auto contour = extract<double>(unit.view(), isovalue, closed());
    const Vector<4> normal{1, -2, 0.5, 3};
    const Scrubber<4, double> scrubber(contour, {normal});
    const auto [least, most] = scrubber.range();
    std::vector<Hyperplane<4>> hyperplanes;
    for (int i = 1; i < 8; ++i) hyperplanes.push_back({normal, least + (most - least) * i / 8.0});
    const auto stack = slice_stack(contour, hyperplanes);
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < hyperplanes.size(); ++i) {
      const auto expected = slice(contour, hyperplanes[i]);
      expect_closed_manifold(expected);
      triangles += expected.simplices.size();
      const auto cut = scrubber.cut(hyperplanes[i].offset);
      EXPECT_TRUE(stack[i].vertices == expected.vertices && stack[i].simplices == expected.simplices) << i;
      EXPECT_TRUE(cut.vertices == expected.vertices && cut.simplices == expected.simplices) << i;
    }
    EXPECT_GT(triangles, 1000u);
  });
}

TEST_P(FilmOfFile, AreasAndVolumesAtTimeStepsAreThoseOfTheLayers) {
  with_image([](const auto& image, double isovalue) {
    const auto unit = on_unit_grid(image);
    const auto contour = extract<double>(unit.view(), isovalue, closed());
    std::vector<double> times;
    for (std::size_t k = 1; k + 1 < image.size(3); ++k) times.push_back(static_cast<double>(k));
    const auto curve = measure_cuts(contour, std::span<const double>(times));
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto surface = extract<double>(layer_across(unit.view(), 3, i + 1), isovalue, closed());
      EXPECT_NEAR(curve[i].size, test::measure(surface), 1e-9 * curve[i].size) << "at " << times[i];
      ASSERT_TRUE(curve[i].content.has_value());
      EXPECT_NEAR(*curve[i].content, enclosed_content(surface), 1e-9 * *curve[i].content) << "at " << times[i];
    }
  });
}

TEST_P(FilmOfFile, ProjectionCoversWhatItEntersAsOftenAsItLeavesIt) {
  with_image([](const auto& image, double isovalue) {
    const auto contour = extract<double>(image, isovalue, closed());
    const auto projected = project(contour);
    const auto& sides = projected.simplex_attributes.front().values;
    double entered = 0, left = 0;
    std::array<double, 2> by_side{};
    for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
      Eigen::Matrix3d edges;
      for (int j = 0; j < 3; ++j)
        for (int a = 0; a < 3; ++a)
          edges(a, j) =
              projected.vertices[projected.tetrahedra[s][j + 1]][a] - projected.vertices[projected.tetrahedra[s][0]][a];
      const double volume = edges.determinant() / 6;
      (volume > 0 ? entered : left) += std::abs(volume);
      by_side[sides[s] < 0 ? 0 : 1] += std::abs(volume);
    }
    EXPECT_GT(entered, 0.0);
    EXPECT_NEAR(entered, left, 1e-9 * entered);
    EXPECT_NEAR(by_side[0], by_side[1], 1e-9 * entered);
    const auto surface = outline(contour);
    const MeshReport report = expect_closed_manifold(surface);
    EXPECT_GT(report.simplices, 100u);
    // The enclosed content, with overlapping folds counted multiply, equals the content entered, up to the effect of
    // smoothed normals.
    EXPECT_NEAR(enclosed_content(surface), entered, 0.2 * entered);
  });
}

INSTANTIATE_TEST_SUITE_P(Shared, SurfaceOfFile,
                         ::testing::Values(File{"classic/neghip_64x64x64_uint8.nhdr", 0.9},
                                           File{"classic/silicium_98x34x34_uint8.nhdr", 0.93},
                                           File{"ct_mri/headsq_quarter_64x64x93_uint16.nhdr", 0.7}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Shared, FilmOfFile,
                         ::testing::Values(File{"fourd/colpex_theta_83x83x10x6_float.nhdr", 0.85},
                                           File{"fourd/pcasl.nii.gz", 0.7},
                                           File{"fourd/viscous_fingers_64x64x64x24_float.nhdr", 0.97}),
                         name_of);

}  // namespace
}  // namespace tegl::test
