// SPDX-License-Identifier: BSD-3-Clause
//
// Compressed frames as DCMTK hands them over: JPEG 2000, which it does not decompress, and RLE, of which it takes what
// is cut short for whole.
#pragma once

#include "base/value_array.hpp"
#include "dicom/dicom_header.hpp"

class DcmDataset;

namespace tegl::io_detail {

/// The stored values of all frames of a data set whose pixels are JPEG 2000. Errors: MalformedFile, UnsupportedData.
ValueArray read_jpeg2000_frames(DcmDataset& data, const DicomFile& file);

/// Throws MalformedFile unless the frames of a data set whose pixels are RLE are whole.
void require_whole_rle(DcmDataset& data, const DicomFile& file);

}  // namespace tegl::io_detail
