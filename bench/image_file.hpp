// SPDX-License-Identifier: BSD-3-Clause
//
// Helpers of the programs that measure images from files.
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "run_program.hpp"
#include "tegl/io.hpp"

namespace tegl::bench {

/// Calls work(name, image) with the file name without folder and the OwnedImage of the file at `path`.
template <class Work>
void with_image_of_file(const std::string& path, const Work& work) {
  const ReadImageResult read = read_image(path);
  const std::string name = std::filesystem::path(path).filename().string();
  std::visit([&](const auto& typed) { std::visit([&](const auto& owned) { work(name, owned); }, typed); }, read.image);
}

}  // namespace tegl::bench
