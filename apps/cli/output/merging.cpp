// SPDX-License-Identifier: BSD-3-Clause
//
// Implements --merge: parses the options and formats the report.
#include "output/merging.hpp"

#include <fmt/format.h>

#include "base/numbers.hpp"
#include "output/result.hpp"

namespace tegl::cli {

Json to_json(const MergeSummary& summary) {
  const MergeReport<2>& counts = summary.counts;
  Json json;
  json["tolerance"] = summary.tolerance;
  json["vertices_before"] = counts.before.vertices;
  json["simplices_before"] = counts.before.simplices;
  json["merged_vertices"] = counts.merged_vertices;
  json["collapsed_simplices"] = counts.collapsed_simplices;
  json["flat_simplices"] = counts.flat_simplices;
  json["kept_flat_simplices"] = counts.kept_flat_simplices;
  json["divided_simplices"] = counts.divided_simplices;
  json["turned_simplices"] = counts.turned_simplices;
  json["euler_before"] = counts.euler_before;
  json["euler_after"] = counts.euler_after;
  json["vanished_components"] = counts.vanished_components;
  json["vanished_at"] = summary.vanished;
  json["pinched_vertices"] = counts.pinched_vertices;
  json["pinched_at"] = summary.vertices;
  json["pinched_faces"] = counts.pinched_faces;
  json["faces_at"] = summary.faces;
  return json;
}

std::string to_text(const MergeSummary& summary) {
  const MergeReport<2>& counts = summary.counts;
  const int dim = summary.simplex_dim;
  const std::uint64_t dropped = counts.collapsed_simplices + counts.flat_simplices;
  std::string text = report_line(
      "merged", fmt::format("{} of {}; {} without size dropped", grouped(counts.merged_vertices),
                            counted(counts.before.vertices, "vertex", "vertices"), counted_simplices(dim, dropped)));
  if (counts.pinched_vertices > 0)
    text += report_line("pinched", dim == 1 ? counted(counts.pinched_vertices, "vertex", "vertices")
                                            : fmt::format("{}, {} in more than two {}",
                                                          counted(counts.pinched_vertices, "vertex", "vertices"),
                                                          counted_simplices(dim - 1, counts.pinched_faces),
                                                          dim == 2 ? "triangles" : "tetrahedra"));
  if (counts.vanished_components > 0)
    text += report_line("vanished",
                        counted(counts.vanished_components, "component without size", "components without size"));
  if (counts.turned_simplices > 0)
    text += report_line("turned", fmt::format("{}; a smaller --merge-within turns fewer",
                                              counted_simplices(dim, counts.turned_simplices)));
  return text;
}

void MergeArguments::add_to(CLI::App& app) {
  app.add_flag("--merge", merge_,
               "merge vertices that coincide, drop simplices without size, and report where the result is no manifold");
  app.add_option("--merge-within", within_,
                 "as --merge, also for vertices at most this far apart, in the units of the axes")
      ->type_name("DISTANCE");
}

void MergeArguments::refuse(const std::string& with) const {
  if (are_given())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} with {}; expected one of the two",
                                                        within_.empty() ? "--merge" : "--merge-within", with));
}

double MergeArguments::tolerance() const {
  if (within_.empty()) return 0.0;
  const double value = parse_finite("--merge-within", within_);
  if (value < 0.0)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--merge-within is {}; expected 0 or more", within_));
  return value;
}

}  // namespace tegl::cli
