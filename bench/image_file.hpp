// SPDX-License-Identifier: BSD-3-Clause
//
// Helpers of the programs that measure images from files.
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <variant>

#include "tegl/io.hpp"

namespace tegl::bench {

/// Calls work(name, image) with the file name without folder and the OwnedImage of the file at `path`.
template <class Work>
void with_image_of_file(const std::string& path, const Work& work) {
  const ReadImageResult read = read_image(path);
  const std::string name = std::filesystem::path(path).filename().string();
  std::visit([&](const auto& typed) { std::visit([&](const auto& owned) { work(name, owned); }, typed); }, read.image);
}

/// Returns the program's exit status: run(argc, argv), or 1 after printing an error.
template <class Run>
int run_program(const char* program, int argc, char** argv, const Run& run) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return 1;
  }
}

}  // namespace tegl::bench
