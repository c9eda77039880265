// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images that are larger than memory: read layer by layer, written as they come.
#pragma once

#include <cstddef>
#include <vector>

#include "result.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"

namespace tegl::cli {

/// Throws InvalidArgument if the system does not let the program have a file open for each of so many contours. Where
/// it lets a program ask for more than it has, it is asked.
void require_open_files(std::size_t contours);

/// Streams the contours at result.isovalue of each result to its output, in one pass; fills their sizes, counts and
/// seconds. Throws EmptyResult, and leaves no file, where nothing comes out for one.
void stream_contours(OpenLayersResult& input, const ExtractOptions& options, bool single_precision,
                     std::vector<ContourResult>& results);

}  // namespace tegl::cli
