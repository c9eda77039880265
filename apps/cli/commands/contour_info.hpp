// SPDX-License-Identifier: BSD-3-Clause
//
// The report of `tegl info` about a saved contour.
#pragma once

#include <string>

#include "base/console.hpp"
#include "output/result.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::cli {

/// The report as text: sizes, isovalue, bounds by axis, normals, periods, attributes with their ranges.
std::string contour_text(const Console& console, const Mesh& mesh, const std::string& file);
/// The report as JSON.
Json contour_json(const Mesh& mesh, const InputFiles& input);

}  // namespace tegl::cli
