// SPDX-License-Identifier: BSD-3-Clause
//
// Readers in a child process: what they give comes back by way of shared memory.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "base/readers.hpp"
#include "process/child_process.hpp"

namespace tegl::io_detail {

/// Whether files like this are read by a library that damaged ones bring down: HDF5 (netCDF-4 and VTKHDF) or DCMTK.
bool needs_separate_process(const std::filesystem::path& path);
bool needs_separate_process(std::span<const std::filesystem::path> paths);

/// An image and the files that it is made of, in their order.
struct ImageOfFiles {
  RawImage image;
  std::vector<std::filesystem::path> files;
};
/// Layers and the files that they are in, in their order.
struct LayersOfFiles {
  RawLayers layers;
  std::vector<std::filesystem::path> files;
};

/// Calls `read` in a child with the progress that it reports to. `path` is named until the reader has named a file.
/// Errors: those of ChildProcess.
ImageOfFiles read_separately(const std::filesystem::path& path, const Progress& progress,
                             const std::function<ImageOfFiles(const Progress&)>& read);
Mesh read_separately(const std::filesystem::path& path, const Progress& progress,
                     const std::function<Mesh(const Progress&)>& read);
std::vector<ImageVariable> read_separately(const std::filesystem::path& path,
                                           const std::function<std::vector<ImageVariable>()>& read);
/// The layers stay in the child, which reads those that are asked for.
LayersOfFiles open_separately(const std::filesystem::path& path, const std::function<LayersOfFiles()>& open);

}  // namespace tegl::io_detail
