// SPDX-License-Identifier: BSD-3-Clause
//
// JPEG 2000 functions for builds without OpenJPEG: they throw an error.
#include "dicom/jpeg2000.hpp"
#include "tegl/error.hpp"

namespace tegl::io_detail {

bool has_jpeg2000() noexcept { return false; }

bool begins_jpeg2000(std::span<const unsigned char>) noexcept { return false; }

Jpeg2000Image decode_jpeg2000(std::span<const unsigned char>, std::size_t, std::size_t, const std::string& label) {
  throw Error(
      ErrorCode::UnsupportedFormat,
      label + ": JPEG 2000, which this build cannot decompress; expected a build with OpenJPEG (libopenjp2-7-dev)");
}

}  // namespace tegl::io_detail
