// SPDX-License-Identifier: BSD-3-Clause
//
// Implements checks of input and output files, and writing of several files together.
#include "output/output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>

#include "base/interrupt.hpp"
#include "base/numbers.hpp"
#include "io/base/simplex_names.hpp"
#include "tegl/error.hpp"

namespace tegl::cli {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& output, std::string_view why) {
  throw Error(ErrorCode::WriteFailed, fmt::format("{}: {}", output.string(), why));
}

/// Registers a target by its path. Throws InvalidArgument if another target has the same path.
void require_new(std::map<fs::path, fs::path>& targets, const fs::path& place, const fs::path& target) {
  const auto [other, is_new] = targets.emplace(place, target);
  if (is_new) return;
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("{} {}; expected a file for each result", target.string(),
                          other->second == target ? "would be written twice"
                                                  : fmt::format("is the same file as {}", other->second.string())));
}

/// Calls `write`. All its errors concern the output: scripts distinguish input and output by the exit code.
template <class Write>
void as_errors_of(const fs::path& output, const Write& write) {
  try {
    write();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    const std::string message = error.what();
    const bool named = message.find(output.string()) != std::string::npos;
    throw Error(ErrorCode::WriteFailed, named ? message : fmt::format("{}: {}", output.string(), message));
  }
}

/// In bytes; 0 if it is unknown.
std::uint64_t size_of_file(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace

void require_input(const fs::path& path, Folders folders) {
  const auto fail_input = [&](std::string_view why) {
    throw Error(ErrorCode::FileNotFound, fmt::format("{}: {}", path.string(), why));
  };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail_input("no such file");
  if (folders == Folders::refused && fs::is_directory(status)) fail_input("is a directory; expected a file");
  if (access(path.c_str(), R_OK) != 0) fail_input(fmt::format("cannot be read: {}", std::strerror(errno)));
}

void require_text_output(const fs::path& output, const std::vector<std::string>& inputs) {
  std::error_code error;
  if (output.empty()) fail(output, "is not the name of a file");
  if (output.native().front() == '-')
    fail(output, fmt::format("looks like an option; expected the name of a file, such as ./{}", output.string()));
  if (fs::is_directory(output, error)) fail(output, "is a directory; expected the name of a file");
  for (const std::string& input : inputs)
    if (fs::equivalent(output, input, error)) fail(output, "is the input itself; expected another file");
  const fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
  if (!fs::exists(folder, error)) {
    fail(output, fmt::format("the folder '{}' does not exist; expected an existing folder", folder.string()));
  }
  if (!fs::is_directory(folder, error)) fail(output, fmt::format("'{}' is not a folder", folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    fail(output, fmt::format("the folder '{}' cannot be written to: {}", folder.string(), std::strerror(errno)));
  }
}

void require_output(const fs::path& output, const std::vector<std::string>& inputs) {
  if (find_mesh_file_format(output) == nullptr) {
    const std::string extension = output.extension().string();
    fail(output, fmt::format("{}; expected {}",
                             extension.empty() ? "the name has no extension"
                                               : fmt::format("the extension '{}' is not known", extension),
                             kContourFiles));
  }
  require_text_output(output, inputs);
}

void require_output_holds(const fs::path& output, int simplex_dim) {
  const MeshFileFormat* const format = find_mesh_file_format(output);
  const std::string extension = output.extension().string();
  if (format == nullptr || simplex_dim > format->most_dim)
    fail(output,
         fmt::format("'{}' cannot hold a {}D contour ({} in {}D space); expected .vtkhdf, or a surface: slice the "
                     "contour first ('tegl slice')",
                     extension, simplex_dim + 1, io_detail::simplex_name(simplex_dim).plural, simplex_dim + 1));
  if (simplex_dim < format->least_dim)
    fail(output, fmt::format("'{}' cannot hold a {}D contour, which is made of lines; expected .ply, .gltf, .glb, .obj "
                             "or .vtkhdf",
                             extension, simplex_dim + 1));
}

void require_output_keeps(const fs::path& output, std::string_view normals, bool attributes) {
  const MeshFileFormat* const format = find_mesh_file_format(output);
  if (format == nullptr || (format->extension != ".stl" && format->extension != ".obj")) return;
  if (attributes)
    fail(output, fmt::format("'{}' cannot hold attributes; expected .vtkhdf, .ply, .gltf or .glb", format->extension));
  // STL stores normals of triangles anyway; programs compute them for OBJ themselves.
  if (normals.empty() || (normals == "flat") == (format->extension == ".stl")) return;
  fail(output, fmt::format("'{}' cannot hold normals of {}; expected .vtkhdf, .ply{} with --normals {}",
                           format->extension, normals == "flat" ? "triangles" : "vertices",
                           normals == "flat" ? "" : ", .obj, .gltf or .glb", normals));
}

void CompressOption::add_to(CLI::App& app) {
  app.add_flag("--compress", compress_,
               ".vtkhdf (and .vtu of --facets): compressed without loss; takes longer to write");
}

void CompressOption::require_known(const fs::path& output, bool facets) const {
  const std::string extension = output.extension().string();
  if (!compress_ || equal_ignoring_case(extension, ".vtkhdf") || (facets && equal_ignoring_case(extension, ".vtu")))
    return;
  fail(output, fmt::format("'{}' has no compression; expected .vtkhdf{}, or no --compress", extension,
                           facets ? " or .vtu" : ""));
}

void CompressOption::require_file(bool any) const {
  if (compress_ && !any)
    throw Error(ErrorCode::InvalidArgument,
                "--compress without a file of a contour; expected one, as in -o part.vtkhdf");
}

void require_different_outputs(const std::vector<std::string>& outputs) {
  std::map<fs::path, fs::path> targets;
  for (const std::string& output : outputs) require_new(targets, place_of(output), output);
}

std::uint64_t write_file(const fs::path& output, const std::function<void()>& write) {
  as_errors_of(output, write);
  return size_of_file(output);
}

const PendingPath& WrittenFiles::stage(const fs::path& target) {
  const PendingPath& added = staged_.emplace_back(target);
  require_new(targets_, added.place(), target);
  return added;
}

std::uint64_t WrittenFiles::write(const fs::path& target, const std::function<void(const PendingPath&)>& write) {
  const PendingPath& file = stage(target);
  as_errors_of(target, [&] { write(file); });
  return size_of_file(file.path());
}

void WrittenFiles::keep() {
  const InterruptHandler::Undivided all_or_none;
  try {
    for (PendingPath& staged : staged_) staged.commit_reversibly();
  } catch (const Error&) {
    for (PendingPath& staged : staged_) staged.roll_back();
    throw;
  }
  staged_.clear();
}

}  // namespace tegl::cli
