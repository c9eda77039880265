// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images that are larger than memory: read layer by layer, written as they come.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "output/result.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"

namespace tegl::cli {

/// Throws InvalidArgument if the system does not let the program have a file open for each of so many contours. Where
/// it lets a program ask for more than it has, it is asked.
void require_open_files(std::size_t contours);

/// How contours are streamed.
struct StreamOptions {
  ExtractOptions extract;
  bool single_precision = false;
  bool allow_empty = false;
  Compression compression = Compression::none;
};

/// Streams the contours at result.isovalue of each result to its output, in one pass; fills their sizes, counts and
/// seconds. Throws EmptyResult, and leaves no file, if an isovalue lies outside of the values, unless `allow_empty`.
/// Returns a remark for each contour that is empty though its isovalue lies within them.
std::vector<std::string> stream_contours(OpenLayersResult& input, const StreamOptions& options,
                                         std::vector<ContourResult>& results);

}  // namespace tegl::cli
