// SPDX-License-Identifier: BSD-3-Clause
//
// Components and measures of simulated and measured 4D data.
#include <gtest/gtest.h>

#include <filesystem>
#include <variant>

#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/components.hpp"
#include "tegl/io.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

/// The contour of the middle half of a file's image along x, y and t.
Contour<4, double> contour_of_middle(const std::filesystem::path& file, double isovalue) {
  const ReadImageResult input = read_image(file);
  const auto of_image = [&]<Value T, int N>(const OwnedImage<T, N>& owned) -> Contour<4, double> {
    if constexpr (N == 4) {
      Image<T, 4> image = owned.view();
      for (const int axis : {0, 1, 3}) image = image.part(axis, image.size(axis) / 4, image.size(axis) / 2);
      return extract<double>(image, isovalue);
    }
    return Contour<4, double>();
  };
  return std::visit([&](const auto& typed) { return std::visit(of_image, typed); }, input.image);
}

void expect_parts_and_measures(const Contour<4, double>& contour) {
  const MeshReport whole = expect_oriented_manifold(contour);
  const ComponentLabels labels = label_components(contour);
  ASSERT_GT(labels.count, 1u);
  EXPECT_EQ(labels.count, whole.components);
  const auto found = components(contour, labels);
  const auto parts = split_components(contour, labels);
  std::int64_t euler = 0;
  double size = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const MeshReport part = expect_oriented_manifold(parts[i]);
    EXPECT_EQ(part.components, 1u);
    EXPECT_EQ(part.euler, found[i].euler);
    EXPECT_EQ(part.boundary_simplices, found[i].boundary_simplices);
    euler += part.euler;
    size += found[i].size;
  }
  EXPECT_EQ(euler, whole.euler);
  const Measures<4> measures = tegl::measure(contour);
  EXPECT_NEAR(size, measures.size, 1e-11 * size);
  EXPECT_NEAR(measures.size, test::measure(contour), 1e-9 * size);
  std::vector<double> at;
  for (const double share : {0.0, 0.13, 0.5, 0.77})
    at.push_back(measures.lowest[3] + share * (measures.highest[3] - measures.lowest[3]));
  const std::vector<CutMeasures> curve = measure_cuts(contour, at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Contour<3, double> cut = slice(contour, Hyperplane<4>::across(3, at[i]));
    const double area = test::measure(cut);
    EXPECT_NEAR(curve[i].size, area, 1e-9 * area) << "at " << at[i];
    EXPECT_EQ(curve[i].content.has_value(), check(cut).boundary_simplices == 0) << "at " << at[i];
  }
}

TEST(ComponentsOfFiles, OfTheOceanMakeUpTheWhole) {
  expect_parts_and_measures(contour_of_middle(TEGL_SOURCE_DIR "/examples/data/ocean_temperature.nc", 20));
}

TEST(ComponentsOfFiles, OfViscousFingersMakeUpTheWhole) {
  const std::filesystem::path file = TEGL_SHARED_DATA_DIR "/fourd/viscous_fingers_64x64x64x24_float.nhdr";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  expect_parts_and_measures(contour_of_middle(file, 30));
}

}  // namespace
}  // namespace tegl::test
