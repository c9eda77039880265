// SPDX-License-Identifier: BSD-3-Clause
//
// Points and cells of a file, as stored: all types of cells, in one list.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tegl/complex.hpp"
#include "vtk/vtk_file.hpp"

namespace tegl::io_detail {

struct StoredCells {
  std::vector<double> points;                  ///< #P x 3
  std::vector<std::uint8_t> types;             ///< #C, VTK's numbers
  std::vector<std::uint64_t> ends;             ///< #C, end of each cell in `corners`
  std::vector<std::int64_t> corners;           ///< numbers of points, below #P
  std::vector<std::int64_t> face_corners;      ///< of the faces of polyhedra, numbers of points
  std::vector<std::uint64_t> face_ends;        ///< by face: its end in `face_corners`
  std::vector<std::uint64_t> face_lists_ends;  ///< #C, end of each cell's faces in `face_ends`
  std::vector<Index> same_point;               ///< #P: the point of an earlier piece at the same place, or itself
  std::vector<bool> is_hidden;                 ///< #C: hidden or a duplicate by vtkGhostType; may be empty
  std::vector<std::uint64_t> piece_ends;       ///< end of each piece's cells; of a StructuredGrid empty
  [[nodiscard]] std::uint64_t point_count() const { return points.size() / 3; }
};

/// Reads the cells of an UnstructuredGrid or StructuredGrid. Errors: UnsupportedData for another type of data;
/// MalformedFile.
StoredCells read_cells(const VtkFile& file, const Progress& progress);

/// Reads an array of points or cells, in the order of read_cells.
ValueArray read_cell_values(const VtkFile& file, std::string_view parent, const std::string& name,
                            std::uint64_t components, const Progress& progress);

/// The dimension of a type of VTK, or -1 if it is unknown.
int dimension_of(std::uint8_t type);
/// Its name, such as "polyhedron".
std::string_view name_of_type(std::uint8_t type);

}  // namespace tegl::io_detail
