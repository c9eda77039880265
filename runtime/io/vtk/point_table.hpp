// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of scattered points as text: a row for each point, with its coordinates and values.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tegl/work.hpp"

namespace tegl::io_detail {

struct PointTable {
  std::vector<std::string> axis_names;   ///< 2 to 4
  std::vector<double> coordinates;       ///< #P x axes, finite
  std::vector<std::string> value_names;  ///< of all columns that are no coordinates
  std::vector<double> values;            ///< #P x columns of values, NaN: missing
  std::vector<std::size_t> lines;        ///< #P, place in the file, counted from 1
  [[nodiscard]] std::size_t dim() const { return axis_names.size(); }
  /// The values of a column.
  [[nodiscard]] std::vector<double> column(std::size_t number) const;
};

/// Whether a file is such a table, by its extension (.csv).
bool is_point_table(const std::filesystem::path& path);

/// Reads a table. Fields are separated by commas, semicolons, tabs or blanks, whichever the first line has; lines that
/// start with '#' are comments. If the first line has a field that is no number, it has the columns' names, and x, y, z
/// and t (or time) are the coordinates, in this order. Without columns x and y, `variable` (or the last column) has the
/// values, and all others are coordinates. A value that is empty or "nan" is missing. Columns with text in the first
/// row are left out, unless they are coordinates or `variable`. Without names, the values are called "value". Errors,
/// with the line: FileNotFound, MalformedFile (no number, not finite, another number of fields, two equal points),
/// UnsupportedData (not 2 to 4 coordinates), VariableNotFound, Cancelled.
PointTable read_point_table(const std::filesystem::path& path, const std::string& variable, const Progress& progress);

/// The number of the column of values named `variable`; if it is empty, of the only one. Errors: VariableNotFound.
std::size_t choose_column(const PointTable& table, const std::string& variable, const std::filesystem::path& path);

}  // namespace tegl::io_detail
