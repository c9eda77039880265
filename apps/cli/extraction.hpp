// SPDX-License-Identifier: BSD-3-Clause
//
// The options that `contour` and `slice` share, and what both do before and after the extraction.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "progress.hpp"
#include "result.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"

namespace tegl::cli {

/// --iso, --triangulation, --ambiguity, --close, --normals, --gradient-direction, --epsilon, --threads, --precision.
class ExtractionOptions {
 public:
  /// Adds the options to a command. This must outlive the parse.
  void add_to(CLI::App& app, bool iso_required);

  /// The names of those that were given.
  [[nodiscard]] std::vector<std::string> given() const;

  /// --iso as a number. Throws InvalidArgument if it is missing or not a finite number.
  [[nodiscard]] double isovalue() const;
  /// True for --precision float.
  [[nodiscard]] bool single_precision() const { return precision_ == "float"; }
  /// The library's options, without progress. Throws InvalidArgument for an epsilon outside of [0, 0.5).
  [[nodiscard]] ExtractOptions library_options() const;

 private:
  std::vector<CLI::Option*> options_;
  std::string iso_;
  std::string triangulation_ = "compact";
  std::string ambiguity_ = "low";
  std::string direction_ = "descent";
  std::string epsilon_ = "0";
  std::string precision_ = "double";
  bool close_ = false;
  bool normals_ = false;
  unsigned threads_ = 0;
};

/// The dimension of the image.
int image_dim(const AnyImage& image);

/// Throws EmptyResult, saying why, unless a contour of the isovalue can exist: two samples along every axis,
/// and samples on both sides of the isovalue.
void require_contour(const ReadImageResult& input, double isovalue);

/// Fills the report and the seconds of the check.
void check_result(ContourResult& result, ProgressBar& bar);

/// Writes the mesh to its output, and fills the size of the file and the seconds.
void write_result(ContourResult& result, ProgressBar& bar);

}  // namespace tegl::cli
