// SPDX-License-Identifier: BSD-3-Clause
//
// Checks the files of a command line before the long work, and writes results.
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

#include "io/base/pending_path.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::cli {

/// Formats of contours, for help and errors.
inline constexpr const char* kContourFiles = ".ply, .gltf, .glb, .obj, .stl (3D only) or .vtkhdf (also 4D and 5D)";

/// Whether an input may be a folder, as for DICOM series.
enum class Folders { refused, allowed };

/// Throws FileNotFound unless `path` is a readable file (or folder).
void require_input(const std::filesystem::path& path, Folders folders = Folders::refused);

/// Throws WriteFailed unless `output` is probably writable: a known extension, an existing writable folder, not a
/// directory, not one of the inputs.
void require_output(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// Throws WriteFailed unless the format of `output` supports simplices of this dimension.
void require_output_holds(const std::filesystem::path& output, int simplex_dim);

/// Throws WriteFailed if the format of `output` does not support the requested normals (a value of --normals; empty:
/// none) or attributes.
void require_output_keeps(const std::filesystem::path& output, std::string_view normals, bool attributes);

/// Throws WriteFailed unless `output` is probably writable as a text file, with any extension.
void require_text_output(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// The option --compress of commands that write contours.
class CompressOption {
 public:
  /// Adds the option to a command. This object must outlive the parse.
  void add_to(CLI::App& app);
  [[nodiscard]] Compression compression() const { return compress_ ? Compression::deflate : Compression::none; }
  /// Throws WriteFailed if it is given and the format of `output` has no compression. `facets`: for files of facets.
  void require_known(const std::filesystem::path& output, bool facets = false) const;
  /// Throws InvalidArgument if it is given and no contour is written.
  void require_file(bool any) const;

 private:
  bool compress_ = false;
};

/// Throws InvalidArgument if two outputs are the same file, even by different names.
void require_different_outputs(const std::vector<std::string>& outputs);

/// Calls `write`, which writes the file, and returns its size in bytes. Errors: WriteFailed for any failure; Cancelled.
std::uint64_t write_file(const std::filesystem::path& output, const std::function<void()>& write);

/// Several output files that appear together or not at all: written beside their targets and renamed at the end.
/// Previous files stay until then.
class WrittenFiles {
 public:
  /// The temporary file for a target, valid as long as this object. Errors: WriteFailed if the target exists and is not
  /// a file or cannot be overwritten; InvalidArgument if another target is the same file.
  const PendingPath& stage(const std::filesystem::path& target);
  /// Calls `write` with the temporary file for a target, and returns the file's size in bytes. Errors: WriteFailed for
  /// any failure, naming the target; Cancelled.
  std::uint64_t write(const std::filesystem::path& target, const std::function<void(const PendingPath&)>& write);
  /// Renames all files to their targets. Errors: WriteFailed; the previous files are restored then.
  void keep();

 private:
  std::list<PendingPath> staged_;
  std::map<std::filesystem::path, std::filesystem::path> targets_;  ///< by path
};

}  // namespace tegl::cli
