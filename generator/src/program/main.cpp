// SPDX-License-Identifier: BSD-3-Clause
//
// The program `gen`: parses the command line, runs the command, and converts errors to a message and an exit status.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "program/cli.hpp"
#include "program/commands.hpp"

namespace {

using tegl::gen::Command;
using tegl::gen::Error;
using tegl::gen::ErrorCode;
using tegl::gen::Options;

int dispatch(const Options& options) {
  switch (options.command) {
    case Command::Help:
      fmt::print("{}", tegl::gen::help_text());
      return 0;
    case Command::Version:
      fmt::print("{}", tegl::gen::version_text());
      return 0;
    case Command::Summary:
      return options.cell == nullptr ? tegl::gen::run_summary(options) : tegl::gen::run_cell_summary(options);
    case Command::Symmetries:
      return tegl::gen::run_symmetries(options);
    case Command::Count:
      return tegl::gen::run_count(options);
    case Command::Transversal:
      return tegl::gen::run_transversal(options);
    case Command::Classes:
      return tegl::gen::run_classes(options);
    case Command::Certify:
      return tegl::gen::run_certify(options);
    case Command::Out:
      return options.cell == nullptr ? tegl::gen::run_out(options) : tegl::gen::run_cell_out(options);
    case Command::Cases:
      return tegl::gen::run_cases(options);
    case Command::Builder:
      return tegl::gen::run_builder(options);
    case Command::Cells:
      return tegl::gen::run_cells(options);
  }
  throw Error(ErrorCode::Internal, fmt::format("command {} is not dispatched", static_cast<int>(options.command)));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string_view> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
    const int status = dispatch(tegl::gen::parse(arguments));
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      throw Error(ErrorCode::WriteFailed, "standard output could not be written");
    }
    return status;
  } catch (const Error& error) {
    fmt::print(stderr, "gen: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::system_error& error) {  // thrown by fmt when flushing its buffer fails
    fmt::print(stderr, "gen: standard output could not be written: {}\n", error.code().message());
    return static_cast<int>(ErrorCode::WriteFailed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "gen: {}\n", error.what());
    return static_cast<int>(ErrorCode::Internal);
  }
}
