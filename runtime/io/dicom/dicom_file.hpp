// SPDX-License-Identifier: BSD-3-Clause
//
// Reads a single DICOM file through DCMTK: its header and its stored values.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/value_array.hpp"
#include "dicom/dicom_header.hpp"

namespace tegl::io_detail {

/// Loads the data dictionary, so that child processes inherit it and do not load it one by one (some 30 ms).
void load_dicom_dictionary();

/// Whether a file is probably DICOM, by its first bytes or its extension.
bool is_dicom_file(const std::filesystem::path& path);

/// Whether a file begins like DICOM: with "DICM" after a preamble, or with an element of its first groups. If such a
/// file cannot be read, it is damaged. Errors: FileNotFound if it cannot be opened.
bool begins_as_dicom(const std::filesystem::path& path);

/// Reads the header of a file; nullopt if it contains no image (a report, a directory of files). Errors: MalformedFile
/// if not even the series can be read. Other errors are stored in `fault`: MalformedFile; UnsupportedFormat for pixels
/// that cannot be decompressed; UnsupportedData for colours and other values that are not one number per sample.
std::optional<DicomFile> read_dicom_header(const std::filesystem::path& path);

/// Reads and decompresses the stored values of all frames. Errors: MalformedFile, UnsupportedData (JPEG 2000 of several
/// components).
ValueArray read_dicom_values(const DicomFile& file);

/// The files that a DICOMDIR lists.
std::vector<std::filesystem::path> read_dicomdir(const std::filesystem::path& path);

}  // namespace tegl::io_detail
