// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images larger than memory: read layer by layer and written in parts.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "output/result.hpp"
#include "tegl/extract.hpp"
#include "tegl/io/layers.hpp"
#include "tegl/io/write_options.hpp"
#include "tegl/lattice.hpp"

namespace tegl::cli {

/// Throws InvalidArgument if the system does not allow an open file for each of the contours. Raises the soft limit if
/// necessary.
void require_open_files(std::size_t contours);

/// Throws InvalidArgument for normals from the contour's shape and for attributes.
void require_streamed_additions(bool shape_normals, bool attributes);

/// Throws WriteFailed unless the file can be written in parts.
void require_output_grows(const std::string& output);

/// Options of streaming.
struct StreamOptions {
  ExtractOptions extract;
  bool single_precision = false;
  bool allow_empty = false;
  Compression compression = Compression::none;
  std::vector<std::string> periodic = {};  ///< the axes of --periodic
  std::optional<Lattice> lattice = {};     ///< of --lattice, or of the file
};

/// Streams the contours at result.isovalue of each result to its output, in one pass; sets their sizes, counts and
/// seconds. If an isovalue lies outside of the values, throws EmptyResult and leaves no file, unless `allow_empty`.
/// Returns a remark for each empty contour whose isovalue lies within the values.
std::vector<std::string> stream_contours(OpenLayersResult& input, const StreamOptions& options,
                                         std::vector<ContourResult>& results);

}  // namespace tegl::cli
