// SPDX-License-Identifier: BSD-3-Clause
//
// Units of what is measured, from those of the axes.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tegl::cli {

/// The unit of lengths, areas, volumes … in a space whose axes have these units: "mm^2" for dimension 2 and axes in mm;
/// "" where no axis has a unit; none where they differ, as then Euclid's measure mixes them.
std::optional<std::string> measure_unit(const std::vector<std::string>& axis_units, int dimension);

/// The unit of what axes of these units enclose: their product, "mm^3 s"; "" where no axis has a unit; none where some
/// have and some have not.
std::optional<std::string> content_unit(const std::vector<std::string>& axis_units);

/// "12.5 mm^2", "12.5".
std::string with_unit(const std::string& value, const std::optional<std::string>& unit);

/// "area (mm^2)", "area": the heading of a column.
std::string heading_with_unit(const std::string& name, const std::optional<std::string>& unit);

/// What a measure of this dimension is called in a space: "length", "area", "volume"; "3-volume" in 4-space,
/// "4-volume".
std::string measure_name(int dimension, int space_dim);

}  // namespace tegl::cli
