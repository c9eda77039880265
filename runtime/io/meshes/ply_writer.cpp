// SPDX-License-Identifier: BSD-3-Clause
//
// Writes binary little-endian PLY with coordinates, normals and attributes as double: lossless. For a mesh in single
// precision, coordinates and normals are float. Segments become an `edge` element. Attributes become properties after
// the standard ones, with comments for their names and units. Colours that are multiples of 1/255 become bytes.
//
// Based on: G. Turk, "The PLY Polygon File Format", 1994.
#include "meshes/ply_writer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/block_writer.hpp"
#include "base/common.hpp"
#include "base/mesh_data.hpp"
#include "base/output_file.hpp"
#include "meshes/attributes.hpp"

namespace tegl::io_detail {

namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

/// Replaces control characters, which would end a comment early.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

/// An attribute and the names of its properties.
struct Properties {
  const Attribute* attribute;
  std::vector<std::string> names;
  bool are_bytes = false;  ///< red, green and blue, which viewers display
};

/// Chooses property names, which are single words; comments hold the attributes' names and units.
std::vector<Properties> properties_of(std::span<const Attribute> attributes, FileNames names) {
  std::vector<Properties> result;
  for (const Attribute& attribute : attributes) {
    Properties& properties = result.emplace_back(Properties{&attribute, {}, is_color_of_bytes(attribute)});
    if (properties.are_bytes) {
      for (const char* const name : {"red", "green", "blue"}) properties.names.push_back(names.make(name));
      continue;
    }
    for (int i = 0; i < attribute.width; ++i)
      properties.names.push_back(
          names.make(as_word(attribute.name) + (attribute.width > 1 ? "_" + std::to_string(i) : "")));
  }
  return result;
}

class PlyWriter {
 public:
  PlyWriter(const MeshView& mesh, OutputFile& file, const Progress& progress)
      : mesh_(mesh),
        file_(file),
        out_(file, progress),
        of_vertices_(properties_of(mesh.vertex_attributes, FileNames({"x", "y", "z", "nx", "ny", "nz"}))),
        of_simplices_(properties_of(mesh.simplex_attributes,
                                    FileNames({"vertex_indices", "vertex_index", "vertex1", "vertex2"}))) {}

  void run() {
    file_.write(header());
    out_.write_rows(vertex_count(mesh_), 0.0, 0.5, [this](std::size_t v) { put_vertex(v); });
    out_.write_rows(simplex_count(mesh_), 0.5, 1.0, [this](std::size_t s) { put_simplex(s); });
  }

 private:
  std::string header() const {
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment written by tegl\n";
    text += fmt::format("comment tegl space_dim {}\n", mesh_.space_dim);
    for (int a = 0; a < mesh_.space_dim; ++a) {
      const std::string name = one_line(axis_text(mesh_.axis_names, a));
      const std::string unit = one_line(axis_text(mesh_.axis_units, a));
      if (!name.empty()) text += fmt::format("comment tegl axis {} name {}\n", a, name);
      if (!unit.empty()) text += fmt::format("comment tegl axis {} unit {}\n", a, unit);
    }
    if (mesh_.isovalue) text += fmt::format("comment tegl isovalue {}\n", *mesh_.isovalue);
    text += comments("vertex", of_vertices_) + comments("simplex", of_simplices_);
    text += fmt::format("element vertex {}\n", vertex_count(mesh_));
    const char* const real = mesh_.single_precision ? "float" : "double";
    for (const char* const name : {"x", "y", "z"}) text += fmt::format("property {} {}\n", real, name);
    if (!mesh_.normals.empty())
      for (const char* const name : {"nx", "ny", "nz"}) text += fmt::format("property {} {}\n", real, name);
    text += declarations(of_vertices_);
    text += mesh_.dim == 1
                ? fmt::format("element edge {}\nproperty uint vertex1\nproperty uint vertex2\n", simplex_count(mesh_))
                : fmt::format("element face {}\nproperty list uchar uint vertex_indices\n", simplex_count(mesh_));
    return text + declarations(of_simplices_) + "end_header\n";
  }

  /// "comment tegl vertex attribute FIRST-PROPERTY WIDTH NAME", "comment tegl vertex unit FIRST-PROPERTY UNIT".
  static std::string comments(const char* kind, const std::vector<Properties>& all) {
    std::string text;
    for (const Properties& properties : all) {
      const Attribute& attribute = *properties.attribute;
      text += fmt::format("comment tegl {} attribute {} {} {}\n", kind, properties.names[0], attribute.width,
                          one_line(attribute.name));
      if (!attribute.unit.empty())
        text += fmt::format("comment tegl {} unit {} {}\n", kind, properties.names[0], one_line(attribute.unit));
    }
    return text;
  }

  static std::string declarations(const std::vector<Properties>& all) {
    std::string text;
    for (const Properties& properties : all)
      for (const std::string& name : properties.names)
        text += fmt::format("property {} {}\n", properties.are_bytes ? "uchar" : "double", name);
    return text;
  }

  void put_attributes(const std::vector<Properties>& all, std::size_t row) {
    for (const Properties& properties : all) {
      const auto width = static_cast<std::size_t>(properties.attribute->width);
      const double* const values = properties.attribute->values.data() + row * width;
      if (!properties.are_bytes) {
        out_.put(values, width);
        continue;
      }
      for (std::size_t i = 0; i < width; ++i) out_.put_byte(static_cast<unsigned char>(std::lround(255.0 * values[i])));
    }
  }

  void put_row(const std::array<double, 3>& row) {
    if (!mesh_.single_precision) return out_.put(row.data(), 3);
    const std::array<float, 3> single = {static_cast<float>(row[0]), static_cast<float>(row[1]),
                                         static_cast<float>(row[2])};
    out_.put(single.data(), 3);
  }

  void put_vertex(std::size_t v) {
    put_row(position(mesh_, v));
    if (!mesh_.normals.empty()) put_row(normal(mesh_, v));
    put_attributes(of_vertices_, v);
  }

  void put_simplex(std::size_t s) {
    const auto corners = static_cast<std::size_t>(mesh_.dim) + 1;
    if (mesh_.dim == 2) out_.put_byte(3);
    out_.put(mesh_.simplices.data() + s * corners, corners);
    put_attributes(of_simplices_, s);
  }

  const MeshView& mesh_;
  OutputFile& file_;
  BlockWriter out_;
  std::vector<Properties> of_vertices_, of_simplices_;
};

}  // namespace

void write_ply(const MeshView& mesh, const PendingPath& pending, const Progress& progress) {
  const std::filesystem::path& path = pending.target();
  OutputFile file(pending);
  PlyWriter(mesh, file, progress).run();
  tick(progress, 1.0, path);
  file.close();
}

}  // namespace tegl::io_detail
