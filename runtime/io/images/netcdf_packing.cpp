// SPDX-License-Identifier: BSD-3-Clause
//
// Unpacks values of netCDF variables.
//
// Based on: "NetCDF Climate and Forecast (CF) Metadata Conventions" 1.10, sections 2.5 and 8; the attribute conventions
// of the NetCDF Users' Guide.
#include "images/netcdf_packing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/stored_integers.hpp"

namespace tegl::io_detail {

namespace {

/// Replaces missing values by NaN. `to` may be the memory of `stored`.
template <class Real, class T>
void mark_missing(std::span<const T> stored, const Packing& packing, Real* to) {
  constexpr Real kMissing = std::numeric_limits<Real>::quiet_NaN();
  const std::size_t count = stored.size();
  // Attributes are compared in the variable's own type: as a float, a fill value of -1e34 is another number.
  for (const double value : packing.missing) {
    const T missing = static_cast<T>(value);
    for (std::size_t i = 0; i < count; ++i) to[i] = stored[i] == missing ? kMissing : to[i];
  }
  if (!packing.has_limits()) return;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<double>(stored[i]);
    to[i] = value < packing.least || value > packing.greatest ? kMissing : to[i];
  }
}

/// Unpacks values in simple loops, which the compiler vectorizes.
template <class Real, class T>
void unpack_block(std::span<const T> stored, const Packing& packing, Real* to) {
  const std::size_t count = stored.size();
  if (packing.scaled) {
    for (std::size_t i = 0; i < count; ++i)
      to[i] = static_cast<Real>(static_cast<double>(stored[i]) * packing.scale + packing.offset);
  } else {
    for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<Real>(stored[i]);
  }
  mark_missing<Real, T>(stored, packing, to);
}

/// Unpacks values to `to`, which may be the same memory: in blocks that stay in the cache.
template <class Real, class T>
void unpack_all(std::span<const T> stored, const Packing& packing, Real* to) {
  constexpr std::size_t kBlock = 2048;
  std::array<T, kBlock> block;
  for (std::size_t first = 0; first < stored.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, stored.size() - first);
    std::copy_n(stored.data() + first, count, block.data());
    unpack_block<Real, T>(std::span<const T>(block).first(count), packing, to + first);
  }
}

template <class Real, class T>
ValueVector<Real> unpacked(const ValueVector<T>& stored, const Packing& packing) {
  ValueVector<Real> result(stored.size());
  unpack_all<Real, T>(stored, packing, result.data());
  return result;
}

/// The numbers that a value of the type can be. Others never occur, and casting them is undefined behaviour.
template <class T>
std::vector<double> possible_values(std::vector<double> numbers) {
  std::erase_if(numbers, [](double value) {
    constexpr auto kLowest = static_cast<double>(std::numeric_limits<T>::lowest());
    constexpr auto kHighest = static_cast<double>(std::numeric_limits<T>::max());
    return !(value >= kLowest && value <= kHighest) || (std::is_integral_v<T> && value >= 0x1p63);
  });
  return numbers;
}

/// Whether no value is missing.
template <class T>
bool are_all_present(const ValueVector<T>& values, const Packing& packing) {
  for (const double missing : possible_values<T>(packing.missing))
    if (std::find(values.begin(), values.end(), static_cast<T>(missing)) != values.end()) return false;
  if (!packing.has_limits()) return true;
  return std::all_of(values.begin(), values.end(), [&](T value) {
    return static_cast<double>(value) >= packing.least && static_cast<double>(value) <= packing.greatest;
  });
}

}  // namespace

Packing read_packing(const NcFile& file, const NcVariable& variable) {
  Packing packing;
  const auto scale = file.number(variable, "scale_factor");
  const auto offset = file.number(variable, "add_offset");
  packing.scale = scale.value_or(1.0);
  packing.offset = offset.value_or(0.0);
  packing.scaled = scale.has_value() || offset.has_value();
  const auto fill = file.numbers(variable, "_FillValue");
  packing.missing = fill;
  for (const double value : file.numbers(variable, "missing_value")) packing.missing.push_back(value);
  packing.any_attribute = packing.scaled || !packing.missing.empty();
  const auto range = file.numbers(variable, "valid_range");
  const auto limit = [&](const char* name, std::size_t index, double& value) {
    if (range.size() == 2) value = range[index];
    if (const auto single = file.number(variable, name)) value = *single;
    packing.any_attribute |= std::isfinite(value);
  };
  limit("valid_min", 0, packing.least);
  limit("valid_max", 1, packing.greatest);
  // Floats without a _FillValue attribute have the library's default fill value where they were never written.
  if (fill.empty() && variable.type == NC_FLOAT) packing.missing.push_back(NC_FILL_FLOAT);
  if (fill.empty() && variable.type == NC_DOUBLE) packing.missing.push_back(NC_FILL_DOUBLE);
  return packing;
}

ValueArray unpack(ValueArray&& values, Packing packing) {
  return std::visit(
      [&]<class T>(ValueVector<T>& stored) -> ValueArray {
        packing.missing = possible_values<T>(packing.missing);
        if constexpr (std::is_floating_point_v<T>) {
          unpack_all<T, T>(stored, packing, stored.data());
          return std::move(stored);
        } else {
          if (!packing.any_attribute) return std::move(stored);
          if constexpr (sizeof(T) <= 2) return unpacked<float>(stored, packing);
          return unpacked<double>(stored, packing);
        }
      },
      values);
}

void unpack_reals(ValueArray& values, std::size_t first, std::size_t count, Packing packing) {
  std::visit(
      [&]<class T>(ValueVector<T>& all) {
        if constexpr (std::is_floating_point_v<T>) {
          packing.missing = possible_values<T>(packing.missing);
          const auto stored = std::span<const T>(all).subspan(first, count);
          if (packing.scaled)
            unpack_all<T, T>(stored, packing, all.data() + first);
          else
            mark_missing<T, T>(stored, packing, all.data() + first);
        }
      },
      values);
}

std::optional<ValueScaling> stored_scaling(const ValueArray& values, const Packing& packing) {
  if (packing.scale == 0 || !std::isfinite(packing.scale) || !std::isfinite(packing.offset)) return std::nullopt;
  const std::optional<ValueScaling> scaling = integer_scaling(values, packing.scale, packing.offset);
  const bool all_present = std::visit(
      [&]<class T>(const ValueVector<T>& stored) { return scaling.has_value() && are_all_present(stored, packing); },
      values);
  return all_present ? scaling : std::nullopt;
}

}  // namespace tegl::io_detail
