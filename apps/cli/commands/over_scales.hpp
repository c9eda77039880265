// SPDX-License-Identifier: BSD-3-Clause
//
// The options --scale-space and --factors: contours of the image smoothed at several scales, with the scale as one more
// axis.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <variant>
#include <vector>

#include "base/progress.hpp"
#include "input/commands.hpp"
#include "tegl/io/layers.hpp"

namespace tegl::cli {

class ScaleSpaceArguments {
 public:
  /// Adds the option to a command. This object must outlive the parse.
  void add_to(CLI::App& app);

  [[nodiscard]] bool are_given() const { return option_->count() > 0; }
  /// Throws InvalidArgument if the option is given, with another option that it does not go with.
  void refuse(bool given, const std::string& with) const;
  /// Parses the scales. Throws InvalidArgument unless they are at least two, positive and ascending, and
  /// for --factors without them.
  void require();

  /// Replaces an image in 2 to 4 dimensions by its scale space.
  void apply(std::variant<ReadImageResult, ReadImage5dResult>& input, unsigned threads, Progress progress) const;
  /// The layers of the scale space of an image in 2 or 3 dimensions, which are computed when they are read. The result
  /// refers to `input`. Throws InvalidArgument for 4 dimensions.
  [[nodiscard]] OpenLayersResult layers(const ReadImageResult& input, unsigned threads) const;

 private:
  CLI::Option* option_ = nullptr;
  std::string text_, factors_;
  std::vector<double> sigmas_;
};

}  // namespace tegl::cli
