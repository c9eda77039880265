// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of measured and simulated 4D data. Skipped if the folder with the files does not exist.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include "compare.hpp"
#include "estimators.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "real_images.hpp"
#include "simplicial_contour.hpp"
#include "tegl/io.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using test::isovalue_at;
using test::middle;
using test::same_surface;

struct File {
  std::string path;
  double quantile;     ///< of the values; the isovalue is slightly above it
  bool closes = true;  ///< no missing values, so that a contour with `close` is closed
};
std::ostream& operator<<(std::ostream& out, const File& file) { return out << file.path; }

template <Value T>
double time_of(const Image<T, 4>& image, double index) {
  const auto& axis = image.grid().axes[3];
  const auto i = std::min(static_cast<std::size_t>(index), axis.size() - 2);
  const double t = axis[i] + (index - static_cast<double>(i)) * (axis[i + 1] - axis[i]);
  return image.grid().linear[3][3] * t + image.grid().offset[3];
}

class SliceOfFile : public ::testing::TestWithParam<File> {
 protected:
  /// Calls `visit` with a part of the file's image.
  template <class Visit>
  void with_image(const Visit& visit) {
    const std::filesystem::path path = std::filesystem::path(TEGL_SHARED_DATA_DIR) / "fourd" / GetParam().path;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    const ReadImageResult read = read_image(path);
    ASSERT_TRUE(std::holds_alternative<AnyImageN<4>>(read.image));
    std::visit(
        [&](const auto& owned) {
          visit(middle(owned.view(), {28, 28, 28, 8}));
        },
        std::get<AnyImageN<4>>(read.image));
  }
};

TEST_P(SliceOfFile, IsAManifoldAtAnyTime) {
  with_image([](const auto& image) {
    ExtractOptions options;
    options.close = true;
    const auto whole = extract<double>(image, isovalue_at(image, GetParam().quantile), options);
    const MeshReport report = check(whole);
    EXPECT_TRUE(test::is_oriented_manifold(report));
    std::mt19937_64 bits(1);
    for (int i = 0; i < 170; ++i) {  // with six files, more than a thousand
      const double index = static_cast<double>(image.size(3) - 1) * test::unit_random(bits);
      const MeshReport cut = check(slice(whole, Hyperplane<4>::across(3, time_of(image, index))));
      EXPECT_GT(cut.simplices, 100u);
      EXPECT_TRUE(test::is_oriented_manifold(cut)) << index;
      if (GetParam().closes) {
        EXPECT_TRUE(test::is_closed_oriented_manifold(cut)) << index;
      }
    }
  });
}

TEST_P(SliceOfFile, IsAManifoldAlongAnyHyperplane) {
  with_image([](const auto& image) {
    ExtractOptions options;
    options.close = true;
    const auto whole = extract<double>(image, isovalue_at(image, GetParam().quantile), options);
    std::mt19937_64 bits(2);
    for (int i = 0; i < 20; ++i) {
      Hyperplane<4> hyperplane;
      for (double& x : hyperplane.normal) x = 2.0 * test::unit_random(bits) - 1.0;
      if (i < 4) hyperplane.normal = unit_vector<4>(i);
      const auto& through = whole.vertices[test::random_below(bits, whole.vertices.size())];
      hyperplane.offset = 0.0;
      for (int a = 0; a < 4; ++a) hyperplane.offset += hyperplane.normal[a] * through[a];
      const MeshReport cut = check(slice(whole, hyperplane));
      EXPECT_TRUE(test::is_oriented_manifold(cut)) << i;
      if (GetParam().closes) {
        EXPECT_TRUE(test::is_closed_oriented_manifold(cut)) << i;
      }
    }
  });
}

TEST_P(SliceOfFile, ByAScrubberIsTheSame) {
  with_image([](const auto& image) {
    const auto whole = extract<double>(image, isovalue_at(image, GetParam().quantile));
    const Scrubber<4, double> scrubber(whole);
    for (double index = 0.0; index <= static_cast<double>(image.size(3) - 1); index += 0.25) {
      const auto expected = slice(whole, Hyperplane<4>::across(3, time_of(image, index)));
      const auto cut = scrubber.cut(time_of(image, index));
      EXPECT_TRUE(cut.vertices == expected.vertices && cut.simplices == expected.simplices) << index;
    }
  });
}

TEST_P(SliceOfFile, AtATimeStepEqualsThe3dContourInEveryCombination) {
  with_image([](const auto& image) {
    const double isovalue = isovalue_at(image, GetParam().quantile);
    for (const auto& [name, options_of_way] : test::all_ways())
      for (const bool close : {false, true}) {
        ExtractOptions options = options_of_way;
        options.close = close;
        const auto whole = extract<double>(image, isovalue, options);
        for (std::size_t k = 0; k < image.size(3); ++k)
          EXPECT_TRUE(same_surface(slice(whole, Hyperplane<4>::across(3, time_of(image, static_cast<double>(k)))),
                                   extract<double>(test::last_axis_layer(image, k), isovalue, options)))
              << name << (close ? ", closed" : "") << ", layer " << k;
      }
  });
}

TEST_P(SliceOfFile, TakenDirectlyEqualsTheCutOfTheWhole) {
  with_image([](const auto& image) {
    const double isovalue = isovalue_at(image, GetParam().quantile);
    const auto whole = extract(image, isovalue);
    const auto last = static_cast<double>(image.size(3) - 1);
    for (const double index : {0.0, 0.25, 1.0, last - 0.1, last}) {
      const double at = time_of(image, index);
      EXPECT_TRUE(same_surface(slice_image(image, isovalue, Hyperplane<4>::across(3, at)),
                               slice(whole, Hyperplane<4>::across(3, at))))
          << index;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Shared, SliceOfFile,
                         ::testing::Values(File{"colpex_theta_83x83x10x6_float.nhdr", 0.6}, File{"functional.nii", 0.7},
                                           File{"pcasl.nii.gz", 0.7}, File{"example4d.nii.gz", 0.7},
                                           File{"viscous_fingers_64x64x64x24_float.nhdr", 0.9},
                                           File{"ocean_atlas_subset.nc.gz", 0.5, false}),
                         [](const auto& param) {
                           std::string name = param.param.path.substr(0, param.param.path.find('.'));
                           return name;
                         });

}  // namespace
}  // namespace tegl
