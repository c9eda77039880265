// SPDX-License-Identifier: BSD-3-Clause
//
// The options --merge and --merge-within, and the report of merged vertices.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tegl/merge.hpp"

namespace tegl::cli {

/// What merging did, for contours of any dimension. Places are in the contour's coordinates.
struct MergeSummary {
  MergeReport<2> counts = {};  ///< without its lists
  int simplex_dim = 0;
  double tolerance = 0;
  std::vector<std::vector<double>> vanished = {}, vertices = {};
  std::vector<std::vector<std::vector<double>>> faces = {};  ///< by face, the places of its vertices
};

/// For JSON: counts and places.
nlohmann::ordered_json to_json(const MergeSummary& summary);
/// Lines of a report.
std::string to_text(const MergeSummary& summary);

class MergeArguments {
 public:
  /// Adds the options to a command. This object must outlive the parse.
  void add_to(CLI::App& app);
  [[nodiscard]] bool are_given() const { return merge_ || !within_.empty(); }
  /// Throws InvalidArgument if vertices are to be merged. `with`: another option.
  void refuse(const std::string& with) const;
  /// The tolerance. Throws InvalidArgument for a text that is no number, 0 or more.
  [[nodiscard]] double tolerance() const;

  /// Merges the vertices of a contour; returns the report.
  template <int N, class Real>
  MergeSummary merge(Contour<N, Real>& contour, const WorkOptions& work) const {
    Merging<N, Real> merging = merge_vertices(contour, {.tolerance = tolerance(), .work = work});
    contour = std::move(merging.contour);
    const auto& report = merging.report;
    MergeSummary summary{.simplex_dim = N - 1, .tolerance = tolerance()};
    MergeReport<2>& to = summary.counts;
    to.before = report.before;
    to.after = report.after;
    to.merged_vertices = report.merged_vertices;
    to.collapsed_simplices = report.collapsed_simplices;
    to.flat_simplices = report.flat_simplices;
    to.kept_flat_simplices = report.kept_flat_simplices;
    to.divided_simplices = report.divided_simplices;
    to.turned_simplices = report.turned_simplices;
    to.euler_before = report.euler_before;
    to.euler_after = report.euler_after;
    to.vanished_components = report.vanished_components;
    to.pinched_vertices = report.pinched_vertices;
    to.pinched_faces = report.pinched_faces;
    const auto place = [&](Index v) {
      return std::vector<double>(contour.vertices[v].begin(), contour.vertices[v].end());
    };
    for (const auto& at : report.vanished) summary.vanished.emplace_back(at.begin(), at.end());
    for (const Index v : report.vertices) summary.vertices.push_back(place(v));
    for (const auto& face : report.faces) {
      auto& places = summary.faces.emplace_back();
      for (const Index v : face) places.push_back(place(v));
    }
    return summary;
  }

 private:
  bool merge_ = false;
  std::string within_;
};

}  // namespace tegl::cli
