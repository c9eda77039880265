// SPDX-License-Identifier: BSD-3-Clause
//
// Packing of netCDF variables: scale, offset and missing values.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "base/value_array.hpp"
#include "images/netcdf_file.hpp"
#include "tegl/io/images.hpp"

namespace tegl::io_detail {

/// The conversion of stored values: v * scale + offset, or missing.
struct Packing {
  double scale = 1;
  double offset = 0;
  bool scaled = false;
  std::vector<double> missing;  ///< stored values that stand for missing values
  double least = -std::numeric_limits<double>::infinity();
  double greatest = std::numeric_limits<double>::infinity();
  bool any_attribute = false;

  [[nodiscard]] bool has_limits() const {
    return least > -std::numeric_limits<double>::infinity() || greatest < std::numeric_limits<double>::infinity();
  }
};

Packing read_packing(const NcFile& file, const NcVariable& variable);

/// Unpacks to float if it is exact, including integers of up to 16 bits; else to double.
ValueArray unpack(ValueArray&& values, Packing packing);
/// Unpacks the values [first, first + count) of an array of float or double in place.
void unpack_reals(ValueArray& values, std::size_t first, std::size_t count, Packing packing);

/// The scaling of stored values, if the image can have them in place of unpacked ones: see
/// ReadImageOptions::keep_stored.
std::optional<ValueScaling> stored_scaling(const ValueArray& values, const Packing& packing);

}  // namespace tegl::io_detail
