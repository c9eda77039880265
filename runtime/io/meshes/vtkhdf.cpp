// SPDX-License-Identifier: BSD-3-Clause
//
// Reads and writes whole meshes as VTKHDF unstructured grids, the format of ParaView. vtkhdf_writer.cpp describes the
// layout.
//
// Based on: Kitware, "VTKHDF File Format", version 1.0 (read by VTK 9.1 and later), unstructured grid.
#include "meshes/vtkhdf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <span>

#include "base/common.hpp"
#include "base/hdf5_file.hpp"
#include "base/mesh_data.hpp"
#include "base/reading_process.hpp"
#include "meshes/vtkhdf_names.hpp"
#include "meshes/vtkhdf_writer.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> split(const std::string& text, std::size_t count) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (c == '\n')
      result.emplace_back();
    else
      result.back() += c;
  }
  result.resize(count);
  return result;
}

/// Reads simplices from cells that all have one type.
class Reader {
 public:
  Reader(const fs::path& path, ReadProgress& progress, bool allow_outside_paths)
      : path_(path), progress_(progress), file_(open_file(path, allow_outside_paths)), group_(open_root(file_, path)) {}

  Mesh run() {
    mesh_.space_dim = 3;
    read_cells();
    read_points();
    const auto dims = file_.get_numbers(group_.id(), "tegl_dim_and_space_dim");
    if (mesh_.dim == 0) mesh_.dim = !dims.empty() && dims[0] >= 1 && dims[0] <= 4 ? static_cast<int>(dims[0]) : 2;
    // Tetrahedra of other programs with a point array t are read as contours in 4-space.
    if (dims.size() == 2 && dims[1] >= 4 && dims[1] <= 5)
      add_coordinates(static_cast<int>(dims[1]));
    else if (dims.size() != 2 && mesh_.dim == 3)
      add_coordinates(4);
    if (mesh_.dim == 4 && mesh_.space_dim != 5)
      fail(ErrorCode::MalformedFile, path_, "4-simplices without the point arrays 't' and 'u'");
    read_normals();
    std::set<std::string> taken;
    if (!mesh_.normals.empty()) taken.insert(kNormals);
    for (std::size_t i = 0; i < further_count(mesh_.space_dim); ++i) {
      taken.insert(kFurtherCoordinates.at(i));
      if (!mesh_.normals.empty()) taken.insert(kFurtherNormals.at(i));
    }
    mesh_.vertex_attributes = attributes("PointData", vertex_count(mesh_), taken);
    mesh_.simplex_attributes = attributes("CellData", simplex_count(mesh_), {});
    if (dims.size() == 2 && dims[1] == 2) flatten(mesh_, path_);
    const auto n = static_cast<std::size_t>(mesh_.space_dim);
    mesh_.axis_names = split(file_.get_text(group_.id(), "tegl_axis_names"), n);
    mesh_.axis_units = split(file_.get_text(group_.id(), "tegl_axis_units"), n);
    read_isovalue();
    read_periods();
    return std::move(mesh_);
  }

 private:
  static H5File open_file(const fs::path& path, bool allow_outside_paths) {
    now_reading(path);
    return H5File::open(path, allow_outside_paths);
  }

  static H5Handle open_root(const H5File& file, const fs::path& path) {
    H5Handle group = file.open_group("VTKHDF");
    const std::string type = file.get_text(group.id(), "Type");
    if (type != "UnstructuredGrid")
      fail(ErrorCode::UnsupportedData, path, "VTKHDF of type {}; expected 'UnstructuredGrid'", shown(type));
    return group;
  }

  [[nodiscard]] std::uint64_t length(hid_t group, const char* name) const {
    const auto size = file_.sizes(group, name);
    if (size.size() != 1) fail(ErrorCode::MalformedFile, path_, "dataset '{}' of 2 dimensions; expected 1", name);
    return size[0];
  }

  /// Requests memory for `count` numbers, and for HDF5's own use.
  static void expect_numbers(std::uint64_t count) { expect_memory(3 * sizeof(double) * count); }

  /// Reads a whole dataset and reports progress.
  void read(hid_t group, const char* name, hid_t type, void* to) const {
    file_.read(group, name, type, to, [this](std::uint64_t bytes) { progress_.add(bytes); });
  }

  template <class T>
  [[nodiscard]] std::vector<T> numbers(const char* name, hid_t type) {
    file_.claim(group_.id(), name);
    const std::uint64_t count = length(group_.id(), name);
    expect_memory(3 * sizeof(T) * count);
    std::vector<T> values(static_cast<std::size_t>(count));
    if (!values.empty()) read(group_.id(), name, type, values.data());
    return values;
  }

  [[noreturn]] void refuse_cells(unsigned type) const {
    constexpr unsigned kPolygon = 7;  // as `tegl contour --facets` writes them
    const bool are_facets = type == kPolygon;
    fail(ErrorCode::UnsupportedData, path_,
         "{}cells of VTK type {}{}; expected all 3 (lines), all 5 (triangles) or all 10 (tetrahedra){}",
         are_facets ? "facets that are not triangulated: " : "", type, are_facets ? " (polygons)" : "",
         are_facets ? ", as contours without --facets have" : "");
  }

  void read_cells() {
    const auto types = numbers<unsigned char>("Types", H5T_NATIVE_UINT8);
    const auto ids = numbers<std::int64_t>("Connectivity", H5T_NATIVE_INT64);
    mesh_.dim = 0;
    const auto dims = file_.get_numbers(group_.id(), "tegl_dim_and_space_dim");
    const int most = !dims.empty() && dims[0] == 4 ? 4 : 3;  // other programs have other poly-vertex cells
    for (int dim = 1; dim <= most && !types.empty(); ++dim)
      if (types[0] == kCellTypes[static_cast<std::size_t>(dim)]) mesh_.dim = dim;
    const auto other = std::find_if(types.begin(), types.end(), [&](unsigned char t) { return t != types[0]; });
    if (!types.empty() && (mesh_.dim == 0 || other != types.end())) refuse_cells(mesh_.dim == 0 ? types[0] : *other);
    const std::size_t corners = static_cast<std::size_t>(mesh_.dim) + 1;
    if (types.empty() ? !ids.empty() : ids.size() != types.size() * corners)
      fail(ErrorCode::MalformedFile, path_, "{} vertex numbers of {} cells; expected {}", ids.size(), types.size(),
           types.size() * corners);
    const auto offsets = numbers<std::int64_t>("Offsets", H5T_NATIVE_INT64);
    for (std::size_t i = 0; i <= types.size(); ++i)
      if (offsets.size() != types.size() + 1 || offsets[i] != static_cast<std::int64_t>(i * corners))
        fail(ErrorCode::MalformedFile, path_, "{} offsets of {} cells, or not in steps of {}", offsets.size(),
             types.size(), corners);
    mesh_.simplices.resize(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] < 0 || ids[i] > std::numeric_limits<Index>::max())
        fail(ErrorCode::MalformedFile, path_, "vertex number {}; expected 0 or more, below 2^32", ids[i]);
      mesh_.simplices[i] = static_cast<Index>(ids[i]);
    }
  }

  void read_points() {
    const auto size = file_.claim(group_.id(), "Points");
    if (size.size() != 2 || size[1] != 3)
      fail(ErrorCode::MalformedFile, path_, "points of shape {}; expected rows of 3", shape_text(size));
    expect_numbers(size[0] * 3);
    mesh_.coordinates.resize(static_cast<std::size_t>(size[0] * 3));
    if (size[0] > 0) read(group_.id(), "Points", H5T_NATIVE_DOUBLE, mesh_.coordinates.data());
  }

  /// Adds the point arrays t and u as coordinates after x, y, z, if they are there.
  void add_coordinates(int space_dim) {
    if (!file_.has(group_.id(), "PointData")) return;
    const H5Handle point_data = file_.open_group("VTKHDF/PointData");
    const std::size_t vertices = mesh_.coordinates.size() / 3;
    for (std::size_t i = 0; i < further_count(space_dim); ++i) {
      const char* const name = kFurtherCoordinates.at(i);
      if (!file_.has(point_data.id(), name)) return;
      if (length(point_data.id(), name) != vertices)
        fail(ErrorCode::MalformedFile, path_, "point array '{}' of {} values; expected {}", name,
             length(point_data.id(), name), vertices);
      add_column(point_data, name, mesh_.coordinates, 3 + i);
      ++mesh_.space_dim;
    }
  }

  /// Converts rows of `width` numbers to rows of one more.
  void add_column(const H5Handle& point_data, const char* name, MeshArray<double>& rows, std::size_t width) {
    const std::size_t count = rows.size() / width;
    file_.claim(point_data.id(), name);
    expect_numbers(count + (width + 1) * count);
    std::vector<double> column(count);
    if (count > 0) read(point_data.id(), name, H5T_NATIVE_DOUBLE, column.data());
    Buffer<double> all((width + 1) * count);
    for (std::size_t v = 0; v < count; ++v) {
      std::copy_n(rows.data() + width * v, width, all.data() + (width + 1) * v);
      all[(width + 1) * v + width] = column[v];
    }
    rows = std::move(all);
  }

  /// Arrays with these names but other shapes belong to other programs and are ignored.
  void read_normals() {
    if (!file_.has(group_.id(), "PointData")) return;
    const H5Handle point_data = file_.open_group("VTKHDF/PointData");
    const auto vertices = static_cast<std::uint64_t>(vertex_count(mesh_));
    const auto has = [&](const char* name, const std::vector<std::uint64_t>& shape) {
      return file_.has(point_data.id(), name) && file_.sizes(point_data.id(), name) == shape;
    };
    if (vertices == 0 || !has(kNormals, {vertices, 3})) return;
    const auto names = std::span(kFurtherNormals).first(further_count(mesh_.space_dim));
    if (!std::ranges::all_of(names, [&](const char* name) { return has(name, {vertices}); })) return;
    file_.claim(point_data.id(), kNormals);
    expect_numbers(3 * vertices);
    mesh_.normals.resize(static_cast<std::size_t>(3 * vertices));
    read(point_data.id(), kNormals, H5T_NATIVE_DOUBLE, mesh_.normals.data());
    for (std::size_t i = 0; i < names.size(); ++i) add_column(point_data, names[i], mesh_.normals, 3 + i);
  }

  /// The finite numbers of a field array with at most `most` of them; none if there is no such array.
  [[nodiscard]] std::vector<double> field_numbers(const char* name, std::uint64_t most) const {
    if (!file_.has(group_.id(), "FieldData")) return {};
    const H5Handle field_data = file_.open_group("VTKHDF/FieldData");
    const std::vector<std::string> names = file_.number_datasets(field_data.id());
    if (std::find(names.begin(), names.end(), name) == names.end() || file_.rank(field_data.id(), name) != 1) return {};
    const std::uint64_t count = file_.sizes(field_data.id(), name)[0];
    if (count > most) return {};
    std::vector<double> numbers(static_cast<std::size_t>(count));
    if (count > 0) file_.read(field_data.id(), name, H5T_NATIVE_DOUBLE, numbers.data());
    if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) return {};
    return numbers;
  }

  /// Reads the field array `isovalue`, if it is one finite number.
  void read_isovalue() {
    if (const std::vector<double> numbers = field_numbers(kIsovalue, 1); numbers.size() == 1)
      mesh_.isovalue = numbers.front();
  }

  void read_periods() {
    const auto width = 2 * static_cast<std::size_t>(mesh_.space_dim) + 1;
    std::vector<double> numbers = field_numbers(kPeriods, width * static_cast<std::size_t>(mesh_.space_dim));
    if (numbers.size() % width != 0 || mesh_.dim + 1 != mesh_.space_dim) return;
    for (std::size_t at = 0; at < numbers.size(); at += width) {  // arrays of other programs may have the same name
      const auto vector = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      const auto dual = vector + mesh_.space_dim;
      if (std::abs(std::inner_product(vector, dual, dual, 0.0) - 1.0) > 1e-6) return;
    }
    mesh_.periods = std::move(numbers);
  }

  /// The arrays of a group with one row per vertex or simplex: first the arrays of VtkhdfWriter, in its order.
  [[nodiscard]] std::vector<Attribute> attributes(const char* group_name, std::size_t rows,
                                                  const std::set<std::string>& taken) {
    std::vector<Attribute> result;
    if (!file_.has(group_.id(), group_name)) return result;
    const H5Handle group = file_.open_group((std::string("VTKHDF/") + group_name).c_str());
    std::vector<std::pair<std::int64_t, std::string>> found;
    for (const std::string& name : file_.number_datasets(group.id())) {
      const H5Handle dataset = file_.open_dataset(group.id(), name.c_str());
      const auto order = file_.get_numbers(dataset.id(), kAttributeOrder);
      if (!taken.contains(name) && has_rows(group.id(), name.c_str(), rows))
        found.emplace_back(order.empty() ? std::numeric_limits<std::int64_t>::max() : order[0], name);
    }
    std::sort(found.begin(), found.end());
    FileNames names({});
    for (const auto& [order, name] : found) {
      const auto size = file_.claim(group.id(), name.c_str());
      const H5Handle dataset = file_.open_dataset(group.id(), name.c_str());
      const std::string own_name = file_.get_text(dataset.id(), kAttributeName);
      Attribute& attribute = result.emplace_back();
      attribute.name = names.make(own_name.empty() ? name : own_name);
      attribute.unit = file_.get_text(dataset.id(), kAttributeUnit);
      attribute.width = size.size() == 1 ? 1 : static_cast<int>(size[1]);
      expect_numbers(rows * static_cast<std::size_t>(attribute.width));
      attribute.values.resize(rows * static_cast<std::size_t>(attribute.width));
      if (rows > 0) read(group.id(), name.c_str(), H5T_NATIVE_DOUBLE, attribute.values.data());
    }
    return result;
  }

  /// Whether a dataset is a list or a table with `rows` rows.
  [[nodiscard]] bool has_rows(hid_t group, const char* name, std::size_t rows) const {
    const int rank = file_.rank(group, name);
    if (rank < 1 || rank > 2) return false;
    const auto size = file_.sizes(group, name);
    constexpr std::uint64_t kMostColumns = 1 << 16;
    return size[0] == rows && (size.size() == 1 || (size[1] > 0 && size[1] <= kMostColumns));
  }

  const fs::path& path_;
  ReadProgress& progress_;
  H5File file_;
  H5Handle group_;
  Mesh mesh_;
};

VtkhdfLayout layout_of(const MeshView& mesh, Compression compression) {
  // Offsets are at most the number of vertex numbers.
  const std::size_t largest_id = std::max(vertex_count(mesh), mesh.simplices.size());
  return {mesh.dim,
          mesh.space_dim,
          {mesh.axis_names.begin(), mesh.axis_names.end()},
          {mesh.axis_units.begin(), mesh.axis_units.end()},
          vertex_count(mesh),
          simplex_count(mesh),
          mesh.isovalue,
          mesh.single_precision,
          mesh.single_precision && largest_id <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()),
          compression,
          mesh.periods};
}

}  // namespace

void write_vtkhdf(const MeshView& mesh, const PendingPath& file, const Progress& progress, Compression compression) {
  const fs::path& path = file.target();
  VtkhdfWriter writer(file, layout_of(mesh, compression));
  // progress
  std::size_t all = mesh.coordinates.size() + mesh.normals.size() + mesh.simplices.size();
  for (const std::span<const Attribute> attributes : {mesh.vertex_attributes, mesh.simplex_attributes})
    for (const Attribute& attribute : attributes) all += attribute.values.size();
  const auto in_blocks = [&](auto values, std::size_t before, std::size_t columns, auto&& append) {
    const std::size_t most = kMostRows * columns;
    for (std::size_t at = 0; at < values.size(); at += most) {
      tick(progress, static_cast<double>(before + at) / static_cast<double>(all), path);
      append(values.subspan(at, std::min(most, values.size() - at)));
    }
  };
  // points, normals, simplices
  const auto space_dim = static_cast<std::size_t>(mesh.space_dim);
  std::vector<double> converted;
  const auto doubles = [&](auto part) -> std::span<const double> {
    if constexpr (std::is_same_v<decltype(part), std::span<const double>>) return part;
    converted.assign(part.begin(), part.end());
    return converted;
  };
  mesh.coordinates.visit([&](auto numbers) {
    in_blocks(numbers, 0, space_dim, [&](auto part) { writer.append_vertices(doubles(part)); });
  });
  mesh.normals.visit([&](auto numbers) {
    in_blocks(numbers, mesh.coordinates.size(), space_dim, [&](auto part) { writer.append_normals(doubles(part)); });
  });
  in_blocks(mesh.simplices, mesh.coordinates.size() + mesh.normals.size(), static_cast<std::size_t>(mesh.dim) + 1,
            [&](std::span<const Index> part) { writer.append_simplices(part); });
  // attributes
  std::size_t done = mesh.coordinates.size() + mesh.normals.size() + mesh.simplices.size();
  const auto append_attributes = [&](const char* group, std::span<const Attribute> attributes) {
    for (std::size_t i = 0; i < attributes.size(); ++i) {
      const auto width = static_cast<std::size_t>(attributes[i].width);
      H5Table table = writer.attribute_table(group, attributes[i], i);
      in_blocks(std::span<const double>(attributes[i].values), done, width, [&](std::span<const double> part) {
        table.append(H5T_NATIVE_DOUBLE, part.data(), part.size() / width);
      });
      done += attributes[i].values.size();
    }
  };
  append_attributes("PointData", mesh.vertex_attributes);
  append_attributes("CellData", mesh.simplex_attributes);
  tick(progress, 1.0, path);
  writer.close();
}

Mesh read_vtkhdf(const fs::path& path, ReadProgress& progress, bool allow_outside_paths) {
  const H5Quiet quiet;
  return Reader(path, progress, allow_outside_paths).run();
}

}  // namespace tegl::io_detail
