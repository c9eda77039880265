// SPDX-License-Identifier: BSD-3-Clause
//
// An image whose samples are read later, in groups of layers.
#pragma once

#include <cstddef>
#include <functional>

#include "base/raw_image.hpp"

namespace tegl::io_detail {

/// An image whose samples are read later, in groups of layers along its last axis.
struct RawLayers {
  RawGrid grid;
  ImageInfo info;
  std::size_t block = 1;  ///< number of layers that are most efficient to read together
  /// Reads the layers [first, first + count); always of the same type. Keeps the file open.
  std::function<ValueArray(std::size_t first, std::size_t count)> read;
  /// Returns the same samples without a copy, valid until the next call. May be empty.
  std::function<ValueView(std::size_t first, std::size_t count)> look = {};
};

}  // namespace tegl::io_detail
