// SPDX-License-Identifier: BSD-3-Clause
//
// The program `tegl` as a function.
#pragma once

namespace tegl::cli {

/// The version and the date in the help and on the manual page.
struct Release {
  const char* version;
  const char* date;
};

/// Runs the program with main's arguments; returns its exit status. Ends by a signal if one interrupted it.
int run_program(int argc, char** argv, const Release& release);

}  // namespace tegl::cli
