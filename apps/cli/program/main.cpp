// SPDX-License-Identifier: BSD-3-Clause
//
// The program `tegl`.
#include "program/run.hpp"

int main(int argc, char** argv) { return tegl::cli::run_program(argc, argv, {TEGL_VERSION, TEGL_MANUAL_DATE}); }
