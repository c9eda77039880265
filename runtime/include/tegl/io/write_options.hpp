// SPDX-License-Identifier: BSD-3-Clause
//
// Options of all functions that write contours to files.
#pragma once

#include <cstdint>

#include "tegl/work.hpp"

namespace tegl {

/// Compression of a file's arrays: deflate is lossless, for formats whose readers all support it.
enum class Compression : std::uint8_t { none, deflate };

/// Options of write_mesh and write_facets.
struct WriteOptions {
  WorkOptions work = {};  ///< progress; files are written by one thread
  /// Only for .vtkhdf and, with write_facets, .vtu; UnsupportedFormat for others.
  Compression compression = Compression::none;
};

}  // namespace tegl
