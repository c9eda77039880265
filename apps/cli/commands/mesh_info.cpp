// SPDX-License-Identifier: BSD-3-Clause
//
// Describes meshes of cells.
#include "commands/mesh_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/numbers.hpp"

namespace tegl::cli {

namespace {

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::string mesh_text(const Console& console, const CellMeshInfo& info, const std::string& file) {
  std::string text = fmt::format("{}\n", console.bold(fmt::format("{}: {}", file, info.type)));
  text += report_line("points", grouped(info.points));
  for (std::size_t a = 0; a < info.bounds.size(); ++a)
    text +=
        report_line(info.axis_names[a], fmt::format("{} .. {}", number(info.bounds[a][0]), number(info.bounds[a][1])));
  bool is_first = true;
  for (const auto& [name, count] : info.cells) {
    text += report_line(is_first ? "cells" : "", fmt::format("{} {}", grouped(count), name));
    is_first = false;
  }
  if (!info.times.empty())
    text += report_line(
        "times", fmt::format("{}: {} .. {}", info.times.size(), number(info.times.front()), number(info.times.back())));
  if (!info.arrays.empty())
    text +=
        fmt::format("\n{}\n", console.bold(info.times.empty() ? "Arrays (choose one with --var)"
                                                              : "Arrays of the first file (choose one with --var)"));
  for (const CellMeshArray& array : info.arrays)
    text += report_line(array.name,
                        fmt::format("{}{}{}, {} .. {}{}", array.type,
                                    array.components == 1 ? "" : fmt::format(", {} components", array.components),
                                    array.on_cells ? ", values of cells" : "", number(array.min), number(array.max),
                                    array.missing == 0 ? "" : fmt::format(", {} missing", grouped(array.missing))));
  return text;
}

Json mesh_json(const CellMeshInfo& info, const InputFiles& input) {
  Json json;
  json["input"] = input.json();
  json["format"] = info.type == "table of points" ? "CSV" : "VTK";
  json["type"] = info.type;
  json["points"] = info.points;
  Json& bounds = json["bounds"] = Json::array();
  for (const auto& [least, most] : info.bounds) bounds.push_back({number_or_null(least), number_or_null(most)});
  Json& cells = json["cells"] = Json::object();
  for (const auto& [name, count] : info.cells) cells[name] = count;
  Json& arrays = json["arrays"] = Json::array();
  for (const CellMeshArray& array : info.arrays)
    arrays.push_back({{"name", array.name},
                      {"on", array.on_cells ? "cells" : "points"},
                      {"components", array.components},
                      {"type", array.type},
                      {"missing", array.missing},
                      {"min", number_or_null(array.min)},
                      {"max", number_or_null(array.max)}});
  json["times"] = info.times;
  return json;
}

}  // namespace tegl::cli
