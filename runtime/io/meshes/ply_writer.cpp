// SPDX-License-Identifier: BSD-3-Clause
//
// Writes binary little-endian PLY with coordinates, normals and attributes as double: lossless. For a mesh in single
// precision, coordinates and normals are float. Segments become an `edge` element. Attributes become properties after
// the standard ones, with comments for their names and units. Colours that are multiples of 1/255 become bytes.
//
// Based on: G. Turk, "The PLY Polygon File Format", 1994.
#include "meshes/ply_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <type_traits>

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
  std::string line;  ///< the attribute's name without control characters, different from all others
  std::vector<std::string> names;
  bool are_bytes = false;  ///< red, green and blue, which viewers display
};

/// Chooses property names, which are single words; comments hold the attributes' names and units.
std::vector<Properties> properties_of(std::span<const Attribute> attributes, FileNames names) {
  std::vector<Properties> result;
  std::set<std::string> unchanged;
  for (const Attribute& attribute : attributes)
    if (one_line(attribute.name) == attribute.name) unchanged.insert(attribute.name);
  FileNames lines(unchanged);  // names that differ only in control characters stay apart
  for (const Attribute& attribute : attributes) {
    std::string line = unchanged.contains(attribute.name) ? attribute.name : lines.make(one_line(attribute.name));
    Properties& properties =
        result.emplace_back(Properties{&attribute, std::move(line), {}, is_color_of_bytes(attribute)});
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

/// Bytes of a row's attributes.
std::size_t bytes_of(const std::vector<Properties>& all) {
  std::size_t bytes = 0;
  for (const Properties& properties : all)
    bytes += properties.names.size() * (properties.are_bytes ? 1 : sizeof(double));
  return bytes;
}

/// A column of a block of rows: its place in the first row, and the distance between rows.
struct Column {
  char* to;
  std::size_t stride;
};

/// Writes rows of up to three numbers as three numbers of type To; missing ones are 0.
template <class To, class From>
void put_points(std::span<const From> numbers, std::size_t width, Column column) {
  const std::size_t rows = numbers.size() / width;
  if constexpr (std::is_same_v<To, From>) {
    if (width == 3 && column.stride == 3 * sizeof(To)) {
      std::memcpy(column.to, numbers.data(), numbers.size_bytes());
      return;
    }
  }
  for (std::size_t r = 0; r < rows; ++r, column.to += column.stride) {
    const From* const from = numbers.data() + r * width;
    const std::array<To, 3> row = {static_cast<To>(from[0]), static_cast<To>(from[1]),
                                   width > 2 ? static_cast<To>(from[2]) : To{0}};
    std::memcpy(column.to, row.data(), sizeof row);
  }
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
    const std::size_t point = 3 * (mesh_.single_precision ? sizeof(float) : sizeof(double));
    const std::size_t vertex = (mesh_.normals.empty() ? 1 : 2) * point + bytes_of(of_vertices_);
    out_.write_blocks(vertex_count(mesh_), vertex, 0.0, 0.5, [&](std::size_t begin, std::size_t end, char* to) {
      put_rows(mesh_.coordinates, begin, end, {to, vertex});
      if (!mesh_.normals.empty()) put_rows(mesh_.normals, begin, end, {to + point, vertex});
      put_attributes(of_vertices_, begin, end, {to + vertex - bytes_of(of_vertices_), vertex});
    });
    const std::size_t simplex = simplex_bytes() + bytes_of(of_simplices_);
    out_.write_blocks(simplex_count(mesh_), simplex, 0.5, 1.0, [&](std::size_t begin, std::size_t end, char* to) {
      put_simplices(begin, end, {to, simplex});
      put_attributes(of_simplices_, begin, end, {to + simplex_bytes(), simplex});
    });
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
                          properties.line);
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

  static void put_attributes(const std::vector<Properties>& all, std::size_t begin, std::size_t end, Column column) {
    for (const Properties& properties : all) {
      const std::size_t width = properties.names.size();
      char* to = column.to;
      for (std::size_t row = begin; row < end; ++row, to += column.stride) {
        const double* const values = properties.attribute->values.data() + row * width;
        if (!properties.are_bytes) {
          std::memcpy(to, values, width * sizeof(double));
          continue;
        }
        for (std::size_t i = 0; i < width; ++i)
          to[i] = static_cast<char>(static_cast<unsigned char>(std::lround(255.0 * values[i])));
      }
      column.to += width * (properties.are_bytes ? 1 : sizeof(double));
    }
  }

  void put_rows(const CoordinateView& rows, std::size_t begin, std::size_t end, Column column) const {
    const auto width = static_cast<std::size_t>(mesh_.space_dim);
    rows.visit([&](const auto& numbers) {
      const auto part = numbers.subspan(begin * width, (end - begin) * width);
      if (mesh_.single_precision)
        put_points<float>(part, width, column);
      else
        put_points<double>(part, width, column);
    });
  }

  [[nodiscard]] std::size_t simplex_bytes() const {
    const std::size_t ids = (static_cast<std::size_t>(mesh_.dim) + 1) * sizeof(Index);
    return mesh_.dim == 2 ? 1 + ids : ids;
  }

  void put_simplices(std::size_t begin, std::size_t end, Column column) const {
    const Index* const ids = mesh_.simplices.data();
    for (std::size_t s = begin; s < end; ++s, column.to += column.stride) {
      if (mesh_.dim == 2) {
        *column.to = 3;
        std::memcpy(column.to + 1, ids + 3 * s, 3 * sizeof(Index));
      } else {
        std::memcpy(column.to, ids + 2 * s, 2 * sizeof(Index));
      }
    }
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
