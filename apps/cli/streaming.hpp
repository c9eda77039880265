// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images that are larger than memory: read layer by layer, written as they come.
#pragma once

#include "result.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"

namespace tegl::cli {

/// Streams the contour to result.output; fills the result's sizes, counts and seconds. Throws EmptyResult, and leaves
/// no file, where nothing comes out.
void stream_contour(OpenLayersResult& input, double isovalue, const ExtractOptions& options, bool single_precision,
                    ContourResult& result);

}  // namespace tegl::cli
