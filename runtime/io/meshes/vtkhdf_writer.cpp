// SPDX-License-Identifier: BSD-3-Clause
//
// Writes VTKHDF unstructured grids: triangles, segments, or tetrahedra with the time of vertices in the point array
// "t". Normals are the point array "Normals", with the fourth component in "normal_t". Attributes are point and cell
// arrays; the isovalue is a field array. All are double: lossless. For a mesh in single precision, points and normals
// are float. Axis names and units are attributes of the group; names and units of arrays are attributes of the arrays.
// VTK ignores both.
//
// Based on: Kitware, "VTKHDF File Format", version 1.0 (read by VTK 9.1 and later), unstructured grid.
#include "meshes/vtkhdf_writer.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "meshes/vtkhdf_names.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

std::string joined(const std::vector<std::string>& texts) { return fmt::format("{}", fmt::join(texts, "\n")); }

H5Handle create_root(const H5File& file, const VtkhdfLayout& layout) {
  H5Handle group = file.create_group("VTKHDF");
  constexpr std::array<std::int64_t, 2> kVersion = {1, 0};
  file.put_numbers(group.id(), "Version", kVersion);
  file.put_text(group.id(), "Type", "UnstructuredGrid");
  const std::array<std::int64_t, 2> dims = {layout.dim, layout.space_dim};
  file.put_numbers(group.id(), "tegl_dim_and_space_dim", dims);
  file.put_text(group.id(), "tegl_axis_names", joined(layout.axis_names));
  file.put_text(group.id(), "tegl_axis_units", joined(layout.axis_units));
  if (layout.isovalue || !layout.periods.empty()) {
    const H5Handle field_data = file.create_group("VTKHDF/FieldData");
    const auto put = [&](const char* name, const double* numbers, std::size_t count) {
      if (count != 0)
        file.create_table(field_data.id(), name, H5T_IEEE_F64LE, 0, count).append(H5T_NATIVE_DOUBLE, numbers, count);
    };
    if (layout.isovalue) put(kIsovalue, &*layout.isovalue, 1);
    put(kPeriods, layout.periods.data(), layout.periods.size());
  }
  return group;
}

hid_t real_type(const VtkhdfLayout& layout) { return layout.single_precision ? H5T_IEEE_F32LE : H5T_IEEE_F64LE; }

hid_t id_type(const VtkhdfLayout& layout) { return layout.narrow_ids ? H5T_STD_I32LE : H5T_STD_I64LE; }

std::set<std::string> reserved_point_names(int space_dim) {
  std::set<std::string> names = {kNormals};
  for (std::size_t i = 0; i < further_count(space_dim); ++i)
    names.insert({kFurtherCoordinates.at(i), kFurtherNormals.at(i)});
  return names;
}

}  // namespace

VtkhdfWriter::Tables::Tables(const H5File& file, hid_t group, const VtkhdfLayout& layout)
    : points(file.create_table(group, "Points", real_type(layout), 3, layout.expected_vertices, layout.compression)),
      connectivity(file.create_table(group, "Connectivity", id_type(layout), 0,
                                     layout.expected_simplices > (1u << 24)
                                         ? H5File::kUnknownRows
                                         : layout.expected_simplices * (static_cast<unsigned>(layout.dim) + 1),
                                     layout.compression)),
      offsets(file.create_table(group, "Offsets", id_type(layout), 0,
                                layout.expected_simplices + (layout.expected_simplices == H5File::kUnknownRows ? 0 : 1),
                                layout.compression)),
      types(file.create_table(group, "Types", H5T_STD_U8LE, 0, layout.expected_simplices, layout.compression)) {
  static_cast<void>(file.create_group("VTKHDF/PointData"));
}

void VtkhdfWriter::Tables::complete() {
  for (H5Table* const table : {&points, &connectivity, &offsets, &types}) table->complete();
  for (std::vector<H5Table>* const tables : {&further, &further_normals})
    for (H5Table& table : *tables) table.complete();
  if (normals) normals->complete();
}

std::vector<H5Table> VtkhdfWriter::further_tables(std::span<const char* const> names) const {
  const H5Handle point_data = file_.open_group("VTKHDF/PointData");
  std::vector<H5Table> tables;
  for (const char* const name : names.first(further_count(static_cast<int>(space_dim_))))
    tables.push_back(file_.create_table(point_data.id(), name, real_, 0, expected_vertices_, compression_));
  return tables;
}

VtkhdfWriter::VtkhdfWriter(const PendingPath& pending, const VtkhdfLayout& layout)
    : corners_(static_cast<std::uint64_t>(layout.dim) + 1),
      space_dim_(static_cast<std::size_t>(layout.space_dim)),
      expected_vertices_(layout.expected_vertices),
      compression_(layout.compression),
      real_(real_type(layout)),
      file_(H5File::create(pending.path(), pending.target())),
      group_(create_root(file_, layout)),
      point_names_(reserved_point_names(layout.space_dim)) {
  tables_.emplace(file_, group_->id(), layout);
  tables_->further = further_tables(kFurtherCoordinates);
  constexpr std::int64_t kFirst = 0;
  tables_->offsets.append(H5T_NATIVE_INT64, &kFirst, 1);
  types_.assign(kMostRows, kCellTypes[static_cast<std::size_t>(layout.dim)]);
}

void VtkhdfWriter::append_vertices(std::span<const double> coordinates) {
  append_rows(coordinates, tables_->points, tables_->further);
}

void VtkhdfWriter::append_normals(std::span<const double> normals) {
  if (!tables_->normals) {
    const H5Handle point_data = file_.open_group("VTKHDF/PointData");
    tables_->normals.emplace(file_.create_table(point_data.id(), kNormals, real_, 3, expected_vertices_, compression_));
    tables_->further_normals = further_tables(kFurtherNormals);
  }
  append_rows(normals, *tables_->normals, tables_->further_normals);
}

void VtkhdfWriter::append_rows(std::span<const double> rows, H5Table& table, std::span<H5Table> further) {
  for (std::size_t at = 0; at < rows.size();) {
    const std::size_t count = std::min(kMostRows, (rows.size() - at) / space_dim_);
    positions_.assign(3 * count, 0.0);
    for (std::size_t r = 0; r < count; ++r)
      std::copy_n(rows.data() + at + r * space_dim_, std::min<std::size_t>(3, space_dim_), positions_.data() + 3 * r);
    table.append(H5T_NATIVE_DOUBLE, positions_.data(), count);
    column_.resize(count);
    for (std::size_t i = 0; i < further.size(); ++i) {
      for (std::size_t r = 0; r < count; ++r) column_[r] = rows[at + r * space_dim_ + 3 + i];
      further[i].append(H5T_NATIVE_DOUBLE, column_.data(), count);
    }
    at += count * space_dim_;
  }
}

void VtkhdfWriter::append_ids(hid_t type, const void* ids, std::size_t count) {
  const std::uint64_t size = type == H5T_NATIVE_UINT32 ? sizeof(std::uint32_t) : sizeof(std::uint64_t);
  for (std::uint64_t at = 0; at < count;) {
    const std::uint64_t rows = std::min<std::uint64_t>(kMostRows, (count - at) / corners_);
    tables_->connectivity.append(type, static_cast<const unsigned char*>(ids) + at * size, rows * corners_);
    at += rows * corners_;
    offsets_.resize(rows);
    for (std::uint64_t r = 0; r < rows; ++r)
      offsets_[r] = static_cast<std::int64_t>((tables_->types.rows() + r + 1) * corners_);
    tables_->offsets.append(H5T_NATIVE_INT64, offsets_.data(), rows);
    tables_->types.append(H5T_NATIVE_UINT8, types_.data(), rows);
  }
}

void VtkhdfWriter::append_cells(unsigned char type, std::span<const std::uint32_t> ids,
                                std::span<const std::int64_t> ends) {
  tables_->connectivity.append(H5T_NATIVE_UINT32, ids.data(), ids.size());
  tables_->offsets.append(H5T_NATIVE_INT64, ends.data(), ends.size());
  const std::vector<unsigned char> types(ends.size(), type);
  tables_->types.append(H5T_NATIVE_UINT8, types.data(), types.size());
}

H5Table VtkhdfWriter::attribute_table(const char* group, const Attribute& attribute, std::size_t order) {
  const bool of_points = std::string_view(group) == "PointData";
  const std::string path = std::string("VTKHDF/") + group;
  const H5Handle data =
      file_.has(group_->id(), group) ? file_.open_group(path.c_str()) : file_.create_group(path.c_str());
  // HDF5 reads names with a slash as paths, and "." as the group itself.
  std::string wished = attribute.name == "." ? "_" : attribute.name;
  std::replace(wished.begin(), wished.end(), '/', '_');
  const std::string name = (of_points ? point_names_ : cell_names_).make(wished);
  const auto columns = static_cast<std::uint64_t>(attribute.width);
  H5Table table = file_.create_table(data.id(), name.c_str(), H5T_IEEE_F64LE, columns == 1 ? 0 : columns,
                                     row_count(attribute), compression_);
  const std::array<std::int64_t, 1> place = {static_cast<std::int64_t>(order)};
  file_.put_numbers(table.id(), kAttributeOrder, place);
  if (name != attribute.name) file_.put_text(table.id(), kAttributeName, attribute.name);
  if (!attribute.unit.empty()) file_.put_text(table.id(), kAttributeUnit, attribute.unit);
  return table;
}

void VtkhdfWriter::replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) {
  tables_->connectivity.replace(H5T_NATIVE_UINT64, &vertex, simplex * corners_ + static_cast<std::uint64_t>(corner), 0);
}

void VtkhdfWriter::close() {
  const auto single = [&](const char* name, std::uint64_t value) {
    file_.create_table(group_->id(), name, H5T_STD_I64LE, 0, 1).append(H5T_NATIVE_UINT64, &value, 1);
  };
  single("NumberOfPoints", tables_->points.rows());
  single("NumberOfCells", tables_->types.rows());
  single("NumberOfConnectivityIds", tables_->connectivity.rows());
  tables_->complete();
  tables_.reset();
  group_.reset();
  file_.close();
}

}  // namespace tegl::io_detail
