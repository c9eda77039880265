// SPDX-License-Identifier: BSD-3-Clause
//
// The arrays of points and cells of a file, the choice of one by its name, and its values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vtk/vtk_file.hpp"

namespace tegl::io_detail {

/// An array of a value for each point or cell. Arrays have the same names in all pieces.
struct VtkVariable {
  std::string name;
  bool on_cells = false;
  std::string_view type;
  std::uint64_t components = 1;
  /// The part of each value that is chosen: a component, or the length of the vector (none).
  std::optional<std::uint64_t> component = 0;

  /// Name of the parent element.
  [[nodiscard]] std::string_view parent() const { return on_cells ? "CellData" : "PointData"; }
};

/// The arrays of the first piece: of points, then of cells if their names differ. Arrays of numbers of points
/// and cells, and vtkGhostType, are left out.
std::vector<VtkVariable> variables_of(const VtkFile& file);

/// The arrays of the first piece whose name occurs again among the values of points, or of cells: readers take the
/// first. Each once.
std::vector<VtkVariable> repeated_variables(const VtkFile& file);
/// A remark on one of them.
std::string remark_on_repeated(const VtkVariable& variable, const std::filesystem::path& path);

/// The names of those with one component.
std::vector<std::string> scalar_names(const std::vector<VtkVariable>& all);

/// The variable named `name`, which may be NAME:K (component K of a vector) or NAME:magnitude; if it is empty, the only
/// scalar. Errors: VariableNotFound, with the names that there are; UnsupportedData if there are none.
VtkVariable choose_variable(const VtkFile& file, const std::vector<VtkVariable>& all, const std::string& name);

/// The chosen part of values with all components; `values` itself for a scalar.
ValueArray chosen_part(ValueArray&& values, const VtkVariable& variable);

/// An array without values, of the type that chosen_part returns.
ValueArray empty_values(const VtkVariable& variable);

}  // namespace tegl::io_detail
