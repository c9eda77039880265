// SPDX-License-Identifier: BSD-3-Clause
//
// Writers of small image files: NRRD, NIfTI, MetaImage and netCDF.
#include "sample_files.hpp"

#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>

namespace tegl::test {

namespace {

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::string joined(const std::vector<std::size_t>& sizes) {
  std::ostringstream text;
  for (std::size_t i = 0; i < sizes.size(); ++i) text << (i == 0 ? "" : " ") << sizes[i];
  return text.str();
}

std::string nrrd_header(const Samples& samples, const std::string& type, const std::string& extra) {
  std::ostringstream header;
  header << "NRRD0004\ntype: " << type << "\ndimension: " << samples.sizes.size()
         << "\nsizes: " << joined(samples.sizes) << "\nendian: little\nencoding: raw\n"
         << extra << "\n";
  return header.str();
}

void require(int status) {
  if (status != NC_NOERR) throw std::runtime_error(nc_strerror(status));
}

}  // namespace

Samples sample(const std::vector<std::size_t>& sizes, const std::function<double(const std::vector<double>&)>& field) {
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  Samples samples{sizes, std::vector<float>(count)};
  std::vector<double> index(sizes.size());
  for (float& value : samples.values) {
    value = static_cast<float>(field(index));
    for (std::size_t a = 0; a < sizes.size() && ++index[a] == static_cast<double>(sizes[a]); ++a) index[a] = 0;
  }
  return samples;
}

Samples ball(const std::vector<std::size_t>& sizes, double radius) {
  return sample(sizes, [&](const std::vector<double>& x) {
    double square = 0;
    for (std::size_t a = 0; a < x.size(); ++a) {
      const double offset = x[a] - static_cast<double>(sizes[a] - 1) / 2;
      square += offset * offset;
    }
    return radius - std::sqrt(square);
  });
}

Samples merging_balls(std::size_t size, std::size_t steps) {
  const double middle = static_cast<double>(size - 1) / 2;
  return sample({size, size, size, steps}, [&](const std::vector<double>& x) {
    const double half_gap = 5.0 - 4.0 * x[3] / static_cast<double>(steps - 1);
    const double around = std::hypot(x[1] - middle, x[2] - middle);
    const double left = std::hypot(x[0] - middle + half_gap, around);
    const double right = std::hypot(x[0] - middle - half_gap, around);
    return 3.0 - std::min(left, right);
  });
}

Samples noise(const std::vector<std::size_t>& sizes, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  return sample(sizes, [&](const std::vector<double>&) { return static_cast<double>(bits() >> 56); });
}

std::string nrrd_bytes(const Samples& samples, const std::string& extra) {
  return nrrd_header(samples, "float", extra) + bytes_of(samples.values);
}

std::string nrrd_bytes_uint8(const Samples& samples) {
  std::string bytes;
  for (const float value : samples.values) bytes.push_back(static_cast<char>(static_cast<std::uint8_t>(value)));
  return nrrd_header(samples, "uint8", "") + bytes;
}

std::string nifti_bytes(const Samples& samples, const std::vector<float>& spacing) {
  // Offsets as in the format's definition, nifti1.h.
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(header.data() + at, &value, sizeof(value)); };
  put(0, std::int32_t{348});
  put(40, static_cast<std::int16_t>(samples.sizes.size()));
  for (std::size_t a = 0; a < 7; ++a) {
    put(42 + 2 * a, static_cast<std::int16_t>(a < samples.sizes.size() ? samples.sizes[a] : 1));
    put(80 + 4 * a, a < spacing.size() ? spacing[a] : 1.0f);
  }
  put(70, std::int16_t{16});      // datatype: float32
  put(72, std::int16_t{32});      // bits
  put(76, 1.0f);                  // handedness
  put(108, 352.0f);               // offset of the values
  put(112, 1.0f);                 // slope
  put(123, std::uint8_t{2 | 8});  // mm and s
  put(252, std::int16_t{1});      // qform: scanner; the zero quaternion is the identity
  std::memcpy(header.data() + 344, "n+1", 4);
  return header + bytes_of(samples.values);
}

std::string nifti_bytes_int16(const Samples& samples, float slope, float intercept) {
  std::string header = nifti_bytes(samples, {}).substr(0, 352);
  const auto put = [&](std::size_t at, auto value) { std::memcpy(header.data() + at, &value, sizeof(value)); };
  put(70, std::int16_t{4});   // datatype: int16
  put(72, std::int16_t{16});  // bits
  put(112, slope);
  put(116, intercept);
  std::vector<std::int16_t> stored;
  for (const float value : samples.values) stored.push_back(static_cast<std::int16_t>(std::lround(value)));
  return header + bytes_of(stored);
}

std::string metaimage_bytes(const Samples& samples) {
  std::ostringstream header;
  header << "ObjectType = Image\nNDims = " << samples.sizes.size()
         << "\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\nDimSize = "
         << joined(samples.sizes) << "\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n";
  return header.str() + bytes_of(samples.values);
}

void write_netcdf(const std::string& path, const std::vector<std::string>& names,
                  const std::vector<std::vector<double>>& coordinates, const std::vector<NetcdfVariable>& variables,
                  const std::vector<NetcdfAttribute>& of_axes) {
  int file = 0;
  require(nc_create(path.c_str(), NC_CLOBBER, &file));
  std::vector<int> dimensions(names.size());
  std::vector<int> axes(names.size());
  for (std::size_t a = 0; a < names.size(); ++a) {
    require(nc_def_dim(file, names[a].c_str(), coordinates[a].size(), &dimensions[a]));
    require(nc_def_var(file, names[a].c_str(), NC_DOUBLE, 1, &dimensions[a], &axes[a]));
  }
  for (const auto& [axis, name, text] : of_axes)
    require(nc_put_att_text(file, axes.at(axis), name.c_str(), text.size(), text.c_str()));
  // In netCDF the last dimension varies fastest.
  const std::vector<int> slow_first(dimensions.rbegin(), dimensions.rend());
  std::vector<int> ids;
  for (const NetcdfVariable& variable : variables) {
    const int rank = static_cast<int>(slow_first.size());
    const bool is_packed = variable.scale != 0;
    require(nc_def_var(file, variable.name.c_str(), is_packed ? NC_SHORT : NC_FLOAT, rank, slow_first.data(),
                       &ids.emplace_back()));
    const float missing = -999;
    if (is_packed)
      require(nc_put_att_double(file, ids.back(), "scale_factor", NC_DOUBLE, 1, &variable.scale));
    else
      require(nc_put_att_float(file, ids.back(), "_FillValue", NC_FLOAT, 1, &missing));
    require(nc_put_att_text(file, ids.back(), "units", variable.unit.size(), variable.unit.c_str()));
  }
  require(nc_enddef(file));
  for (std::size_t a = 0; a < names.size(); ++a) require(nc_put_var_double(file, axes[a], coordinates[a].data()));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::vector<float> stored = variables[i].samples.values;
    if (const double scale = variables[i].scale; scale != 0)
      for (float& value : stored) value = static_cast<float>(std::lround(value / scale));
    require(nc_put_var_float(file, ids[i], stored.data()));
  }
  require(nc_close(file));
}

void write_curved_globe(const std::string& path, const char* longitudes, bool is_turned, std::size_t repeated,
                        std::size_t columns) {
  constexpr std::size_t kAround = 36, kLat = 17;
  columns += repeated;
  std::vector<double> lon, lat, values;
  for (std::size_t s = 0; s < columns * kLat; ++s) {
    const std::size_t column = is_turned ? s / kLat : s % columns;
    const auto along = static_cast<double>(column % kAround);
    const auto up = static_cast<double>(is_turned ? s % kLat : s / columns);
    lon.push_back(-175.0 + 10.0 * along + 0.1 * up);
    lat.push_back(-80.0 + 10.0 * up + std::sin(along / 36.0 * 2.0 * std::numbers::pi));
    const double away = lon.back() - 180.0 - 360.0 * std::round((lon.back() - 180.0) / 360.0);
    values.push_back(40.0 - std::hypot(away, lat.back()));
    if (column >= kAround) lon.back() += 360.0;
  }
  int file = 0, variable = 0;
  std::array<int, 2> dimensions{};
  require(nc_create(path.c_str(), NC_CLOBBER, &file));
  require(nc_def_dim(file, "j", kLat, &dimensions[is_turned ? 1 : 0]));
  require(nc_def_dim(file, "i", columns, &dimensions[is_turned ? 0 : 1]));
  const auto define = [&](const char* name, const char* attribute, const std::string& text) {
    require(nc_def_var(file, name, NC_DOUBLE, 2, dimensions.data(), &variable));
    require(nc_put_att_text(file, variable, attribute, text.size(), text.c_str()));
    return variable;
  };
  const int of_lon = define(longitudes, "units", "degrees_east"), of_lat = define("lat", "units", "degrees_north");
  const int of_values = define("spot", "coordinates", std::string(longitudes) + " lat");
  require(nc_enddef(file));
  require(nc_put_var_double(file, of_lon, lon.data()));
  require(nc_put_var_double(file, of_lat, lat.data()));
  require(nc_put_var_double(file, of_values, values.data()));
  require(nc_close(file));
}

}  // namespace tegl::test
