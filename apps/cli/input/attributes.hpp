// SPDX-License-Identifier: BSD-3-Clause
//
// --attribute: values of other images on a contour.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/progress.hpp"
#include "input/commands.hpp"
#include "tegl/contour.hpp"

namespace tegl::cli {

/// A file and one of its variables, which may be empty, as "FILE:VARIABLE" names them. A colon that belongs to the
/// name of a file that exists is one.
struct FileAndVariable {
  std::string file;
  std::string variable;
};
FileAndVariable parse_file_and_variable(const std::string& text);

class AttributeOptions {
 public:
  /// Adds --attribute to a command. This must outlive the parse.
  void add_to(CLI::App& app);

  [[nodiscard]] bool wanted() const { return !texts_.empty(); }

  /// The files that are read.
  [[nodiscard]] std::vector<std::string> files() const;

  /// Throws FileNotFound if one of the files is not there: before the long work.
  void require_inputs() const;

  /// The images' values at the vertices: by the names of the variables, or of the files without their extensions.
  /// `reading`: how the files are read. Throws InvalidArgument if two have the same name, UnsupportedData for an image
  /// of another dimension, and what the readers throw.
  template <int N, class Real>
  void sample_to(Contour<N, Real>& contour, ReadImageOptions reading, unsigned threads, ProgressBar& bar) const;

 private:
  std::vector<std::string> texts_;
};

}  // namespace tegl::cli
