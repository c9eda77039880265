// SPDX-License-Identifier: BSD-3-Clause
//
// Commands whose result is a new image.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "input/commands.hpp"

namespace tegl::cli {

std::unique_ptr<Command> make_scale_space_command(CLI::App& program);
std::unique_ptr<Command> make_sample_command(CLI::App& program);

/// Parses scales: FIRST:LAST:COUNT with a constant quotient, or a list. Throws InvalidArgument, naming the option, also
/// unless they are positive and ascending.
std::vector<double> parse_sigmas(const char* option, const std::string& text);

}  // namespace tegl::cli
