// SPDX-License-Identifier: BSD-3-Clause
//
// VTKHDF, unstructured grids, written: triangles, segments, or tetrahedra whose vertices carry the time as the point
// array "t". All coordinates are double: lossless. Axis names and units are attributes of the group, which VTK does not
// look at.
//
// Based on: Kitware, "VTKHDF File Format", version 1.0 (read by VTK 9.1 and later), unstructured grid.
#include "vtkhdf_writer.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "vtkhdf.hpp"

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
  return group;
}

}  // namespace

VtkhdfWriter::Tables::Tables(const H5File& file, hid_t group, const VtkhdfLayout& layout)
    : points(file.create_table(group, "Points", H5T_IEEE_F64LE, 3, layout.expected_vertices)),
      connectivity(file.create_table(group, "Connectivity", H5T_STD_I64LE, 0,
                                     layout.expected_simplices > (1u << 24)
                                         ? ~std::uint64_t{0}
                                         : layout.expected_simplices * (static_cast<unsigned>(layout.dim) + 1))),
      offsets(file.create_table(group, "Offsets", H5T_STD_I64LE, 0,
                                layout.expected_simplices + (layout.expected_simplices == ~std::uint64_t{0} ? 0 : 1))),
      types(file.create_table(group, "Types", H5T_STD_U8LE, 0, layout.expected_simplices)) {
  const H5Handle point_data = file.create_group("VTKHDF/PointData");
  if (layout.space_dim == 4)
    times.emplace(file.create_table(point_data.id(), "t", H5T_IEEE_F64LE, 0, layout.expected_vertices));
}

VtkhdfWriter::VtkhdfWriter(const fs::path& target, const VtkhdfLayout& layout)
    : pending_(target),
      corners_(static_cast<std::uint64_t>(layout.dim) + 1),
      space_dim_(static_cast<std::size_t>(layout.space_dim)),
      file_(H5File::create(pending_.path(), target)),
      group_(create_root(file_, layout)) {
  tables_.emplace(file_, group_->id(), layout);
  constexpr std::int64_t kFirst = 0;
  tables_->offsets.append(H5T_NATIVE_INT64, &kFirst, 1);
  types_.assign(kMostRows, kCellTypes[static_cast<std::size_t>(layout.dim)]);
}

void VtkhdfWriter::append_vertices(std::span<const double> coordinates) {
  for (std::size_t at = 0; at < coordinates.size();) {
    const std::size_t rows = std::min(kMostRows, (coordinates.size() - at) / space_dim_);
    positions_.assign(3 * rows, 0.0);
    times_.resize(tables_->times ? rows : 0);
    for (std::size_t r = 0; r < rows; ++r, at += space_dim_) {
      std::copy_n(coordinates.data() + at, std::min<std::size_t>(3, space_dim_), positions_.data() + 3 * r);
      if (tables_->times) times_[r] = coordinates[at + 3];
    }
    tables_->points.append(H5T_NATIVE_DOUBLE, positions_.data(), rows);
    if (tables_->times) tables_->times->append(H5T_NATIVE_DOUBLE, times_.data(), rows);
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

void VtkhdfWriter::replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) {
  tables_->connectivity.replace(H5T_NATIVE_UINT64, &vertex, simplex * corners_ + static_cast<std::uint64_t>(corner), 0);
}

void VtkhdfWriter::commit() {
  const auto single = [&](const char* name, std::uint64_t value) {
    file_.create_table(group_->id(), name, H5T_STD_I64LE, 0, 1).append(H5T_NATIVE_UINT64, &value, 1);
  };
  single("NumberOfPoints", tables_->points.rows());
  single("NumberOfCells", tables_->types.rows());
  single("NumberOfConnectivityIds", tables_->connectivity.rows());
  tables_.reset();
  group_.reset();
  file_.close();
  pending_.commit();
}

}  // namespace tegl::io_detail
