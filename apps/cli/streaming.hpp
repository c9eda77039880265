// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images that are larger than memory: read layer by layer, written as they come.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "progress.hpp"
#include "result.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"

namespace tegl::cli {

/// --stream, and the --raw options, which say what is in a file of nothing but values.
class StreamingOptions {
 public:
  /// Adds the options to a command. This must outlive the parse.
  void add_to(CLI::App& app);

  /// True with --stream or a --raw option: then the contour is streamed.
  [[nodiscard]] bool wanted() const;

  /// Opens the image. Throws InvalidArgument for raw options that say too little or nothing that can be, and what
  /// open_layers and open_raw_layers throw.
  [[nodiscard]] OpenLayersResult open(const std::string& file, const std::string& variable) const;

 private:
  bool stream_ = false;
  std::string raw_;
  std::string raw_type_;
  std::uint64_t raw_offset_ = 0;
  bool raw_big_endian_ = false;
  CLI::Option* raw_option_ = nullptr;
};

/// Streams the contour to result.output; fills the result's sizes, counts and seconds. Throws EmptyResult, and leaves
/// no file, where nothing comes out.
void stream_contour(OpenLayersResult& input, double isovalue, const ExtractOptions& options, bool single_precision,
                    ContourResult& result);

}  // namespace tegl::cli
