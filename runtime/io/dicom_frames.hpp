// SPDX-License-Identifier: BSD-3-Clause
//
// Frames that DICOM holds as JPEG 2000, which DCMTK hands over as they are.
#pragma once

#include "dicom_file.hpp"

class DcmDataset;

namespace tegl::io_detail {

/// The stored values of all frames of a data set whose pixels are JPEG 2000. Errors: MalformedFile, UnsupportedData.
ValueArray read_jpeg2000_frames(DcmDataset& data, const DicomFile& file);

}  // namespace tegl::io_detail
