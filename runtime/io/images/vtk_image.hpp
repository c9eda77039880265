// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's XML files of images (.vti) and rectilinear grids (.vtr).
#pragma once

#include <filesystem>
#include <vector>

#include "base/raw_image.hpp"
#include "base/raw_layers.hpp"

namespace tegl::io_detail {

/// Reads an array of points, or of cells: then the samples are at the cells' centres. Errors: those of read_image.
RawImage read_vtk_image(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options);

/// Opens it to be read by layers. Arrays that are not appended raw, in one piece and with one component, are read as a
/// whole when the first layer is.
RawLayers open_vtk_layers(const std::filesystem::path& path, const ReadImageOptions& options);

/// All arrays with one component.
std::vector<ImageVariable> list_vtk_image(const std::filesystem::path& path);

}  // namespace tegl::io_detail
