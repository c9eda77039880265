// SPDX-License-Identifier: BSD-3-Clause
//
// Small image files, written without the library that reads them.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tegl::test {

/// Values on a grid, axis 0 fastest.
struct Samples {
  std::vector<std::size_t> sizes;
  std::vector<float> values;
};

/// Samples of a function of the index.
Samples sample(const std::vector<std::size_t>& sizes, const std::function<double(const std::vector<double>&)>& field);

/// A ball of this radius in the middle of the grid: radius minus distance. Contour at 0: a sphere.
Samples ball(const std::vector<std::size_t>& sizes, double radius);

/// Two balls of radius 3 in 3D that approach each other along x for t = 0 to steps - 1, and merge.
Samples merging_balls(std::size_t size, std::size_t steps);

/// Pseudo-random numbers in [0, 255], determined by the seed.
Samples noise(const std::vector<std::size_t>& sizes, std::uint64_t seed);

/// NRRD, attached header, float. `extra` header lines end with a newline each.
std::string nrrd_bytes(const Samples& samples, const std::string& extra = "");
/// As nrrd_bytes, with uint8 values.
std::string nrrd_bytes_uint8(const Samples& samples);

/// NIfTI-1, float, with spacings (mm; s along t) and without a rotation.
std::string nifti_bytes(const Samples& samples, const std::vector<float>& spacing);

/// As nifti_bytes, with int16 values, which are the samples rounded, and this slope and intercept.
std::string nifti_bytes_int16(const Samples& samples, float slope, float intercept);

/// MetaImage, float, attached data.
std::string metaimage_bytes(const Samples& samples);

/// A variable of a netCDF file; dimension i has these coordinates. Slowest dimension last, as in Samples.
struct NetcdfVariable {
  std::string name;
  Samples samples;
  std::string unit = "degC";
  double scale = 0;  ///< not 0: stored as int16 with this scale_factor, rounded
};
/// An attribute of an axis in a netCDF file.
struct NetcdfAttribute {
  std::size_t axis = 0;
  std::string name;
  std::string text;
};
/// netCDF classic with coordinate variables: axis i is named names[i] and has coordinates[i]; -999 is missing.
void write_netcdf(const std::string& path, const std::vector<std::string>& names,
                  const std::vector<std::vector<double>>& coordinates, const std::vector<NetcdfVariable>& variables,
                  const std::vector<NetcdfAttribute>& of_axes = {});

/// A netCDF file of a global grid with two-dimensional longitudes and latitudes. `is_turned`: its first dimension runs
/// around the globe. `repeated`: so many of its columns follow 360 degrees further. `columns`: of the globe, others are
/// a region.
void write_curved_globe(const std::string& path, const char* longitudes = "lon", bool is_turned = false,
                        std::size_t repeated = 0, std::size_t columns = 36);

}  // namespace tegl::test
