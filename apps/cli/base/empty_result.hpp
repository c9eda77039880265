// SPDX-License-Identifier: BSD-3-Clause
//
// The error of a request that gives nothing, such as an isovalue outside of the data: an error of the program only; the
// library returns empty contours.
#pragma once

#include <stdexcept>

namespace tegl::cli {

/// There is no contour at this isovalue or cut. ExitCode::Nothing, "EmptyResult" in JSON.
class EmptyResult : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tegl::cli
