// SPDX-License-Identifier: BSD-3-Clause
//
// Runs readers in a child process and returns their results through shared memory.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "base/raw_layers.hpp"
#include "process/child_process.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::io_detail {

/// Whether a file is read by a library that damaged files may crash: HDF5 (netCDF-4 and VTKHDF) or DCMTK.
bool needs_separate_process(const std::filesystem::path& path);
bool needs_separate_process(std::span<const std::filesystem::path> paths);

/// An image and its files, in order.
struct ImageOfFiles {
  RawImage image;
  std::vector<std::filesystem::path> files;
};
/// Layers and their files, in order.
struct LayersOfFiles {
  RawLayers layers;
  std::vector<std::filesystem::path> files;
};

/// Calls `read` in a child, with a progress callback that reports to the parent. Messages name `path` until the reader
/// reports a file. Errors: those of ChildProcess.
ImageOfFiles read_separately(const std::filesystem::path& path, const Progress& progress,
                             const std::function<ImageOfFiles(const Progress&)>& read);
Mesh read_separately(const std::filesystem::path& path, const Progress& progress,
                     const std::function<Mesh(const Progress&)>& read);
std::vector<ImageVariable> read_separately(const std::filesystem::path& path,
                                           const std::function<std::vector<ImageVariable>()>& read);
/// Opens layers in a child, which reads them on request. `progress` is called while `open` runs.
LayersOfFiles open_separately(const std::filesystem::path& path, const Progress& progress,
                              const std::function<LayersOfFiles(const Progress&)>& open);

}  // namespace tegl::io_detail
