// SPDX-License-Identifier: BSD-3-Clause
//
// A DICOM file through DCMTK: its header and its stored values.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/value_array.hpp"
#include "dicom/dicom_header.hpp"

namespace tegl::io_detail {

/// Whether a file looks like DICOM by its first bytes or its extension.
bool is_dicom_file(const std::filesystem::path& path);

/// Whether a file begins as DICOM does, with "DICM" behind a preamble or with an element of its first groups: then it
/// is damaged if it cannot be read. Errors: FileNotFound for one that cannot be opened.
bool begins_as_dicom(const std::filesystem::path& path);

/// The header of a file; none if it holds no image (a report, a directory of files). Errors: MalformedFile, if not even
/// its series can be read. What else is wrong is in `fault`: MalformedFile; UnsupportedFormat for pixels that cannot be
/// decompressed; UnsupportedData for colours and other values that are not one number per sample.
std::optional<DicomFile> read_dicom_header(const std::filesystem::path& path);

/// The stored values of all frames, decompressed. Errors: MalformedFile, UnsupportedData (JPEG 2000 of several
/// components).
ValueArray read_dicom_values(const DicomFile& file);

/// The files that a DICOMDIR lists.
std::vector<std::filesystem::path> read_dicomdir(const std::filesystem::path& path);

}  // namespace tegl::io_detail
