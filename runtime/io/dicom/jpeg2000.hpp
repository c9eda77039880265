// SPDX-License-Identifier: BSD-3-Clause
//
// Decodes grey JPEG 2000 code streams through OpenJPEG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tegl::io_detail {

/// A decoded image of one component.
struct Jpeg2000Image {
  std::vector<std::int32_t> values;  ///< row by row
  int precision = 0;                 ///< bits of each value, 1 to 24
};

/// Whether this build has OpenJPEG.
bool has_jpeg2000() noexcept;

/// Whether the bytes begin like a code stream, bare or in a JP2 file.
bool begins_jpeg2000(std::span<const unsigned char> bytes) noexcept;

/// Decodes a code stream, bare or in a JP2 file. `label`, the file and the frame, begins messages. Errors:
/// MalformedFile (damaged, truncated, or of another size), UnsupportedData (several components, more than 24 bits),
/// UnsupportedFormat (a build without OpenJPEG).
Jpeg2000Image decode_jpeg2000(std::span<const unsigned char> bytes, std::size_t columns, std::size_t rows,
                              const std::string& label);

}  // namespace tegl::io_detail
