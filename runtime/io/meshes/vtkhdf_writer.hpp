// SPDX-License-Identifier: BSD-3-Clause
//
// Writes a VTKHDF file incrementally: vertices and simplices are appended in parts of any size.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/hdf5_file.hpp"
#include "base/pending_path.hpp"
#include "meshes/attributes.hpp"
#include "tegl/io/write_options.hpp"

namespace tegl::io_detail {

/// Metadata of a file, and the expected numbers of vertices and simplices (other numbers are allowed).
struct VtkhdfLayout {
  int dim = 2;        ///< dimension of the simplices, 1 to 4
  int space_dim = 3;  ///< 2 to 5; the coordinates after x, y, z go to the point arrays "t" and "u"
  std::vector<std::string> axis_names;
  std::vector<std::string> axis_units;
  std::uint64_t expected_vertices = H5File::kUnknownRows;
  std::uint64_t expected_simplices = H5File::kUnknownRows;
  std::optional<double> isovalue;  ///< written to the field array "isovalue"
  bool single_precision = false;   ///< points, times and normals are float
  bool narrow_ids = false;         ///< vertex numbers and offsets are int32; all must fit
  Compression compression = Compression::none;
  std::vector<double> periods = {};  ///< Mesh::periods; written to the field array "periods"
};

/// Writes to the temporary file of a PendingPath. Errors: WriteFailed, naming the target. Memory: a few MiB.
class VtkhdfWriter {
 public:
  VtkhdfWriter(const PendingPath& pending, const VtkhdfLayout& layout);

  /// `coordinates`: rows of space_dim numbers.
  void append_vertices(std::span<const double> coordinates);
  /// Appends normals, in the order of the vertices: for all vertices or for none.
  void append_normals(std::span<const double> normals);
  /// `ids`: rows of dim + 1 vertex numbers; vertices may be appended later.
  void append_simplices(std::span<const std::uint32_t> ids) { append_ids(H5T_NATIVE_UINT32, ids.data(), ids.size()); }
  void append_simplices(std::span<const std::uint64_t> ids) { append_ids(H5T_NATIVE_UINT64, ids.data(), ids.size()); }
  /// Appends cells of one VTK type with any numbers of vertices, instead of simplices. `ends`: end of each cell's ids,
  /// counted from the first id in the file.
  void append_cells(unsigned char type, std::span<const std::uint32_t> ids, std::span<const std::int64_t> ends);
  /// Creates the table of an attribute. `group`: "PointData" or "CellData"; `order`: its index in that group. Append
  /// one row per vertex or simplex, and destroy the table before close().
  H5Table attribute_table(const char* group, const Attribute& attribute, std::size_t order);
  /// Replaces one vertex of a simplex that was appended before.
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex);
  /// Completes and closes the file. The caller commits the PendingPath.
  void close();

 private:
  /// The datasets; they must be closed before the file.
  struct Tables {
    Tables(const H5File& file, hid_t group, const VtkhdfLayout& layout);
    /// Creates the datasets whose numbers of rows were unknown until now.
    void complete();
    H5Table points, connectivity, offsets, types;
    std::vector<H5Table> further;  ///< coordinates after x, y, z
    std::optional<H5Table> normals;
    std::vector<H5Table> further_normals;
  };
  /// Splits rows of space_dim numbers: three columns to `table`, each other one to one of `further`.
  void append_rows(std::span<const double> rows, H5Table& table, std::span<H5Table> further);
  /// Tables of single numbers of the vertices, for the coordinates after x, y, z.
  [[nodiscard]] std::vector<H5Table> further_tables(std::span<const char* const> names) const;
  void append_ids(hid_t type, const void* ids, std::size_t count);

  H5Quiet quiet_;
  std::uint64_t corners_;
  std::size_t space_dim_;
  std::uint64_t expected_vertices_;
  Compression compression_;
  hid_t real_;  ///< HDF5 type of coordinates and normals in the file
  H5File file_;
  std::optional<H5Handle> group_;
  std::optional<Tables> tables_;
  std::vector<double> positions_, column_;
  std::vector<std::int64_t> offsets_;
  std::vector<unsigned char> types_;
  FileNames point_names_{{}};
  FileNames cell_names_{{}};
};

}  // namespace tegl::io_detail
