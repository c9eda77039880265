// SPDX-License-Identifier: BSD-3-Clause
//
// The values of --at, and the output that belongs to each.
#pragma once

#include <string>
#include <vector>

#include "result.hpp"

namespace tegl::cli {

/// The cuts that the values of --at ask for: "t=7.3", "time=1,2.5". Throws InvalidArgument, quoting the value,
/// for anything else.
std::vector<Cut> parse_cuts(const std::vector<std::string>& at);

/// The output of each cut: `pattern` with "{t}", or the axis as it was typed in braces, replaced by the number
/// as it was typed. Throws InvalidArgument if two cuts had the same file.
std::vector<std::string> cut_outputs(const std::string& pattern, const std::vector<Cut>& cuts);

}  // namespace tegl::cli
