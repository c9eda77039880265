// SPDX-License-Identifier: BSD-3-Clause
//
// Lists and chooses arrays of points and cells.
#include "vtk/vtk_variables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/ranges.h>

#include "base/common.hpp"
#include "base/raw_image.hpp"

namespace tegl::io_detail {

namespace {

/// Whether an array numbers or marks points or cells.
bool is_bookkeeping(const XmlElement& parent, const std::string& name) {
  constexpr std::array<std::string_view, 5> kNames = {"vtkGhostType", "vtkOriginalPointIds", "vtkOriginalCellIds",
                                                      "GlobalNodeId", "GlobalElementId"};
  return name.empty() || std::find(kNames.begin(), kNames.end(), name) != kNames.end() ||
         parent.attribute("GlobalIds") == name || parent.attribute("PedigreeIds") == name;
}

std::string listed(const std::vector<VtkVariable>& all) {
  std::vector<std::string> names;
  for (const VtkVariable& one : all)
    names.push_back(one.components == 1 ? fmt::format("'{}'", one.name)
                                        : fmt::format("'{}' of {} components", one.name, one.components));
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<VtkVariable> variables_of(const VtkFile& file) {
  std::vector<VtkVariable> all;
  const XmlElement& piece = *file.pieces().front();
  for (const bool on_cells : {false, true}) {
    const XmlElement* const parent = piece.child(on_cells ? "CellData" : "PointData");
    for (const VtkArray& array : file.arrays(parent)) {
      const bool is_known =
          std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == array.name; });
      if (is_known || is_bookkeeping(*parent, array.name)) continue;
      all.push_back({array.name, on_cells, array.type, array.components});
    }
  }
  return all;
}

std::vector<VtkVariable> repeated_variables(const VtkFile& file) {
  std::vector<VtkVariable> repeated;
  const XmlElement& piece = *file.pieces().front();
  for (const bool on_cells : {false, true}) {
    std::map<std::string, int> counts;
    const XmlElement* const parent = piece.child(on_cells ? "CellData" : "PointData");
    for (const VtkArray& array : file.arrays(parent))
      if (!is_bookkeeping(*parent, array.name) && ++counts[array.name] == 2)
        repeated.push_back({array.name, on_cells, array.type, array.components});
  }
  return repeated;
}

std::string remark_on_repeated(const VtkVariable& variable, const std::filesystem::path& path) {
  return fmt::format("{} has several arrays '{}' of {}; the first is taken", path.string(), variable.name,
                     variable.on_cells ? "cells" : "points");
}

std::vector<std::string> scalar_names(const std::vector<VtkVariable>& all) {
  std::vector<std::string> names;
  for (const VtkVariable& one : all)
    if (one.components == 1) names.push_back(one.name);
  return names;
}

VtkVariable choose_variable(const VtkFile& file, const std::vector<VtkVariable>& all, const std::string& name) {
  if (name.empty()) {
    const auto is_scalar = [](const VtkVariable& one) { return one.components == 1; };
    const auto first = std::find_if(all.begin(), all.end(), is_scalar);
    if (first != all.end() && std::count_if(all.begin(), all.end(), is_scalar) == 1) return *first;
    if (all.empty())
      fail(ErrorCode::UnsupportedData, file.path(), "has no arrays; expected one with values of points or cells");
    fail(ErrorCode::VariableNotFound, file.path(), "has the arrays {}; expected one with one component, or a choice{}",
         listed(all), first == all.end() ? ", such as NAME:0 or NAME:magnitude" : "");
  }
  for (const VtkVariable& one : all) {
    if (one.name == name && one.components == 1) return one;
    if (one.name == name)
      fail(ErrorCode::UnsupportedData, file.path(),
           "array '{0}' has {1} components; expected one number: choose '{0}:0' to '{0}:{2}' or '{0}:magnitude'", name,
           one.components, one.components - 1);
  }
  // NAME:K, NAME:magnitude
  const std::size_t colon = name.rfind(':');
  for (VtkVariable one : all) {
    if (colon == std::string::npos || one.name != name.substr(0, colon)) continue;
    const std::string part = name.substr(colon + 1);
    std::uint64_t component = 0;
    if (part == "magnitude")
      one.component.reset();
    else if (parse_number(part, component) && component < one.components)
      one.component = component;
    else
      fail(ErrorCode::VariableNotFound, file.path(), "array '{}' has no component '{}'; expected 0 to {}, or magnitude",
           one.name, part, one.components - 1);
    return one;
  }
  fail(ErrorCode::VariableNotFound, file.path(), "has no array '{}'; it has {}", name, listed(all));
}

ValueArray chosen_part(ValueArray&& values, const VtkVariable& variable) {
  if (variable.components == 1 && variable.component) return std::move(values);
  const auto width = static_cast<std::size_t>(variable.components);
  return std::visit(
      [&]<class T>(const ValueVector<T>& all) -> ValueArray {
        const std::size_t count = all.size() / width;
        if (variable.component) {
          ValueVector<T> part(count);
          for (std::size_t i = 0; i < count; ++i) part[i] = all[i * width + *variable.component];
          return part;
        }
        ValueVector<double> lengths(count);
        for (std::size_t i = 0; i < count; ++i) {
          double sum = 0;
          for (std::size_t c = 0; c < width; ++c)
            sum += static_cast<double>(all[i * width + c]) * static_cast<double>(all[i * width + c]);
          lengths[i] = std::sqrt(sum);
        }
        return lengths;
      },
      values);
}

ValueArray empty_values(const VtkVariable& variable) { return chosen_part(array_of_type(variable.type), variable); }

}  // namespace tegl::io_detail
