// SPDX-License-Identifier: BSD-3-Clause
//
// A VTKHDF file that grows: vertices and simplices are appended in parts of any size.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/hdf5_file.hpp"
#include "base/output_file.hpp"
#include "meshes/attributes.hpp"

namespace tegl::io_detail {

/// What a file says beyond vertices and simplices, and how many of them to expect (any number may come).
struct VtkhdfLayout {
  int dim = 2;        ///< of the simplices, 1 to 3
  int space_dim = 3;  ///< 2 to 4; 4: the last coordinate goes to the point array "t"
  std::vector<std::string> axis_names;
  std::vector<std::string> axis_units;
  std::uint64_t expected_vertices = ~std::uint64_t{0};
  std::uint64_t expected_simplices = ~std::uint64_t{0};
  std::optional<double> isovalue;  ///< to the field array "isovalue"
  bool single_precision = false;   ///< points, times and normals are float
  bool narrow_ids = false;         ///< vertex numbers and offsets are int32: only if all of them fit
  Compression compression = Compression::none;
};

/// Nothing is at the target before commit(). Errors: WriteFailed, naming the target. Memory: a few MiB.
class VtkhdfWriter {
 public:
  VtkhdfWriter(const std::filesystem::path& target, const VtkhdfLayout& layout);

  /// `coordinates`: rows of space_dim.
  void append_vertices(std::span<const double> coordinates);
  /// Of all vertices or of none, in their order.
  void append_normals(std::span<const double> normals);
  /// `ids`: rows of dim + 1 vertex numbers; the vertices may come later.
  void append_simplices(std::span<const std::uint32_t> ids) { append_ids(H5T_NATIVE_UINT32, ids.data(), ids.size()); }
  void append_simplices(std::span<const std::uint64_t> ids) { append_ids(H5T_NATIVE_UINT64, ids.data(), ids.size()); }
  /// Other cells, of any number of vertices, instead of simplices: all of one VTK type. `ends`: where the ids of each
  /// end, counted from the first of the file on.
  void append_cells(unsigned char type, std::span<const std::uint32_t> ids, std::span<const std::int64_t> ends);
  /// `group`: "PointData" or "CellData"; `order`: the place among the attributes of that group. To be filled by
  /// `append` of as many rows as vertices or simplices, and gone before commit().
  H5Table attribute_table(const char* group, const Attribute& attribute, std::size_t order);
  /// Another vertex for one corner of a simplex that was appended.
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex);
  /// Completes the file and moves it to the target.
  void commit();

 private:
  /// The datasets, which have to be closed before the file is.
  struct Tables {
    Tables(const H5File& file, hid_t group, const VtkhdfLayout& layout);
    H5Table points, connectivity, offsets, types;
    std::optional<H5Table> times;
    std::optional<H5Table> normals, normal_times;
  };
  /// Rows of space_dim: three columns go to one table, the fourth to another. `fourth` may be null for fewer.
  void append_rows(std::span<const double> rows, H5Table& table, H5Table* fourth);
  void append_ids(hid_t type, const void* ids, std::size_t count);

  H5Quiet quiet_;
  PendingPath pending_;
  std::uint64_t corners_;
  std::size_t space_dim_;
  std::uint64_t expected_vertices_;
  Compression compression_;
  hid_t real_;  ///< the file's type of coordinates and normals
  H5File file_;
  std::optional<H5Handle> group_;
  std::optional<Tables> tables_;
  std::vector<double> positions_, times_;
  std::vector<std::int64_t> offsets_;
  std::vector<unsigned char> types_;
  FileNames point_names_{{}};
  FileNames cell_names_{{}};
};

}  // namespace tegl::io_detail
