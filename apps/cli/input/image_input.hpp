// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the image of FILE, for all commands: one file, or several files of one image, and the options to read them.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "output/result.hpp"
#include "tegl/io/cell_meshes.hpp"
#include "tegl/io/series.hpp"

namespace tegl::cli {

/// Replaces names of library options in an error message by the program's names.
std::string with_option_names(std::string message);

/// Calls `read`; if the image has 5 axes, which it refuses, throws InvalidArgument that names the option.
template <class Read>
auto with_option_to_4d(std::string_view option, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::UnsupportedData ||
        std::string_view(error.what()).find("image of 5 axes") == std::string_view::npos)
      throw;
    throw Error(ErrorCode::InvalidArgument, std::string(option) + " with an image of 5 axes; expected 2 to 4 axes");
  }
}

/// --var, --series, --times, --time-step, --time-unit, --sort, --fix, --raw and the options of its layout.
class ImageOptions {
 public:
  /// Adds the options to a command. This object must outlive the parse.
  void add_to(CLI::App& app);
  /// Adds --in-process, which commands without images have too.
  void add_in_process_to(CLI::App& app);
  /// Whether files that may crash a library are read in a child process: always, unless --in-process is given.
  [[nodiscard]] bool separate_process() const { return !in_process_; }

  /// Value of --allow-outside-paths, which every command has, also for meshes; added by Command.
  [[nodiscard]] bool& allow_outside_paths() { return allow_outside_paths_; }
  [[nodiscard]] bool allow_outside_paths() const { return allow_outside_paths_; }

  /// Leaves the lattices of the files read from now on out of account (ReadImageOptions::as_cubic).
  void read_as_cubic() { as_cubic_ = true; }

  /// Reads the files as one image. Errors: those of read_series; InvalidArgument for options that conflict with each
  /// other or the files, and for files in the order of a shell.
  [[nodiscard]] ReadSeriesResult read(const std::vector<std::string>& files, const Progress& progress) const;
  /// The same for images of up to 5 axes. `keep_stored`: as in ReadImageOptions.
  [[nodiscard]] std::variant<ReadSeriesResult, ReadSeries5dResult> read_to_5d(const std::vector<std::string>& files,
                                                                              const Progress& progress,
                                                                              bool keep_stored = false) const;

  /// Opens the files as one image to be read layer by layer.
  [[nodiscard]] OpenSeriesResult open(const std::vector<std::string>& files) const;

  /// The options to read FILE as a mesh: --var, --times, --time-step, --sort, --cells-to-points. Errors:
  /// InvalidArgument, also for several files in the order of a shell without --sort.
  [[nodiscard]] CellMeshOptions cell_mesh_options(const Progress& progress,
                                                  const std::vector<std::string>& files = {}) const;

  /// The variables of the files, as from list_image_variables; empty for raw files.
  [[nodiscard]] std::vector<ImageVariable> variables(const std::vector<std::string>& files) const;

  /// The selected variable or DICOM series; may be empty.
  [[nodiscard]] const std::string& variable() const { return series_.empty() ? variable_ : series_; }
  /// The option that selects among the contents of these files.
  [[nodiscard]] static std::string choosing_option(const std::vector<std::string>& files);
  /// The readers' remarks about the files read so far: skipped files, uneven distances.
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
  [[nodiscard]] bool raw() const { return raw_option_->count() > 0; }
  /// Whether --index-grid is given: indices as coordinates of curved grids.
  [[nodiscard]] bool index_grid() const { return index_grid_; }
  /// Whether --curved-grid is given: structured grids as images.
  [[nodiscard]] bool curved_grid() const { return curved_grid_; }
  /// Whether --fix is given.
  [[nodiscard]] bool has_fixed() const { return !fixed_.empty(); }
  /// The names of the options that were given.
  [[nodiscard]] std::vector<std::string> given() const;

 private:
  /// Throws if --var is given for DICOM, or --series for other formats.
  void require_fitting_choice(const std::vector<std::string>& files) const;
  [[nodiscard]] SeriesOptions series_options(const std::vector<std::string>& files) const;
  void add_raw_to(CLI::App& app);
  /// Parses the layout options. Throws InvalidArgument.
  [[nodiscard]] RawLayout raw_layout() const;
  /// Reads the files by `function`, and adds hints to its errors.
  template <class Function>
  auto read_by(const Function& function, const std::vector<std::string>& files, const Progress& progress,
               bool keep_stored = false) const;
  /// Stores the remarks of a result.
  void remember(const ImageInfo& info) const {
    for (const std::string& remark : info.remarks)  // a file may be opened before it is read as a whole
      if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end()) remarks_.push_back(remark);
  }

  std::string variable_, series_, times_, time_step_, time_unit_, sort_, raw_, raw_type_, spacing_, origin_,
      axis_names_, axis_units_;
  std::uint64_t raw_offset_ = 0;
  bool raw_big_endian_ = false;
  bool allow_outside_paths_ = false;
  bool in_process_ = false;
  bool cells_to_points_ = false;
  bool index_grid_ = false;
  bool curved_grid_ = false;
  bool as_cubic_ = false;
  std::vector<std::string> fixed_;
  CLI::Option* raw_option_ = nullptr;
  std::vector<CLI::Option*> options_;
  mutable std::vector<std::string> remarks_;
};

}  // namespace tegl::cli
