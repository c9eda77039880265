// SPDX-License-Identifier: BSD-3-Clause
//
// Implements --merge and --merge-within.
#include "input/merging.hpp"

#include <fmt/format.h>

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "output/result.hpp"
#include "tegl/error.hpp"

namespace tegl::cli {

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

std::string MergeArguments::require_left(const MergeSummary& summary, std::size_t simplices, bool allow_empty) {
  if (simplices > 0 || summary.counts.before.simplices == 0) return {};
  const std::string what =
      fmt::format("vertices within {} are merged, which leaves nothing of {}", number(summary.tolerance),
                  counted_simplices(summary.simplex_dim, summary.counts.before.simplices));
  if (allow_empty) return what;
  throw EmptyResult(what + "; expected a smaller distance (--allow-empty: an empty result)");
}

double MergeArguments::tolerance() const {
  if (within_.empty()) return 0.0;
  const double value = parse_finite("--merge-within", within_);
  if (value < 0.0)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--merge-within is {}; expected 0 or more", within_));
  return value;
}

}  // namespace tegl::cli
