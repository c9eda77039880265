// SPDX-License-Identifier: BSD-3-Clause
//
// Collections of files over time (.pvd).
#pragma once

#include <filesystem>
#include <vector>

namespace tegl::io_detail {

/// Whether a file is a collection, by its extension.
bool is_pvd(const std::filesystem::path& path);

struct PvdStep {
  double time = 0;
  std::filesystem::path file;
};

/// The files of a collection, by ascending time. Paths are relative to the collection's folder and must not leave it
/// unless `allow_outside_paths`. Errors: FileNotFound; MalformedFile (no collection, no files, a time that is no number
/// or occurs twice); UnsupportedData (several parts; a collection in it, or another format; a path outside of the
/// folder).
std::vector<PvdStep> read_pvd(const std::filesystem::path& path, bool allow_outside_paths);

}  // namespace tegl::io_detail
