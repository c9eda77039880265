// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes of cells in VTK's XML files, with values at their points: .vtu, .vts, and series of them over time (.pvd); and
// tables of scattered points (.csv), whose cells are those of the Delaunay triangulation.
// Link with tegl::io; the rules for threads in tegl/io.hpp apply.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tegl/complex.hpp"
#include "tegl/io/series.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// A mesh of cells with one array of values at its points, at one or several times.
struct CellMesh {
  int dim = 3;                       ///< of the cells, and number of coordinates: 2 or 3; tables: or 4
  std::vector<double> points = {};   ///< #P x dim, or #T x #P x dim if the points move
  bool points_move = false;          ///< whether the points differ between times
  std::vector<CellType> types = {};  ///< one per cell
  std::vector<Index> corners = {};   ///< the corners of all cells, one cell after the other
  /// With polygons or polyhedra: `ends`, `face_corners`, `face_ends` and `face_lists_ends` of CellLists. Otherwise
  /// empty.
  std::vector<std::uint64_t> ends = {};
  std::vector<Index> face_corners = {};             ///< see `ends`
  std::vector<std::uint64_t> face_ends = {};        ///< see `ends`
  std::vector<std::uint64_t> face_lists_ends = {};  ///< see `ends`
  std::vector<double> times = {};                   ///< #T ascending times; empty for one file that is not in a series
  std::vector<double> values = {};                  ///< max(1, #T) x #P; NaN: missing
  std::string variable = {};                        ///< name of the values
  std::vector<std::string> axis_names = {};         ///< of the coordinates: x, y, z, or as in the table
  std::vector<std::string> remarks = {};            ///< cells left out, values of which one is taken, extensions
  std::vector<std::filesystem::path> files = {};    ///< in the order of the times
};

/// Options of read_cell_mesh.
struct CellMeshOptions {
  /// The array; NAME:K is component K of a vector and NAME:magnitude its length. Empty: the only one of one component.
  /// Tables: the column.
  std::string variable = {};
  /// Values of cells become values of points: the mean of the cells at the point, as by vtkCellDataToPointData. An
  /// error for values of points.
  bool cells_to_points = false;
  /// One per mesh, in the order of the list; empty: those in the files, else 0, 1, 2, ... For several meshes only.
  std::vector<double> times = {};
  std::optional<double> time_step = {};  ///< in place of times: 0, this, twice this, ... in the order of the files
  /// Order of several files, also of those that a .pvd file names. Given times stay with their files; by `coordinate`,
  /// files have the order of the given times or of their own. In the resulting order, times must ascend.
  SeriesOrder order = SeriesOrder::given;
  bool allow_outside_paths = false;  ///< a .pvd file may name files outside of its folder
  WorkOptions work = {};             ///< progress; files are read by one thread
};

/// Whether a file is a mesh of cells: by extension (.vtu, .vts, .csv); a .pvd file by the files that it names. Errors:
/// those of reading a .pvd file.
[[nodiscard]] bool is_cell_mesh_file(const std::filesystem::path& path, bool allow_outside_paths = false);

/// Reads a mesh, or several files as one mesh over time. A .pvd file must be the only one.
///
/// Cells: those of CellType in 2D or 3D, pentagonal and hexagonal prisms (as polyhedra), triangle strips (as
/// triangles). Polygons of more than 32 corners become triangles and must be convex. If there are 3D cells, others are
/// left out; so are vertices and lines. Structured grids become quadrilaterals or hexahedra. 2D meshes must lie in a
/// plane across an axis, whose coordinate is dropped. Cells that are hidden or duplicates by vtkGhostType are left out.
/// Points of several pieces at one place become one.
///
/// Tables: a row for each point, with fields separated by commas, semicolons, tabs or blanks; lines that start with '#'
/// are comments. With a first line of names, the columns x, y, z and t (or time) are the coordinates; without columns
/// x and y, and without names, the chosen or the last column has the values, and all others are coordinates: 2 to 4. A
/// value that is empty or "nan" is missing.
///
/// Errors, naming the file (and of a table the line): FileNotFound; MalformedFile (damaged, or numbers that contradict
/// each other; two equal points of a table, two columns of the name of a coordinate or of the chosen one);
/// UnsupportedFormat (a compressor other than zlib; parallel files, which name others); UnsupportedData (curved cells
/// and other types; no cells of 2 or 3 dimensions; repeated cells; values of cells without cells_to_points; files of a
/// series that do not match); VariableNotFound; InvalidArgument (times; values of points); TooLarge; Cancelled.
[[nodiscard]] CellMesh read_cell_mesh(std::span<const std::filesystem::path> files,
                                      const CellMeshOptions& options = {});

/// A complex of 2, 3 or 4 dimensions.
using AnyComplex = std::variant<Complex<2>, Complex<3>, Complex<4>>;

/// The mesh as a complex; with two times or more, in space and time. Errors: those of Complex and in_time.
[[nodiscard]] AnyComplex to_complex(const CellMesh& mesh);

/// An array of a file.
struct CellMeshArray {
  std::string name = {};      ///< its name
  bool on_cells = false;      ///< values of cells, not of points
  int components = 1;         ///< numbers for each point or cell
  std::string type = {};      ///< "float", "int32", ...
  std::uint64_t missing = 0;  ///< how many numbers are NaN
  double min = 0;             ///< smallest number; NaN if there is none
  double max = 0;             ///< largest number; NaN if there is none
};

/// The contents of a file.
struct CellMeshInfo {
  std::string type = {};     ///< "UnstructuredGrid", "StructuredGrid", "table of points"
  std::uint64_t points = 0;  ///< number of points
  std::vector<std::pair<std::string, std::uint64_t>> cells = {};  ///< number of cells by the name of their type
  std::vector<std::string> axis_names = {};                       ///< x, y, z; of a table, its coordinates
  std::vector<std::array<double, 2>> bounds = {};                 ///< of the points, by axis
  std::vector<CellMeshArray> arrays = {};                         ///< of points, then of cells
  std::vector<double> times = {};                                 ///< of a .pvd file
  std::vector<std::string> remarks = {};                          ///< other extensions, equal arrays or cells
};

/// Describes a file; of a .pvd file, its first one. Reads all its arrays. Errors: those of read_cell_mesh.
[[nodiscard]] CellMeshInfo describe_cell_mesh(const std::filesystem::path& path, const CellMeshOptions& options = {});

}  // namespace tegl
