// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays of structured data (images, rectilinear and curvilinear grids), which may be in several pieces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vtk/vtk_file.hpp"

namespace tegl::io_detail {

/// A range of points in index space, ends included.
struct VtkExtent {
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 3> last{};

  /// Number of points, or of cells, along each axis. An axis with one point counts as one cell.
  [[nodiscard]] std::array<std::uint64_t, 3> sizes(bool of_cells) const;
  bool operator==(const VtkExtent&) const = default;
};

/// Parses an attribute of six numbers. Errors: MalformedFile (also if the extent is empty, or too large to count).
VtkExtent read_extent(const VtkFile& file, const XmlElement& element, std::string_view key);

/// The whole extent of a file.
VtkExtent whole_extent(const VtkFile& file);

/// Reads an array of all pieces and places it in the whole extent, axis 0 fastest. `parent` and `name` as for
/// VtkFile::array. Errors: MalformedFile, also for pieces that do not cover the whole extent.
ValueArray read_structured(const VtkFile& file, std::string_view parent, const std::string& name,
                           std::uint64_t components, bool of_cells, const Progress& progress);

/// The array vtkGhostType of a piece's cells or points, if it has one. Errors: MalformedFile for an array of several
/// components, or of real numbers.
std::optional<VtkArray> ghosts_of(const VtkFile& file, const XmlElement& piece, bool of_cells);

/// Whether a value of vtkGhostType marks a cell or point as hidden, or as one that another piece has.
struct GhostMarks {
  bool is_hidden, is_duplicate;
  GhostMarks(std::uint64_t value, bool of_cells) noexcept  // as vtkDataSetAttributes
      : is_hidden((value & (of_cells ? 32u : 2u)) != 0), is_duplicate((value & 1u) != 0) {}
};

/// Whether each cell or point of a structured grid is hidden: in any piece, or as it is a duplicate in each piece that
/// has it. Pieces of parallel programs overlap, and the duplicates there are not hidden. Empty if no piece has the
/// array vtkGhostType. The pieces must cover the whole extent. Errors: MalformedFile.
std::vector<bool> hidden_in_structured(const VtkFile& file, bool of_cells);

}  // namespace tegl::io_detail
