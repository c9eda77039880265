// SPDX-License-Identifier: BSD-3-Clause
//
// Reads series of DICOM files as images.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/raw_layers.hpp"

namespace tegl::io_detail {

/// Whether a path is a DICOM file, or a folder or DICOMDIR, which may contain some.
bool is_dicom(const std::filesystem::path& path);
/// Opens the image of DICOM files and folders whose UID, number or description is `series`. `progress` is called while
/// headers are read (with 0) and for each read. `keep_stored`: see ReadImageOptions.
RawLayers open_dicom(std::span<const std::filesystem::path> paths, const std::string& series, bool keep_stored,
                     const Progress& progress);
/// Lists the DICOM series of a path.
std::vector<ImageVariable> list_dicom(const std::filesystem::path& path);

}  // namespace tegl::io_detail
