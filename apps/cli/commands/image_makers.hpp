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

/// The help of --factors.
inline constexpr const char* kFactorsHelp =
    "sigma along each axis as a multiple of the scale: as in 1,1,0.5; 0: the axis is not smoothed. Default: 1 for all "
    "axes, also for a time";
/// The numbers of --factors, one for each axis; none if `text` is empty. Throws InvalidArgument, also for negative
/// ones.
std::vector<double> parse_factors(const std::string& text, std::size_t axes);

}  // namespace tegl::cli
