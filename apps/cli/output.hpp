// SPDX-License-Identifier: BSD-3-Clause
//
// The files that a command line names, looked at before the long work starts, and the writing of results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

#include "tegl/io.hpp"

namespace tegl::cli {

/// Whether an input may be a folder: those of DICOM series are.
enum class Folders { refused, allowed };

/// Throws FileNotFound unless `path` is a file (or folder) that can be read.
void require_input(const std::filesystem::path& path, Folders folders = Folders::refused);

/// Throws WriteFailed unless `output` can be expected to be written: a known extension, a folder that
/// exists and can be written to, no directory, none of the inputs.
void require_output(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// Throws WriteFailed unless the format of `output` holds simplices of this dimension.
void require_output_holds(const std::filesystem::path& output, int simplex_dim);

/// Throws WriteFailed unless `output` can be expected to be written as a text file, of any extension.
void require_text_output(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// Calls `write`, which writes the file, and returns its size in bytes. Errors: WriteFailed, whatever is wrong;
/// Cancelled.
std::uint64_t write_file(const std::filesystem::path& output, const std::function<void()>& write);

/// Writes the mesh and returns the file's size in bytes. Errors: WriteFailed, Cancelled.
std::uint64_t write_output(const Mesh& mesh, const std::filesystem::path& output, const Progress& progress);

/// The files that a command has written so far: removed again unless all could be.
class WrittenFiles {
 public:
  WrittenFiles() = default;
  ~WrittenFiles();
  WrittenFiles(const WrittenFiles&) = delete;
  WrittenFiles& operator=(const WrittenFiles&) = delete;

  void add(std::filesystem::path written) { paths_.push_back(std::move(written)); }
  void keep() noexcept { paths_.clear(); }

 private:
  std::vector<std::filesystem::path> paths_;
};

}  // namespace tegl::cli
