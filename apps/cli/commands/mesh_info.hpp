// SPDX-License-Identifier: BSD-3-Clause
//
// The report of `tegl info` about a mesh of cells.
#pragma once

#include <string>

#include "base/console.hpp"
#include "output/result.hpp"
#include "tegl/io/cell_meshes.hpp"

namespace tegl::cli {

/// The report as text: cells by type, arrays with their ranges, times.
std::string mesh_text(const Console& console, const CellMeshInfo& info, const std::string& file);
/// The report as JSON.
Json mesh_json(const CellMeshInfo& info, const InputFiles& input);

}  // namespace tegl::cli
