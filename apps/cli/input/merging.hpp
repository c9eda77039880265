// SPDX-License-Identifier: BSD-3-Clause
//
// The options --merge and --merge-within.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>

#include "output/merge_summary.hpp"

namespace tegl::cli {

class MergeArguments {
 public:
  /// Adds the options to a command. This object must outlive the parse.
  void add_to(CLI::App& app);
  [[nodiscard]] bool are_given() const { return merge_ || !within_.empty(); }
  /// Throws InvalidArgument if vertices are to be merged. `with`: another option.
  void refuse(const std::string& with) const;
  /// The tolerance. Throws InvalidArgument for a text that is no number, 0 or more.
  [[nodiscard]] double tolerance() const;

  /// Throws EmptyResult if merging left nothing of a contour, unless `allow_empty`; then it returns a remark.
  static std::string require_left(const MergeSummary& summary, std::size_t simplices, bool allow_empty);
  /// Merges the vertices of a contour; returns the report.
  template <int N, class Real>
  MergeSummary merge(Contour<N, Real>& contour, const WorkOptions& work) const {
    Merging<N, Real> merging = merge_vertices(contour, {.tolerance = tolerance(), .work = work});
    MergeSummary summary = summary_of(merging, tolerance());
    contour = std::move(merging.contour);
    return summary;
  }

 private:
  bool merge_ = false;
  std::string within_;
};

}  // namespace tegl::cli
