// SPDX-License-Identifier: BSD-3-Clause
//
// The header of an image whose samples are contiguous in one file.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "base/raw_image.hpp"
#include "base/sample_reader.hpp"

namespace tegl::io_detail {

struct StoredImage {
  RawGrid grid;
  ImageInfo info;
  StoredSamples samples;
  /// Index, among the file's axes, of the image's last axis if that is not last in the file: a list of images in NRRD.
  std::optional<std::size_t> list_axis;
  /// The file stores the axes in the reverse order: the image's last axis is the fastest there.
  bool is_reversed = false;
  /// Converts stored values to the image's values; empty if they are equal.
  std::function<ValueArray(ValueArray&&)> convert;
};

}  // namespace tegl::io_detail
