// SPDX-License-Identifier: BSD-3-Clause
//
// Every measured file of the shared data in a supported format: sizes, spacing, value range and number of missing
// values as in the list of the data. Skipped if the data are not present.
#include <cmath>
#include <limits>

#include "io_support.hpp"

namespace tegl::test {
namespace {

struct RealFile {
  const char* path;
  const char* variable;
  std::vector<std::size_t> sizes;  ///< axis 0 first
  double low;
  double high;
  double mean;
  std::size_t missing;
  std::vector<double> steps;  ///< step lengths; 0 if they vary
};

std::vector<RealFile> real_files() {
  return {
      {"classic/aneurism_256x256x256_uint8.nhdr", "", {256, 256, 256}, 0, 255, 1.069, 0, {1, 1, 1}},
      {"classic/hydrogen_atom_128x128x128_uint8.nhdr", "", {128, 128, 128}, 0, 250, 2.857, 0, {1, 1, 1}},
      {"classic/fuel_64x64x64_uint8.nhdr", "", {64, 64, 64}, 0, 255, 1.945, 0, {1, 1, 1}},
      {"classic/neghip_64x64x64_uint8.nhdr", "", {64, 64, 64}, 0, 255, 18.4, 0, {1, 1, 1}},
      {"classic/silicium_98x34x34_uint8.nhdr", "", {98, 34, 34}, 0, 255, 40.9, 0, {1, 1, 1}},
      {"ct_mri/headsq_quarter_64x64x93_uint16.nhdr", "", {64, 64, 93}, 0, 3926, 507.7, 0, {3.2, 3.2, 1.5}},
      {"ct_mri/stent_128x128x256_int16.nhdr", "", {128, 128, 256}, 0, 2000, 35.4, 0, {1, 1, 1}},
      {"ct_mri/chris_t1.nii.gz", "", {188, 256, 190}, 0, 255, 44.95, 0, {0.88, 0.88, 0.88}},
      {"ct_mri/shear.nii.gz", "", {306, 422, 54}, -1024, 789, -799.9, 0, {0.4824, 0.4824, 2.371}},
      {"ct_mri/3DCT_lung.mha", "", {115, 157, 129}, -1255, 1474, -351.7, 0, {1.366, 1.366, 2.5}},
      {"dem2d/jacksboro_403x344_int16.nhdr", "", {403, 344}, 236, 1076, 531, 0, {1, 1}},
      {"grid_nc/levitus_climatology.cdf.gz", "TEMP", {360, 180, 20}, -2.02, 29.74, 8.267, 577275, {1, 1, 0}},
      {"fourd/pcasl.nii.gz", "", {52, 68, 20, 10}, 0, 2640, 461.6, 0, {3, 3, 6, 2.54}},
      {"fourd/example4d.nii.gz", "", {128, 96, 24, 2}, 0, 1162, 172.9, 0, {2, 2, 2.2, 2000}},
      {"fourd/functional.nii", "", {17, 21, 3, 20}, 629.826, 5571.62, 3637, 0, {4, 4, 8, 2}},
      {"fourd/nmc_contour.nc", "T", {36, 33, 10, 7}, 191.33, 307.739, 236, 0, {2.5, 1.25, 0, 0}},
      {"fourd/colpex_theta_83x83x10x6_float.nhdr", "", {83, 83, 10, 6}, 277.616, 289.864, 284.5, 0, {1, 1, 1, 10}},
      {"fourd/viscous_fingers_64x64x64x24_float.nhdr", "", {64, 64, 64, 24}, 0, 118.851, 11.19, 0, {1, 1, 1, 1}},
      {"fourd/ocean_atlas_subset.nc.gz", "", {180, 90, 19, 12}, -3, 34.1779, 9.348, 1454616, {2, 2, 0, 0}},
  };
}

template <class T, int N>
void expect_as_listed(const OwnedImage<T, N>& image, const RealFile& file) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double sum = 0;
  std::size_t missing = 0;
  for (const T value : image.values) {
    const auto number = static_cast<double>(value);
    if (std::isnan(number)) {
      ++missing;
      continue;
    }
    low = std::min(low, number);
    high = std::max(high, number);
    sum += number;
  }
  // The list has six digits of the range and four of the mean and the steps.
  EXPECT_NEAR(low, file.low, 1e-5 * (1 + std::abs(file.low)));
  EXPECT_NEAR(high, file.high, 1e-5 * (1 + std::abs(file.high)));
  EXPECT_NEAR(sum / static_cast<double>(image.values.size() - missing), file.mean, 2e-3 * (1 + std::abs(file.mean)));
  EXPECT_EQ(missing, file.missing);
  ASSERT_EQ(file.sizes.size(), static_cast<std::size_t>(N));
  for (std::size_t a = 0; a < N; ++a) {
    const Axis& axis = image.grid.axes[a];
    EXPECT_EQ(axis.size(), file.sizes[a]) << "axis " << a;
    EXPECT_EQ(axis.is_uniform(), file.steps[a] != 0) << "axis " << a;
    if (axis.is_uniform()) {
      EXPECT_NEAR(std::abs(axis.step()), file.steps[a], 1e-3 * file.steps[a]) << "axis " << a;
    }
    EXPECT_FALSE(axis.name.empty()) << "axis " << a;
  }
}

TEST(RealFiles, AreReadAsListed) {
  const fs::path root = TEGL_SHARED_DATA_DIR;
  if (!fs::exists(root)) GTEST_SKIP() << "no shared data";
  for (const RealFile& file : real_files()) {
    SCOPED_TRACE(file.path);
    const auto result = read_image(root / file.path, {file.variable, {}});
    std::visit([&](const auto& any) { std::visit([&](const auto& image) { expect_as_listed(image, file); }, any); },
               result.image);
  }
}

TEST(RealFiles, ShearedAffineIsExact) {
  const fs::path path = fs::path(TEGL_SHARED_DATA_DIR) / "ct_mri/shear.nii.gz";
  if (!fs::exists(path)) GTEST_SKIP() << "no shared data";
  const auto [any, info] = read_image(path);
  const auto grid = image_as<float, 3>(any).grid;
  // srow_y and srow_z of the header, as float: (0, .45749196, 0, -117.10602) and (0, .15307483, 2.3708093, -102.20355).
  const Eigen::Vector3d at = world(grid, {100, 200, 50});
  EXPECT_NEAR(at[0], -94.37935638427734 + 100 * 0.482421875, 1e-9);
  EXPECT_NEAR(at[1], -117.10601806640625 + 200 * 0.457492, 1e-3);
  EXPECT_NEAR(at[2], -102.20355224609375 + 200 * 0.153075 + 50 * 2.370809, 1e-3);
  EXPECT_EQ(info.world_frame, "RAS");
}

TEST(RealFiles, SeveralVariablesAreListed) {
  const fs::path path = fs::path(TEGL_SHARED_DATA_DIR) / "grid_nc/levitus_climatology.cdf.gz";
  if (!fs::exists(path)) GTEST_SKIP() << "no shared data";
  expect_error(ErrorCode::VariableNotFound, {"TEMP (360 x 180 x 20), SALT (360 x 180 x 20)"},
               [&] { read_image(path); });
}

}  // namespace
}  // namespace tegl::test
