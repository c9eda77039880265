// SPDX-License-Identifier: BSD-3-Clause
//
// Describes saved contours.
#include "commands/contour_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

#include "base/numbers.hpp"

namespace tegl::cli {

namespace {

/// The range of finite numbers, and how many are not finite.
struct FiniteRange {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  std::size_t missing = 0;

  void add(double x) {
    if (!std::isfinite(x)) {
      ++missing;
      return;
    }
    min = std::min(min, x);
    max = std::max(max, x);
  }
  [[nodiscard]] bool is_empty() const { return min > max; }
  [[nodiscard]] std::string text() const {
    return is_empty() ? "no numbers" : fmt::format("{} .. {}", number(min), number(max));
  }
};

FiniteRange finite_range(const Attribute& attribute) {
  FiniteRange range;
  for (const double x : attribute.values) range.add(x);
  return range;
}

FiniteRange finite_range(const Mesh& mesh, std::size_t axis) {
  FiniteRange range;
  for (std::size_t i = axis; i < mesh.coordinates.size(); i += static_cast<std::size_t>(mesh.space_dim))
    range.add(mesh.coordinates[i]);
  return range;
}

/// The dimension of the space. Some formats return segments of a planar mesh with a third coordinate, 0.
int dimension_of(const Mesh& mesh) {
  if (mesh.dim != 1 || mesh.space_dim != 3) return mesh.space_dim;
  const FiniteRange z = finite_range(mesh, 2);
  return z.is_empty() || (z.min == 0.0 && z.max == 0.0) ? 2 : 3;
}

std::string name_of_axis(const Mesh& mesh, std::size_t axis) {
  return axis_label(axis < mesh.axis_names.size() ? mesh.axis_names[axis] : "", axis);
}

std::string unit_of_axis(const Mesh& mesh, std::size_t axis) {
  return axis < mesh.axis_units.size() ? mesh.axis_units[axis] : "";
}

std::string format_of(const std::filesystem::path& file) {
  std::string name = file.extension().string().substr(1);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
  return name == "GLTF" || name == "GLB" ? "glTF" : name;
}

std::string text_of(const Attribute& attribute, bool of_vertices) {
  const FiniteRange range = finite_range(attribute);
  return fmt::format("{}{}, {}{}{}", of_vertices ? "of vertices" : "of simplices",
                     attribute.width == 1 ? "" : fmt::format(", {} components", attribute.width), range.text(),
                     attribute.unit.empty() ? "" : " " + attribute.unit,
                     range.missing == 0 ? "" : fmt::format(", {} missing", grouped(range.missing)));
}

Json json_of(const Attribute& attribute, bool of_vertices) {
  const FiniteRange range = finite_range(attribute);
  return {{"name", attribute.name},
          {"unit", attribute.unit},
          {"on", of_vertices ? "vertices" : "simplices"},
          {"components", attribute.width},
          {"missing", range.missing},
          {"min", range.is_empty() ? Json(nullptr) : Json(range.min)},
          {"max", range.is_empty() ? Json(nullptr) : Json(range.max)}};
}

/// The vectors of the periods.
std::vector<std::vector<double>> period_vectors(const Mesh& mesh) {
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  std::vector<std::vector<double>> vectors;
  for (std::size_t i = 0; i + 2 * n + 1 <= mesh.periods.size(); i += 2 * n + 1)
    vectors.emplace_back(mesh.periods.begin() + static_cast<std::ptrdiff_t>(i),
                         mesh.periods.begin() + static_cast<std::ptrdiff_t>(i + n));
  return vectors;
}

}  // namespace

std::string contour_text(const Console& console, const Mesh& mesh, const std::string& file) {
  const MeshSize size = size_of(mesh);
  const int dim = dimension_of(mesh);
  std::string text =
      fmt::format("{}\n", console.bold(fmt::format("{}: a contour in {}D, {}", file, dim, format_of(file))));
  if (mesh.isovalue) text += report_line("isovalue", number(*mesh.isovalue));
  text += report_line("size", fmt::format("{}, {}", counted(size.vertices, "vertex", "vertices"),
                                          counted_simplices(size.dim, size.simplices)));
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
    const std::string unit = unit_of_axis(mesh, a);
    text += report_line(name_of_axis(mesh, a), finite_range(mesh, a).text() + (unit.empty() ? "" : " " + unit));
  }
  for (const std::vector<double>& vector : period_vectors(mesh)) {
    std::string numbers;
    for (const double x : vector) numbers += (numbers.empty() ? "" : ", ") + number(x);
    text += report_line("period", numbers);
  }
  text += report_line("precision", mesh.single_precision ? "single" : "double");
  text += report_line("normals", mesh.normals.empty() ? "none" : "at the vertices");
  if (!mesh.vertex_attributes.empty() || !mesh.simplex_attributes.empty())
    text += fmt::format("\n{}\n", console.bold("Attributes"));
  for (const Attribute& one : mesh.vertex_attributes) text += report_line(one.name, text_of(one, true));
  for (const Attribute& one : mesh.simplex_attributes) text += report_line(one.name, text_of(one, false));
  return text;
}

Json contour_json(const Mesh& mesh, const InputFiles& input) {
  const MeshSize size = size_of(mesh);
  const int dim = dimension_of(mesh);
  Json json;
  json["input"] = input.json();
  json["format"] = format_of(input.names.front());
  json["type"] = "contour";
  json["image_dim"] = dim;
  json["dim"] = size.dim;
  json["vertices"] = size.vertices;
  json["simplices"] = size.simplices;
  json["isovalue"] = mesh.isovalue ? Json(*mesh.isovalue) : Json(nullptr);
  Json& axes = json["axes"] = Json::array();
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
    const FiniteRange range = finite_range(mesh, a);
    axes.push_back({{"name", name_of_axis(mesh, a)},
                    {"unit", unit_of_axis(mesh, a)},
                    {"min", range.is_empty() ? Json(nullptr) : Json(range.min)},
                    {"max", range.is_empty() ? Json(nullptr) : Json(range.max)}});
  }
  json["periods"] = period_vectors(mesh);
  json["precision"] = mesh.single_precision ? "single" : "double";
  json["normals"] = !mesh.normals.empty();
  Json& attributes = json["attributes"] = Json::array();
  for (const Attribute& one : mesh.vertex_attributes) attributes.push_back(json_of(one, true));
  for (const Attribute& one : mesh.simplex_attributes) attributes.push_back(json_of(one, false));
  return json;
}

}  // namespace tegl::cli
