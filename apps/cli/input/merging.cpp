// SPDX-License-Identifier: BSD-3-Clause
//
// Implements --merge and --merge-within.
#include "input/merging.hpp"

#include <fmt/format.h>

#include "base/numbers.hpp"
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

double MergeArguments::tolerance() const {
  if (within_.empty()) return 0.0;
  const double value = parse_finite("--merge-within", within_);
  if (value < 0.0)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--merge-within is {}; expected 0 or more", within_));
  return value;
}

}  // namespace tegl::cli
