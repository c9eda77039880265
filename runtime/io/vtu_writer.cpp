// SPDX-License-Identifier: BSD-3-Clause
#include "vtu_writer.hpp"

#include <bit>

#include <fmt/format.h>

#include "common.hpp"

namespace tegl::io_detail {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

constexpr std::size_t kBlock = std::size_t{1} << 16;  ///< items between two reports

std::uint64_t byte_count(const VtuArray& array) { return array.rows * array.columns * array.bytes; }

/// The XML of arrays; `offset` goes on by what they take behind it.
std::string array_tags(const std::vector<VtuArray>& arrays, std::uint64_t& offset) {
  std::string text;
  for (const VtuArray& array : arrays) {
    text += fmt::format(R"(<DataArray type="{}" Name="{}")", array.type, array.name);
    if (array.columns > 1) text += fmt::format(R"( NumberOfComponents="{}")", array.columns);
    text += fmt::format(R"( format="appended" offset="{}"/>)", offset) + "\n";
    offset += sizeof(std::uint64_t) + byte_count(array);
  }
  return text;
}

/// Text of any kind: the bytes as numbers, 0 behind each.
std::string text_tag(const char* name, const std::vector<std::string>& texts) {
  std::string text =
      fmt::format(R"(<DataArray type="String" Name="{}" NumberOfTuples="{}" format="ascii">)", name, texts.size());
  for (const std::string& one : texts) {
    for (const char c : one) text += fmt::format("{} ", static_cast<unsigned>(static_cast<unsigned char>(c)));
    text += "0 ";
  }
  return text + "</DataArray>\n";
}

std::string header(const VtuGrid& grid) {
  std::uint64_t offset = 0;
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n<FieldData>\n";
  text += text_tag("axis_names", grid.axis_names) + text_tag("axis_units", grid.axis_units) + "</FieldData>\n";
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", grid.points, grid.cells);
  text += grid.normals.empty() ? "<PointData>\n" : fmt::format("<PointData Normals=\"{}\">\n", grid.normals);
  text += array_tags(grid.point_arrays, offset) + "</PointData>\n<CellData>\n";
  text += array_tags(grid.cell_arrays, offset) + "</CellData>\n<Points>\n";
  text += array_tags({grid.coordinates}, offset) + "</Points>\n<Cells>\n";
  text += array_tags(grid.topology, offset) + "</Cells>\n";
  return text + "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
}

}  // namespace

void write_vtu(const VtuGrid& grid, const std::filesystem::path& path, const Progress& progress) {
  std::vector<const VtuArray*> arrays;
  for (const VtuArray& array : grid.point_arrays) arrays.push_back(&array);
  for (const VtuArray& array : grid.cell_arrays) arrays.push_back(&array);
  arrays.push_back(&grid.coordinates);
  for (const VtuArray& array : grid.topology) arrays.push_back(&array);
  std::uint64_t all = 1, done = 0;
  for (const VtuArray* const array : arrays) all += byte_count(*array);

  OutputFile file(path);
  file.write(header(grid));
  for (const VtuArray* const array : arrays) {
    const std::uint64_t bytes = byte_count(*array);
    file.write(&bytes, sizeof bytes);
    ByteSink sink(file);
    for (std::size_t i = 0; i < array->items; ++i) {
      if (i % kBlock == 0) tick(progress, static_cast<double>(done + sink.bytes()) / static_cast<double>(all), path);
      array->put(sink, i);
    }
    sink.flush();
    done += bytes;
  }
  file.write("\n</AppendedData>\n</VTKFile>\n");
  tick(progress, 1.0, path);
  file.commit();
}

}  // namespace tegl::io_detail
