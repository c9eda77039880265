// SPDX-License-Identifier: BSD-3-Clause
//
// The order and the times of the files of a mesh over time.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "tegl/io/cell_meshes.hpp"

namespace tegl::io_detail {

/// Sorts files and given times, before files are read. Errors: InvalidArgument.
void sort_files(CellMeshOptions& options, std::vector<std::filesystem::path>& files);

/// Sorts values, and points that move, by the times in the files, if there are no given times. Errors: InvalidArgument
/// (a file without a time).
void sort_by_own_times(const CellMeshOptions& options, std::vector<std::optional<double>>& own, CellMesh& mesh);

/// The times of files; empty for a single file without one. `collection`: the .pvd file that options.times are from;
/// empty: none. Errors: InvalidArgument.
[[nodiscard]] std::vector<double> times_of(const std::vector<std::optional<double>>& own,
                                           const CellMeshOptions& options,
                                           const std::vector<std::filesystem::path>& files,
                                           const std::filesystem::path& collection);

}  // namespace tegl::io_detail
