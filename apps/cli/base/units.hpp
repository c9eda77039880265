// SPDX-License-Identifier: BSD-3-Clause
//
// Units of measures, derived from the units of the axes.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tegl::cli {

/// The unit of lengths, areas, volumes … in a space whose axes have these units: "mm^2" for dimension 2 and axes in mm;
/// "" if no axis has a unit; nullopt if they differ, because the Euclidean measure then mixes them.
std::optional<std::string> measure_unit(const std::vector<std::string>& axis_units, int dimension);

/// The unit of enclosed contents: the product of the axes' units, "mm^3 s"; "" if no axis has a unit; nullopt if only
/// some have one.
std::optional<std::string> content_unit(const std::vector<std::string>& axis_units);

/// "12.5 mm^2", "12.5".
std::string with_unit(const std::string& value, const std::optional<std::string>& unit);

/// "area (mm^2)", "area": the heading of a column.
std::string heading_with_unit(const std::string& name, const std::optional<std::string>& unit);

/// The name of a measure of this dimension: "length", "area", "volume"; "3-volume" and "4-volume" in 4-space.
std::string measure_name(int dimension, int space_dim);

}  // namespace tegl::cli
