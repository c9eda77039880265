// SPDX-License-Identifier: BSD-3-Clause
//
// DICOM functions for builds without DCMTK: they throw an error.
#include "base/common.hpp"
#include "dicom/dicom.hpp"
#include "dicom/dicom_file.hpp"

namespace tegl::io_detail {

namespace {

[[noreturn]] void fail_without_dcmtk(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path))
    fail(ErrorCode::FileNotFound, path,
         "is a directory; expected a file (folders of DICOM files are read by builds with DCMTK: libdcmtk-dev)");
  fail(ErrorCode::UnsupportedFormat, path,
       "a DICOM file, which this build cannot read; expected a build with DCMTK (libdcmtk-dev)");
}

}  // namespace

bool is_dicom(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path) || lower_name(path) == "dicomdir") return true;
  const std::string name = lower_name(path);
  return name.ends_with(".dcm") || name.ends_with(".ima") || name.ends_with(".dicom");
}

void load_dicom_dictionary() {}

RawLayers open_dicom(std::span<const std::filesystem::path> paths, const std::string&, bool, const Progress&) {
  fail_without_dcmtk(paths.front());
}

std::vector<ImageVariable> list_dicom(const std::filesystem::path& path) { fail_without_dcmtk(path); }

}  // namespace tegl::io_detail
