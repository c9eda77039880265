// SPDX-License-Identifier: BSD-3-Clause
//
// The option --attribute: values of other images at the vertices of a contour.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/progress.hpp"
#include "input/commands.hpp"
#include "tegl/contour.hpp"

namespace tegl::cli {

/// A file and one of its variables (may be empty), parsed from "FILE:VARIABLE". If a file with the whole text as its
/// name exists, the colon is part of the name. A variable may have a colon, too, as in "FILE:velocity:0".
struct FileAndVariable {
  std::string file;
  std::string variable;
};
FileAndVariable parse_file_and_variable(const std::string& text);

/// Reads another image than FILE, with the names of this program's options in errors.
ReadImageResult read_other_image(const std::string& file, const ReadImageOptions& options);

/// Numbers of samples along the axes.
std::vector<std::size_t> sizes_of(const AnyImage& image);

/// How the contour lies on the curved grid of its image.
template <int N, class Real>
struct CurvedContour {
  std::span<const CurvedAxis> axes = {};         ///< none: the contour is not on a curved grid
  const Contour<N, Real>* in_indices = nullptr;  ///< the same vertices on index_grid
  bool by_index = false;                         ///< curved grids have their indices as coordinates (--index-grid)
  bool of_mesh = false;                          ///< of a mesh of cells: files that are meshes are left out
  /// For a contour on a lattice, and an image of its dimension: the attribute without name and unit.
  std::function<Attribute(const ReadImageResult& image, const std::string& file)> on_lattice = {};
};

class AttributeOptions {
 public:
  /// Adds --attribute to a command. This object must outlive the parse.
  void add_to(CLI::App& app);

  [[nodiscard]] bool wanted() const { return !texts_.empty(); }

  /// The files to read.
  [[nodiscard]] std::vector<std::string> files() const;

  /// The files that are meshes of cells, with their variables. `allow_outside_paths`: in .pvd files.
  [[nodiscard]] std::vector<FileAndVariable> meshes(bool allow_outside_paths) const;

  /// Throws FileNotFound if a file is missing, before the long work.
  void require_inputs() const;

  /// Sets the image that is contoured, whose sizes `sample_to` then compares on curved grids and with --index-grid.
  void keep_sizes_of(const AnyImage& image);
  template <int N>
  void keep_sizes_of(const Grid<N>& grid) {
    sizes_.clear();
    for (const Axis& axis : grid.axes) sizes_.push_back(axis.size());
  }

  /// Interpolates the images at the vertices, as attributes named after the variables, or after the files without
  /// extensions. `reading`: how the files are read. Images on the contour's own curved grid are interpolated by the
  /// indices. Throws InvalidArgument if two have the same name; UnsupportedData for an image of another dimension or on
  /// another curved grid, of other sizes with --index-grid, or without any value at a contour on a curved grid; and
  /// errors of the readers.
  template <int N, class Real>
  void sample_to(Contour<N, Real>& contour, ReadImageOptions reading, unsigned threads, ProgressBar& bar,
                 const std::type_identity_t<CurvedContour<N, Real>>& curved = {}) const;

 private:
  std::vector<std::string> texts_;
  std::vector<std::size_t> sizes_;  ///< of the image that is contoured; empty: unknown
};

}  // namespace tegl::cli
