// SPDX-License-Identifier: BSD-3-Clause
//
// The files that a command line names, looked at before the long work starts, and the writing of results.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tegl/io.hpp"
#include "tegl/io/pending_path.hpp"

namespace tegl::cli {

/// What contours are written to, for help and errors.
inline constexpr const char* kContourFiles = ".ply, .gltf, .glb, .obj, .stl (3D alone) or .vtkhdf (4D too)";

/// Whether an input may be a folder: those of DICOM series are.
enum class Folders { refused, allowed };

/// Throws FileNotFound unless `path` is a file (or folder) that can be read.
void require_input(const std::filesystem::path& path, Folders folders = Folders::refused);

/// Throws WriteFailed unless `output` can be expected to be written: a known extension, a folder that
/// exists and can be written to, no directory, none of the inputs.
void require_output(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// Throws WriteFailed unless the format of `output` holds simplices of this dimension.
void require_output_holds(const std::filesystem::path& output, int simplex_dim);

/// Throws WriteFailed if the format of `output` would leave out what options ask for: `normals` of this kind (as
/// --normals has it; empty: none), or `attributes`.
void require_output_keeps(const std::filesystem::path& output, std::string_view normals, bool attributes);

/// Throws WriteFailed unless `output` can be expected to be written as a text file, of any extension.
void require_text_output(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// --compress, of commands that write contours.
class CompressOption {
 public:
  /// Adds the option to a command. This must outlive the parse.
  void add_to(CLI::App& app);
  [[nodiscard]] Compression compression() const { return compress_ ? Compression::deflate : Compression::none; }
  /// Throws WriteFailed if it is given and the format of `output` has no compression. `facets`: of files of facets.
  void require_known(const std::filesystem::path& output, bool facets = false) const;
  /// Throws InvalidArgument if it is given and no contour is written.
  void require_file(bool any) const;

 private:
  bool compress_ = false;
};

/// Throws InvalidArgument if two outputs are one file, by whatever names.
void require_different_outputs(const std::vector<std::string>& outputs);

/// Calls `write`, which writes the file, and returns its size in bytes. Errors: WriteFailed, whatever is wrong;
/// Cancelled.
std::uint64_t write_file(const std::filesystem::path& output, const std::function<void()>& write);

/// Several files that appear together or not at all: written beside their targets, and put in place at the end. Until
/// then whatever was there stays.
class WrittenFiles {
 public:
  /// The name to write a target under, with the same extension. Errors: WriteFailed, if what is there is no file or
  /// cannot be overwritten; InvalidArgument, if another target is the same file.
  std::filesystem::path stage(const std::filesystem::path& target);
  /// Calls `write` with the name to write the target under, and returns the file's size in bytes. Errors: WriteFailed,
  /// whatever is wrong, naming the target; Cancelled.
  std::uint64_t write(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path&)>& write);
  /// Calls `work`; its errors name the targets in place of the names that these are written under.
  void with_target_names(const std::function<void()>& work) const;
  /// Puts all files in place. Errors: WriteFailed; then what was there before is there again.
  void keep();

 private:
  std::list<PendingPath> staged_;
  std::map<std::filesystem::path, std::filesystem::path> targets_;  ///< by place
};

}  // namespace tegl::cli
