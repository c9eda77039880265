// SPDX-License-Identifier: BSD-3-Clause
//
// Compressed frames that DCMTK does not handle completely: it does not decompress JPEG 2000, and it accepts truncated
// RLE.
#pragma once

#include "base/value_array.hpp"
#include "dicom/dicom_header.hpp"

class DcmDataset;

namespace tegl::io_detail {

/// Decodes all frames of a data set with JPEG 2000 pixels to stored values. Errors: MalformedFile, UnsupportedData.
ValueArray read_jpeg2000_frames(DcmDataset& data, const DicomFile& file);

/// Throws MalformedFile if a frame of a data set with RLE pixels is truncated.
void require_whole_rle(DcmDataset& data, const DicomFile& file);

}  // namespace tegl::io_detail
