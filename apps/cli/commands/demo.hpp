// SPDX-License-Identifier: BSD-3-Clause
//
// tegl demo: shows the program on example data.
#pragma once

#include <memory>

#include "input/commands.hpp"

namespace tegl::cli {

std::unique_ptr<Command> make_demo_command(CLI::App& program);

}  // namespace tegl::cli
