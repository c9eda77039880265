// SPDX-License-Identifier: BSD-3-Clause
//
// What merging the vertices of a contour did, for reports.
#pragma once

#include <vector>

#include "tegl/merge.hpp"

namespace tegl::cli {

/// The report for a contour of any dimension. Places are in the contour's coordinates.
struct MergeSummary {
  MergeCounts counts = {};
  int simplex_dim = 0;
  double tolerance = 0;
  std::vector<std::vector<double>> vanished = {}, shrunk = {}, vertices = {};
  std::vector<std::vector<std::vector<double>>> faces = {};  ///< by face, the places of its vertices
};

template <int N, class Real>
MergeSummary summary_of(const Merging<N, Real>& merging, double tolerance) {
  const MergeReport<N>& report = merging.report;
  const auto place = [&](Index v) {
    return std::vector<double>(merging.contour.vertices[v].begin(), merging.contour.vertices[v].end());
  };
  MergeSummary summary{.counts = report.counts, .simplex_dim = N - 1, .tolerance = tolerance};
  for (const auto& at : report.vanished) summary.vanished.emplace_back(at.begin(), at.end());
  for (const auto& at : report.shrunk) summary.shrunk.emplace_back(at.begin(), at.end());
  for (const Index v : report.vertices) summary.vertices.push_back(place(v));
  for (const auto& face : report.faces) {
    auto& places = summary.faces.emplace_back();
    for (const Index v : face) places.push_back(place(v));
  }
  return summary;
}

}  // namespace tegl::cli
