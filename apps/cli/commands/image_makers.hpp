// SPDX-License-Identifier: BSD-3-Clause
//
// Commands whose result is a new image.
#pragma once

#include <memory>

#include "input/commands.hpp"

namespace tegl::cli {

std::unique_ptr<Command> make_scale_space_command(CLI::App& program);
std::unique_ptr<Command> make_sample_command(CLI::App& program);

}  // namespace tegl::cli
